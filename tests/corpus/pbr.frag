#version 450
// Metallic-roughness shading: GGX, Smith, Schlick (Karis 2013), with maps and a normal map by derivatives.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D albedoMap;
layout(set = 0, binding = 1) uniform sampler2D normalMap;
layout(set = 0, binding = 2) uniform sampler2D materialMap;
layout(push_constant) uniform Push { vec4 eye; vec4 light; } push;
const float pi = 3.14159265;
float distribution(float nh, float a) {
    float a2 = a * a, d = nh * nh * (a2 - 1.0) + 1.0;
    return a2 / (pi * d * d);
}
float visibility(float nv, float nl, float r) {
    float k = (r + 1.0) * (r + 1.0) / 8.0;
    return nv / (nv * (1.0 - k) + k) * (nl / (nl * (1.0 - k) + k));
}
vec3 fresnel(float c, vec3 f0) { return f0 + (1.0 - f0) * pow(clamp(1.0 - c, 0.0, 1.0), 5.0); }
vec3 perturbed() {
    vec3 tangentNormal = texture(normalMap, uv).xyz * 2.0 - 1.0;
    vec3 q1 = dFdx(position), q2 = dFdy(position);
    vec2 st1 = dFdx(uv), st2 = dFdy(uv);
    vec3 n = normalize(normal), t = normalize(q1 * st2.t - q2 * st1.t + vec3(1e-4)), b = -normalize(cross(n, t));
    return normalize(mat3(t, b, n) * tangentNormal);
}
void main() {
    vec3 albedo = pow(texture(albedoMap, uv).rgb, vec3(2.2));
    vec2 material = texture(materialMap, uv * 2.0).xy;
    float metallic = clamp(material.x, 0.0, 1.0), roughness = clamp(material.y, 0.05, 1.0);
    vec3 n = perturbed(), v = normalize(push.eye.xyz - position), l = normalize(push.light.xyz - position);
    vec3 h = normalize(v + l), f0 = mix(vec3(0.04), albedo, metallic);
    float nl = max(dot(n, l), 0.0), nv = max(dot(n, v), 1e-3);
    vec3 f = fresnel(max(dot(h, v), 0.0), f0);
    float d = distribution(max(dot(n, h), 0.0), roughness * roughness);
    vec3 specular = d * visibility(nv, nl, roughness) * f / (4.0 * nv * nl + 1e-3);
    vec3 radiance = (((1.0 - f) * (1.0 - metallic)) * albedo / pi + specular) * nl + 0.03 * albedo;
    colour = vec4(pow(radiance / (radiance + 1.0), vec3(1.0 / 2.2)), 1.0);
}
