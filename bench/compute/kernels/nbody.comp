#version 450
// Gravity of every body on every other, a tile of bodies at a time in shared memory.

layout(local_size_x = 128) in;
layout(set = 0, binding = 0) readonly buffer Bodies {
    vec4 bodies[];  // position and mass
};
layout(set = 0, binding = 1) writeonly buffer Accelerations {
    vec4 accelerations[];
};
shared vec4 tile[128];

void main() {
    vec3 position = bodies[gl_GlobalInvocationID.x].xyz, sum = vec3(0.0);
    for (uint first = 0u; first < gl_NumWorkGroups.x * 128u; first += 128u) {
        tile[gl_LocalInvocationIndex] = bodies[first + gl_LocalInvocationIndex];
        barrier();
        for (uint i = 0u; i < 128u; ++i) {
            vec3 to = tile[i].xyz - position;
            float inverse = inversesqrt(dot(to, to) + 0.01);
            sum += to * ((tile[i].w * 0.5 + 0.5) * inverse * inverse * inverse);
        }
        barrier();
    }
    accelerations[gl_GlobalInvocationID.x] = vec4(sum, 0.0);
}
