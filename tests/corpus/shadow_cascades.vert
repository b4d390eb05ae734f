#version 450
// Positions for four shadow cascades: arrays of matrices in and arrays of vectors out.
//! buffer 0 0 1024 uniform -1 1
layout(location = 0) in vec4 position;
layout(location = 0) out vec4 cascade[4];
layout(location = 4) out mat2 turn;
layout(location = 6) flat out int best;
struct Camera { mat4 projection; vec2 range[2]; };
layout(set = 0, binding = 0) uniform Scene { Camera cameras[4]; } scene;
void main() {
    best = -1;
    for (int i = 0; i < 4; ++i) {
        cascade[i] = scene.cameras[i].projection * position;
        vec2 range = scene.cameras[i].range[gl_InstanceIndex & 1];
        if (best < 0 && cascade[i].z > min(range.x, range.y) && cascade[i].z < max(range.x, range.y)) best = i;
    }
    turn = mat2(cascade[best < 0 ? 0 : best].xy, -cascade[3].yx);
    gl_Position = matrixCompMult(scene.cameras[0].projection, outerProduct(position, cascade[1])) * position;
}
