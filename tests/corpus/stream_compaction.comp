#version 450
#extension GL_KHR_shader_subgroup_ballot : require
// Compaction: those that pass are written one behind the other, by ballots and one atomic for each subgroup.
//! vulkan 1.1
//! groups 3 1 1
//! buffer 0 0 2048 integer 0 100
//! buffer 0 1 2048 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { uint source[]; };
layout(std430, set = 0, binding = 1) buffer Result { uint counts[8]; uint kept[]; };
void main() {
    uint v = source[gl_GlobalInvocationID.x];
    bool keep = v % 3u != 0u;
    uvec4 mask = subgroupBallot(keep);
    uint base = gl_WorkGroupID.x * 32u;
    if (subgroupElect()) atomicAdd(counts[gl_WorkGroupID.x], subgroupBallotBitCount(mask));
    if (keep) kept[base + subgroupBallotExclusiveBitCount(mask)] = v * (subgroupInverseBallot(mask) ? 2u : 3u);
}
