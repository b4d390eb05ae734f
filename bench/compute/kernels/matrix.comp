#version 450
// C = A * B by tiles of 16 x 16 in shared memory.

const uint kTile = 16u;
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) readonly buffer Left {
    float left[];
};
layout(set = 0, binding = 1) readonly buffer Right {
    float right[];
};
layout(set = 0, binding = 2) writeonly buffer Product {
    float product[];
};
shared float leftTile[kTile][kTile], rightTile[kTile][kTile];

void main() {
    uint size = gl_NumWorkGroups.x * kTile;
    uvec2 at = gl_GlobalInvocationID.xy, local = gl_LocalInvocationID.xy;
    float sum = 0.0;
    for (uint first = 0u; first < size; first += kTile) {
        leftTile[local.y][local.x] = left[at.y * size + first + local.x];
        rightTile[local.y][local.x] = right[(first + local.y) * size + at.x];
        barrier();
        for (uint i = 0u; i < kTile; ++i) sum += leftTile[local.y][i] * rightTile[i][local.x];
        barrier();
    }
    product[at.y * size + at.x] = sum;
}
