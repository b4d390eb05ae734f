#version 450
// Julia set with smooth colouring.
layout(location = 0) in vec2 position;
layout(location = 0) out vec4 colour;
layout(push_constant) uniform Push { vec2 c; } push;
void main() {
    vec2 z = position * 1.5;
    vec2 c = vec2(-0.8, 0.156) + 0.05 * push.c;
    int n = 0;
    for (; n < 48; ++n) {
        z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + c;
        if (dot(z, z) > 16.0) break;
    }
    float smoothCount = n == 48 ? 0.0 : float(n) - log2(0.5 * log2(dot(z, z)));
    colour = vec4(0.5 + 0.5 * cos(3.0 + smoothCount * 0.15 + vec3(0.0, 0.6, 1.0)), 1.0);
}
