#version 450
// A field of spheres and boxes over a floor, sphere-traced: neighbouring pixels leave their loops after different counts.

float sceneDistance(vec3 p) {
    vec3 cell = vec3(mod(p.x, 2.0) - 1.0, p.y, mod(p.z, 2.0) - 1.0);
    float sphere = length(cell - vec3(0.0, 0.1, 0.0)) - 0.45;
    vec3 box = abs(cell - vec3(0.0, -0.45, 0.0)) - vec3(0.35, 0.2, 0.35);
    float block = length(max(box, 0.0)) + min(max(box.x, max(box.y, box.z)), 0.0) - 0.05;
    return min(min(sphere, block), p.y + 0.7);
}

vec3 sceneNormal(vec3 p) {
    const vec2 e = vec2(0.002, -0.002);
    return normalize(e.xyy * sceneDistance(p + e.xyy) + e.yyx * sceneDistance(p + e.yyx) +
                     e.yxy * sceneDistance(p + e.yxy) + e.xxx * sceneDistance(p + e.xxx));
}

float shadow(vec3 origin, vec3 direction) {
    float light = 1.0, t = 0.04;
    for (int i = 0; i < 32 && t < 6.0; ++i) {
        float d = sceneDistance(origin + direction * t);
        if (d < 0.001) return 0.0;
        light = min(light, 10.0 * d / t);
        t += clamp(d, 0.02, 0.5);
    }
    return light;
}

vec4 image(vec2 uv) {
    vec2 screen = uv * 2.0 - 1.0;
    vec3 origin = vec3(0.3, 1.3, -4.0);
    vec3 direction = normalize(vec3(screen.x * 1.2, -screen.y * 0.9 - 0.25, 1.4));
    float t = 0.0, d = 1.0;
    int steps = 0;
    for (; steps < 96 && t < 24.0; ++steps) {
        d = sceneDistance(origin + direction * t);
        if (d < 0.001 * t) break;
        t += d * 0.8;
    }
    vec3 sky = mix(vec3(0.75, 0.8, 0.9), vec3(0.2, 0.4, 0.7), clamp(direction.y * 2.0 + 0.5, 0.0, 1.0));
    if (t >= 24.0 || steps == 96) return vec4(sky, 1.0);
    vec3 p = origin + direction * t, n = sceneNormal(p), sun = normalize(vec3(0.6, 0.8, -0.4));
    float diffuse = max(dot(n, sun), 0.0);
    if (diffuse > 0.0) diffuse *= shadow(p + n * 0.01, sun);
    float rim = pow(1.0 - max(dot(n, -direction), 0.0), 3.0);
    vec3 color = vec3(0.8, 0.6, 0.4) * (0.15 + 0.85 * diffuse) + 0.2 * rim;
    return vec4(mix(color, sky, clamp(t / 24.0, 0.0, 1.0)), 1.0);
}
