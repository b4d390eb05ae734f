#version 450
// Terrain: triplanar mapping with implicit levels of detail, slope and height blends, fog.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D maps[3];
void main() {
    vec3 n = normalize(normal), weights = pow(abs(n), vec3(4.0));
    weights /= weights.x + weights.y + weights.z;
    vec3 grass = texture(maps[0], position.zy * 4.0).rgb * weights.x + texture(maps[0], position.xz * 4.0).rgb * weights.y +
                 texture(maps[0], position.xy * 4.0).rgb * weights.z;
    vec3 rock = texture(maps[1], position.xz * 2.0, 0.5).rgb;
    vec3 snow = textureGrad(maps[2], position.xz, dFdx(position.xz) * 0.5, dFdy(position.xz) * 0.5).rgb;
    float slope = smoothstep(0.5, 0.8, n.y), high = smoothstep(0.2, 0.6, position.y);
    vec3 ground = mix(rock, mix(grass, snow, high), slope);
    float fog = 1.0 - exp(-length(position) * 0.4);
    vec2 lod = textureQueryLod(maps[0], position.xz * 4.0);
    colour = vec4(mix(ground, vec3(0.6, 0.7, 0.8), fog), lod.x + lod.y * 0.01);
}
