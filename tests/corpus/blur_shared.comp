#version 450
// Gaussian blur of rows through shared memory with a border, image to image.
//! groups 2 4 1
layout(local_size_x = 32) in;
layout(set = 0, binding = 0, rgba32f) readonly uniform image2D source;
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D result;
shared vec4 row[40];
const float weights[5] = float[](0.2270270270, 0.1945945946, 0.1216216216, 0.0540540541, 0.0162162162);
void main() {
    int i = int(gl_LocalInvocationIndex), x = int(gl_GlobalInvocationID.x), y = int(gl_WorkGroupID.y);
    row[i + 4] = imageLoad(source, ivec2(x, y));
    if (i < 4) row[i] = imageLoad(source, ivec2(max(x - 4, 0), y));
    if (i >= 28) row[i + 8] = imageLoad(source, ivec2(min(x + 4, 63), y));
    barrier();
    vec4 sum = row[i + 4] * weights[0];
    for (int k = 1; k < 5; ++k) sum += (row[i + 4 - k] + row[i + 4 + k]) * weights[k];
    imageStore(result, ivec2(x, y), sum);
}
