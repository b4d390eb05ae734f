#version 450
// Triangles thrown outwards along their normals, with a spike where they face up: strips of a number found at run time.
//! buffer 0 0 256 uniform -1 1
layout(triangles) in;
layout(triangle_strip, max_vertices = 10) out;
layout(location = 0) in vec3 normal[];
layout(location = 1) in vec2 uv[];
layout(location = 0) out vec3 outNormal;
layout(location = 1) out vec2 outUv;
layout(location = 2) flat out int id;
layout(std140, set = 0, binding = 0) uniform Shell { mat4 view; vec4 wind; } shell;
void corner(vec3 place, int v) {
    gl_Position = shell.view * vec4(place, 1.0);
    outNormal = normalize(normal[v]);
    outUv = uv[v] * 0.5 + 0.5;
    id = gl_PrimitiveIDIn * 4 + v;
    gl_PrimitiveID = gl_PrimitiveIDIn;
    EmitVertex();
}
void main() {
    vec3 a = gl_in[0].gl_Position.xyz, b = gl_in[1].gl_Position.xyz, c = gl_in[2].gl_Position.xyz;
    vec3 n = cross(b - a, c - a);
    float area = length(n);
    if (area < 1e-3) return;
    vec3 away = n / area * (0.1 + dot(shell.wind.xyz, n));
    for (int v = 0; v < 3; ++v) corner(gl_in[v].gl_Position.xyz + away, v);
    EndPrimitive();
    if (n.y < 0.0) return;
    vec3 tip = (a + b + c) / 3.0 + away * 2.0;
    for (int v = 0; v < 3; ++v) {
        corner(gl_in[v].gl_Position.xyz + away, v);
        corner(tip, (v + 1) % 3);
        if (uv[v].x > 0.5) EndPrimitive();
    }
}
