#version 450
// Path tracing of spheres: diffuse, metal and glass, with an integer hash for random numbers.
//! invocations 32
layout(location = 0) in vec2 screen;
layout(location = 0) out vec4 colour;
struct Sphere { vec3 centre; float radius; vec3 albedo; float material; };
const Sphere spheres[5] = Sphere[](Sphere(vec3(0, -100.5, -1), 100.0, vec3(0.8, 0.8, 0.1), 0.0),
    Sphere(vec3(0, 0, -1), 0.5, vec3(0.7, 0.3, 0.3), 0.0), Sphere(vec3(1, 0, -1), 0.5, vec3(0.8, 0.6, 0.2), 1.0),
    Sphere(vec3(-1, 0, -1), 0.5, vec3(1.0), 2.0), Sphere(vec3(0.3, -0.35, -0.5), 0.15, vec3(0.2, 0.4, 0.9), 1.0));
uint state;
float random() {
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float(((word >> 22u) ^ word) >> 8) * (1.0 / 16777216.0);
}
vec3 inSphere() {
    for (int i = 0; i < 8; ++i) {
        vec3 p = vec3(random(), random(), random()) * 2.0 - 1.0;
        if (dot(p, p) < 1.0) return p;
    }
    return vec3(0.0);
}
bool hit(vec3 o, vec3 d, out float t, out int index) {
    t = 1e9;
    index = -1;
    for (int i = 0; i < 5; ++i) {
        vec3 oc = o - spheres[i].centre;
        float b = dot(oc, d), c = dot(oc, oc) - spheres[i].radius * spheres[i].radius, disc = b * b - c;
        if (disc < 0.0) continue;
        float root = -b - sqrt(disc);
        if (root < 1e-3) root = -b + sqrt(disc);
        if (root > 1e-3 && root < t) { t = root; index = i; }
    }
    return index >= 0;
}
void main() {
    state = uint(gl_FragCoord.x) * 1973u + uint(gl_FragCoord.y) * 9277u + 1u;
    vec3 sum = vec3(0.0);
    for (int s = 0; s < 2; ++s) {
        vec3 o = vec3(0.0), d = normalize(vec3(screen + 0.01 * vec2(random(), random()), -1.0)), throughput = vec3(1.0);
        for (int bounce = 0; bounce < 5; ++bounce) {
            float t; int i;
            if (!hit(o, d, t, i)) {
                sum += throughput * mix(vec3(1.0), vec3(0.5, 0.7, 1.0), 0.5 * d.y + 0.5);
                break;
            }
            vec3 p = o + d * t, n = (p - spheres[i].centre) / spheres[i].radius;
            throughput *= spheres[i].albedo;
            o = p;
            if (spheres[i].material == 0.0) {
                d = normalize(n + inSphere());
            } else if (spheres[i].material == 1.0) {
                d = reflect(d, n) + 0.1 * inSphere();
                if (dot(d, n) <= 0.0) { throughput = vec3(0.0); break; }
                d = normalize(d);
            } else {
                float eta = dot(d, n) < 0.0 ? 1.0 / 1.5 : 1.5;
                vec3 outward = dot(d, n) < 0.0 ? n : -n, r = refract(d, outward, eta);
                float reflectance = 0.04 + 0.96 * pow(1.0 - abs(dot(d, n)), 5.0);
                d = r == vec3(0.0) || random() < reflectance ? reflect(d, outward) : normalize(r);
            }
        }
    }
    colour = vec4(sqrt(sum * 0.5), 1.0);
}
