#version 450
// Phong tessellation: a triangle bent towards the tangent planes of its corners.
layout(triangles, fractional_odd_spacing, cw) in;
layout(location = 0) in Corner { vec3 normal; float term[3]; } corner[];
layout(location = 5) patch in float flatness;
layout(location = 6) flat in ivec2 kind[];
layout(location = 0) out vec3 normal;
layout(location = 1) flat out ivec4 kinds;
void main() {
    vec3 t = gl_TessCoord, squares = t * t;
    vec3 bent = gl_in[0].gl_Position.xyz * squares.x + gl_in[1].gl_Position.xyz * squares.y +
                gl_in[2].gl_Position.xyz * squares.z;
    for (int c = 0; c < 3; ++c)
        bent[c] += t.x * t.y * corner[0].term[c] + t.y * t.z * corner[1].term[c] + t.z * t.x * corner[2].term[c];
    vec3 straight = gl_in[0].gl_Position.xyz * t.x + gl_in[1].gl_Position.xyz * t.y + gl_in[2].gl_Position.xyz * t.z;
    gl_Position = vec4(mix(straight, bent, clamp(flatness, 0.0, 1.0)), 1.0);
    normal = normalize(corner[0].normal * t.x + corner[1].normal * t.y + corner[2].normal * t.z);
    int most = t.x > t.y ? (t.x > t.z ? 0 : 2) : (t.y > t.z ? 1 : 2);
    kinds = ivec4(kind[most], gl_PrimitiveID, gl_PatchVerticesIn);
}
