#version 450
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_shuffle_relative : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_quad : require
#extension GL_KHR_shader_subgroup_clustered : require
// Transposition and sorting by shuffles, neighbours in quads, clusters of eight.
//! vulkan 1.1
//! groups 2 1 1
//! buffer 0 0 2048 uniform -1 1
//! buffer 0 1 8192 zero
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { float source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { vec4 result[]; };
void main() {
    uint i = gl_SubgroupInvocationID;
    float v = source[gl_GlobalInvocationID.x], sorted = v;
    for (uint size = 2u; size <= 32u; size <<= 1)
        for (uint stride = size >> 1; stride > 0u; stride >>= 1) {
            float other = subgroupShuffleXor(sorted, stride);
            bool up = ((i & size) == 0u) == ((i & stride) == 0u);
            sorted = up ? min(sorted, other) : max(sorted, other);
        }
    float turned = subgroupShuffle(v, (i & 3u) * 8u + (i >> 2));
    float left = i > 0u ? subgroupShuffleUp(v, 1u) : 0.0, quad = subgroupQuadBroadcast(v, 2u) + subgroupQuadSwapHorizontal(v);
    uint cluster = subgroupClusteredAdd(uint(abs(v) * 100.0), 8u);
    uvec4 mask = subgroupBallot(v > 0.0);
    uint at = subgroupBallotExclusiveBitCount(mask), first = subgroupBallotFindLSB(mask);
    result[gl_GlobalInvocationID.x * 2u] = vec4(sorted, turned, left, quad);
    result[gl_GlobalInvocationID.x * 2u + 1u] = vec4(cluster, at, subgroupBroadcast(v, 5u), float(first) + subgroupBroadcastFirst(v));
}
