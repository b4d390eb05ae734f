#version 450
// Text from a signed-distance atlas with outline and shadow, antialiased by derivatives.
layout(location = 0) in vec2 uv;
layout(location = 1) flat in uvec4 glyph;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D atlas;
void main() {
    vec2 cell = vec2(glyph.x % 16u, glyph.x / 16u % 16u) / 16.0;
    vec2 at = cell + fract(uv) / 16.0;
    float d = texture(atlas, at).r - 0.4;
    float width = clamp(fwidth(d), 1e-3, 0.25);
    float inside = smoothstep(-width, width, d), outline = smoothstep(-width, width, d + 0.1);
    float shadow = smoothstep(-0.1, 0.1, texture(atlas, at - 0.004).r - 0.4);
    vec4 ink = unpackUnorm4x8(glyph.y);
    vec4 base = mix(vec4(0.0, 0.0, 0.0, shadow * 0.5), vec4(0.0, 0.0, 0.0, 1.0), outline);
    colour = mix(base, ink, inside);
}
