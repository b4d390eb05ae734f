#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) centroid out float value;
void main() { gl_Position = position; value = color.x; }
