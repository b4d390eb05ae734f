#version 450
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 result;
void main() {
    float a = sin(color.x * 9.0) + cos(color.y * 7.0) * log2(color.z + 2.0);
    vec2 slope = vec2(dFdx(a), dFdy(color.x));
    float own = float(gl_SampleID) * 0.25 + gl_SamplePosition.y;
    result = vec4(a, slope.x * own, slope.y + dFdx(own * color.x), own);
}
