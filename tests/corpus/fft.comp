#version 450
// Fast Fourier transform of 128 complex numbers (Stockham, radix 2) with two halves of shared memory.
//! groups 2 1 1
//! buffer 0 0 2048 uniform -1 1
//! buffer 0 1 2048 zero
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { vec2 source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { vec2 result[]; };
shared vec2 data[2][128];
vec2 times(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }
void main() {
    uint i = gl_LocalInvocationIndex, base = gl_WorkGroupID.x * 128u;
    data[0][i] = source[base + i];
    data[0][i + 64u] = source[base + i + 64u];
    uint from = 0u;
    for (uint half_ = 1u; half_ < 128u; half_ <<= 1) {
        barrier();
        uint k = i & (half_ - 1u);
        float angle = -3.14159265358979 * float(k) / float(half_);
        vec2 a = data[from][i], b = times(vec2(cos(angle), sin(angle)), data[from][i + 64u]);
        uint to = 2u * i - k;
        data[from ^ 1u][to] = a + b;
        data[from ^ 1u][to + half_] = a - b;
        from ^= 1u;
    }
    barrier();
    result[base + i] = data[from][i];
    result[base + i + 64u] = data[from][i + 64u];
}
