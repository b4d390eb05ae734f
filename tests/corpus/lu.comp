#version 450
// LU decomposition of an 8 x 8 matrix with partial pivoting; a row for each invocation.
//! groups 2 1 1
//! buffer 0 0 1024 uniform -1 1
//! buffer 0 1 1024 zero
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) readonly buffer Matrices { float source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Factors { float factors[]; };
shared float m[8][8];
shared uint pivot;
void main() {
    uint r = gl_LocalInvocationIndex, base = gl_WorkGroupID.x * 64u, swaps = 0u;
    for (uint c = 0u; c < 8u; ++c) m[r][c] = source[base + r * 8u + c];
    for (uint k = 0u; k < 8u; ++k) {
        barrier();
        if (r == 0u) {
            pivot = k;
            for (uint j = k + 1u; j < 8u; ++j)
                if (abs(m[j][k]) > abs(m[pivot][k])) pivot = j;
        }
        barrier();
        uint p = pivot;
        swaps += p != k ? 1u : 0u;
        float a = m[k][r], b = m[p][r];
        barrier();
        m[k][r] = b;
        if (p != k) m[p][r] = a;
        barrier();
        if (r > k) {
            float factor = m[r][k] / m[k][k];
            m[r][k] = factor;
            for (uint c = k + 1u; c < 8u; ++c) m[r][c] -= factor * m[k][c];
        }
    }
    barrier();
    for (uint c = 0u; c < 8u; ++c) factors[base + r * 8u + c] = m[r][c];
    if (r == 0u) factors[200u + gl_WorkGroupID.x] = float(swaps);
}
