// One row of a separable blur, written as a column: two passes blur both ways and turn the image back.
layout(local_size_x = 256) in;
const int kSide = 768, kReach = 16;
shared float row[256 + 2 * kReach];
shared float weights[2 * kReach + 1];
void main() {
    int here = int(gl_LocalInvocationID.x), y = int(gl_WorkGroupID.y), first = int(gl_WorkGroupID.x) * 256;
    for (int i = here; i < 256 + 2 * kReach; i += 256)
        row[i] = source[y * kSide + clamp(first + i - kReach, 0, kSide - 1)];
    if (here <= 2 * kReach) {
        float d = float(here - kReach) / 8.0;
        weights[here] = exp(-0.5 * d * d) / 19.159;
    }
    barrier();
    float sum = 0.0;
    for (int i = 0; i <= 2 * kReach; ++i) sum += weights[i] * row[here + i];
    result[(first + here) * kSide + y] = sum;
}
