#version 450
// Gerstner waves: positions and exact normals of a sum of waves.
//! buffer 0 0 256 uniform 0.1 1
layout(location = 0) in vec3 position;
layout(location = 0) out vec3 normal;
layout(set = 0, binding = 0) uniform Waves { vec4 wave[8]; } waves;
layout(push_constant) uniform Push { float time; } push;
void main() {
    vec3 p = vec3(position.x, 0.0, position.z), tangent = vec3(1.0, 0.0, 0.0), binormal = vec3(0.0, 0.0, 1.0);
    for (int i = 0; i < 8; ++i) {
        vec2 d = normalize(waves.wave[i].xy);
        float steepness = waves.wave[i].z * 0.2, k = 6.2831853 / (waves.wave[i].w * 4.0);
        float f = k * (dot(d, position.xz) - sqrt(9.8 / k) * push.time), a = steepness / k;
        p += vec3(d.x * a * cos(f), a * sin(f), d.y * a * cos(f));
        tangent += vec3(-d.x * d.x * steepness * sin(f), d.x * steepness * cos(f), -d.x * d.y * steepness * sin(f));
        binormal += vec3(-d.x * d.y * steepness * sin(f), d.y * steepness * cos(f), -d.y * d.y * steepness * sin(f));
    }
    normal = normalize(cross(binormal, tangent));
    gl_Position = vec4(p, 1.0);
}
