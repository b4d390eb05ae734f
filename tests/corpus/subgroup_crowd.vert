#version 450
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_clustered : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
// A crowd that keeps together: each looks at who stands next to it and counts who is of its kind.
//! vulkan 1.1
//! inputs uniform -4 4
//! input 1 integer 0 9
layout(location = 0) in vec4 place;
layout(location = 1) in int kind;
layout(location = 0) out vec4 outPlace;
layout(location = 1) flat out uvec4 counts;
void main() {
    uvec4 here = subgroupBallot(true);
    uint other = gl_SubgroupInvocationID ^ 3u, rank = 0u, most = 0u;
    vec4 neighbour = subgroupShuffle(place, other);
    if (!subgroupBallotBitExtract(here, other)) neighbour = place;
    for (int n = 0; n < 6; ++n) {
        if (n > kind) break;
        rank = rank * 3u + subgroupBallotExclusiveBitCount(subgroupBallot((kind & 1) == (n & 1)));
        if ((kind + n) % 3 == 0) most += uint(subgroupMax(kind - n) + subgroupClusteredAdd(kind, 8u));
    }
    counts = uvec4(rank, most, subgroupInclusiveAdd(uint(kind)), subgroupAllEqual(kind / 8) ? here.x : gl_SubgroupSize);
    outPlace = vec4(min(place, neighbour).xyz, subgroupMin(place.x));
    gl_Position = vec4(place.xyz, subgroupAny(kind == 7) ? subgroupExclusiveMax(place.w) : 1.0);
}
