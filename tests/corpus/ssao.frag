#version 450
// Screen-space ambient occlusion: a kernel from a uniform buffer, turned by a noise texture.
//! buffer 0 2 1024 uniform -1 1
layout(location = 0) in vec2 uv;
layout(location = 0) out float occlusion;
layout(set = 0, binding = 0) uniform sampler2D depths;
layout(set = 0, binding = 1) uniform sampler2D turns;
layout(set = 0, binding = 2) uniform Kernel { vec4 samples[16]; } kernel;
vec3 positionAt(vec2 at) {
    float z = 1.0 / (1.02 - textureLod(depths, at, 0.0).r);
    return vec3((at * 2.0 - 1.0) * z, z);
}
void main() {
    vec3 p = positionAt(uv);
    vec3 n = normalize(cross(positionAt(uv + vec2(1.0 / 64.0, 0.0)) - p, positionAt(uv + vec2(0.0, 1.0 / 64.0)) - p));
    vec3 turn = vec3(textureLod(turns, uv * 4.0, 0.0).xy * 2.0 - 1.0, 0.0);
    vec3 t = normalize(turn - n * dot(turn, n)), b = cross(n, t);
    mat3 basis = mat3(t, b, n);
    float sum = 0.0;
    for (int i = 0; i < 16; ++i) {
        vec3 s = p + basis * vec3(kernel.samples[i].xy, abs(kernel.samples[i].z)) * 0.3;
        vec2 at = s.xy / s.z * 0.5 + 0.5;
        float depth = positionAt(at).z;
        float range = smoothstep(0.0, 1.0, 0.3 / max(abs(p.z - depth), 1e-4));
        sum += (depth <= s.z - 0.02 ? 1.0 : 0.0) * range;
    }
    occlusion = 1.0 - sum / 16.0;
}
