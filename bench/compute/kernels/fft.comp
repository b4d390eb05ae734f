#version 450
// One 512-point FFT per work-group: Stockham's radix 2 in shared memory, two butterflies per invocation and step.

const uint kPoints = 512u, kInvocations = 128u;
layout(local_size_x = 128) in;
layout(set = 0, binding = 0) readonly buffer Signal {
    vec2 signal[];
};
layout(set = 0, binding = 1) writeonly buffer Spectrum {
    vec2 spectrum[];
};
shared vec2 points[kPoints];

void main() {
    uint first = gl_WorkGroupID.x * kPoints, me = gl_LocalInvocationIndex;
    for (uint i = me; i < kPoints; i += kInvocations) points[i] = signal[first + i];
    barrier();
    for (uint width = 1u; width < kPoints; width *= 2u) {
        vec2 sums[2], differences[2];
        for (uint b = 0u; b < 2u; ++b) {
            uint j = me + b * kInvocations;
            float angle = -3.14159265 * float(j & (width - 1u)) / float(width);
            vec2 w = vec2(cos(angle), sin(angle)), x = points[j + kPoints / 2u];
            x = vec2(x.x * w.x - x.y * w.y, x.x * w.y + x.y * w.x);
            sums[b] = points[j] + x;
            differences[b] = points[j] - x;
        }
        barrier();
        for (uint b = 0u; b < 2u; ++b) {
            uint j = me + b * kInvocations, k = j & (width - 1u), to = (j - k) * 2u + k;
            points[to] = sums[b];
            points[to + width] = differences[b];
        }
        barrier();
    }
    for (uint i = me; i < kPoints; i += kInvocations) spectrum[first + i] = points[i];
}
