#version 450
// Game of life on words of 32 cells: neighbours counted with bit-sliced adders.
//! groups 4 1 1
//! buffer 0 0 512 integer -2147483648 2147483647
//! buffer 0 1 512 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) readonly buffer Now { uint now[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Next { uint next[]; };
uint cell(uint row, uint word) { return now[(row & 31u) * 4u + (word & 3u)]; }
uint left(uint row, uint word) { return cell(row, word) << 1 | cell(row, word - 1u) >> 31; }
uint right(uint row, uint word) { return cell(row, word) >> 1 | cell(row, word + 1u) << 31; }
void main() {
    uint at = gl_GlobalInvocationID.x, row = at / 4u, word = at % 4u;
    uint n[8] = uint[](left(row - 1u, word), cell(row - 1u, word), right(row - 1u, word), left(row, word),
                       right(row, word), left(row + 1u, word), cell(row + 1u, word), right(row + 1u, word));
    uint one = 0u, two = 0u, four = 0u;
    for (int k = 0; k < 8; ++k) {
        uint carry = one & n[k];
        one ^= n[k];
        uint high = two & carry;
        two ^= carry;
        four |= high;
    }
    next[at] = two & ~four & (one | cell(row, word));
}
