#version 450
// Several levels of a mip chain in one work-group, by shared memory.
//! groups 2 2 1
//! buffer 0 1 8192 zero
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D image;
layout(std430, set = 0, binding = 1) writeonly buffer Levels { vec4 levels[]; };
shared vec4 texels[8][8];
void main() {
    uvec2 l = gl_LocalInvocationID.xy;
    uint group = gl_WorkGroupID.y * 2u + gl_WorkGroupID.x;
    texels[l.y][l.x] = textureLod(image, (vec2(gl_GlobalInvocationID.xy) + 0.5) / 16.0, 0.0);
    for (uint size = 4u, base = 0u; size > 0u; base += size * size, size >>= 1) {
        barrier();
        vec4 v;
        bool active_ = l.x < size && l.y < size;
        if (active_) {
            uvec2 p = l * 2u;
            v = (texels[p.y][p.x] + texels[p.y][p.x + 1u] + texels[p.y + 1u][p.x] + texels[p.y + 1u][p.x + 1u]) * 0.25;
        }
        barrier();
        if (active_) {
            texels[l.y][l.x] = v;
            levels[group * 32u + base + l.y * size + l.x] = v;
        }
    }
}
