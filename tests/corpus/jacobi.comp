#version 450
// Jacobi steps of a pressure solver on a 16 x 16 tile with walls, and the residual by a shared reduction.
//! groups 2 1 1
//! buffer 0 0 2048 uniform -1 1
//! buffer 0 1 2560 zero
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, set = 0, binding = 0) readonly buffer Divergence { float divergence[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Pressure { float pressure[]; };
shared float p[18][18];
shared float residuals[256];
void main() {
    uvec2 l = gl_LocalInvocationID.xy + 1u;
    uint i = gl_LocalInvocationIndex, at = gl_WorkGroupID.x * 256u + i;
    p[l.y][l.x] = 0.0;
    if (i < 18u) { p[0][i] = 0.0; p[17][i] = 0.0; p[i][0] = 0.0; p[i][17] = 0.0; }
    float b = divergence[at], x = 0.0;
    for (int k = 0; k < 6; ++k) {
        barrier();
        x = (p[l.y - 1u][l.x] + p[l.y + 1u][l.x] + p[l.y][l.x - 1u] + p[l.y][l.x + 1u] - b) * 0.25;
        barrier();
        p[l.y][l.x] = x;
    }
    barrier();
    residuals[i] = abs(p[l.y - 1u][l.x] + p[l.y + 1u][l.x] + p[l.y][l.x - 1u] + p[l.y][l.x + 1u] - 4.0 * x - b);
    for (uint s = 128u; s > 0u; s >>= 1) {
        barrier();
        if (i < s) residuals[i] = max(residuals[i], residuals[i + s]);
    }
    pressure[at] = x;
    if (i == 0u) pressure[512u + gl_WorkGroupID.x] = residuals[0];
}
