#version 450
// Levels of a bicubic patch by the lengths of its sides on the screen, and whether it is seen at all.
//! invocations 32
//! buffer 0 0 256 uniform -1 1
layout(vertices = 16) out;
layout(location = 0) in vec3 normal[];
layout(location = 0) out vec3 outNormal[];
layout(location = 1) patch out vec4 bounds;
layout(std140, set = 0, binding = 0) uniform View { mat4 clip; vec4 size; } view;
vec2 onScreen(int v) {
    vec4 p = view.clip * gl_in[v].gl_Position;
    return p.xy / max(abs(p.w), 1e-3) * view.size.xy * 40.0;
}
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    outNormal[gl_InvocationID] = normalize(normal[gl_InvocationID]);
    if (gl_InvocationID % 5 != 0) return;
    const ivec2 kSides[4] = ivec2[](ivec2(0, 12), ivec2(0, 3), ivec2(3, 15), ivec2(12, 15));
    int side = gl_InvocationID / 5;
    float level = clamp(distance(onScreen(kSides[side].x), onScreen(kSides[side].y)) / 8.0, 1.0, 64.0);
    gl_TessLevelOuter[side] = level;
    if (side != 0) return;
    vec4 box = vec4(1e9, 1e9, -1e9, -1e9);
    for (int v = 0; v < gl_PatchVerticesIn; ++v) {
        vec2 p = onScreen(v);
        box = vec4(min(box.xy, p), max(box.zw, p));
    }
    bounds = box;
    gl_TessLevelInner[0] = gl_TessLevelInner[1] = length(box.zw - box.xy);
}
