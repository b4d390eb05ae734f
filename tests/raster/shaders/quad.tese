#version 450
layout(quads, equal_spacing, cw) in;
layout(location = 0) out vec4 outColor;
void main() {
    vec4 a = mix(gl_in[0].gl_Position, gl_in[1].gl_Position, gl_TessCoord.x);
    vec4 b = mix(gl_in[3].gl_Position, gl_in[2].gl_Position, gl_TessCoord.x);
    gl_Position = mix(a, b, gl_TessCoord.y);
    outColor = vec4(gl_TessCoord.xy, float(gl_TessLevelOuter[1] + gl_TessLevelInner[1]), 1);
}
