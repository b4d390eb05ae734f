#version 450
layout(location = 0) in vec3 normal;
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 color;
layout(push_constant) uniform Push { vec4 light; } push;
float hash(vec2 p) {
    return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453);
}
void main() {
    vec3 n = normalize(normal);
    float diffuse = max(dot(n, normalize(push.light.xyz)), 0.0);
    float noise = 0.0;
    for (int i = 0; i < 3; ++i) noise += hash(uv * float(1 << i)) / float(2 << i);
    color = vec4(vec3(diffuse * noise), 1.0);
}
