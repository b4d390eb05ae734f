#version 450
// Simplex noise in two dimensions (Perlin 2001) with a hash in place of a table.
layout(location = 0) in vec2 position;
layout(location = 0) out vec4 colour;
vec2 gradient(ivec2 p) {
    uint h = (uint(p.x) * 1597334677u) ^ (uint(p.y) * 3812015801u);
    h = h * 2654435769u;
    float angle = float(h >> 8) * (6.2831853 / 16777216.0);
    return vec2(cos(angle), sin(angle));
}
float noise(vec2 p) {
    const float F = 0.366025403784, G = 0.211324865405;
    vec2 i = floor(p + (p.x + p.y) * F), x0 = p - i + (i.x + i.y) * G;
    vec2 side = x0.x > x0.y ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    vec2 x1 = x0 - side + G, x2 = x0 - 1.0 + 2.0 * G;
    vec3 h = max(0.5 - vec3(dot(x0, x0), dot(x1, x1), dot(x2, x2)), 0.0);
    vec3 n = h * h * h * h * vec3(dot(x0, gradient(ivec2(i))), dot(x1, gradient(ivec2(i + side))),
                                  dot(x2, gradient(ivec2(i) + 1)));
    return dot(n, vec3(70.0));
}
void main() {
    float n = noise(position * 6.0) + 0.5 * noise(position * 12.0);
    colour = vec4(0.5 + 0.5 * n, n, n * n, 1.0);
}
