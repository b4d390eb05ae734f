#version 450
// Matrix product by tiles of 8 x 8 in shared memory; sizes from a uniform buffer, borders checked.
//! groups 3 3 1
//! buffer 0 0 4096 uniform -1 1
//! buffer 0 1 4096 uniform -1 1
//! buffer 0 2 4096 zero
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, set = 0, binding = 0) readonly buffer A { float a[]; };
layout(std430, set = 0, binding = 1) readonly buffer B { float b[]; };
layout(std430, set = 0, binding = 2) writeonly buffer C { float c[]; };
const uint rows = 20u, inner = 21u, columns = 19u;
shared float tileA[8][9];
shared float tileB[8][9];
void main() {
    uvec2 l = gl_LocalInvocationID.xy, g = gl_GlobalInvocationID.xy;
    float sum = 0.0;
    for (uint t = 0u; t < (inner + 7u) / 8u; ++t) {
        uint k = t * 8u;
        tileA[l.y][l.x] = g.y < rows && k + l.x < inner ? a[g.y * inner + k + l.x] : 0.0;
        tileB[l.y][l.x] = k + l.y < inner && g.x < columns ? b[(k + l.y) * columns + g.x] : 0.0;
        barrier();
        for (uint j = 0u; j < 8u; ++j) sum += tileA[l.y][j] * tileB[j][l.x];
        barrier();
    }
    if (g.y < rows && g.x < columns) c[g.y * columns + g.x] = sum;
}
