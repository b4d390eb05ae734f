#version 450
// Separable Gaussian: one direction, nine taps as five by sampling between texels.
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D image;
layout(push_constant) uniform Push { vec2 direction; } push;
const float offsets[3] = float[](0.0, 1.3846153846, 3.2307692308);
const float weights[3] = float[](0.2270270270, 0.3162162162, 0.0702702703);
void main() {
    vec2 texel = push.direction / vec2(textureSize(image, 0));
    colour = textureLod(image, uv, 0.0) * weights[0];
    for (int i = 1; i < 3; ++i) {
        colour += textureLod(image, uv + texel * offsets[i], 0.0) * weights[i];
        colour += textureLod(image, uv - texel * offsets[i], 0.0) * weights[i];
    }
}
