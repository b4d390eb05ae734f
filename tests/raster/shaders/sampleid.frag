#version 450
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 result;
void main() { result = vec4(float(gl_SampleID), gl_FragCoord.xy, color.x); }
