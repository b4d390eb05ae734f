#version 450
// Filmic tone mapping (Hable), Reinhard and ACES side by side, with sRGB encoding.
layout(location = 0) in vec4 hdr;
layout(location = 1) in float which;
layout(location = 0) out vec4 colour;
layout(push_constant) uniform Push { float exposure; } push;
vec3 hable(vec3 x) {
    const float A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30;
    return ((x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F)) - E / F;
}
vec3 aces(vec3 x) { return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0); }
vec3 reinhard(vec3 x) {
    float l = dot(x, vec3(0.2126, 0.7152, 0.0722));
    return x * ((1.0 + l / 16.0) / (1.0 + l));
}
float encode(float c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1.0 / 2.4) - 0.055; }
void main() {
    vec3 x = abs(hdr.rgb) * 4.0 * exp2(push.exposure);
    vec3 mapped = which < -0.3 ? hable(x) / hable(vec3(11.2)) : which < 0.3 ? reinhard(x) : aces(x);
    colour = vec4(encode(mapped.r), encode(mapped.g), encode(mapped.b), hdr.a);
}
