#version 450
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_quad : require
#extension GL_KHR_shader_subgroup_shuffle_relative : require
#extension GL_KHR_shader_subgroup_vote : require
// Points that are moved by how many of those made with them lie where.
//! vulkan 1.1
//! inputs uniform -4 4
layout(quads, equal_spacing) in;
layout(location = 0) in vec4 corner[];
layout(location = 0) out vec4 moved;
layout(location = 1) flat out uvec4 counts;
void main() {
    uvec4 here = subgroupBallot(true), far = subgroupBallot(gl_TessCoord.x > 0.5);
    uint me = gl_SubgroupInvocationID, next = me + 1u;
    vec4 p = mix(mix(corner[0], corner[1], gl_TessCoord.x), mix(corner[2], corner[3], gl_TessCoord.x), gl_TessCoord.y);
    vec4 after = subgroupShuffleDown(p, 1u), beside = subgroupQuadSwapHorizontal(p);
    if (next > 31u || !subgroupBallotBitExtract(here, next & 31u)) after = p;
    if (!subgroupBallotBitExtract(here, me ^ 1u)) beside = p;
    counts = uvec4(subgroupBallotBitCount(far), subgroupBallotFindMSB(here), 0u, 0u);
    if (p.y > 0.0) {
        counts.z = subgroupInclusiveAdd(me * 5u + 1u);
        if (p.z > 0.0) counts.w = subgroupBallot(p.x > p.w).x;
        else counts.w = subgroupAnd(me | 64u) + (subgroupAny(p.w < -2.0) ? 1000u : 0u);
    }
    moved = vec4(after.xy + beside.zw, subgroupMax(p.x), subgroupBroadcastFirst(p.y));
    gl_Position = p;
}
