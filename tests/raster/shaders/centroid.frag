#version 450
layout(location = 0) centroid in float value;
layout(location = 0) out vec4 result;
void main() { result = vec4(value); }
