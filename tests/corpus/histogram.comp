#version 450
// Histogram of an image: counts in shared memory, then added to the whole.
//! groups 4 2 1
//! buffer 0 1 1024 zero
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D image;
layout(std430, set = 0, binding = 1) buffer Histogram { uint bins[64]; uint total; };
shared uint local[64];
void main() {
    local[gl_LocalInvocationIndex] = 0u;
    barrier();
    for (int k = 0; k < 3; ++k) {
        ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, k * 16);
        vec4 texel = texelFetch(image, at & 63, 0);
        uint bin = uint(clamp(dot(texel.rgb, vec3(0.2126, 0.7152, 0.0722)) * 64.0, 0.0, 63.0));
        atomicAdd(local[bin], 1u);
    }
    barrier();
    uint count = local[gl_LocalInvocationIndex];
    if (count != 0u) atomicAdd(bins[gl_LocalInvocationIndex], count);
    if (gl_LocalInvocationIndex == 0u) atomicAdd(total, 192u);
}
