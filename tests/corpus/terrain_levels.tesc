#version 450
// Levels of a terrain's cells by their distance, the same for a side from both cells that have it.
//! buffer 0 0 64 uniform -1 1
//! push 16 uniform 1 8
layout(vertices = 4) out;
layout(location = 0) in vec2 uv[];
layout(location = 0) out vec2 outUv[];
layout(std140, set = 0, binding = 0) uniform Eye { vec4 eye; } eye;
layout(push_constant) uniform Detail { float scale; } detail;
float level(vec3 a, vec3 b) {
    float away = distance((a + b) * 0.5, eye.eye.xyz);
    return clamp(detail.scale * 16.0 / (0.1 + away), 1.0, 64.0);
}
void main() {
    outUv[gl_InvocationID] = uv[gl_InvocationID];
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    gl_TessLevelOuter[gl_InvocationID] =
        level(gl_in[gl_InvocationID].gl_Position.xyz, gl_in[(gl_InvocationID + 1) & 3].gl_Position.xyz);
    barrier();
    if (gl_InvocationID < 2)
        gl_TessLevelInner[gl_InvocationID] =
            max(gl_TessLevelOuter[gl_InvocationID], gl_TessLevelOuter[gl_InvocationID + 2]);
}
