#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 outColor;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[8]; };
void main() {
    gl_Position = position;
    outColor = vec4(1.0);
    // Eight half planes around the origin: an octagon of inradius color.x.
    for (int i = 0; i < 8; ++i) {
        vec2 n = i == 0 ? vec2(1, 0) : i == 1 ? vec2(0, 1) : i == 2 ? vec2(-1, 0) : i == 3 ? vec2(0, -1)
               : i == 4 ? vec2(1, 1) : i == 5 ? vec2(-1, 1) : i == 6 ? vec2(-1, -1) : vec2(1, -1);
        gl_ClipDistance[i] = color.x * (i < 4 ? 1.0 : 1.5) * position.w - dot(n, position.xy);
    }
}
