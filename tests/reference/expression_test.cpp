// Expressions with results worked out by hand, in all three number types.
#include <climits>
#include <cmath>

#include "tests/reference/reference_support.h"

namespace vernier::reference::test {
namespace {

struct FloatCase {
    const char* body;
    std::array<double, 4> expected;
};
struct IntCase {
    const char* body;
    std::array<int32_t, 4> expected;
};

constexpr double kPi = 3.14159265358979323846;
const double kInf = std::numeric_limits<double>::infinity();

// v = (0.5, -1.25, 2, 3), i = (7, -3, 100, INT_MIN), u = (5, 12, 0x80000001, 0xFFFFFFFF).
const FloatCase kFloatCases[] = {
    {"r = v + v.wzyx;", {3.5, 0.75, 0.75, 3.5}},
    {"r = v - 1.0;", {-0.5, -2.25, 1, 2}},
    {"r = v * v;", {0.25, 1.5625, 4, 9}},
    {"r = 3.0 / v;", {6, -2.4, 1.5, 1}},
    {"r = -v;", {-0.5, 1.25, -2, -3}},
    {"r = mod(vec4(5.5, -5.5, 5.5, -5.5), vec4(v.z, v.z, -v.z, -v.z));", {1.5, 0.5, -0.5, -1.5}},
    {"r = v * 2.5;", {1.25, -3.125, 5, 7.5}},
    {"r = vec4(dot(v, v), dot(v.xy, v.zw), dot(v.xyz, v.yzw), 0);", {14.8125, -2.75, 2.875, 0}},
    {"mat2 m = mat2(v.x, v.y, v.z, v.w); r = vec4(m * vec2(2, 1), vec2(2, 1) * m);", {3, 0.5, -0.25, 7}},
    {"mat2 m = mat2(v.x, v.y, v.z, v.w); mat2 n = m * m; r = vec4(n[0], n[1]);", {-2.25, -4.375, 7, 6.5}},
    {"mat2 n = transpose(mat2(v.x, v.y, v.z, v.w)); r = vec4(n[0], n[1]);", {0.5, 2, -1.25, 3}},
    {"mat2 n = outerProduct(v.xy, v.zw); r = vec4(n[0], n[1]);", {1, -2.5, 1.5, -3.75}},
    {"mat2 n = mat2(v.x, v.y, v.z, v.w) * 2.0; r = vec4(n[0], n[1]);", {1, -2.5, 4, 6}},
    {"mat2x3 m = mat2x3(1, 2, 3, 4, 5, 6) * v.z; r = vec4(m * vec2(1, 10), 0);", {82, 104, 126, 0}},
    {"mat3x2 m = mat3x2(1, 2, 3, 4, 5, v.w); mat2x3 n = mat2x3(1, 2, 3, 4, 5, 6); mat2 p = m * n;"
     " r = vec4(p[0], p[1]);",
     {22, 19, 49, 46}},
    {"mat2 m = mat2(v.x, v.y, v.z, v.w); r = vec4(determinant(m), 0, 0, 0);", {4, 0, 0, 0}},
    {"mat2 m = inverse(mat2(v.x, v.y, v.z, v.w)); r = vec4(m[0], m[1]);", {0.75, 0.3125, -0.5, 0.125}},
    {"mat3 m = mat3(2, 0, 0, 0, 4, 0, 1, 0, v.x); m = inverse(m); r = vec4(m[0].x, m[1].y, m[2].x, m[2].z);",
     {0.5, 0.25, -1, 2}},
    {"mat4 m = mat4(v.z); m[3] = vec4(1, 2, 3, 1); r = vec4(determinant(m), inverse(m)[3].xyz);", {8, -0.5, -1, -1.5}},
    {"r = vec4(float(i.x), float(i.y), float(u.z), float(u.w));", {7, -3, 2147483649.0, 4294967295.0}},
    {"r = vec4(i.w, v.x > 0.0, v.y > 0.0, 0);", {-2147483648.0, 1, 0, 0}},
    {"r = v.x > v.y ? v : -v;", {0.5, -1.25, 2, 3}},
    {"r = mix(v, v.wzyx, greaterThan(v, vec4(1)));", {0.5, -1.25, -1.25, 0.5}},
    {"r = vec4(v[i.x - 6], v[i.x - 4], v[0], 0);", {-1.25, 3, 0.5, 0}},
    {"r = v; r[u.x - 3u] = 9.0;", {0.5, -1.25, 9, 3}},
    {"r = vec4(v.xy, 1, 1).zxyw;", {1, 0.5, -1.25, 1}},
    {"r = vec4(intBitsToFloat(i.x - 7 + 0x40490FDB), uintBitsToFloat(0x7F800000u + u.x - 5u), 0, 0);",
     {3.1415927410125732, kInf, 0, 0}},
    // GLSL.std.450
    {"r = round(v * vec4(5, 2, 1.25, 1.5));", {2, -2, 2, 4}},
    {"r = roundEven(v + vec4(0, -1.25, 0.5, 0.5));", {0, -2, 2, 4}},
    {"r = trunc(v * 1.5);", {0, -1, 3, 4}},
    {"r = abs(v);", {0.5, 1.25, 2, 3}},
    {"r = sign(vec4(v.xy, v.x - 0.5, 0));", {1, -1, 0, 0}},
    {"r = floor(v * 1.5);", {0, -2, 3, 4}},
    {"r = ceil(v * 1.5);", {1, -1, 3, 5}},
    {"r = fract(v);", {0.5, 0.75, 0, 0}},
    {"r = radians(v * 180.0);", {kPi / 2, -1.25 * kPi, 2 * kPi, 3 * kPi}},
    {"r = degrees(v);", {90 / kPi, -225 / kPi, 360 / kPi, 540 / kPi}},
    {"r = sin(v);", {0.47942553860420301, -0.94898461935558621, 0.90929742682568171, 0.14112000805986721}},
    {"r = cos(v);", {0.87758256189037276, 0.31532236239526867, -0.41614683654714241, -0.98999249660044542}},
    {"r = tan(v);", {0.54630248984379048, -3.0095696738628313, -2.1850398632615189, -0.1425465430742778}},
    {"r = asin(v / 4.0);", {0.12532783116806540, -0.31782370392788067, 0.52359877559829893, 0.84806207898148100}},
    {"r = acos(v / 4.0);", {1.4454684956268312, 1.8886200307227771, 1.0471975511965979, 0.72273424781341566}},
    {"r = atan(v);", {0.46364760900080609, -0.89605538457134393, 1.1071487177940904, 1.2490457723982544}},
    {"r = atan(v, v.wwxy);", {0.16514867741462683, -0.39479111969976155, 1.3258176636680326, 1.9655874464946581}},
    {"r = sinh(v);", {0.52109530549374738, -1.6019190803008256, 3.6268604078470190, 10.017874927409903}},
    {"r = cosh(v);", {1.1276259652063807, 1.8884238771610159, 3.7621956910836314, 10.067661995777765}},
    {"r = tanh(v);", {0.46211715726000973, -0.84828363995751289, 0.96402758007581690, 0.99505475368673046}},
    {"r = asinh(v);", {0.48121182505960347, -1.0475930126492587, 1.4436354751788103, 1.8184464592320668}},
    {"r = vec4(acosh(v.z), acosh(v.w), atanh(v.x), atanh(v.y / 2.0));",
     {1.3169578969248166, 1.7627471740390859, 0.54930614433405489, -0.73316853439671351}},
    {"r = pow(v.zwxz, v.wzxx);", {8, 9, 0.70710678118654757, 1.4142135623730951}},
    {"r = exp(v);", {1.6487212707001282, 0.28650479686019009, 7.3890560989306504, 20.085536923187668}},
    {"r = log(abs(v));", {-0.69314718055994529, 0.22314355131420976, 0.69314718055994529, 1.0986122886681098}},
    {"r = exp2(v);", {1.4142135623730951, 0.42044820762685725, 4, 8}},
    {"r = log2(abs(v));", {-1, 0.32192809488736235, 1, 1.5849625007211561}},
    {"r = sqrt(abs(v) * vec4(2, 5, 2, 3));", {1, 2.5, 2, 3}},
    {"r = inversesqrt(vec4(4.0 * v.z * v.x, v.z * 2.0, 16.0 * v.x / 2.0, v.x * v.x));", {0.5, 0.5, 0.5, 2}},
    {"float whole; r.x = modf(v.y, whole); r.y = whole; r.z = modf(v.w, whole); r.w = whole;", {-0.25, -1, 0, 3}},
    {"r = min(v, v.yxwz);", {-1.25, -1.25, 2, 2}},
    {"r = max(v, 1.5);", {1.5, 1.5, 2, 3}},
    {"r = clamp(v, -1.0, 2.5);", {0.5, -1, 2, 2.5}},
    {"r = mix(v, v.wzyx, 0.25);", {1.125, -0.4375, 1.1875, 2.375}},
    {"r = step(vec4(0.5, 0, 2.5, 3), v);", {1, 0, 0, 1}},
    {"r = smoothstep(vec4(0, 0, 0, 2), vec4(1, 1, 4, 4), v);", {0.5, 0, 0.5, 0.5}},
    {"r = fma(v, v, vec4(1));", {1.25, 2.5625, 5, 10}},
    {"int e; r.x = frexp(v.y, e); r.y = float(e); r.z = frexp(v.w * 8.0, e); r.w = float(e);", {-0.625, 1, 0.75, 5}},
    {"r = ldexp(v, ivec4(1, i.y, 10, -1));", {1, -0.15625, 2048, 1.5}},
    {"r = vec4(length(v.zw * vec2(1.5, 4.0 / 3.0)), length(v.y), distance(v.x, v.w), distance(v.xy, v.zw));",
     {5, 1.25, 2.5, 4.5069390943299865}},
    {"r = vec4(cross(v.xyz, v.yzw), 0);", {-7.75, -4, -0.5625, 0}},
    {"r = vec4(normalize(vec2(1.5, v.z)), normalize(v.y), 0);", {0.6, 0.8, -1, 0}},
    {"r = vec4(faceforward(v.xy, v.xy, v.xy), faceforward(v.xy, v.xy, -v.xy));", {-0.5, 1.25, 0.5, -1.25}},
    {"r = vec4(reflect(v.xy, vec2(0, 1)), reflect(v.xy, vec2(1, 0)));", {0.5, 1.25, -0.5, -1.25}},
    {"r = vec4(refract(vec2(0, -1), vec2(0, 1), v.x), refract(vec2(0.8, -0.6), vec2(0, 1), v.z));", {0, -1, 0, 0}},
    {"r = unpackSnorm4x8(u.x - 5u + 0x7F81807Fu);", {1, -1, -1, 1}},
    {"r = unpackUnorm4x8(u.x - 5u + 0xFF330066u);", {0.4, 0, 0.2, 1}},
    {"r = vec4(unpackSnorm2x16(u.x - 5u + 0x80007FFFu), unpackUnorm2x16(u.x - 5u + 0xFFFF3333u));", {1, -1, 0.2, 1}},
    {"r = vec4(unpackHalf2x16(u.x - 5u + 0xC1003555u), unpackHalf2x16(u.x - 5u + 0x00017BFFu));",
     {0.333251953125, -2.5, 65504, 5.9604644775390625e-08}},
    {"r.x = float(double(v.x) * double(v.y)); r.y = float(packDouble2x32(uvec2(0, 0x40080000u + u.x - 5u)));"
     " r.zw = vec2(0);",
     {-0.625, 3, 0, 0}},
};

const IntCase kIntCases[] = {
    {"ri = i + ivec4(1, 2, 3, -1);", {8, -1, 103, INT_MAX}},
    {"ri = i - i.yxwz;", {10, -10, INT_MIN + 100, INT_MAX - 99}},
    {"ri = i * ivec4(3, -5, 1 << 30, -1);", {21, 15, 0, INT_MIN}},
    {"ri = i / ivec4(2, 2, -7, -1);", {3, -1, -14, INT_MIN}},
    {"ri = i / (i.xxxx - 7);", {0, 0, 0, 0}},
    {"ri = ivec4(u / uvec4(2, 5, 2, 16));", {2, 2, 0x40000000, 0x0FFFFFFF}},
    {"ri = ivec4(u % uvec4(3, 5, 16, 10));", {2, 2, 1, 5}},
    {"ri = i.xxxx % ivec4(4, 5, 7, 8);", {3, 2, 0, 7}},
    {"ri = -i;", {-7, 3, -100, INT_MIN}},
    {"ri = ~i;", {-8, 2, -101, INT_MAX}},
    {"ri = i & ivec4(3, 0xFF, 0x64, -1);", {3, 0xFD, 100, INT_MIN}},
    {"ri = i | ivec4(8, 1, 3, 1);", {15, -3, 103, INT_MIN + 1}},
    {"ri = i ^ ivec4(7, -1, 0, -1);", {0, 2, 100, INT_MAX}},
    {"ri = i << ivec4(2, 1, 31, 1);", {28, -6, 0, 0}},
    {"ri = i >> ivec4(1, 1, 3, 31);", {3, -2, 12, -1}},
    {"ri = ivec4(u >> uvec4(1, 2, 31, 28));", {2, 3, 1, 15}},
    {"ri = ivec4(v * vec4(3, 3, 1e10, -1e10));", {1, -3, INT_MAX, INT_MIN}},
    {"ri = ivec4(uvec4(v * vec4(3, 3, 2e9, 1e10)));", {1, 0, static_cast<int32_t>(4000000000u), -1}},
    {"ri = ivec4(v.x / (v.x - 0.5) > 1e38, isinf(v.x / (v.x - 0.5)), isnan((v.x - 0.5) / (v.x - 0.5)), 0);",
     {1, 1, 1, 0}},
    {"float n = (v.x - 0.5) / (v.x - 0.5); ri = ivec4(n == n, n != n, n < 1.0, int(n));", {0, 1, 0, 0}},
    {"ri = ivec4(lessThan(v, vec4(1, -1.25, 2, 4)));", {1, 0, 0, 1}},
    {"ri = ivec4(lessThanEqual(v, vec4(1, -1.25, 1, 4)));", {1, 1, 0, 1}},
    {"ri = ivec4(greaterThanEqual(v, vec4(1, -1.25, 1, 4)));", {0, 1, 1, 0}},
    {"ri = ivec4(equal(v, vec4(0.5, 0, 2, 0)));", {1, 0, 1, 0}},
    {"ri = ivec4(notEqual(i, ivec4(7, 0, 100, 0)));", {0, 1, 0, 1}},
    {"ri = ivec4(lessThan(i, ivec4(8, -3, 99, 0)));", {1, 0, 0, 1}},
    {"ri = ivec4(greaterThan(u, uvec4(5, 11, 1, 0xFFFFFFFFu)));", {0, 1, 1, 0}},
    {"ri = ivec4(any(greaterThan(v, vec4(2.5))), all(greaterThan(v, vec4(0))), all(lessThan(v, vec4(4))), "
     "0);",
     {1, 0, 1, 0}},
    {"bool a = v.x > 0.0, b = v.y > 0.0; ri = ivec4(a && b, a || b, a ^^ b, !a);", {0, 1, 1, 0}},
    {"bool a = v.x > 0.0, b = v.y > 0.0; ri = ivec4(a == b, a != b, bool(i.x), u.x != 0u);", {0, 1, 1, 1}},
    {"ri = abs(i);", {7, 3, 100, INT_MIN}},
    {"ri = sign(ivec4(i.xyz, i.x - 7));", {1, -1, 1, 0}},
    {"ri = min(i, ivec4(5)); ri.w = int(min(u.w, u.z));", {5, -3, 5, INT_MIN + 1}},
    {"ri = max(i, ivec4(5)); ri.w = int(max(u.w, u.z));", {7, 5, 100, -1}},
    {"ri = clamp(i, ivec4(-2), ivec4(50)); ri.w = int(clamp(u.w, 3u, 9u));", {7, -2, 50, 9}},
    {"ri = findLSB(i); ri.x = findLSB(i.x - 7);", {-1, 0, 2, 31}},
    {"ri = findMSB(i); ri.w = findMSB(u.w);", {2, 1, 6, 31}},
    {"ri = ivec4(findMSB(i.x - 7), findMSB(i.y + 2), findMSB(u.x), findMSB(i.w));", {-1, -1, 2, 30}},
    {"ri = bitCount(i);", {3, 31, 3, 1}},
    {"ri = bitfieldReverse(i);", {static_cast<int32_t>(0xE0000000u), static_cast<int32_t>(0xBFFFFFFFu), 0x26000000, 1}},
    {"ri = ivec4(bitfieldExtract(i.y, 0, 4), bitfieldExtract(u.z, 28, 4), bitfieldExtract(i.x, 1, 2),"
     " bitfieldExtract(i.x, 3, 0));",
     {-3, 8, -1, 0}},
    {"ri = bitfieldInsert(i, ivec4(2), 4, 4);", {0x27, static_cast<int32_t>(0xFFFFFF2Du), 0x24, INT_MIN + 0x20}},
    {"uint c; uint s = uaddCarry(u.w, u.x, c); uint b; uint d = usubBorrow(u.x, u.y, b); ri = ivec4(s, c, d, "
     "b);",
     {4, 1, -7, 1}},
    {"uint h, l; umulExtended(u.w, u.w, h, l); int sh, sl; imulExtended(i.y, i.x, sh, sl); ri = ivec4(h, l, "
     "sh, sl);",
     {-2, 1, -1, -21}},
    {"ri = floatBitsToInt(v);", {0x3F000000, static_cast<int32_t>(0xBFA00000u), 0x40000000, 0x40400000}},
    {"ri = ivec4(packSnorm4x8(v.xyzx), packUnorm4x8(v.xyzx), packSnorm2x16(v.xz), packUnorm2x16(v.xz));",
     {0x407F8140, static_cast<int32_t>(0x80FF0080u), 0x7FFF4000, static_cast<int32_t>(0xFFFF8000u)}},
    {"ri = ivec4(packHalf2x16(v.xy), packHalf2x16(v.zw * 30000.0), 0, 0);",
     {static_cast<int32_t>(0xBD003800u), 0x7C007B53, 0, 0}},
    {"uvec2 w = unpackDouble2x32(double(v.w)); ri = ivec4(w, 0, 0);", {0, 0x40080000, 0, 0}},
};

template <class Number>
class Expression : public testing::Test {};
using Numbers = testing::Types<float, double, Real>;
TYPED_TEST_SUITE(Expression, Numbers);

TYPED_TEST(Expression, Floats) {
    for (const FloatCase& c : kFloatCases) {
        Resources<TypeParam> none;
        const auto outcome =
            runFragment<TypeParam>(compileFragment(fragmentSource("", c.body)), standardInputs<TypeParam>(), none);
        const auto got = floatsAt(outcome);
        for (size_t k = 0; k < 4; ++k) {
            if (got[k] == c.expected[k]) continue;
            // The literals of the shaders are floats, so also wide number types differ from the expectation
            // by that.
            EXPECT_NEAR(got[k], c.expected[k], 1.2e-7 * std::fabs(c.expected[k]) + 1e-12)
                << c.body << " component " << k;
        }
    }
}

TYPED_TEST(Expression, Integers) {
    for (const IntCase& c : kIntCases) {
        Resources<TypeParam> none;
        const auto outcome =
            runFragment<TypeParam>(compileFragment(fragmentSource("", c.body)), standardInputs<TypeParam>(), none);
        EXPECT_EQ(intsAt(outcome), c.expected) << c.body;
    }
}

TYPED_TEST(Expression, SixtyFourBitIntegers) {
    Resources<TypeParam> none;
    const auto outcome = runFragment<TypeParam>(
        compileFragment(fragmentSource("", R"(
            int64_t a = int64_t(i.w) * int64_t(i.x);
            uint64_t b = (uint64_t(u.w) << 32) | uint64_t(u.x);
            uvec2 w = unpackUint2x32(b);
            ri = ivec4(int(a >> 32), int(a), int(w.y), int(b / 5ul == 0x3333333300000001ul));
            r = vec4(float(a), double(b) > 1.8e19 ? 1 : 0, a < 0L, b > 0ul);)")
                            .replace(0, 12, "#version 450\n#extension GL_ARB_gpu_shader_int64 : require\n")),
        standardInputs<TypeParam>(), none);
    EXPECT_EQ(intsAt(outcome),
              (std::array<int32_t, 4>{-4, INT_MIN, -1, 0xFFFFFFFF00000005ull / 5 == 0x3333333300000001ull}));
    EXPECT_EQ(floatsAt(outcome), (std::array<double, 4>{-15032385536.0, 1, 1, 1}));
}

/// float32 arithmetic, exact arithmetic, and exact arithmetic with every result rounded.
TEST(Rounding, TellsExactnessFromRounding) {
    const Words words =
        compileFragment(fragmentSource("", "float big = v.w * 33554432.0; r = vec4((big + v.x) - big);"));
    const Options rounding{.roundToFloat = true};
    Resources<float> floats;
    Resources<double> doubles;
    Resources<Real> reals;
    EXPECT_EQ(floatsAt(runFragment<float>(words, standardInputs<float>(), floats))[0], 0);
    EXPECT_EQ(floatsAt(runFragment<double>(words, standardInputs<double>(), doubles))[0], 0.5);
    EXPECT_EQ(floatsAt(runFragment<Real>(words, standardInputs<Real>(), reals))[0], 0.5);
    EXPECT_EQ(floatsAt(runFragment<double>(words, standardInputs<double>(), doubles, rounding))[0], 0);
    EXPECT_EQ(floatsAt(runFragment<Real>(words, standardInputs<Real>(), reals, rounding))[0], 0);
}

}  // namespace
}  // namespace vernier::reference::test
