#version 450
// A place at the edge of the Mandelbrot set in 64-bit floats.
//! invocations 32
//! inputs uniform -1 1
layout(location = 0) in vec2 position;
layout(location = 0) out vec4 colour;
void main() {
    dvec2 c = dvec2(-0.743643887037151LF, 0.131825904205330LF) + dvec2(position) * 0.01LF, z = dvec2(0.0LF);
    int n = 0;
    for (; n < 60; ++n) {
        dvec2 square = z * z;
        if (square.x + square.y > 4.0LF) break;
        z = dvec2(square.x - square.y, 2.0LF * z.x * z.y) + c;
    }
    colour = vec4(float(n) / 60.0, float(z.x), float(z.y), float(length(z)));
}
