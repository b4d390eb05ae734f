#version 450
// A Catmull-Rom curve through the two middle points of four, in steps that its bend asks for.
layout(lines_adjacency) in;
layout(line_strip, max_vertices = 17) out;
layout(location = 0) in vec4 colour[];
layout(location = 0) out vec4 outColour;
layout(location = 1) out float along;
void main() {
    vec4 p0 = gl_in[0].gl_Position, p1 = gl_in[1].gl_Position, p2 = gl_in[2].gl_Position, p3 = gl_in[3].gl_Position;
    float bend = length(p0 - p1 - p2 + p3);
    int steps = clamp(int(bend * 8.0), 1, 16);
    for (int n = 0; n <= steps; ++n) {
        float t = float(n) / float(steps), t2 = t * t, t3 = t2 * t;
        gl_Position = 0.5 * (2.0 * p1 + (p2 - p0) * t + (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) * t2 +
                             (3.0 * p1 - p0 - 3.0 * p2 + p3) * t3);
        outColour = mix(colour[1], colour[2], t);
        along = t;
        EmitVertex();
    }
}
