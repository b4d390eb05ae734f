#version 460
// One set of vertices for many draws: each places its own by the number of the draw, of the instance and of the vertex.
layout(location = 0) in vec4 corner;
layout(location = 0) out vec4 color;
layout(set = 0, binding = 0) readonly buffer Draws { vec4 draws[16]; };
void main() {
    int vertex = gl_VertexIndex - gl_BaseVertex, instance = gl_InstanceIndex - gl_BaseInstance;
    vec4 draw = draws[(gl_DrawID * 3 + instance) & 15];
    gl_Position = vec4(corner.xy * draw.x + draw.zw, float(vertex) * 0.01, 1.0);
    color = vec4(float(gl_DrawID), float(gl_BaseVertex * 16 + gl_BaseInstance), float(instance), float(vertex % 4));
}
