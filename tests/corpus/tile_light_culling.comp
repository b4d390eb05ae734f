#version 450
// Tiled light culling: the depth bounds of a tile by atomics, lights against its frustum, a list in shared memory.
//! groups 4 2 1
//! buffer 0 1 1024 uniform -1 1
//! buffer 0 2 4096 zero
layout(local_size_x = 8, local_size_y = 4) in;
layout(set = 0, binding = 0) uniform sampler2D depths;
layout(std430, set = 0, binding = 1) readonly buffer Lights { vec4 lights[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Lists { uint lists[]; };
shared uint low, high, count;
shared uint mask[2];
void main() {
    uint i = gl_LocalInvocationIndex, tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (i == 0u) { low = 0xFFFFFFFFu; high = 0u; count = 0u; mask[0] = 0u; mask[1] = 0u; }
    barrier();
    float depth = texelFetch(depths, ivec2(gl_GlobalInvocationID.xy), 0).r;
    atomicMin(low, floatBitsToUint(depth));
    atomicMax(high, floatBitsToUint(depth));
    barrier();
    float near = uintBitsToFloat(low), far = uintBitsToFloat(high);
    vec2 centre = (vec2(gl_WorkGroupID.xy) + 0.5) / vec2(gl_NumWorkGroups.xy) * 2.0 - 1.0;
    for (uint k = i; k < 64u; k += 32u) {
        vec4 light = lights[k];
        float radius = 0.2 + 0.4 * abs(light.w);
        vec2 d = max(abs(light.xy - centre) - 1.0 / vec2(gl_NumWorkGroups.xy), 0.0);
        if (dot(d, d) > radius * radius || abs(light.z) + radius < near || abs(light.z) - radius > far) continue;
        atomicOr(mask[k >> 5], 1u << (k & 31u));
        atomicAdd(count, 1u);
    }
    barrier();
    if (i < 2u) lists[tile * 4u + i] = mask[i];
    if (i == 2u) lists[tile * 4u + 2u] = count;
    if (i == 3u) lists[tile * 4u + 3u] = findMSB(mask[1] | 1u);
}
