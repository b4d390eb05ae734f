#version 450
#extension GL_ARB_gpu_shader_int64 : require
// Positions in double precision, relative to an origin, and identities of 64 bits.
//! input 2 integer -1000 1000
layout(location = 0) in dvec3 place;
layout(location = 2) in i64vec2 identity;
layout(location = 0) flat out dvec3 moved;
layout(location = 2) flat out u64vec2 names;
layout(push_constant) uniform Origin { vec4 origin; };
void main() {
    moved = place * 0.5lf + dvec3(origin.xyz);
    names = u64vec2(identity.x * identity.y, identity.x ^ (identity.y >> 7));
    gl_Position = vec4(vec3(moved), 1.0);
}
