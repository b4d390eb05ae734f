#version 450
layout(location = 0) out vec4 result;
void main() { result = vec4(float(gl_PrimitiveID), gl_FrontFacing ? 1.0 : 0.0, gl_PointCoord); }
