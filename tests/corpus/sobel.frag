#version 450
// Edges of luminance by the Sobel operator; direction as a hue.
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D image;
float luminance(ivec2 at) { return dot(texelFetch(image, at, 0).rgb, vec3(0.2126, 0.7152, 0.0722)); }
void main() {
    ivec2 p = clamp(ivec2(abs(uv) * 62.0), ivec2(1), ivec2(61));
    mat3 m;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) m[c][r] = luminance(p + ivec2(c - 1, r - 1));
    float gx = m[2][0] + 2.0 * m[2][1] + m[2][2] - m[0][0] - 2.0 * m[0][1] - m[0][2];
    float gy = m[0][2] + 2.0 * m[1][2] + m[2][2] - m[0][0] - 2.0 * m[1][0] - m[2][0];
    float magnitude = length(vec2(gx, gy)), angle = atan(gy, gx);
    colour = vec4(magnitude * (0.5 + 0.5 * cos(angle + vec3(0.0, 2.094, 4.189))), magnitude);
}
