#version 450
// A bicubic Bezier patch with its normal.
//! buffer 0 0 256 uniform -1 1
layout(quads, fractional_even_spacing, ccw) in;
layout(location = 0) out vec3 normal;
layout(location = 1) out vec2 uv;
layout(std140, set = 0, binding = 0) uniform View { mat4 clip; } view;
void basis(float t, out vec4 b, out vec4 d) {
    float s = 1.0 - t;
    b = vec4(s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t);
    d = vec4(-3.0 * s * s, 3.0 * s * s - 6.0 * s * t, 6.0 * s * t - 3.0 * t * t, 3.0 * t * t);
}
void main() {
    vec4 bu, du, bv, dv;
    basis(gl_TessCoord.x, bu, du);
    basis(gl_TessCoord.y, bv, dv);
    vec3 p = vec3(0), alongU = vec3(0), alongV = vec3(0);
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            vec3 c = gl_in[4 * j + i].gl_Position.xyz;
            p += c * bu[i] * bv[j];
            alongU += c * du[i] * bv[j];
            alongV += c * bu[i] * dv[j];
        }
    }
    gl_Position = view.clip * vec4(p, 1.0);
    normal = cross(alongU, alongV);
    uv = gl_TessCoord.xy;
}
