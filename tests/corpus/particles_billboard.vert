#version 450
// Particles without a vertex buffer: state from a storage buffer, a quad from the vertex index, size by age.
//! buffer 0 0 2048 uniform -1 1
layout(location = 0) out vec2 uv;
layout(location = 1) out vec4 tint;
struct Particle { vec3 position; float age; vec3 velocity; uint colour; };
layout(std430, set = 0, binding = 0) readonly buffer Particles { Particle particles[]; };
layout(push_constant) uniform Push { mat4 view; vec4 right; } push;
void main() {
    Particle p = particles[gl_VertexIndex / 6 % 64];
    vec2 corner = vec2((0x32 >> gl_VertexIndex % 6) & 1, (0x1C >> gl_VertexIndex % 6) & 1);
    float age = fract(abs(p.age)), size = mix(0.02, 0.2, smoothstep(0.0, 1.0, age));
    vec3 along = normalize(p.velocity), side = normalize(cross(along, push.right.xyz));
    vec3 world = p.position + p.velocity * age - vec3(0.0, 4.9 * age * age, 0.0);
    world += ((corner.x - 0.5) * side + (corner.y - 0.5) * along * (1.0 + length(p.velocity))) * size;
    uv = corner;
    tint = unpackUnorm4x8(p.colour) * (1.0 - age);
    gl_Position = push.view * vec4(world, 1.0);
}
