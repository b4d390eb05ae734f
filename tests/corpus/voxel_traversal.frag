#version 450
// Amanatides-Woo traversal of a voxel grid of bits in a storage buffer.
//! buffer 0 0 1024 integer -2147483648 2147483647
layout(location = 0) in vec2 screen;
layout(location = 0) out vec4 colour;
layout(std430, set = 0, binding = 0) readonly buffer Grid { uint words[]; };
bool solid(ivec3 p) {
    if (any(lessThan(p, ivec3(0))) || any(greaterThan(p, ivec3(15)))) return false;
    uint at = uint(p.x | p.y << 4 | p.z << 8);
    uint noise = words[at >> 5] & words[(at >> 5) ^ 1u] & words[(at >> 5) ^ 2u];
    return (noise >> (at & 31u) & 1u) != 0u;
}
void main() {
    vec3 origin = vec3(8.0, 8.0, -4.0) + vec3(screen * 3.0, 0.0), direction = normalize(vec3(screen * 0.7 + 0.01, 1.0));
    ivec3 cell = ivec3(floor(origin)), step = ivec3(sign(direction));
    vec3 delta = abs(1.0 / direction), next = (sign(direction) * (floor(origin) - origin) + sign(direction) * 0.5 + 0.5) * delta;
    int axis = 2;
    for (int i = 0; i < 64; ++i) {
        if (solid(cell)) break;
        axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
        switch (axis) {
            case 0: next.x += delta.x; cell.x += step.x; break;
            case 1: next.y += delta.y; cell.y += step.y; break;
            default: next.z += delta.z; cell.z += step.z; break;
        }
        if (cell.z > 16) break;
    }
    vec3 n = vec3(0.0);
    n[axis] = -float(step[axis]);
    colour = cell.z > 16 ? vec4(0.0) : vec4(n * 0.5 + 0.5, float(cell.z));
}
