#version 450
// Hairs as isolines: each line a hair of its own, bent by what its number gives.
layout(isolines, fractional_odd_spacing) in;
layout(location = 0) in vec4 tip[];
layout(location = 0) out float along;
layout(location = 1) flat out uint hair;
float noise(uint n) {
    n = (n << 13) ^ n;
    n = n * (n * n * 15731u + 789221u) + 1376312589u;
    return float(n & 0x7FFFFFFFu) / 2147483647.0;
}
void main() {
    uint number = uint(gl_PrimitiveID) * 64u + uint(gl_TessCoord.y * 64.0);
    float t = gl_TessCoord.x, a = noise(number), b = noise(number + 1u) * (1.0 - a);
    vec4 root = gl_in[0].gl_Position * a + gl_in[1].gl_Position * b + gl_in[2].gl_Position * (1.0 - a - b);
    vec4 end = tip[number % 3u];
    gl_Position = root + end * t + vec4(a - 0.5, b - 0.5, 0.0, 0.0) * t * t;
    gl_PointSize = 1.0 + t;
    along = t;
    hair = number;
}
