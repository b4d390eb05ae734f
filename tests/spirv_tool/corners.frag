#version 450
#extension GL_EXT_fragment_shader_barycentric : require
layout(location = 0) pervertexEXT in vec2 corners[];
layout(location = 0) out vec4 color;
void main() {
    vec3 weight = gl_BaryCoordEXT;
    color = vec4(corners[0] * weight.x + corners[1] * weight.y + corners[2] * weight.z, gl_BaryCoordNoPerspEXT.xy);
}
