#version 450
// Mandelbrot set with derivative-based distance estimate; interior test by periodicity.
//! groups 2 4 1
//! buffer 0 0 2048 zero
layout(local_size_x = 16, local_size_y = 2) in;
layout(std430, set = 0, binding = 0) writeonly buffer Result { float distance_[]; };
void main() {
    vec2 c = vec2(gl_GlobalInvocationID.xy) / vec2(16.0, 5.0) - vec2(1.6, 0.8), z = vec2(0.0), dz = vec2(0.0), old = vec2(9.0);
    float square = 0.0;
    int n = 0;
    for (; n < 64; ++n) {
        dz = 2.0 * vec2(z.x * dz.x - z.y * dz.y, z.x * dz.y + z.y * dz.x) + vec2(1.0, 0.0);
        z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + c;
        square = dot(z, z);
        if (square > 256.0) break;
        if (all(lessThan(abs(z - old), vec2(1e-6)))) { n = 64; break; }
        if ((n & (n + 1)) == 0) old = z;
    }
    float d = n >= 64 ? 0.0 : sqrt(square / dot(dz, dz)) * 0.5 * log(square);
    distance_[gl_GlobalInvocationID.y * 32u + gl_GlobalInvocationID.x] = d;
}
