#version 450
// One step of k-means: assignment to the nearest centre, sums by fixed-point atomics in shared memory.
//! groups 2 1 1
//! buffer 0 0 2048 uniform 0 1
//! buffer 0 1 128 uniform 0 1
//! buffer 0 2 1024 zero
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Points { vec4 points[]; };
layout(std430, set = 0, binding = 1) readonly buffer Centres { vec4 centres[5]; };
layout(std430, set = 0, binding = 2) buffer Result { uint labels[128]; uint sums[5][5]; };
shared uint local[5][5];
void main() {
    uint i = gl_LocalInvocationIndex, at = gl_GlobalInvocationID.x;
    if (i < 25u) local[i / 5u][i % 5u] = 0u;
    barrier();
    vec4 p = points[at];
    uint best = 0u;
    float nearest = 1e9;
    for (uint c = 0u; c < 5u; ++c) {
        float d = distance(p, centres[c]);
        if (d < nearest) { nearest = d; best = c; }
    }
    labels[at] = best;
    for (uint k = 0u; k < 4u; ++k) atomicAdd(local[best][k], uint(p[k] * 65536.0));
    atomicAdd(local[best][4], 1u);
    barrier();
    if (i < 25u) atomicAdd(sums[i / 5u][i % 5u], local[i / 5u][i % 5u]);
}
