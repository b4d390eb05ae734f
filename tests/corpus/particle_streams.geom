#version 450
// A step of a particle system: those that live on into one stream, what they shed into others, until there is no room.
//! buffer 0 0 64 uniform -1 1
layout(points) in;
layout(points, max_vertices = 6) out;
layout(location = 0) in vec4 velocity[];
layout(location = 1) in float age[];
layout(location = 0, stream = 0) out vec4 outVelocity;
layout(location = 1, stream = 0) out float outAge;
layout(location = 2, stream = 1) out vec3 spark;
layout(location = 3, stream = 3) out ivec2 note;
layout(std140, set = 0, binding = 0) uniform Forces { vec4 gravity; } forces;
void main() {
    float next = age[0] + 0.25;
    if (next < 1.0) {
        outVelocity = velocity[0] + forces.gravity * 0.25;
        gl_Position = gl_in[0].gl_Position + outVelocity * 0.25;
        outAge = next;
        EmitStreamVertex(0);
    }
    int sparks = int(abs(velocity[0].x) * 8.0);
    for (int n = 0; n < sparks; ++n) {
        spark = velocity[0].xyz * float(n + 1);
        EmitStreamVertex(1);
        EndStreamPrimitive(1);
    }
    note = ivec2(gl_PrimitiveIDIn, sparks);
    EmitStreamVertex(3);
}
