#version 450
// Indexed colour: indices from an integer image, a palette with animation in a uniform buffer, cosine palettes.
//! integers 0 0
//! buffer 0 1 4096 uniform 0 1
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform usampler2D indices;
layout(set = 0, binding = 1) uniform Palette { vec4 entries[256]; } palette;
layout(push_constant) uniform Push { int shift; float time; } push;
vec3 cosine(float t) { return 0.5 + 0.5 * cos(6.28318 * (vec3(1.0, 1.0, 0.5) * t + vec3(0.8, 0.9, 0.3))); }
void main() {
    ivec2 p = ivec2(uv * 64.0) & 63;
    uint index = texelFetch(indices, p, 0).r;
    uint cycled = index >= 128u ? 128u + ((index - 128u + uint(push.shift & 63)) % 128u) : index;
    vec4 entry = palette.entries[cycled & 255u];
    colour = index % 3u == 0u ? vec4(cosine(entry.x + push.time), 1.0) : entry;
}
