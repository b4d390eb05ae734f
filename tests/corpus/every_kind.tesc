#version 450
#extension GL_EXT_shader_explicit_arithmetic_types_int16 : require
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
#extension GL_EXT_shader_16bit_storage : require
// Outputs of every kind, written and read back, by constant numbers and by others.
//! invocations 20
//! inputs uniform -4 4
layout(vertices = 5) out;
layout(location = 0) in vec4 a[];
layout(location = 1) in dvec2 b[];
layout(location = 0) out mat3x2 m[];
layout(location = 3) out dvec3 d[];
layout(location = 5) out float list[][4];
layout(location = 9) patch out int16_t small[3];
layout(location = 12) patch out f16vec2 half2;
layout(location = 13) patch out uvec3 sums;
struct Pair { int n; vec2 v; };
layout(location = 14) patch out Pair pair;
void main() {
    int me = gl_InvocationID;
    m[gl_InvocationID] = mat3x2(a[me].xy, a[me].zw, a[(me + 2) % 5].yx);
    d[gl_InvocationID] = dvec3(b[me], b[me].x * double(me));
    for (int k = 0; k < 4; ++k) list[gl_InvocationID][k] = a[k % gl_PatchVerticesIn][me % 4] + float(k);
    barrier();
    int from = int(abs(a[0].x)) % 5;
    list[gl_InvocationID][3] = m[from][1].y + list[(me + 1) % 5][me % 3];
    if (me < 3) small[me] = int16_t(a[me].x * 9000.0);
    barrier();
    if (me == 4) {
        half2 = f16vec2(float(small[0]) * 0.25, a[1].x);
        sums = uvec3(uint(int(small[1]) + int(small[2])), uint(me), floatBitsToUint(float(d[from].z)));
        pair.n = int(small[from % 3]);
        pair.v = m[3] * vec3(list[1][0], list[2][3], float(half2.y));
    }
    gl_out[gl_InvocationID].gl_PointSize = float(me) + list[me][0];
    gl_TessLevelOuter[me & 3] = 2.0;
}
