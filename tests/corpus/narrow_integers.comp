#version 450
#extension GL_EXT_shader_explicit_arithmetic_types_int8 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int16 : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_16bit_storage : require
// Arithmetic in 8 and 16 bits: a checksum, saturated addition, conversions and shifts that wrap.
//! vulkan 1.1
//! buffer 0 0 1024 special
//! buffer 0 1 1024 special
//! buffer 0 2 2048 zero
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Bytes { int8_t bytes[]; };
layout(std430, set = 0, binding = 1) readonly buffer Shorts { uint16_t shorts[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Result { int16_t words[256]; uint8_t small[256]; };
void main() {
    uint i = gl_LocalInvocationIndex;
    int8_t a = bytes[i], b = bytes[i + 64u];
    uint16_t c = shorts[i], d = shorts[i + 64u];
    int16_t wide = int16_t(a) * int16_t(b) + int16_t(c);
    int16_t saturated = int16_t(clamp(int(a) + int(b), -128, 127));
    uint8_t narrow = uint8_t(c) + uint8_t(d >> 8);
    c = c << uint16_t(3) | c >> uint16_t(13);
    if (b != int8_t(0)) wide -= int16_t(a / b) ^ int16_t(a % b);
    words[i * 3u] = wide;
    words[i * 3u + 1u] = saturated < int16_t(b) ? saturated : int16_t(c * d);
    words[i * 3u + 2u] = int16_t(max(c, d) - min(c, d));
    small[i * 2u] = narrow;
    small[i * 2u + 1u] = uint8_t(abs(int(a))) & uint8_t(~narrow);
}
