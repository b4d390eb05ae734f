#version 450
// Each point becomes two strips of two triangles; every invocation its own, by the numbers it gets.
layout(points, invocations = 3) in;
layout(triangle_strip, max_vertices = 8) out;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 outColor;
void corner(float x, float y) {
    gl_Position = gl_in[0].gl_Position + vec4(x, y, 0.0, 0.0);
    EmitVertex();
}
void main() {
    float right = float(gl_InvocationID) * 0.25;
    outColor = vec4(float(gl_PrimitiveIDIn), float(gl_InvocationID), color[0].zw);
    gl_PrimitiveID = 100 * gl_PrimitiveIDIn + gl_InvocationID;
    for (int strip = 0; strip < 2; ++strip) {
        float below = float(strip) * 0.25;
        corner(right, below);
        corner(right + 0.125, below);
        corner(right, below + 0.125);
        corner(right + 0.125, below + 0.125);
        EndPrimitive();
    }
}
