#version 450
// Search of a pattern by Knuth, Morris and Pratt: the failure table in a local array, positions in a bit mask.
//! groups 1 1 1
//! buffer 0 0 4096 integer 0 1
//! buffer 0 1 256 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) readonly buffer Text { uint text[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Found { uvec2 found[]; };
void main() {
    uint i = gl_GlobalInvocationID.x, pattern[5], failure[5];
    for (uint k = 0u; k < 5u; ++k) pattern[k] = i >> k & 1u;
    failure[0] = 0u;
    for (uint q = 1u, k = 0u; q < 5u; ++q) {
        while (k > 0u && pattern[k] != pattern[q]) k = failure[k - 1u];
        if (pattern[k] == pattern[q]) ++k;
        failure[q] = k;
    }
    uint mask = 0u, count = 0u, state = 0u;
    for (uint n = 0u; n < 96u; ++n) {
        uint c = text[i * 7u + n];
        while (state > 0u && (state == 5u || pattern[state] != c)) state = failure[state - 1u];
        if (pattern[state] == c) ++state;
        if (state == 5u) { ++count; mask |= 1u << (n & 31u); }
    }
    found[i] = uvec2(count, mask);
}
