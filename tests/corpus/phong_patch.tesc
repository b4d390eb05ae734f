#version 450
// Phong tessellation: what the projections onto the tangent planes of the corners need, once per corner, and then what
// the neighbours have found out.
layout(vertices = 3) out;
layout(location = 0) in vec3 normal[];
layout(location = 1) in ivec2 kind[];
layout(location = 0) out Corner { vec3 normal; float term[3]; } corner[];
layout(location = 5) patch out float flatness;
layout(location = 6) flat out ivec2 outKind[];
float project(int i, vec3 q) {
    vec3 d = q - gl_in[i].gl_Position.xyz;
    return dot(d, normal[i]);
}
void main() {
    int me = gl_InvocationID, next = (me + 1) % 3;
    gl_out[gl_InvocationID].gl_Position = gl_in[me].gl_Position;
    corner[gl_InvocationID].normal = normal[me];
    for (int c = 0; c < 3; ++c)
        corner[gl_InvocationID].term[c] = project(me, gl_in[next].gl_Position.xyz) * normal[me][c] +
                             project(next, gl_in[me].gl_Position.xyz) * normal[next][c];
    outKind[gl_InvocationID] = kind[me] * 2 + gl_PrimitiveID;
    barrier();
    float bend = 0.0;
    for (int v = 0; v < 3; ++v)
        for (int c = 0; c < 3; ++c) bend += abs(corner[v].term[c] - corner[(v + me) % 3].term[c]);
    if (me == 1) flatness = bend;
    if (me == 2) {
        gl_TessLevelInner[0] = 1.0 + bend + float(outKind[0].x & 3);
        for (int s = 0; s < 3; ++s) gl_TessLevelOuter[s] = 1.0 + abs(corner[(s + 1) % 3].term[0]) * 8.0;
    }
}
