#version 450
// Multiplication of 256-bit integers with carries, and modular exponentiation by Montgomery in 32 bits.
//! groups 1 1 1
//! buffer 0 0 2048 integer -2147483648 2147483647
//! buffer 0 1 4096 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) readonly buffer Source { uint source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { uint result[]; };
uint montgomery(uint a, uint b, uint m, uint inverse) {
    uint high, low, h2, l2, carry;
    umulExtended(a, b, high, low);
    umulExtended(low * inverse, m, h2, l2);
    uaddCarry(low, l2, carry);
    uint sum = h2 + carry, over;
    sum = uaddCarry(high, sum, over);
    return over != 0u || sum >= m ? sum - m : sum;
}
void main() {
    uint i = gl_GlobalInvocationID.x, product[16];
    for (int k = 0; k < 16; ++k) product[k] = 0u;
    for (uint a = 0u; a < 8u; ++a) {
        uint carry = 0u;
        for (uint b = 0u; b < 8u; ++b) {
            uint high, low, c1, c2;
            umulExtended(source[i * 8u + a], source[(i * 8u + 8u + b) & 511u], high, low);
            low = uaddCarry(low, carry, c1);
            product[a + b] = uaddCarry(product[a + b], low, c2);
            carry = high + c1 + c2;
        }
        product[a + 8u] = carry;
    }
    uint m = source[i] | 0x80000001u, inverse = m;
    for (int k = 0; k < 4; ++k) inverse *= 2u - m * inverse;
    uint x = source[i + 1u] % m, y = x, e = 65537u;
    for (; e != 0u; e >>= 1) {
        if ((e & 1u) != 0u) y = montgomery(y, x, m, 0u - inverse);
        x = montgomery(x, x, m, 0u - inverse);
    }
    for (uint k = 0u; k < 16u; ++k) result[i * 17u + k] = product[k];
    result[i * 17u + 16u] = y;
}
