#version 450
// An elementary cellular automaton of any rule, several generations in shared memory with ping-pong rows.
//! groups 2 1 1
//! buffer 0 0 1024 integer 0 1
//! buffer 0 1 1024 zero
//! spec 0 110
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint rule = 30u;
layout(std430, set = 0, binding = 0) readonly buffer First { uint first[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Last { uint last[]; };
shared uint rows[2][64];
void main() {
    uint i = gl_LocalInvocationIndex;
    rows[0][i] = first[gl_GlobalInvocationID.x] & 1u;
    uint bits = 0u;
    for (uint generation = 0u; generation < 16u; ++generation) {
        barrier();
        uint from = generation & 1u;
        uint pattern = rows[from][(i + 63u) & 63u] << 2 | rows[from][i] << 1 | rows[from][(i + 1u) & 63u];
        uint next = rule >> pattern & 1u;
        rows[from ^ 1u][i] = next;
        bits = bits << 1 | next;
    }
    last[gl_GlobalInvocationID.x] = bits;
}
