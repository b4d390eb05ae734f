#version 450
// The counting pass of marching cubes: corner signs to a case, triangles and places by an atomic in shared memory.
//! groups 1 1 2
//! buffer 0 0 4096 zero
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 1) uniform sampler3D volume;
layout(std430, set = 0, binding = 0) buffer Result { uint cases[128]; vec4 normals[128]; uint counts[8]; };
shared uint count;
float field(vec3 p) { return textureLod(volume, p / 8.0, 0.0).x + 0.2 * sin(p.x) - 0.4; }
void main() {
    if (gl_LocalInvocationIndex == 0u) count = 0u;
    barrier();
    vec3 p = vec3(gl_GlobalInvocationID);
    uint code = 0u;
    for (uint k = 0u; k < 8u; ++k) {
        vec3 corner = vec3(k & 1u, k >> 1 & 1u, k >> 2);
        if (field(p + corner) < 0.0) code |= 1u << k;
    }
    uint at = gl_WorkGroupID.z * 64u + gl_LocalInvocationIndex;
    cases[at] = code;
    if (code != 0u && code != 255u) {
        atomicAdd(count, uint(bitCount(code ^ code >> 1)));
        vec3 g = vec3(field(p + vec3(1, 0, 0)), field(p + vec3(0, 1, 0)), field(p + vec3(0, 0, 1))) - field(p);
        normals[at] = vec4(normalize(g + 1e-6), 1.0);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) counts[gl_WorkGroupID.z] = count;
}
