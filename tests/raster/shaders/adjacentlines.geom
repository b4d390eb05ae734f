#version 450
layout(lines_adjacency) in;
layout(line_strip, max_vertices = 4) out;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 outColor;
void main() {
    for (int v = 0; v < 4; ++v) {
        gl_Position = gl_in[v].gl_Position;
        outColor = color[v];
        EmitVertex();
    }
}
