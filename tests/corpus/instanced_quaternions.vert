#version 450
// Instances with position, orientation and scale packed into four words.
//! buffer 0 0 1024 integer -2147483648 2147483647
layout(location = 0) in vec3 position;
layout(location = 0) out vec4 colour;
layout(std430, set = 0, binding = 0) readonly buffer Instances { uvec4 instance[]; };
vec4 orientation(uint packed) {
    vec3 q = (vec3(bitfieldExtract(packed, 0, 10), bitfieldExtract(packed, 10, 10), bitfieldExtract(packed, 20, 10)) / 1023.0 * 2.0 - 1.0) * 0.70710678;
    float w = sqrt(max(0.0, 1.0 - dot(q, q)));
    switch (packed >> 30) {
        case 0u: return vec4(w, q);
        case 1u: return vec4(q.x, w, q.yz);
        case 2u: return vec4(q.xy, w, q.z);
        default: return vec4(q, w);
    }
}
void main() {
    uvec4 data = instance[uint(gl_InstanceIndex) & 63u];
    vec4 q = orientation(data.x);
    vec3 p = position * (0.5 + unpackHalf2x16(data.y & 0x3BFF3BFFu).x);
    p = p + 2.0 * cross(q.xyz, cross(q.xyz, p) + q.w * p);
    p += vec3(unpackSnorm2x16(data.z), unpackSnorm4x8(data.w).x) * 8.0;
    colour = unpackUnorm4x8(data.w);
    gl_Position = vec4(p, 1.0);
}
