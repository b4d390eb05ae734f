#version 450
// Cellular noise: distances to the nearest and second nearest of jittered points.
layout(location = 0) in vec3 position;
layout(location = 0) out vec4 colour;
vec2 point(ivec2 cell) {
    uvec2 q = uvec2(cell) * uvec2(1597334673u, 3812015801u);
    uint n = (q.x ^ q.y) * 1597334673u;
    return vec2(n & 0xFFFFu, n >> 16) * (1.0 / 65536.0);
}
void main() {
    vec2 p = position.xy * 5.0;
    ivec2 cell = ivec2(floor(p));
    vec2 f = fract(p);
    float nearest = 8.0, second = 8.0;
    ivec2 owner = ivec2(0);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            vec2 d = vec2(x, y) + point(cell + ivec2(x, y)) - f;
            float square = dot(d, d);
            if (square < nearest) {
                second = nearest;
                nearest = square;
                owner = cell + ivec2(x, y);
            } else if (square < second) {
                second = square;
            }
        }
    colour = vec4(sqrt(nearest), sqrt(second), sqrt(second) - sqrt(nearest), point(owner).x);
}
