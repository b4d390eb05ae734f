#version 450
// Fractal gradient noise in three dimensions: integer hashes and smooth blends, no branches.

vec3 gradient(ivec3 cell) {
    uvec3 h = uvec3(cell) * uvec3(1597334673u, 3812015801u, 2798796415u);
    uint n = (h.x ^ h.y ^ h.z) * 1597334673u;
    n ^= n >> 15;
    n *= 2246822519u;
    uvec3 bits = uvec3(n, n >> 10, n >> 20) & 1023u;
    return vec3(bits) * (2.0 / 1023.0) - 1.0;
}

float gradientNoise(vec3 p) {
    vec3 base = floor(p), f = p - base;
    ivec3 cell = ivec3(base);
    vec3 blend = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    float corner[8];
    for (int i = 0; i < 8; ++i) {
        ivec3 offset = ivec3(i & 1, i >> 1 & 1, i >> 2);
        corner[i] = dot(gradient(cell + offset), f - vec3(offset));
    }
    vec4 x = mix(vec4(corner[0], corner[2], corner[4], corner[6]), vec4(corner[1], corner[3], corner[5], corner[7]),
                 blend.x);
    vec2 y = mix(x.xz, x.yw, blend.y);
    return mix(y.x, y.y, blend.z);
}

vec4 image(vec2 uv) {
    vec3 p = vec3(uv * 8.0, 0.5);
    float sum = 0.0, weight = 0.5;
    for (int octave = 0; octave < 6; ++octave) {
        sum += weight * gradientNoise(p);
        p = p * 2.03 + vec3(17.0, 5.0, 11.0);
        weight *= 0.5;
    }
    return vec4(vec3(0.5 + 0.5 * sum), 1.0);
}
