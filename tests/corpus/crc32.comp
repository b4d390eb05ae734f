#version 450
// CRC-32 by nibbles with a table in shared memory, and Adler-32.
//! groups 2 1 1
//! buffer 0 0 4096 integer -2147483648 2147483647
//! buffer 0 1 512 zero
layout(local_size_x = 32) in;
layout(std430, set = 0, binding = 0) readonly buffer Bytes { uint words[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Sums { uvec2 sums[]; };
shared uint table[16];
void main() {
    uint i = gl_LocalInvocationIndex;
    if (i < 16u) {
        uint c = i;
        for (int k = 0; k < 4; ++k) c = (c & 1u) != 0u ? 0xEDB88320u ^ c >> 1 : c >> 1;
        table[i] = c;
    }
    barrier();
    uint crc = ~0u, a = 1u, b = 0u, length = 20u + gl_GlobalInvocationID.x % 13u;
    for (uint n = 0u; n < length; ++n) {
        uint byte_ = bitfieldExtract(words[(gl_GlobalInvocationID.x * 16u + n / 4u) & 1023u], int(n % 4u * 8u), 8);
        crc ^= byte_;
        crc = table[crc & 15u] ^ crc >> 4;
        crc = table[crc & 15u] ^ crc >> 4;
        a = (a + byte_) % 65521u;
        b = (b + a) % 65521u;
    }
    sums[gl_GlobalInvocationID.x] = uvec2(~crc, b << 16 | a);
}
