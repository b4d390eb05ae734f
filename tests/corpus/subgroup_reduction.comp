#version 450
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_basic : require
// Sums of a work-group by subgroup reductions joined in shared memory; scans and extremes beside.
//! vulkan 1.1
//! groups 2 1 1
//! buffer 0 0 2048 integer -1000 1000
//! buffer 0 1 4096 zero
layout(local_size_x = 96) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { int source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { ivec4 result[]; };
shared int sums[4];
void main() {
    int v = source[gl_GlobalInvocationID.x];
    int before = subgroupExclusiveAdd(v), low = subgroupMin(v), product = subgroupInclusiveMul(v | 1);
    if (subgroupElect()) sums[gl_SubgroupID] = subgroupAdd(1);
    int sum = subgroupAdd(v);
    if (gl_SubgroupInvocationID == 0u) sums[gl_SubgroupID] = sum;
    barrier();
    int base = 0;
    for (uint k = 0u; k < gl_SubgroupID; ++k) base += sums[k];
    result[gl_GlobalInvocationID.x] = ivec4(base + before, low, product, subgroupInclusiveMax(v) ^ subgroupXor(v));
}
