#version 450
// Colours of vertices are (red, green, inner level, outer level).
layout(vertices = 3) out;
layout(location = 0) in vec4 color[];
layout(location = 0) out vec4 corner[];
layout(location = 1) patch out float whole;
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    corner[gl_InvocationID] = color[gl_InvocationID];
    barrier();
    if (gl_InvocationID != 2) return;
    whole = float(gl_PatchVerticesIn);
    for (int n = 0; n < 3; ++n) gl_TessLevelOuter[n] = corner[n].w;
    gl_TessLevelInner[0] = corner[1].z;
}
