#version 450
// Bitonic sort of 128 keys with their payloads in shared memory.
//! groups 2 1 1
//! buffer 0 0 4096 integer 0 100000
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Data { uvec2 pairs[]; };
shared uvec2 keys[128];
void main() {
    uint i = gl_LocalInvocationIndex, base = gl_WorkGroupID.x * 128u;
    keys[i] = pairs[base + i];
    keys[i + 64u] = pairs[base + i + 64u];
    for (uint size = 2u; size <= 128u; size <<= 1)
        for (uint stride = size >> 1; stride > 0u; stride >>= 1) {
            barrier();
            uint low = 2u * i - (i & (stride - 1u)), high = low + stride;
            bool up = (low & size) == 0u;
            uvec2 a = keys[low], b = keys[high];
            if ((a.x > b.x) == up && a.x != b.x) {
                keys[low] = b;
                keys[high] = a;
            }
        }
    barrier();
    pairs[base + i] = keys[i];
    pairs[base + i + 64u] = keys[i + 64u];
}
