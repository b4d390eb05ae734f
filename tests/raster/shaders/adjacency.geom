#version 450
layout(triangles_adjacency) in;
layout(triangle_strip, max_vertices = 9) out;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 outColor;
void corner(int v) {
    gl_Position = gl_in[v].gl_Position;
    outColor = color[v];
    EmitVertex();
}
// The three neighbours, each with the edge that it shares.
void main() {
    for (int side = 0; side < 6; side += 2) {
        corner(side);
        corner(side + 1);
        corner((side + 2) % 6);
        EndPrimitive();
    }
}
