#version 450
// Inclusive prefix sum of a work-group (Hillis and Steele), and the group's total.
//! groups 3 1 1
//! buffer 0 0 4096 integer -100 100
//! buffer 0 1 4096 zero
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { int source[]; };
layout(std430, set = 0, binding = 1) buffer Result { int result[]; };
shared int values[64];
void main() {
    uint i = gl_LocalInvocationID.x, at = gl_GlobalInvocationID.x;
    values[i] = source[at];
    barrier();
    for (uint step = 1u; step < 64u; step <<= 1) {
        int add = i >= step ? values[i - step] : 0;
        barrier();
        values[i] += add;
        barrier();
    }
    result[at] = values[i];
    if (i == 63u) result[512u + gl_WorkGroupID.x] = values[63];
}
