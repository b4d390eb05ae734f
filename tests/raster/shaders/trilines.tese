#version 450
layout(isolines, equal_spacing) in;
layout(location = 0) out vec4 outColor;
void main() {
    gl_Position = mix(gl_in[0].gl_Position, gl_in[1].gl_Position, gl_TessCoord.x) +
                  (gl_in[2].gl_Position - gl_in[0].gl_Position) * gl_TessCoord.y;
    outColor = vec4(gl_TessCoord.xy, gl_PrimitiveID, 1);
}
