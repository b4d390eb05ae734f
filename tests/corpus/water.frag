#version 450
// Water: a normal from moving noise, refraction and reflection by Fresnel, foam by depth, discarding dry places.
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D waves;
layout(set = 0, binding = 1) uniform samplerCube sky;
layout(push_constant) uniform Push { float time; float level; } push;
void main() {
    float depth = position.y + 0.6 + 0.2 * push.level;
    vec2 a = textureLod(waves, uv * 2.0 + push.time * vec2(0.05, 0.02), 0.0).xy;
    vec2 b = textureLod(waves, uv * 3.0 - push.time * vec2(0.03, 0.06), 1.0).xy;
    if (depth < 0.0) discard;
    vec3 n = normalize(vec3((a + b - 1.0) * 0.7, 1.0)).xzy, v = normalize(position - vec3(0.0, 3.0, -3.0));
    float fresnel = 0.02 + 0.98 * pow(1.0 - max(dot(-v, n), 0.0), 5.0);
    vec3 reflected = textureLod(sky, reflect(v, n), 0.0).rgb;
    vec3 refracted = vec3(0.0, 0.3, 0.35) * exp(-depth * vec3(1.5, 0.8, 0.6)) + refract(v, n, 0.75) * 0.05;
    float foam = smoothstep(0.15, 0.0, depth);
    colour = vec4(mix(mix(refracted, reflected, fresnel), vec3(1.0), foam), 1.0 - exp(-depth * 4.0));
}
