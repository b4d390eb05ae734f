#version 450
// Exclusive prefix sum, work-efficient (Blelloch 1990), two elements for each invocation.
//! groups 2 1 1
//! buffer 0 0 4096 uniform 0 1
//! buffer 0 1 4096 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { float source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { float result[]; };
shared float tree[64];
void main() {
    uint i = gl_LocalInvocationIndex, base = gl_WorkGroupID.x * 64u;
    tree[2u * i] = source[base + 2u * i];
    tree[2u * i + 1u] = source[base + 2u * i + 1u];
    uint offset = 1u;
    for (uint d = 32u; d > 0u; d >>= 1) {
        barrier();
        if (i < d) tree[offset * (2u * i + 2u) - 1u] += tree[offset * (2u * i + 1u) - 1u];
        offset *= 2u;
    }
    if (i == 0u) tree[63] = 0.0;
    for (uint d = 1u; d < 64u; d *= 2u) {
        offset >>= 1;
        barrier();
        if (i < d) {
            uint a = offset * (2u * i + 1u) - 1u, b = offset * (2u * i + 2u) - 1u;
            float t = tree[a];
            tree[a] = tree[b];
            tree[b] += t;
        }
    }
    barrier();
    result[base + 2u * i] = tree[2u * i];
    result[base + 2u * i + 1u] = tree[2u * i + 1u];
}
