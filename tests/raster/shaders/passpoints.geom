#version 450
layout(points) in;
layout(points, max_vertices = 1) out;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 outColor;
void main() {
    gl_Position = gl_in[0].gl_Position;
    gl_PointSize = color[0].w;
    outColor = color[0];
    EmitVertex();
}
