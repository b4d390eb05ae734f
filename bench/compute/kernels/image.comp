layout(local_size_x = 16, local_size_y = 8) in;
layout(set = 0, binding = 0) writeonly buffer Output {
    vec4 pixels[];
};

void main() {
    uvec2 size = gl_NumWorkGroups.xy * gl_WorkGroupSize.xy, at = gl_GlobalInvocationID.xy;
    pixels[at.y * size.x + at.x] = image((vec2(at) + 0.5) / vec2(size));
}
