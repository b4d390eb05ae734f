#version 450
layout(local_size_x = 4) in;
layout(set = 0, binding = 0) buffer Data { float values[]; };
void main() { values[gl_GlobalInvocationID.x] = sqrt(values[gl_GlobalInvocationID.x]) * 2.0; }
