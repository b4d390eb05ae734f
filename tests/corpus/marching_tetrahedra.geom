#version 450
// A level set inside a tetrahedron, given as a line with its neighbours: none, one or two triangles.
layout(lines_adjacency) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = 0) in float density[];
layout(location = 0) out vec3 gradient;
layout(location = 1) flat out uint inside;
const uvec4 kEdges[16] = uvec4[](uvec4(0), uvec4(1, 2, 3, 0), uvec4(8, 6, 7, 0), uvec4(2, 3, 6, 7),
                                 uvec4(9, 11, 4, 0), uvec4(1, 3, 9, 11), uvec4(8, 7, 9, 11), uvec4(3, 7, 11, 0),
                                 uvec4(12, 14, 13, 0), uvec4(1, 2, 13, 14), uvec4(8, 6, 13, 12), uvec4(2, 6, 14, 0),
                                 uvec4(12, 13, 9, 4), uvec4(1, 13, 9, 0), uvec4(8, 12, 4, 0), uvec4(0));
void crossing(uint edge) {
    uint a = edge >> 2 & 3u, b = edge & 3u;
    float t = density[a] / (density[a] - density[b]);
    gl_Position = mix(gl_in[a].gl_Position, gl_in[b].gl_Position, clamp(t, 0.0, 1.0));
    gradient = gl_in[b].gl_Position.xyz - gl_in[a].gl_Position.xyz;
    EmitVertex();
}
void main() {
    uint mask = 0;
    for (int v = 0; v < 4; ++v) mask |= density[v] < 0.0 ? 1u << v : 0u;
    uvec4 edges = kEdges[mask];
    inside = mask;
    for (int e = 0; e < 4 && edges[e] != 0u; ++e) crossing(edges[e]);
}
