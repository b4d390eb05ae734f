#version 450
// Rays against a small implicit binary tree of boxes with a stack, Moeller-Trumbore on triangles at the leaves.
//! groups 1 1 1
//! buffer 0 0 4096 uniform -1 1
//! buffer 0 1 2048 zero
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Triangles { vec4 vertex[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Hits { vec4 hits[]; };
vec3 corner(int triangle, int k) { return vertex[(triangle * 3 + k) & 127].xyz * 0.4 + vec3(triangle & 1, triangle >> 1 & 1, triangle >> 2 & 3) * 0.4; }
bool box(vec3 o, vec3 inverse, int node, float far) {
    float size = 2.5 / float(1 << (findMSB(node)));
    vec3 centre = vec3(0.3) + 0.1 * vec3(node & 3, node & 5, node & 7), a = (centre - size - o) * inverse, b = (centre + size - o) * inverse;
    vec3 low = min(a, b), high = max(a, b);
    float enter = max(max(low.x, low.y), max(low.z, 0.0)), leave = min(min(high.x, high.y), min(high.z, far));
    return enter <= leave;
}
void main() {
    uint i = gl_GlobalInvocationID.x;
    vec3 o = vec3(float(i % 8u) * 0.1, float(i / 8u) * 0.1, -2.0), d = normalize(vec3(0.1, 0.05, 1.0)), inverse = 1.0 / d;
    float t = 1e9;
    vec2 uv = vec2(0.0);
    int stack[8], top = 1, hit = -1;
    stack[0] = 1;
    while (top > 0) {
        int node = stack[--top];
        if (!box(o, inverse, node, t)) continue;
        if (node < 8) {
            stack[top++] = node * 2;
            stack[top++] = node * 2 + 1;
            continue;
        }
        vec3 a = corner(node, 0), e1 = corner(node, 1) - a, e2 = corner(node, 2) - a, p = cross(d, e2);
        float determinant_ = dot(e1, p);
        if (abs(determinant_) < 1e-7) continue;
        vec3 s = (o - a) / determinant_;
        float u = dot(s, p);
        vec3 q = cross(s, e1);
        float v = dot(d, q), at = dot(e2, q);
        if (u < 0.0 || v < 0.0 || u + v > 1.0 || at < 1e-4 || at >= t) continue;
        t = at; uv = vec2(u, v); hit = node;
    }
    hits[i] = vec4(hit < 0 ? -1.0 : t, uv, float(hit));
}
