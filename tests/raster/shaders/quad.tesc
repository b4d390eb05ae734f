#version 450
layout(vertices = 4) out;
layout(location = 0) in vec4 color[];
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    gl_TessLevelOuter[gl_InvocationID] = color[gl_InvocationID].w;
    if (gl_InvocationID < 2) gl_TessLevelInner[gl_InvocationID] = color[gl_InvocationID].z;
}
