#version 450
// Parallax occlusion mapping: linear search for the height, then one secant step.
layout(location = 0) in vec2 uv;
layout(location = 1) in vec3 view;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D heights;
layout(set = 0, binding = 1) uniform sampler2D albedo;
void main() {
    vec3 v = normalize(vec3(view.xy, abs(view.z) + 0.2));
    float layers = mix(24.0, 6.0, v.z), depth = 0.0, step = 1.0 / layers;
    vec2 delta = v.xy / v.z * 0.08 / layers, at = uv;
    float height = 1.0 - textureLod(heights, at, 0.0).r, before = height, depthBefore = 0.0;
    int count = 0;
    while (depth < height && count < 32) {
        before = height;
        depthBefore = depth;
        at -= delta;
        depth += step;
        height = 1.0 - textureLod(heights, at, 0.0).r;
        ++count;
    }
    float after = height - depth, ahead = before - depthBefore, denominator = after - ahead;
    float weight = abs(denominator) > 1e-6 ? after / denominator : 0.0;
    at = mix(at, at + delta, clamp(weight, 0.0, 1.0));
    colour = vec4(textureLod(albedo, at, 0.0).rgb, float(count));
}
