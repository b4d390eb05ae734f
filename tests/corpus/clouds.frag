#version 450
// Volumetric clouds: marching through layered noise with early exit when opaque.
//! invocations 32
layout(location = 0) in vec2 screen;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler3D volume;
float density(vec3 p) {
    float d = textureLod(volume, p * 0.25, 0.0).x * 0.5 + textureLod(volume, p * 0.6 + 0.3, 0.0).y * 0.25;
    return clamp(d * 2.0 - 0.4 - abs(p.y) * 0.5, 0.0, 1.0);
}
void main() {
    vec3 direction = normalize(vec3(screen, 1.5)), p = vec3(0.0, 0.0, -2.0) + direction * fract(gl_FragCoord.x * 0.37) * 0.2;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 24; ++i) {
        float d = density(p);
        if (d > 0.01) {
            float light = density(p + vec3(0.2, 0.3, -0.1));
            vec3 lit = mix(vec3(1.0, 0.95, 0.8), vec3(0.25, 0.3, 0.35), clamp(d - light + 0.5, 0.0, 1.0));
            float alpha = d * 0.4 * (1.0 - sum.a);
            sum += vec4(lit * alpha, alpha);
        }
        if (sum.a > 0.95) break;
        p += direction * 0.2;
    }
    colour = vec4(mix(vec3(0.3, 0.5, 0.9), sum.rgb / max(sum.a, 1e-4), sum.a), 1.0);
}
