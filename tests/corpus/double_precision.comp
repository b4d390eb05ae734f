#version 450
// Kahan summation in float beside double: dot products, a cubic's root by Newton.
//! groups 1 1 1
//! buffer 0 0 2048 uniform -1 1
//! buffer 0 1 2048 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { float source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { dvec2 result[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    precise float sum = 0.0, lost = 0.0;
    double wide = 0.0LF;
    for (uint k = 0u; k < 32u; ++k) {
        precise float term = source[i + k] * source[i + k + 32u];
        precise float y = term - lost, t = sum + y;
        lost = (t - sum) - y;
        sum = t;
        wide += double(source[i + k]) * double(source[i + k + 32u]);
    }
    double a = double(source[i]), x = 1.0LF;
    for (int k = 0; k < 8; ++k) {
        double f = ((x + a) * x - 2.0LF) * x - 1.0LF, slope = (3.0LF * x + 2.0LF * a) * x - 2.0LF;
        if (abs(slope) < 1e-12LF) break;
        x -= f / slope;
    }
    result[i] = dvec2(wide - double(sum), sqrt(abs(x)) + floor(x));
}
