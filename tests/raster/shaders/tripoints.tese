#version 450
layout(triangles, equal_spacing, cw, point_mode) in;
layout(location = 0) out vec4 outColor;
void main() {
    gl_Position = gl_in[0].gl_Position * gl_TessCoord.x + gl_in[1].gl_Position * gl_TessCoord.y +
                  gl_in[2].gl_Position * gl_TessCoord.z;
    gl_PointSize = 1;
    outColor = vec4(1);
}
