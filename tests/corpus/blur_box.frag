#version 450
// Box blur, 5 x 5 texels, by fetches with repeated borders.
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D image;
void main() {
    ivec2 size = textureSize(image, 0);
    ivec2 centre = ivec2(uv * vec2(size));
    vec4 sum = vec4(0.0);
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) sum += texelFetch(image, (centre + ivec2(x, y) + size) % size, 0);
    colour = sum / 25.0;
}
