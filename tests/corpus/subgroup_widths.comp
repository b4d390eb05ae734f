#version 450
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_clustered : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_EXT_shader_subgroup_extended_types_int8 : require
#extension GL_EXT_shader_subgroup_extended_types_int16 : require
#extension GL_EXT_shader_subgroup_extended_types_int64 : require
#extension GL_EXT_shader_subgroup_extended_types_float16 : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
// Normalised weights of halves, checksums of bytes and shorts, and wide products, across subgroups that branch.
//! vulkan 1.1
//! groups 2 1 1
//! buffer 0 0 2048 uniform -4 4
//! buffer 0 1 8192 zero
layout(local_size_x = 80) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { float source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { uvec4 result[]; };
void main() {
    float16_t v = float16_t(source[gl_GlobalInvocationID.x]);
    uint8_t byte = uint8_t(floatBitsToUint(source[gl_GlobalInvocationID.x]) >> 13);
    f16vec2 scaled = f16vec2(v, v * float16_t(0.3));
    float16_t most = subgroupMax(v);
    float16_t share = float16_t(1) / (float16_t(1) + (most - v) * (most - v));
    f16vec2 sums = subgroupInclusiveAdd(scaled);
    uint words = 0u;
    if ((int(byte) & 3) != 0) {
        share /= subgroupAdd(share);
        words = uint(subgroupExclusiveAdd(byte)) | uint(subgroupClusteredXor(uint16_t(byte) * uint16_t(257), 8u)) << 8;
        sums.y = subgroupClusteredMul(scaled.y, 4u);
    }
    uint64_t wide = subgroupInclusiveMul(uint64_t(byte) | 1ul);
    int16_t low = subgroupMin(int16_t(byte) * int16_t(-200));
    int8_t turned = subgroupShuffleXor(int8_t(byte), 5u);
    result[gl_GlobalInvocationID.x * 2u] = uvec4(packFloat2x16(f16vec2(share, most)), packFloat2x16(sums), words, uint(wide));
    result[gl_GlobalInvocationID.x * 2u + 1u] = uvec4(uint(wide >> 32), uint(low), uint(turned), uint(subgroupAllEqual(byte >> 7)));
}
