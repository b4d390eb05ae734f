#version 450
// Depth of field: a golden-angle spiral as wide as the circle of confusion, near samples weigh by their own.
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D image;
layout(set = 0, binding = 1) uniform sampler2D depths;
float confusion(float depth) { return clamp(abs(1.0 / 0.5 - 1.0 / max(depth, 0.05)) * 0.6, 0.0, 1.0); }
void main() {
    float centreDepth = textureLod(depths, uv, 0.0).r, centre = confusion(centreDepth);
    vec3 sum = textureLod(image, uv, 0.0).rgb;
    float total = 1.0, radius = 0.5, angle = 0.0;
    while (radius < 4.0) {
        vec2 at = uv + vec2(cos(angle), sin(angle)) * radius / 64.0;
        float depth = textureLod(depths, at, 0.0).r, size = confusion(depth) * 4.0;
        if (depth > centreDepth) size = clamp(size, 0.0, centre * 8.0);
        float weight = smoothstep(radius - 0.5, radius + 0.5, size);
        sum += mix(sum / total, textureLod(image, at, 0.0).rgb, weight);
        total += 1.0;
        radius += 0.5 / radius;
        angle += 2.39996323;
    }
    colour = vec4(sum / total, total);
}
