#version 450
// A triangle for each face of a cube that sees it, an invocation each: layered rendering of a point light's shadows.
//! buffer 0 0 512 uniform -1 1
layout(triangles, invocations = 6) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec4 world[];
layout(location = 0) out vec4 outWorld;
layout(std140, set = 0, binding = 0) uniform Light { mat4 faces[6]; vec4 place; } light;
void main() {
    mat4 face = light.faces[gl_InvocationID];
    vec4 clip[3];
    int outside = 0;
    for (int v = 0; v < 3; ++v) {
        clip[v] = face * vec4(world[v].xyz - light.place.xyz, 1.0);
        if (clip[v].x > abs(clip[v].w)) ++outside;
    }
    if (outside == 3) return;
    for (int v = 0; v < 3; ++v) {
        gl_Position = clip[v];
        gl_Layer = gl_InvocationID;
        gl_ViewportIndex = gl_InvocationID & 1;
        outWorld = world[v];
        EmitVertex();
    }
}
