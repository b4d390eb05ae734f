#version 450
layout(triangles, fractional_odd_spacing, ccw) in;
layout(location = 0) in vec4 corner[];
layout(location = 1) patch in float whole;
layout(location = 0) out vec4 outColor;
void main() {
    gl_Position = gl_in[0].gl_Position * gl_TessCoord.x + gl_in[1].gl_Position * gl_TessCoord.y +
                  gl_in[2].gl_Position * gl_TessCoord.z;
    outColor = vec4(corner[0].x * gl_TessCoord.x + corner[1].x * gl_TessCoord.y + corner[2].x * gl_TessCoord.z,
                    gl_PrimitiveID, whole, 1);
}
