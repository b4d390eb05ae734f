#version 450
// One pass of a radix sort, four bits: ranks by counting in shared memory, stable scatter.
//! groups 2 1 1
//! buffer 0 0 2048 integer 0 65535
//! buffer 0 1 2048 zero
//! spec 1 4
layout(local_size_x = 64) in;
layout(constant_id = 1) const uint shift = 0u;
layout(std430, set = 0, binding = 0) readonly buffer Source { uint source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Sorted { uint sorted[]; };
shared uint digits[64];
shared uint counts[16];
shared uint starts[16];
void main() {
    uint i = gl_LocalInvocationIndex, key = source[gl_GlobalInvocationID.x], digit = key >> shift & 15u;
    digits[i] = digit;
    if (i < 16u) counts[i] = 0u;
    barrier();
    atomicAdd(counts[digit], 1u);
    barrier();
    if (i < 16u) {
        uint sum = 0u;
        for (uint d = 0u; d < i; ++d) sum += counts[d];
        starts[i] = sum;
    }
    barrier();
    uint rank = 0u;
    for (uint k = 0u; k < i; ++k) rank += digits[k] == digit ? 1u : 0u;
    sorted[gl_WorkGroupID.x * 64u + starts[digit] + rank] = key;
}
