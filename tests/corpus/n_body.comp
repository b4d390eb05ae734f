#version 450
// N-body: gravity of all bodies, tiles of positions through shared memory.
//! groups 2 1 1
//! buffer 0 0 1024 uniform -1 1
//! buffer 0 1 1024 uniform -1 1
//! buffer 0 2 2048 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) readonly buffer Positions { vec4 positions[]; };
layout(std430, set = 0, binding = 1) readonly buffer Velocities { vec4 velocities[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Next { vec4 next[]; };
shared vec4 tile[32];
void main() {
    uint i = gl_GlobalInvocationID.x;
    vec4 p = positions[i];
    vec3 acceleration = vec3(0.0);
    for (uint t = 0u; t < 2u; ++t) {
        tile[gl_LocalInvocationIndex] = positions[t * 32u + gl_LocalInvocationIndex];
        barrier();
        for (int k = 0; k < 32; ++k) {
            vec3 d = tile[k].xyz - p.xyz;
            float inverse = inversesqrt(dot(d, d) + 0.01);
            acceleration += d * (abs(tile[k].w) * inverse * inverse * inverse);
        }
        barrier();
    }
    vec3 v = velocities[i].xyz + acceleration * 0.01;
    next[i] = vec4(p.xyz + v * 0.01, p.w);
    next[64u + i] = vec4(v, length(acceleration));
}
