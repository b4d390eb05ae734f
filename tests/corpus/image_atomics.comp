#version 450
// Atomics on an image: splats of points counted by cell, a mask of who came, the largest value.
//! groups 2 1 1
//! integers 0 0
//! buffer 0 1 1024 uniform 0 1
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, r32ui) uniform uimage2D image;
layout(std430, set = 0, binding = 1) readonly buffer Points { vec2 points[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    ivec2 cell = ivec2(points[i & 127u] * 8.0);
    imageAtomicAdd(image, cell, 1u);
    imageAtomicMax(image, cell + ivec2(16, 0), i);
    imageAtomicOr(image, cell + ivec2(32, 0), 1u << (i & 31u));
    imageAtomicXor(image, cell + ivec2(48, 0), i * 2654435761u);
    imageAtomicMin(image, cell + ivec2(0, 16), i);
    imageAtomicAnd(image, cell + ivec2(16, 16), ~(1u << (i & 7u)));
}
