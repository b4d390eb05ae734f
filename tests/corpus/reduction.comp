#version 450
// Sum, minimum and maximum of a work-group by a tree in shared memory; groups joined by atomics.
//! groups 4 1 1
//! buffer 0 0 4096 integer -1000 1000
//! buffer 0 1 64 zero
layout(local_size_x = 48) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { int source[]; };
layout(std430, set = 0, binding = 1) buffer Result { int sum; int low; int high; uint count; } result;
shared ivec3 values[64];
void main() {
    uint i = gl_LocalInvocationIndex;
    int v = source[gl_GlobalInvocationID.x];
    values[i] = ivec3(v);
    if (i < 16u) values[i + 48u] = ivec3(0, 2147483647, -2147483648);
    for (uint step = 32u; step > 0u; step >>= 1) {
        memoryBarrierShared();
        barrier();
        if (i < step) {
            ivec3 a = values[i], b = values[i + step];
            values[i] = ivec3(a.x + b.x, min(a.y, b.y), max(a.z, b.z));
        }
    }
    if (i == 0u) {
        atomicAdd(result.sum, values[0].x);
        atomicMin(result.low, values[0].y);
        atomicMax(result.high, values[0].z);
        atomicAdd(result.count, gl_WorkGroupSize.x);
    }
}
