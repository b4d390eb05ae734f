#version 450
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 outColor;
void main() {
    for (int v = 0; v < 3; ++v) {
        gl_Position = gl_in[v].gl_Position;
        outColor = color[v];
        gl_PrimitiveID = gl_PrimitiveIDIn;
        EmitVertex();
    }
}
