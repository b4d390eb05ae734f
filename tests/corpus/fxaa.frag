#version 450
// Fast approximate antialiasing (Lottes 2009), the short console variant.
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D image;
void main() {
    const vec3 weights = vec3(0.299, 0.587, 0.114);
    vec2 texel = 1.0 / vec2(textureSize(image, 0));
    vec4 luma4 = textureGather(image, uv, 1);
    float nw = dot(textureLodOffset(image, uv, 0.0, ivec2(-1, -1)).rgb, weights);
    float ne = dot(textureLodOffset(image, uv, 0.0, ivec2(1, -1)).rgb, weights);
    float sw = dot(textureLodOffset(image, uv, 0.0, ivec2(-1, 1)).rgb, weights);
    float se = dot(textureLodOffset(image, uv, 0.0, ivec2(1, 1)).rgb, weights);
    float m = dot(textureLod(image, uv, 0.0).rgb, weights);
    float low = min(m, min(min(nw, ne), min(sw, se))), high = max(m, max(max(nw, ne), max(sw, se)));
    vec2 direction = vec2(-((nw + ne) - (sw + se)), (nw + sw) - (ne + se));
    float reduce = max((nw + ne + sw + se) * 0.03125, 0.0078125);
    float scale = 1.0 / (min(abs(direction.x), abs(direction.y)) + reduce);
    direction = clamp(direction * scale, -8.0, 8.0) * texel;
    vec3 a = 0.5 * (textureLod(image, uv + direction * (1.0 / 3.0 - 0.5), 0.0).rgb +
                    textureLod(image, uv + direction * (2.0 / 3.0 - 0.5), 0.0).rgb);
    vec3 b = a * 0.5 + 0.25 * (textureLod(image, uv - direction * 0.5, 0.0).rgb +
                               textureLod(image, uv + direction * 0.5, 0.0).rgb);
    float luma = dot(b, weights);
    colour = vec4(luma < low || luma > high ? a : b, luma4.x + luma4.w);
}
