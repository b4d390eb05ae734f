#version 450
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_shader_16bit_storage : require
// Colours and codes of 16 bits between the stages and to the attachments.
//! input 1 integer -40000 40000
layout(location = 0) in f16vec4 tint;
layout(location = 1) flat in i16vec2 code;
layout(location = 2) flat in u16vec3 mask;
layout(location = 0) out f16vec4 color;
layout(location = 1) out i16vec2 sums;
layout(location = 2) out uint16_t bits;
void main() {
    color = tint * float16_t(1.5) + f16vec4(code.x > code.y ? 0.25 : -0.25);
    sums = i16vec2(code.x + code.y, code.x - int16_t(3));
    bits = mask.x ^ (mask.y << 3us) & ~mask.z;
}
