#version 450
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 result;
void main() {
    vec2 p = color.xy * 8.0;
    float a = sin(p.x) * cos(p.y) + sqrt(abs(p.x * p.y)) + pow(color.z + 0.1, 1.7) + exp(-p.x);
    bool bright = a > 0.8;
    float b = fract(a * 3.0);
    for (int k = 0; k < int(color.z * 6.0); ++k) b = b * 0.5 + 0.125;
    if (gl_SampleID == 1 && b > 0.7) discard;
    float own = float(gl_SampleID) * 0.25 + fract(gl_FragCoord.x) * 0.125;
    result = vec4(a + own, b, bright ? own : a, gl_FrontFacing ? 1.0 : 0.5);
}
