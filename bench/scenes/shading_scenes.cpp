// Full-screen fragment shaders.
#include "bench/scenes/bench_scenes.h"
#include "bench/scenes/full_screen.h"

namespace vernier::bench::speed {

using namespace conformance;

Result<Scene> arithmetic() {
    return fullScreen("arithmetic", "64 rounds of dependent float arithmetic per pixel.", R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    vec4 a = vec4(uv, uv.yx), b = vec4(0.3, 0.5, 0.7, 0.9);
    for (int i = 0; i < 64; ++i) {
        a = a * b + vec4(0.125);
        b = fract(a.wxyz * 1.7 + b * 0.25);
    }
    color = vec4(a.xyz * 0.25 + b.xyz * 0.5, 1.0);
})",
                      1);
}

Result<Scene> divergent() {
    return fullScreen("divergent", "A Julia set: loops of different length in neighbouring pixels.", R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    vec2 z = uv * vec2(3.2, 2.4) - vec2(1.6, 1.2);
    int i = 0;
    while (i < 96 && dot(z, z) < 4.0) {
        z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + vec2(-0.79, 0.15);
        ++i;
    }
    float t = float(i) / 96.0;
    color = vec4(t, t * t, sqrt(t), 1.0);
})",
                      1);
}

Result<Scene> lighting() {
    return fullScreen("lighting", "Normalise, three lights with specular powers per pixel.", R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    vec3 n = normalize(vec3(uv * 2.0 - 1.0, 1.0)), eye = vec3(0, 0, 1), sum = vec3(0.05);
    for (int i = 0; i < 3; ++i) {
        vec3 light = normalize(vec3(float(i) - 1.0, 0.5, 1.0));
        vec3 halfway = normalize(light + eye);
        sum += vec3(0.3, 0.25, 0.2) * max(dot(n, light), 0.0) + pow(max(dot(n, halfway), 0.0), 32.0) * 0.3;
    }
    color = vec4(sum, 1.0);
})",
                      1);
}

}  // namespace vernier::bench::speed
