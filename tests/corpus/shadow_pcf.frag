#version 450
// Shadow mapping with percentage-closer filtering over a Poisson disc.
//! inputs uniform 0 0.7
layout(location = 0) in vec4 lightPosition;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2DShadow shadowMap;
const vec2 disc[8] = vec2[](vec2(-0.7071, 0.7071), vec2(0.0, -0.875), vec2(0.5303, 0.5303), vec2(-0.625, 0.0),
                            vec2(0.3536, -0.3536), vec2(-0.0, 0.375), vec2(-0.1768, -0.1768), vec2(0.125, 0.0));
void main() {
    vec4 p = vec4(lightPosition.xyz, abs(lightPosition.w) + 0.5);
    float centre = textureProjLod(shadowMap, vec4(p.xy, p.z - 0.01, p.w), 0.0);
    vec3 q = p.xyz / p.w;
    float sum = 0.0;
    for (int i = 0; i < 8; ++i) sum += textureLod(shadowMap, vec3(q.xy + disc[i] * (2.0 / 64.0), q.z - 0.01), 0.0);
    vec4 gathered = textureGather(shadowMap, q.xy, q.z);
    colour = vec4(centre, sum / 8.0, dot(gathered, vec4(0.25)), 1.0);
}
