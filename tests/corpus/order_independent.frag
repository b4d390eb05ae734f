#version 450
// Weighted blended transparency (McGuire and Bavoil 2013): accumulation and revealage to two targets.
layout(location = 0) in vec4 source;
layout(location = 0) out vec4 accumulation;
layout(location = 1) out float revealage;
void main() {
    float alpha = clamp(abs(source.a), 0.0, 1.0), z = gl_FragCoord.z;
    float weight = clamp(pow(min(1.0, alpha * 10.0) + 0.01, 3.0) * 1e8 * pow(1.0 - z * 0.9, 3.0), 1e-2, 3e3);
    accumulation = vec4(source.rgb * alpha, alpha) * weight;
    revealage = alpha;
}
