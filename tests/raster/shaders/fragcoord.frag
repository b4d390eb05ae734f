#version 450
layout(location = 0) out vec4 result;
void main() { result = gl_FragCoord; }
