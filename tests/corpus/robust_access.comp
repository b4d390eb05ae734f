#version 450
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
// Indices far outside: places that do not fit 32 bits, before the buffer, and across its end.
//! buffer 0 0 1024 special
//! buffer 0 1 1020 special
//! buffer 0 2 1036 special
//! buffer 0 3 4096 zero
layout(local_size_x = 64) in;
struct Item {
    vec4 head;
    mat4 matrix;
    uint tail[12];
};
layout(std430, set = 0, binding = 0) readonly buffer Indices { uint indices[]; };
layout(std430, set = 0, binding = 1) buffer Items { uint first[4]; Item items[]; };
layout(std430, set = 0, binding = 2) buffer Longs { uint64_t before; double longs[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Result { uvec4 results[]; };
void main() {
    uint i = gl_LocalInvocationIndex, index = indices[i], wrapping = 0x2000000u * (index % 256u);
    uint sum = floatBitsToUint(items[index].head.y) + items[int(index)].tail[wrapping % 12u];
    sum += items[wrapping].tail[3] + first[index] + first[wrapping * 32u];
    sum += floatBitsToUint(items[i % 8u].matrix[indices[i + 64u]][indices[i + 128u] % 4u]);
    uvec2 pair = unpackUint2x32(uint64_t(doubleBitsToInt64(longs[i * 2u]))) + unpackUint2x32(uint64_t(doubleBitsToInt64(longs[index])));
    pair += unpackUint2x32(uint64_t(doubleBitsToInt64(longs[wrapping])));
    barrier();
    if (i < 8u) items[wrapping + i + 0x20000000u].tail[i] = 77u;
    if (i < 8u) longs[0x20000000u * (i % 4u) + 128u] = 1.0;
    results[i] = uvec4(sum, pair, first[indices[i + 192u] >> 2u]);
}
