#version 450
// Dual-quaternion skinning with four bones from a storage buffer.
//! input 3 integer 0 15
//! input 4 uniform 0 1
//! buffer 0 0 2048 uniform -1 1
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 3) in uvec4 bones;
layout(location = 4) in vec4 weights;
layout(location = 0) out vec3 worldNormal;
struct DualQuaternion { vec4 real; vec4 dual; };
layout(std430, set = 0, binding = 0) readonly buffer Skeleton { DualQuaternion pose[]; };
layout(push_constant) uniform Push { mat4 viewProjection; } push;
vec3 rotate(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
void main() {
    vec4 w = weights / (weights.x + weights.y + weights.z + weights.w);
    vec4 real = vec4(0.0), dual = vec4(0.0), first = pose[bones.x].real;
    for (int i = 0; i < 4; ++i) {
        DualQuaternion q = pose[bones[i]];
        float side = dot(first, q.real) < 0.0 ? -w[i] : w[i];
        real += side * q.real;
        dual += side * q.dual;
    }
    float norm = length(real);
    real /= norm;
    dual /= norm;
    vec3 translation = 2.0 * (real.w * dual.xyz - dual.w * real.xyz + cross(real.xyz, dual.xyz));
    vec3 p = rotate(real, position) + translation;
    worldNormal = rotate(real, normal);
    gl_Position = push.viewProjection * vec4(p, 1.0);
}
