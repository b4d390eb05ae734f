#version 450
layout(lines) in;
layout(line_strip, max_vertices = 2) out;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 outColor;
void main() {
    gl_Position = gl_in[0].gl_Position;
    outColor = color[0];
    EmitVertex();
    gl_Position = gl_in[1].gl_Position;
    outColor = color[1];
    EmitVertex();
}
