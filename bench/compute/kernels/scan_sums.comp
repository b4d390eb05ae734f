#version 450
// Prefix sums of the list of block sums, by one work-group: 1024 numbers.

layout(local_size_x = 256) in;
layout(set = 0, binding = 2) buffer Sums {
    uvec4 sums[];
};
shared uint totals[256];

void main() {
    uint me = gl_LocalInvocationIndex;
    uvec4 mine = sums[me];
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
    sums[me] = mine + (total - mine.w);
}
