#version 450
// Deferred lighting: octahedral normals, depth to position by an inverse matrix, a loop over lights in a storage buffer.
//! buffer 0 3 2048 uniform -1 1
//! buffer 0 4 256 uniform -1 1
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D albedos;
layout(set = 0, binding = 1) uniform sampler2D normals;
layout(set = 0, binding = 2) uniform sampler2D depths;
struct Light { vec3 position; float radius; vec3 colour; float cosine; };
layout(std430, set = 0, binding = 3) readonly buffer Lights { Light lights[]; };
layout(set = 0, binding = 4) uniform Camera { mat4 projection; } camera;
vec3 decode(vec2 f) {
    f = f * 2.0 - 1.0;
    vec3 n = vec3(f, 1.0 - abs(f.x) - abs(f.y));
    float t = max(-n.z, 0.0);
    n.xy += mix(vec2(t), vec2(-t), greaterThanEqual(n.xy, vec2(0.0)));
    return normalize(n);
}
void main() {
    mat4 projection = camera.projection + mat4(3.0);
    vec4 h = inverse(projection) * vec4(uv * 2.0 - 1.0, textureLod(depths, uv, 0.0).r, 1.0);
    vec3 p = h.xyz / h.w, n = decode(textureLod(normals, uv, 0.0).xy), albedo = textureLod(albedos, uv, 0.0).rgb;
    vec3 sum = albedo * 0.05;
    for (uint i = 0u; i < min(uint(lights.length()), 20u); ++i) {
        vec3 l = lights[i].position - p;
        float square = dot(l, l), radius = 1.0 + abs(lights[i].radius);
        if (square > radius * radius) continue;
        float falloff = 1.0 - square / (radius * radius);
        sum += albedo * abs(lights[i].colour) * max(dot(n, l * inversesqrt(square + 1e-5)), 0.0) * falloff * falloff;
    }
    colour = vec4(sum, determinant(projection));
}
