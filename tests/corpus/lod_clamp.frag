#version 450
#extension GL_ARB_sparse_texture_clamp : require
// A texture streamed in from its coarse levels: the shader keeps its reads off the levels that are not there yet.
layout(location = 0) in vec2 place;
layout(location = 0) out vec4 color;
layout(set = 0, binding = 0) uniform sampler2D detail;
layout(set = 0, binding = 1) uniform sampler2DArray pages;
void main() {
    float resident = floor(place.x * 3.0 + 2.0);
    vec4 near = textureClampARB(detail, place, resident), biased = textureClampARB(detail, place, resident, 1.5);
    vec4 shifted = textureOffsetClampARB(detail, place, ivec2(3, -2), resident);
    vec4 steep = textureGradClampARB(pages, vec3(place, 2.0), vec2(0.01, 0.0), vec2(0.0, place.y), resident);
    color = near + 0.5 * biased - 0.25 * shifted + steep;
}
