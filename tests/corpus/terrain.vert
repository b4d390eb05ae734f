#version 450
// Terrain: heights from a texture by fetch with bilinear weights, normals by differences, clip distances for a plane.
layout(location = 0) in vec2 grid;
layout(location = 0) out vec3 normal;
layout(location = 1) flat out ivec2 tile;
layout(set = 0, binding = 0) uniform sampler2D heights;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[2]; };
float heightAt(vec2 p) {
    vec2 t = p * 63.0, f = fract(t);
    ivec2 i = ivec2(floor(t));
    float a = texelFetch(heights, i & 63, 0).r, b = texelFetch(heights, (i + ivec2(1, 0)) & 63, 0).r;
    float c = texelFetch(heights, (i + ivec2(0, 1)) & 63, 0).r, d = texelFetch(heights, (i + 1) & 63, 0).r;
    return mix(mix(a, b, f.x), mix(c, d, f.x), f.y);
}
void main() {
    const vec2 e = vec2(1.0 / 64.0, 0.0);
    float h = heightAt(grid);
    normal = normalize(vec3(heightAt(grid - e) - heightAt(grid + e), 2.0 * e.x, heightAt(grid - e.yx) - heightAt(grid + e.yx)));
    tile = ivec2(floor(grid * 16.0));
    gl_Position = vec4(grid.x, h, grid.y, 1.0);
    gl_ClipDistance[0] = h - 0.2;
    gl_ClipDistance[1] = dot(gl_Position, vec4(0.1, 0.5, -0.3, 0.2));
}
