#version 450
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
#extension GL_EXT_shader_16bit_storage : require
// A polynomial, a dot product and conversions in 16-bit floats.
//! vulkan 1.1
//! buffer 0 0 1024 special
//! buffer 0 1 2048 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { float16_t source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { f16vec4 result[]; };
void main() {
    uint i = gl_LocalInvocationIndex;
    float16_t x = source[i], y = source[i + 32u], z = float16_t(0.25) + float16_t(i) * float16_t(0.0625);
    float16_t p = ((z * float16_t(0.5) - float16_t(1.0)) * z + float16_t(0.3)) * z + x;
    f16vec3 a = f16vec3(x, y, z), b = f16vec3(z, float16_t(1.5), y);
    result[i * 2u] = f16vec4(p, x * y, x / z, x < y ? x - y : x + y);
    result[i * 2u + 1u] = f16vec4(dot(a, b), float16_t(float(x) * 3.0), min(x, z), float16_t(int(z * float16_t(100.0))));
}
