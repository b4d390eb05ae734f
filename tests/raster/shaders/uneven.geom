#version 450
// As many vertices as the first vertex's colour says, which may be more than there is room for, and ends of strips where
// nothing has begun.
layout(triangles) in;
layout(triangle_strip, max_vertices = 5) out;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 outColor;
void main() {
    EndPrimitive();
    int count = int(color[0].x);
    for (int v = 0; v < count; ++v) {
        int from = v % 3;
        gl_Position = gl_in[from].gl_Position + vec4(float(v / 3) * 0.5, 0.0, 0.0, 0.0);
        outColor = color[(v + 1) % 3];
        EmitVertex();
        if (v == 6) EndPrimitive();
    }
    EndPrimitive();
    EndPrimitive();
}
