#version 450
#extension GL_EXT_shader_atomic_float : require
#extension GL_EXT_shader_atomic_float2 : require
// Atomics on an image of floats: weights gathered by cell, the nearest and the farthest depth, values handed over.
//! groups 2 1 1
//! buffer 0 1 1024 uniform 0 1
//! buffer 0 2 2048 zero
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, r32f) uniform image2D image;
layout(std430, set = 0, binding = 1) readonly buffer Points { vec2 points[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Result { vec4 result[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    vec2 point = points[i & 127u];
    ivec2 cell = ivec2(point * 8.0), own = ivec2(32 + i % 16u, 16 + i / 16u);
    // Sums of multiples of 1/8 do not depend on their order.
    imageAtomicAdd(image, cell, float(i) * 0.125);
    imageAtomicMin(image, cell + ivec2(16, 0), point.x - 0.5);
    imageAtomicMax(image, cell + ivec2(0, 16), point.y - 0.5);
    float before = imageAtomicExchange(image, own, point.x), put = imageAtomicAdd(image, own, point.y);
    imageAtomicMin(image, own, uintBitsToFloat(0x7FC00000u));
    result[i] = vec4(before, put, imageLoad(image, own).x, imageAtomicMax(image, own, -0.0));
}
