#version 450
// Random numbers by counter (Philox 4x32-10) and normal deviates by Box and Muller; a Monte Carlo integral.
//! groups 2 1 1
//! buffer 0 0 4096 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) writeonly buffer Result { vec4 result[]; };
uvec4 philox(uvec4 c, uvec2 k) {
    for (int round_ = 0; round_ < 10; ++round_) {
        uint h0, l0, h1, l1;
        umulExtended(0xD2511F53u, c.x, h0, l0);
        umulExtended(0xCD9E8D57u, c.z, h1, l1);
        c = uvec4(h1 ^ c.y ^ k.x, l1, h0 ^ c.w ^ k.y, l0);
        k += uvec2(0x9E3779B9u, 0xBB67AE85u);
    }
    return c;
}
void main() {
    uint i = gl_GlobalInvocationID.x;
    vec4 sum = vec4(0.0);
    for (uint n = 0u; n < 4u; ++n) {
        vec4 u = (vec4(philox(uvec4(i, n, 0u, 7u), uvec2(1u, 2u)) >> 8) + 0.5) / 16777216.0;
        vec2 radius = sqrt(-2.0 * log(u.xz)), angle = 6.2831853 * u.yw;
        sum += vec4(radius * cos(angle), radius * sin(angle));
    }
    result[i] = sum * 0.5;
}
