#version 450
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require
// Subgroup operations in branches, switches and loops that invocations leave at different times.
//! vulkan 1.1
//! groups 2 1 1
//! buffer 0 0 2048 integer 0 9
//! buffer 0 1 4096 zero
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { uint source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { uvec4 result[]; };
uint early(uint v) {
    if (v > 6u) return subgroupBallotBitCount(subgroupBallot(true));
    uint sum = subgroupAdd(v);
    if (v < 2u) return sum;
    return subgroupMax(v) + sum;
}
void main() {
    uint v = source[gl_GlobalInvocationID.x], a = 0u, b = 0u;
    for (uint n = 0u; n < 12u; ++n) {
        if (n > v) break;
        uvec4 here = subgroupBallot((v & 1u) == (n & 1u));
        a = a * 5u + subgroupBallotBitCount(here);
        if ((v + n) % 3u == 0u) continue;
        a += subgroupAdd(n);
        switch (v % 4u) {
            case 0u: b += subgroupAdd(1u); break;
            case 1u: b += 7u;  // falls through
            case 2u: b += subgroupMin(v + n); break;
            default: if (subgroupAll(v > 2u)) b += 3u;
        }
        b = b * 3u + (subgroupAny(v == n) ? 1u : 0u);
    }
    uint c = early(v);
    uvec4 all = subgroupBallot(true);
    result[gl_GlobalInvocationID.x] = uvec4(a, b, c, all.x ^ (subgroupAllEqual(v) ? 1u : 0u));
}
