#version 450
layout(local_size_x = 4) in;
layout(binding = 0) uniform sampler2D colours;
layout(binding = 1, r32i) uniform iimage2D counts;
layout(binding = 2, rgba32f) uniform image2DArray target;
layout(binding = 3) uniform samplerCube sky;
layout(binding = 4) uniform isampler1D steps;

void main() {
    ivec2 place = ivec2(gl_LocalInvocationID.x & 1u, gl_LocalInvocationID.x >> 1u);
    int before = imageAtomicAdd(counts, ivec2(0, 1), 5);
    vec4 blend = textureLod(colours, vec2(float(before) / 40.0, 0.5), 0.0);
    vec4 four = textureGather(colours, vec2(0.5), 1);
    vec4 face = textureLod(sky, vec3(0.0, 0.0, -1.0), 0.0);
    ivec2 size = textureSize(colours, 0);
    int far = texelFetch(steps, 7, 0).x + texelFetch(steps, 1, 0).x;
    imageStore(target, ivec3(place, 1), blend + four + vec4(size, face.w, far));
}
