#version 450
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
// 64-bit integers: a hash (FNV-1a and xorshift), multiplication with carries, division.
//! vulkan 1.1
//! buffer 0 0 2048 special
//! buffer 0 1 2048 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { uint64_t source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { uint64_t result[]; };
void main() {
    uint i = gl_LocalInvocationIndex;
    uint64_t hash = 0xcbf29ce484222325ul, x = source[i], y = source[i + 32u];
    for (uint k = 0u; k < 8u; ++k) hash = (hash ^ (x >> (8u * k) & 255ul)) * 0x100000001b3ul;
    uint64_t s = x | 1ul;
    s ^= s << 13; s ^= s >> 7; s ^= s << 17;
    int64_t q = y != 0ul ? int64_t(x) / int64_t(y) : 0l;
    result[i * 4u] = hash;
    result[i * 4u + 1u] = s;
    result[i * 4u + 2u] = uint64_t(q) + x % (y | 1ul);
    result[i * 4u + 3u] = uint64_t(max(int64_t(x), int64_t(y))) ^ uint64_t(x < y);
}
