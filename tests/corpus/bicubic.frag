#version 450
// Bicubic filtering: Catmull-Rom by sixteen fetches, B-spline by four bilinear samples.
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 sharp;
layout(location = 1) out vec4 soft;
layout(set = 0, binding = 0) uniform sampler2D image;
vec4 catmullRom(float t) {
    float t2 = t * t, t3 = t2 * t;
    return vec4(-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2);
}
vec4 spline(float t) {
    vec4 n = vec4(1.0, 2.0, 3.0, 4.0) - t, s = n * n * n;
    float x = s.x, y = s.y - 4.0 * s.x, z = s.z - 4.0 * s.y + 6.0 * s.x;
    return vec4(x, y, z, 6.0 - x - y - z) / 6.0;
}
void main() {
    vec2 size = vec2(textureSize(image, 0)), p = uv * size - 0.5, f = fract(p);
    ivec2 base = ivec2(floor(p));
    vec4 wx = catmullRom(f.x), wy = catmullRom(f.y);
    sharp = vec4(0.0);
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) sharp += wx[i] * wy[j] * texelFetch(image, (base + ivec2(i, j) - 1) & 63, 0);
    vec4 sx = spline(f.x), sy = spline(f.y);
    vec2 g0 = vec2(sx.x + sx.y, sy.x + sy.y), g1 = vec2(sx.z + sx.w, sy.z + sy.w);
    vec2 h0 = (vec2(base) - 0.5 + vec2(sx.y, sy.y) / g0) / size, h1 = (vec2(base) + 1.5 + vec2(sx.w, sy.w) / g1) / size;
    soft = g0.y * (g0.x * textureLod(image, h0, 0.0) + g1.x * textureLod(image, vec2(h1.x, h0.y), 0.0)) +
           g1.y * (g0.x * textureLod(image, vec2(h0.x, h1.y), 0.0) + g1.x * textureLod(image, h1, 0.0));
}
