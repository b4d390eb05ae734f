#version 450
// Morph targets: sparse displacements from a storage buffer, as many as the weights in push constants are not zero.
//! buffer 0 0 8192 uniform -1 1
//! push 64 uniform 0 1
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 normal;
layout(location = 0) out vec3 n;
layout(std430, set = 0, binding = 0) readonly buffer Targets { vec4 displacement[]; };
layout(push_constant) uniform Push { float weight[8]; } push;
void main() {
    vec3 p = position.xyz;
    n = normal.xyz;
    uint count = uint(displacement.length()) / 16u;
    for (int t = 0; t < 8; ++t) {
        if (push.weight[t] < 0.25) continue;
        uint at = uint(t) * 16u + uint(gl_VertexIndex % 8) * 2u;
        if (at + 1u >= count * 16u) break;
        p += displacement[at].xyz * push.weight[t];
        n += displacement[at + 1u].xyz * push.weight[t];
    }
    n = normalize(n);
    gl_Position = vec4(p, 1.0);
    gl_PointSize = 1.0 + 4.0 * displacement[gl_VertexIndex % 64].w;
}
