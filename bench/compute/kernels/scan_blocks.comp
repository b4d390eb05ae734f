#version 450
// Prefix sums inside blocks of 1024, four numbers per invocation; the sum of each block goes into a list.

layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer Input {
    uvec4 numbers[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
    uvec4 prefixes[];
};
layout(set = 0, binding = 2) writeonly buffer Sums {
    uint sums[];
};
shared uint totals[256];

void main() {
    uint me = gl_LocalInvocationIndex;
    uvec4 mine = numbers[gl_GlobalInvocationID.x];
    mine.y += mine.x;
    mine.z += mine.y;
    mine.w += mine.z;
    uint total = mine.w;
    totals[me] = total;
    barrier();
    for (uint step = 1u; step < 256u; step *= 2u) {
        uint before = me >= step ? totals[me - step] : 0u;
        barrier();
        total += before;
        totals[me] = total;
        barrier();
    }
    prefixes[gl_GlobalInvocationID.x] = mine + (total - mine.w);
    if (me == 255u) sums[gl_WorkGroupID.x] = total;
}
