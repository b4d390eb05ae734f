#version 450
// Value noise in five octaves, turned between octaves.
layout(location = 0) in vec2 position;
layout(location = 0) out vec4 colour;
float hash(ivec2 p) {
    uint h = uint(p.x) * 374761393u + uint(p.y) * 668265263u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return float(h ^ (h >> 16)) * (1.0 / 4294967296.0);
}
float noise(vec2 p) {
    ivec2 i = ivec2(floor(p));
    vec2 f = fract(p), u = f * f * (3.0 - 2.0 * f);
    return mix(mix(hash(i), hash(i + ivec2(1, 0)), u.x), mix(hash(i + ivec2(0, 1)), hash(i + ivec2(1, 1)), u.x), u.y);
}
void main() {
    const mat2 turn = mat2(0.8, 0.6, -0.6, 0.8);
    vec2 p = position * 8.0;
    float sum = 0.0, amplitude = 0.5;
    for (int octave = 0; octave < 5; ++octave) {
        sum += amplitude * noise(p);
        p = turn * p * 2.02;
        amplitude *= 0.5;
    }
    colour = vec4(sum, fract(sum * 8.0), step(0.5, sum), 1.0);
}
