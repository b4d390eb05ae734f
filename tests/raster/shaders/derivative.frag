#version 450
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 result;
void main() { result = vec4(dFdx(color.x), dFdy(color.x), gl_HelperInvocation ? 1.0 : 0.0, 1.0); }
