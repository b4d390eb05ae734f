#version 450
// Edit distance of two strings by anti-diagonals in shared memory.
//! groups 2 1 1
//! buffer 0 0 1024 integer 0 3
//! buffer 0 1 256 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) readonly buffer Strings { uint text[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { uint distances[]; };
shared uint diagonal[3][33];
void main() {
    uint i = gl_LocalInvocationIndex, base = gl_WorkGroupID.x * 64u;
    uint a = text[base + i], best = 0u;
    for (uint d = 0u; d <= 64u; ++d) {
        uint now = d % 3u, one = (d + 2u) % 3u, two = (d + 1u) % 3u;
        for (uint row = i; row <= 32u; row += 32u) {
            if (row <= d && d - row <= 32u) {
                uint column = d - row, value;
                if (row == 0u || column == 0u) {
                    value = d;
                } else {
                    uint same = text[base + row - 1u] == text[base + 31u + column] ? 0u : 1u;
                    value = min(min(diagonal[one][row - 1u], diagonal[one][row]) + 1u, diagonal[two][row - 1u] + same);
                }
                diagonal[now][row] = value;
                if (row == i) best = value;
            }
        }
        barrier();
    }
    distances[gl_GlobalInvocationID.x] = best + (i == 31u ? diagonal[64u % 3u][32] << 16 : 0u);
}
