#version 450
// Eight queens by backtracking with an explicit stack; the first queen's column from the invocation.
//! groups 1 1 1
//! buffer 0 0 256 zero
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Result { uint solutions[8]; uint total; };
void main() {
    uint first = gl_LocalInvocationIndex, columns[7], left[7], right[7], open[7], count = 0u;
    uint bit = 1u << first;
    int depth = 1;
    columns[1] = bit; left[1] = bit << 1; right[1] = bit >> 1;
    open[1] = ~(columns[1] | left[1] | right[1]) & 0x3Fu;
    while (depth > 0) {
        if (open[depth] == 0u) { --depth; continue; }
        uint place = open[depth] & (~open[depth] + 1u);
        open[depth] &= ~place;
        if (depth == 5) { ++count; continue; }
        columns[depth + 1] = columns[depth] | place;
        left[depth + 1] = (left[depth] | place) << 1;
        right[depth + 1] = (right[depth] | place) >> 1;
        ++depth;
        open[depth] = ~(columns[depth] | left[depth] | right[depth]) & 0x3Fu;
    }
    solutions[first] = first < 6u ? count : 0u;
    if (first < 6u) atomicAdd(total, count);
}
