#version 450
// Linear blend skinning with 3 x 4 matrices, row-major, and a normal by the inverse transpose.
//! input 3 integer 0 7
//! input 4 uniform 0 1
//! buffer 0 0 1024 uniform -1 1
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 3) in uvec4 bones;
layout(location = 4) in vec4 weights;
layout(location = 0) out vec3 worldNormal;
layout(location = 1) out vec4 debug;
layout(std140, row_major, set = 0, binding = 0) uniform Bones { mat4x3 bone[16]; } skeleton;
void main() {
    mat4x3 m = mat4x3(0.0);
    for (int i = 0; i < 4; ++i) m += skeleton.bone[bones[i]] * weights[i];
    vec3 p = m * vec4(position, 1.0);
    worldNormal = normalize(transpose(inverse(mat3(m))) * normal);
    debug = p * m * mat4(1.0, 0.0, 0.0, 0.5, 0.0, 1.0, 0.0, 0.25, 0.0, 0.0, 1.0, 0.1, 0.2, 0.3, 0.4, 1.0);
    gl_Position = vec4(p, 1.0 + abs(p.z));
}
