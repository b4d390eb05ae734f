#include "tests/spirv_interp/front_snippets.h"

namespace vernier::test {

const char* const kSnippetPrologue = R"(#version 450
#extension GL_EXT_demote_to_helper_invocation : enable
layout(location=0) in vec4 a;
layout(location=1) in vec4 b;
layout(location=2) flat in ivec4 i;
layout(location=3) flat in uvec4 j;
layout(location=4) in vec2 ar[3];
struct Light { vec3 position; float radius; mat3x2 m; int kind; };
layout(std140, set=0, binding=0) uniform U {
    vec4 v; mat4 m; layout(row_major) mat3 r; float f[4]; Light lights[3]; ivec2 n; mat2x3 mm[2];
} u;
layout(std430, set=0, binding=1) buffer S { uint counter; vec3 w; layout(row_major) mat2x3 k; Light l; int tail[]; } s;
layout(push_constant) uniform P { vec4 tint; mat2 q; } pc;
layout(constant_id=3) const int kThree = 3;
layout(constant_id=4) const bool kFlag = true;
layout(constant_id=5) const float kHalf = 0.5;
layout(location=0) out vec4 o;
layout(location=1) out ivec4 p;
)";

std::vector<Snippet> snippets() {
    return {
        {"arithmetic", "",
         "o = a * b + a / b - mod(a, b) + -b; p = i * i.wzyx + i / 3 - i % 5; p ^= ivec4(j >> 3u) | (i << 2) & ~i;"},
        {"unsigned", "",
         "uvec4 x = j * 2654435761u; p = ivec4(x / 7u + x % 11u - (x >> 5)); o = vec4(x) + vec4(lessThan(j, x));"},
        {"comparisons", "",
         "o = vec4(lessThan(a, b)) + 2.0 * vec4(greaterThanEqual(a, b)) + 4.0 * vec4(equal(a, b)); "
         "p = ivec4(greaterThan(i, ivec4(j))) + 2 * ivec4(notEqual(i, i.yxwz)); if (any(lessThan(a.xy, b.xy))) p.x += "
         "8; "
         "if (all(not(equal(i, i.wzyx)))) p.y += 8;"},
        {"vectors", "",
         "vec3 c = cross(a.xyz, b.xyz); o = vec4(c, dot(a, b)); o.zx += reflect(a.xy, b.zw); o.w += length(a.xyz) + "
         "distance(a, b); o.yz = o.zy; p = ivec4(o.wzyx * 8.0);"},
        {"normalise", "",
         "o.xyz = normalize(a.xyz); o.w = normalize(b.x); o += faceforward(a, b, a + b); o.xyz += refract(a.xyz, "
         "b.xyz, 0.7);"},
        {"matrices", "",
         "mat3 m = mat3(a.xyz, b.xyz, a.zxy + vec3(1, 5, 2)); mat3 t = transpose(m) * m; o = vec4(t * a.xyz, "
         "determinant(m)); "
         "mat4 z = outerProduct(a, b) + mat4(2.0); o += b * z; mat2x3 n = mat2x3(a.xyz, b.xyz); o.xy += a.xyz * n;"},
        {"inverse", "",
         "mat4 m = mat4(vec4(3, 0, 0, 1), vec4(0, 2, 0, 0) + a * 0.1, vec4(0, 0, 4, 0), b * 0.1 + vec4(0, 0, 0, 5)); o "
         "= inverse(m) * a; "
         "mat2 k = mat2(a.x + 3.0, 1, 2, b.y + 9.0); o.xy += inverse(k) * b.xy; mat3 l = mat3(7.0) + mat3(a.xyz, "
         "b.xyz, a.yzx) * 0.1; o.xyz += inverse(l)[1]; o.w += determinant(m);"},
        {"functions", "",
         "o = abs(a) + sign(b) + floor(a) + ceil(b) + trunc(a) + fract(b) + roundEven(a) + min(a, b) + max(a, b); "
         "o += clamp(a, -1.0, 1.0) + mix(a, b, 0.25) + step(a, b) + smoothstep(-1.0, 2.0, a) + sqrt(abs(a)) + "
         "inversesqrt(abs(b) + 1.0); "
         "o += mix(a, b, lessThan(a, b)) + radians(a) + degrees(b); p = abs(i) + sign(i) + min(i, i.yxwz) + max(i, "
         "i.zwxy) + clamp(i, -5, 9);"},
        {"transcendental", "",
         "vec4 x = abs(a) + 0.1; o = sin(a) + cos(b) + tan(a * 0.1) + exp(a * 0.3) + exp2(b * 0.3) + log(x) + log2(x) "
         "+ pow(x, b * 0.2); "
         "o += asin(clamp(a, -1.0, 1.0)) + acos(clamp(b, -1.0, 1.0)) + atan(a) + atan(a, b) + sinh(a * 0.2) + cosh(b * "
         "0.2) + tanh(a) + asinh(a) + acosh(x + 1.0) + atanh(clamp(b, -0.9, 0.9));"},
        {"bits", "",
         "p = bitfieldExtract(i, 3, 7) + bitfieldInsert(i, i.yxwz, 5, 9) + bitfieldReverse(i) + bitCount(i) + "
         "findLSB(i) + findMSB(i); "
         "p += ivec4(bitfieldExtract(j, 2, 30)) + findMSB(j); uint c, h, l; c = uaddCarry(j.x, j.y * 4000000000u, l); "
         "p.x += int(c + l); "
         "c = usubBorrow(j.x, j.y, l); p.y += int(c ^ l); umulExtended(j.x * 77777777u, j.y * 3333333u, h, l); p.z += "
         "int(h ^ l); "
         "int sh, sl; imulExtended(i.x * 7777777, i.y * 33333333, sh, sl); p.w += sh ^ sl;"},
        {"packing", "",
         "p.x = int(packUnorm4x8(a) ^ packSnorm4x8(b)); p.y = int(packUnorm2x16(a.xy) ^ packSnorm2x16(b.xy)); p.z = "
         "int(packHalf2x16(a.zw)); p.w = floatBitsToInt(a.x); "
         "o = unpackUnorm4x8(j.x * 7654321u) + unpackSnorm4x8(j.y * 987654321u); o.xy += "
         "unpackHalf2x16(packHalf2x16(a.xy)) + unpackUnorm2x16(j.z) + unpackSnorm2x16(j.w * 654321u); o.z += "
         "intBitsToFloat(floatBitsToInt(b.z) ^ 1);"},
        {"split", "",
         "float whole; o.x = modf(a.x, whole); o.y = whole; int e; o.z = frexp(b.x, e); p.x = e; o.w = ldexp(a.z, i.x "
         "% 8); "
         "vec3 ws; o.xyz += modf(b.yzw, ws) + ws; ivec2 es; o.xy += frexp(a.yz, es); p.yz = es;"},
        {"conversions", "",
         "p = ivec4(a * 100.0) + ivec4(uvec4(abs(b))); o = vec4(i) + vec4(j) + vec4(bvec4(i)); p += ivec4(bvec4(a)) ; "
         "o.x += float(i.x != 0); p.w += int(kFlag) + kThree; o.w *= kHalf;"},
        {"doubles", "",
         "double x = double(a.x) * 3.0LF, y = double(b.y) / 7.0LF; dvec3 v = dvec3(x, y, x - y); o.xyz = vec3(v * "
         "v.yzx + sqrt(abs(v))); "
         "o.w = float(dot(v, v)); p.x = int(x > y) + int(floor(x)); uvec2 w = unpackDouble2x32(x); p.y = int(w.x ^ "
         "w.y); double z = packDouble2x32(w); p.z = int(z == x); p.w = int(fract(abs(y)) * 64.0LF);"},
        {"uniforms", "",
         "o = u.v * u.m + u.m * a; o.xyz += u.r * a.xyz + a.xyz * u.r + u.r[1]; o.w += u.f[2] + u.lights[1].radius + "
         "u.lights[2].m[1].y; "
         "p.xy = u.n; p.z = u.lights[0].kind; o.xyz += u.mm[1][1] + u.mm[0][0]; o.x += u.r[2][1];"},
        {"dynamicUniforms", "",
         "int k = i.x & 1, n = (i.y & 3) % 3; o.x = u.f[i.z & 3]; o.yzw = u.lights[n].position * u.lights[n].radius; "
         "o.xy += u.lights[n].m[k]; "
         "o.x += u.lights[n].m[2][k] + u.r[n][k] + u.m[n][n]; o.xyz += u.mm[k][k]; p.x = u.lights[n].kind + u.n[k]; o "
         "+= u.m[n]; o.xyz += u.r[n];"},
        {"pushConstants", "", "o = pc.tint; o.xy += pc.q * a.xy; o.zw = pc.q[i.x & 1]; p = i;"},
        {"storage", "",
         "s.w = a.xyz; s.k[1] = b.xyz; s.k[0][2] += a.w; s.l.position += s.w; s.l.m = u.lights[1].m; s.l.kind = "
         "s.tail.length(); "
         "s.tail[i.x & 3] = i.y; s.tail[1] += s.tail[(i.z & 3)]; o = vec4(s.l.position, s.l.radius); o.xyz += s.k * "
         "a.xy; p = ivec4(s.tail[0], s.tail[1], s.l.kind, s.tail[100000]);"},
        {"structCopy", "",
         "Light l = u.lights[i.x & 1]; l.position *= 2.0; s.l = l; Light c = s.l; o = vec4(c.position, c.m[1].x); "
         "Light d[2] = Light[2](c, l); d[1].radius = 4.0; o.w += d[0].radius + d[1].radius; p.x = d[1].kind; p.y = "
         "int(d[0] == d[1]); p.z = int(c == l);"},
        {"atomics", "",
         "p.x = int(atomicAdd(s.counter, j.x)); p.y = int(atomicMax(s.counter, 77u)); p.z = "
         "int(atomicExchange(s.counter, j.y)); "
         "p.w = int(atomicCompSwap(s.counter, j.y, j.z)); p.x += atomicMin(s.tail[1], i.x) + atomicAnd(s.tail[1], "
         "0xFFF) + atomicOr(s.tail[1], 64) + atomicXor(s.tail[i.y & 1], 5); o.x = float(s.counter);"},
        {"localArrays", "",
         "float t[8]; for (int k = 0; k < 8; ++k) t[k] = a[k & 3] * float(k); o = vec4(t[i.x & 7], t[3], t[(i.y + 1) & "
         "7], t[7]); vec4 v = b; v[i.z & 3] = 9.0; o += v; mat3 m = mat3(1.0); m[i.x & 1][i.y & 1] = a.x; o.xyz += m * "
         "b.xyz;"},
        {"constantTable",
         "const vec3 kTable[4] = vec3[4](vec3(1, 2, 3), vec3(4, 5, 6), vec3(7, 8, 9), vec3(10, 11, 12));",
         "o.xyz = kTable[i.x & 3] + kTable[2]; o.w = kTable[i.y & 3][i.z & 1]; const ivec4 c = ivec4(5, 6, 7, 8); p = "
         "c * c[i.w & 3];"},
        {"boolArrays", "",
         "bool f[4]; for (int k = 0; k < 4; ++k) f[k] = a[k] > b[k]; p = ivec4(f[0], f[i.x & 3], f[2] != f[i.y & 3], "
         "all(bvec2(f[1], f[3]))); bool g[4] = f; g[i.z & 3] = !g[1]; o = vec4(g[0], g[1], g[2], g[3]);"},
        {"inputArrays", "",
         "o.xy = ar[i.x & 1] + ar[2]; o.z = ar[i.y & 1][i.z & 1]; o.w = a[i.w & 3]; p.x = i[j.x & 3u];"},
        {"ifElse", "",
         "if (a.x > 0.0) { o = a; if (a.y > 0.0) o.x = 3.0; else if (b.x > 0.0) o.y = 4.0; else { o.z = sin(a.z); o.w "
         "= 1.0; } } else o = b; p = a.w > b.w ? i : i.wzyx;"},
        {"shortCircuit", "float f(inout int n, float x) { n++; return x * 2.0; }",
         "int n = 0; bool c = a.x > 0.0 && f(n, a.y) > 1.0 || f(n, b.x) > 0.5; o = vec4(c, n, 0, 0); bool d = a.x > "
         "0.0 ^^ b.x > 0.0; p.x = int(d);"},
        {"loop", "",
         "vec4 t = a; for (int k = 0; k < (i.x & 7); ++k) { t = t * 0.5 + b; if (t.x > 4.0) break; if (t.y < 0.0) "
         "continue; t.z += 1.0; } o = t;"},
        {"nestedLoops", "",
         "int n = 0; for (int x = 0; x < (i.x & 7); ++x) { for (int y = x; y < (i.y & 7); y += 2) { if (((x * y + i.z) "
         "& 3) == 1) continue; if (n > 20) break; n += x * y + 1; } if (n > 30) break; n ^= x; } p = ivec4(n); o = "
         "vec4(n);"},
        {"doWhile", "",
         "int n = i.x & 15, c = 0; do { c += n; n >>= 1; if (c == 13) break; } while (n > 0 && c < 20); p = ivec4(n, "
         "c, 0, 0); while (true) { c += 3; if (c > (i.y & 31)) break; } p.z = c;"},
        {"infinite", "",
         "int k = 0; for (;;) { k += 1 + (i.x & 3); if (k > 9) { if (a.x > 0.0) { o = a; break; } else { o = b; } k = "
         "100; break; } } p.x = k;"},
        {"loopReturn",
         "int find(int n) { for (int k = 0; k < 16; ++k) { if (k * k == n) return k; for (int m = k; m < 5; ++m) if (m "
         "* k == n) return m * 100; } return -1; }",
         "p = ivec4(find(i.x & 31), find(i.y & 15), find(9), find(7)); o = vec4(p) * 0.5;"},
        {"switch", "",
         "o = a; switch (i.x & 7) { case 0: o.x = 1.0; case 1: o.y = 2.0; break; case 2: case 3: o.z = 3.0; break; "
         "case 5: { o.w = 5.0; if (a.x > 0.0) break; o.x = 6.0; } default: o = b; } p.x = i.x & 7;"},
        {"switchInLoop", "",
         "int n = 0; for (int k = 0; k < 10; ++k) { switch ((k + i.x) & 3) { case 0: continue; case 1: n += 1; break; "
         "case 2: n += 10; if (n > 40) return; default: n += 100; } if (n > (i.y & 511)) break; o.x += float(n); } p.x "
         "= n; o.yzw = a.xyz;"},
        {"switchReturn",
         "float g(int k) { switch (k) { case 0: return 1.5; case 4: return a.x; case -7: return b.x; } return 9.0; }",
         "o = vec4(g(i.x & 7), g(4), g(-7), g(i.y)); "},
        {"earlyReturn", "",
         "o = a; if (a.x < 0.0) return; o.x = sqrt(a.x); if (b.x < 0.0) { o.y = 3.0; return; } p = i; o.z += o.x;"},
        {"discard", "",
         "if (a.x > 1.0) discard; o = a; for (int k = 0; k < 4; ++k) { if (b[k] > 3.0) discard; o[k] += b[k]; }"},
        {"demote", "",
         "o = a; if (a.x > 0.5) { demote; o.x = 2.0; } s.counter = 77u; p.x = int(helperInvocationEXT());"},
        {"calls",
         "vec3 h(vec3 v, out float l) { l = length(v); return v / l; } float sum(float v[3]) { return v[0] + v[1] + "
         "v[2]; } void twice(inout vec4 v) { v += v; } vec4 gg = vec4(1); void bump() { gg *= 2.0; }",
         "float l; o.xyz = h(a.xyz, l); o.w = l; float v[3] = float[3](a.x, b.x, 3.0); o.x += sum(v); twice(o); vec4 "
         "arr[2]; arr[1] = a; twice(arr[i.x & 1]); o += arr[1]; bump(); bump(); o *= gg;"},
        {"globals", "int depth = 0; float acc[3]; void rec(int n) { depth += n; acc[depth % 3] = float(n); }",
         "acc[0] = 0.0; acc[1] = 1.0; acc[2] = 2.0; rec(i.x & 3); rec(2); o = vec4(acc[0], acc[1], acc[2], depth); p.x "
         "= depth;"},
        {"outputsRead", "",
         "o = a; o.x += o.y; for (int k = 0; k < 3; ++k) o[k] *= b[k]; p = ivec4(o); p[i.x & 3] = 77;"},
        {"derivatives", "", "o = dFdx(a) + dFdyFine(b) + fwidth(a) + dFdxCoarse(b) + a;"},
        {"specialised", "const int kCount = kThree * 2 + 1;",
         "float kQuarter = kHalf * 0.5; float t[kCount]; for (int k = 0; k < kCount; ++k) t[k] = a.x * float(k); if "
         "(kFlag) o.x = t[kThree]; else o.x = sin(a.x); o.y = t[kCount - 1] * kQuarter; p.x = kCount; p.y = kThree > 2 "
         "? i.x : i.y;"},
        {"precise", "", "precise vec4 t = a * b + a; o = t - a; vec4 q = a * b + b; o += q;"},
        {"swizzleStores", "",
         "vec4 t = vec4(0); t.wx = a.xy; t.yz = b.zw; t.xy = t.yx; mat4 m = mat4(a, b, t, a); m[1].yz = t.xw; m[2][3] "
         "= 5.0; o = m[1] + m[2] + m * t; "},
        {"longChain", "",
         "float x = a.x; for (int k = 0; k < 5; ++k) { if ((i.x >> k & 1) != 0) { if ((i.y >> k & 1) != 0) x += b.x; "
         "else { x *= 0.5; if (x > 1.0) continue; } x = -x; } else { int m = k; while (m > 0) { x += 0.25; m -= 2; if "
         "(x < -2.0) break; } } } o = vec4(x);"},
    };
}

}  // namespace vernier::test
