#version 450
// Adds to every block what the blocks before it sum up to.

layout(local_size_x = 256) in;
layout(set = 0, binding = 1) buffer Output {
    uvec4 prefixes[];
};
layout(set = 0, binding = 2) readonly buffer Sums {
    uint sums[];
};

void main() {
    if (gl_WorkGroupID.x > 0u) prefixes[gl_GlobalInvocationID.x] += sums[gl_WorkGroupID.x - 1u];
}
