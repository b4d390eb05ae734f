#version 450
// Phong with several point lights from a uniform buffer.
//! buffer 0 0 1024 uniform -2 2
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 colour;
struct Light { vec4 positionRange; vec4 colourIntensity; };
layout(set = 0, binding = 0) uniform Scene { vec4 eye; vec4 ambient; Light lights[6]; mat4 unused; } scene;
void main() {
    vec3 n = normalize(normal), v = normalize(scene.eye.xyz - position);
    vec3 sum = scene.ambient.rgb * 0.1;
    for (int i = 0; i < 6; ++i) {
        vec3 l = scene.lights[i].positionRange.xyz - position;
        float d = length(l), range = abs(scene.lights[i].positionRange.w) * 4.0;
        if (d > range) continue;
        l /= d;
        float attenuation = 1.0 - smoothstep(0.5 * range, range, d);
        float diffuse = max(dot(n, l), 0.0);
        if (diffuse <= 0.0) continue;
        float specular = pow(max(dot(reflect(-l, n), v), 0.0), 32.0);
        sum += attenuation * (diffuse * abs(scene.lights[i].colourIntensity.rgb) + specular);
    }
    colour = vec4(sum, 1.0);
}
