#version 450
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_shader_16bit_storage : require
#extension GL_EXT_shader_8bit_storage : require
layout(location = 0) in f16vec2 uv;
layout(location = 1) flat in int64_t key;
layout(location = 0) out f16vec4 color;
layout(location = 1) out i16vec2 offset;
layout(location = 2) out uvec2 hash;
struct Entry { uint8_t kind; int16_t rank; float16_t weight; };
layout(set = 0, binding = 0, std430) buffer Log { double mean; int64_t keys[2]; Entry entries[2]; f16vec2 uvs[2]; };
void main() {
    color = f16vec4(uv / float16_t(3), 1, 0);
    offset = i16vec2(key, -int(uv.x * float16_t(100)));
    hash = unpackUint2x32(uint64_t(key) * 0x9E3779B97F4A7C15ul);
    mean = double(key) / 7.0lf;
    keys[1] = -key;
    entries[1] = Entry(uint8_t(key), int16_t(-key), uv.y);
    uvs[0] = uv * float16_t(0.1);
}
