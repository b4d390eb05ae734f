#version 450
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
// Levels that the corners of a patch agree on without memory: each knows what the others have found out.
//! vulkan 1.1
//! invocations 20
//! inputs uniform -4 4
layout(vertices = 5) out;
layout(location = 0) in vec4 weight[];
layout(location = 0) out vec4 outWeight[];
layout(location = 1) flat out uvec4 votes[];
layout(location = 2) patch out float share;
void main() {
    int me = gl_InvocationID;
    float w = weight[me].x;
    uvec4 positive = subgroupBallot(w > 0.0);
    outWeight[gl_InvocationID] = vec4(subgroupInclusiveAdd(w), subgroupMax(w),
                                     subgroupShuffle(w, uint(me + 1) % 5u), subgroupAdd(w));
    votes[gl_InvocationID] = uvec4(positive.x, subgroupBallotExclusiveBitCount(positive), subgroupElect() ? 1u : 0u, gl_SubgroupSize);
    if ((me & 1) == 0) votes[gl_InvocationID].z += subgroupAdd(uint(me) + 3u) + (subgroupAll(w > -3.0) ? 100u : 0u);
    votes[gl_InvocationID].w += gl_SubgroupInvocationID + gl_SubgroupGeMask.x;
    barrier();
    if (subgroupElect()) {
        share = outWeight[4].w - outWeight[1].x;
        for (int n = 0; n < 4; ++n) gl_TessLevelOuter[n] = float(votes[n].y) + 1.0;
        gl_TessLevelInner[0] = gl_TessLevelInner[1] = float(bitCount(positive.x));
    }
}
