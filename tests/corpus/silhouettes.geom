#version 450
// The edges at which a mesh turns away from the eye, as quads, found with the neighbours of every triangle.
//! push 64 uniform -2 2
layout(triangles_adjacency) in;
layout(triangle_strip, max_vertices = 12) out;
layout(location = 0) out float side;
layout(push_constant) uniform Eye { vec4 eye; float width; } push;
bool faces(int a, int b, int c) {
    vec3 p = gl_in[a].gl_Position.xyz;
    return dot(cross(gl_in[b].gl_Position.xyz - p, gl_in[c].gl_Position.xyz - p), push.eye.xyz - p) > 0.0;
}
void main() {
    if (!faces(0, 2, 4)) return;
    for (int edge = 0; edge < 6; edge += 2) {
        int next = (edge + 2) % 6;
        if (faces(edge, edge + 1, next)) continue;
        vec4 a = gl_in[edge].gl_Position, b = gl_in[next].gl_Position;
        vec4 out_ = vec4(normalize(cross(b.xyz - a.xyz, push.eye.xyz)) * push.width, 0.0);
        side = 0.0;
        gl_Position = a;
        EmitVertex();
        gl_Position = b;
        EmitVertex();
        side = 1.0;
        gl_Position = a + out_;
        EmitVertex();
        gl_Position = b + out_;
        EmitVertex();
        EndPrimitive();
    }
}
