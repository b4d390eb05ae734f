#version 450
// Sphere tracing of a scene of signed distances with soft shadows and ambient occlusion.
//! invocations 32
layout(location = 0) in vec2 screen;
layout(location = 0) out vec4 colour;
float smoothUnion(float a, float b, float k) {
    float h = clamp(0.5 + 0.5 * (b - a) / k, 0.0, 1.0);
    return mix(b, a, h) - k * h * (1.0 - h);
}
float box(vec3 p, vec3 b) {
    vec3 q = abs(p) - b;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}
float torus(vec3 p, vec2 t) { return length(vec2(length(p.xz) - t.x, p.y)) - t.y; }
float scene(vec3 p) {
    float d = smoothUnion(length(p - vec3(0.0, 0.4, 0.0)) - 0.5, box(p - vec3(0.5, 0.2, 0.3), vec3(0.25)), 0.2);
    d = min(d, torus(p - vec3(-0.6, 0.3, 0.2), vec2(0.35, 0.1)));
    return min(d, p.y + 0.1 * sin(p.x * 3.0) * sin(p.z * 2.0));
}
vec3 normalAt(vec3 p) {
    const vec2 e = vec2(0.002, 0.0);
    return normalize(vec3(scene(p + e.xyy) - scene(p - e.xyy), scene(p + e.yxy) - scene(p - e.yxy),
                          scene(p + e.yyx) - scene(p - e.yyx)));
}
float shadow(vec3 origin, vec3 direction) {
    float result = 1.0, t = 0.05;
    for (int i = 0; i < 12; ++i) {
        float h = scene(origin + direction * t);
        if (h < 0.001) return 0.0;
        result = min(result, 8.0 * h / t);
        t += clamp(h, 0.02, 0.3);
    }
    return result;
}
void main() {
    vec3 origin = vec3(0.0, 1.0, -2.5), direction = normalize(vec3(screen, 1.6) - vec3(0.0, 0.35, 0.0));
    float t = 0.0;
    bool hit = false;
    for (int i = 0; i < 40; ++i) {
        float d = scene(origin + direction * t);
        if (d < 0.002 * t) { hit = true; break; }
        t += d;
        if (t > 10.0) break;
    }
    if (!hit) { colour = vec4(mix(vec3(0.5, 0.6, 0.8), vec3(0.2, 0.3, 0.6), direction.y), 1.0); return; }
    vec3 p = origin + direction * t, n = normalAt(p), light = normalize(vec3(0.6, 0.9, -0.4));
    float occlusion = 0.0, weight = 1.0;
    for (int i = 1; i <= 3; ++i) {
        float h = 0.06 * float(i);
        occlusion += weight * (h - scene(p + n * h));
        weight *= 0.6;
    }
    float diffuse = max(dot(n, light), 0.0) * shadow(p + n * 0.01, light);
    colour = vec4(vec3(0.8, 0.6, 0.4) * (0.25 * clamp(1.0 - 2.0 * occlusion, 0.0, 1.0) + diffuse), t);
}
