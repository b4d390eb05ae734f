#version 450
// Kaleidoscopic iterated function system: folds and scales in a loop, coloured by orbit traps.
layout(location = 0) in vec3 position;
layout(location = 0) out vec4 colour;
layout(constant_id = 3) const int iterations = 5;
//! spec 3 9
void main() {
    vec3 z = position * 2.0;
    float trap = 1e9, scale = 1.0;
    for (int i = 0; i < iterations; ++i) {
        if (z.x + z.y < 0.0) z.xy = -z.yx;
        if (z.x + z.z < 0.0) z.xz = -z.zx;
        if (z.y + z.z < 0.0) z.yz = -z.zy;
        z = z * 1.8 - vec3(0.8);
        scale *= 1.8;
        trap = min(trap, dot(z, z));
        if (dot(z, z) > 1e4) break;
    }
    colour = vec4(sqrt(trap), length(z) / scale, fract(z.xy));
}
