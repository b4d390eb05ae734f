// Floats of 16 bits against exact arithmetic: every operation rounds once, to the nearest half.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <random>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/half_model.h"
#include "tests/spirv_interp/shader_run.h"

namespace vernier::test {
namespace {

constexpr const char* kExtensions =
    "#extension GL_EXT_shader_explicit_arithmetic_types : require\n"
    "#extension GL_EXT_shader_8bit_storage : require\n#extension GL_EXT_shader_16bit_storage : require\n";

struct Case {
    const char* glsl;
    std::function<long double(double, double, double)> exact;
};

std::vector<uint16_t> specials() {
    return {0,      0x8000, 1,      0x8001, 2,      0x3FF,  0x400,  0x401,  0x7FF,  0x3BFF, 0x3C00, 0x3C01,
            0xBC00, 0x4000, 0x4200, 0x7BFF, 0xFBFF, 0x7C00, 0xFC00, 0x7E00, 0x3555, 0xB800, 0x3800, 0x6400};
}

TEST(Halves, OperationsRoundOnce) {
    std::mt19937 random(3);
    std::vector<uint16_t> a, b, c;
    for (const uint16_t x : specials()) {
        for (const uint16_t y : specials()) {
            a.push_back(x);
            b.push_back(y);
            c.push_back(specials()[random() % specials().size()]);
        }
    }
    while (a.size() < 16384) {
        // Near each other, so that sums and quotients have many digits.
        a.push_back(static_cast<uint16_t>(random()));
        b.push_back(static_cast<uint16_t>(random() % 4 == 0 ? random() : a.back() + random() % 8192));
        c.push_back(static_cast<uint16_t>(random() % 4 == 0 ? random()
                                                            : halfOf(valueOf(a.back()) * valueOf(b.back())) ^ 0x8001));
    }
    const Case cases[] = {
        {"x + y", [](double x, double y, double) { return static_cast<long double>(x) + y; }},
        {"x - y", [](double x, double y, double) { return static_cast<long double>(x) - y; }},
        {"x * y", [](double x, double y, double) { return static_cast<long double>(x) * y; }},
        {"x / y", [](double x, double y, double) { return static_cast<long double>(x) / y; }},
        {"-x", [](double x, double, double) { return static_cast<long double>(-x); }},
        {"sqrt(abs(x))", [](double x, double, double) { return std::sqrt(static_cast<long double>(std::fabs(x))); }},
        {"fma(x, y, z)", [](double x, double y, double z) { return static_cast<long double>(x) * y + z; }},
        {"floor(x)", [](double x, double, double) { return static_cast<long double>(std::floor(x)); }},
        {"ceil(x)", [](double x, double, double) { return static_cast<long double>(std::ceil(x)); }},
        {"trunc(x)", [](double x, double, double) { return static_cast<long double>(std::trunc(x)); }},
        {"roundEven(x)", [](double x, double, double) { return static_cast<long double>(std::nearbyint(x)); }},
        {"max(x, y)",
         [](double x, double y, double) {
             return static_cast<long double>(std::isnan(y) ? x : x > y ? x : std::isnan(x) ? y : y > x ? y : x);
         }},
        {"ldexp(x, int(lane) - 32)", nullptr},
        {"float16_t(float(x) * 0.333)",
         [](double x, double, double) { return static_cast<long double>(static_cast<float>(x) * 0.333f); }},
        {"float16_t(double(x) * 1.0001lf)",
         [](double x, double, double) { return static_cast<long double>(x * 1.0001); }},
        {"float16_t(x < y)", [](double x, double y, double) { return x < y ? 1.0L : 0.0L; }},
    };
    const auto perLane = static_cast<uint32_t>(a.size() / 64);
    std::string body = "for (int i = 0; i < " + std::to_string(perLane) + "; ++i) { int k = lane * " +
                       std::to_string(perLane) + " + i; float16_t x = a[k], y = b[k], z = c[k];\n";
    for (size_t n = 0; n < std::size(cases); ++n) {
        body += "r[k + " + std::to_string(n * a.size()) + "] = " + cases[n].glsl + ";\n";
    }
    ShaderRun shader;
    shader.words =
        laneShader(kExtensions,
                   "layout(binding=0) buffer A { float16_t a[]; }; layout(binding=1) buffer B { float16_t b[]; };"
                   "layout(binding=2) buffer C { float16_t c[]; }; layout(binding=3) buffer R { float16_t r[]; };",
                   body + "}");
    shader.buffers[0] = bytesOf(a);
    shader.buffers[1] = bytesOf(b);
    shader.buffers[2] = bytesOf(c);
    for (const Isa isa : isas()) {
        shader.buffers[3] = Bytes(a.size() * 2 * std::size(cases));
        ASSERT_TRUE(shader.run(isa));
        const auto result = valuesOf<uint16_t>(shader.buffers[3]);
        for (size_t n = 0; n < std::size(cases); ++n) {
            uint32_t failures = 0;
            for (size_t k = 0; k < a.size() && failures < 3; ++k) {
                const double x = valueOf(a[k]), y = valueOf(b[k]), z = valueOf(c[k]);
                const int lane = static_cast<int>(k / perLane);
                const long double exact =
                    cases[n].exact ? cases[n].exact(x, y, z) : std::ldexp(static_cast<long double>(x), lane - 32);
                const uint16_t expected = halfOf(exact), got = result[n * a.size() + k];
                if (isNan(expected) ? isNan(got) : expected == got) continue;
                // min and max of zeros of both signs may give either.
                if ((expected | got) == 0x8000 && n == 11) continue;
                ++failures;
                ADD_FAILURE() << cases[n].glsl << " of " << x << ", " << y << ", " << z << " is " << valueOf(got)
                              << " instead of " << valueOf(expected);
            }
        }
    }
}

// All halves through loads and stores, as values and as bits; and back from floats and doubles between them.
TEST(Halves, ConversionsBothWays) {
    ShaderRun shader;
    shader.words = laneShader(
        kExtensions,
        "layout(binding=0) buffer A { float16_t a[]; }; layout(binding=1) buffer F { float f[]; };"
        "layout(binding=2) buffer D { double d[]; }; layout(binding=3) buffer R { float16_t r[]; };"
        "layout(binding=4) buffer I { int i[]; };",
        "for (int n = 0; n < 1024; ++n) { int k = lane * 1024 + n; float16_t x = a[k];"
        "f[k] = float(x); d[k] = double(x); r[k] = x; r[k + 65536] = uint16BitsToFloat16(float16BitsToUint16(x));"
        "r[k + 131072] = unpackFloat2x16(packFloat2x16(f16vec2(0.0, x))).y;"
        "r[k + 196608] = float16_t(k - 32768); i[k] = int(x); i[k + 65536] = int(uint16_t(abs(x)));"
        "i[k + 131072] = int(int16_t(x)); i[k + 196608] = int(int8_t(x));"
        "r[k + 262144] = float16_t(uint64_t(k) * uint64_t(k)); }");
    std::vector<uint16_t> a(65536);
    for (uint32_t k = 0; k < 65536; ++k) a[k] = static_cast<uint16_t>(k);
    shader.buffers[0] = bytesOf(a);
    for (const Isa isa : isas()) {
        shader.buffers[1] = Bytes(65536 * 4);
        shader.buffers[2] = Bytes(65536 * 8);
        shader.buffers[3] = Bytes(65536 * 10);
        shader.buffers[4] = Bytes(65536 * 16);
        ASSERT_TRUE(shader.run(isa));
        const auto f = valuesOf<float>(shader.buffers[1]);
        const auto d = valuesOf<double>(shader.buffers[2]);
        const auto r = valuesOf<uint16_t>(shader.buffers[3]);
        const auto i = valuesOf<int32_t>(shader.buffers[4]);
        const auto cut = [](double x, double low, double high) {
            return std::isnan(x) ? 0 : static_cast<int>(std::trunc(std::fmin(std::fmax(x, low), high)));
        };
        for (uint32_t k = 0; k < 65536; ++k) {
            const double x = valueOf(a[k]);
            if (std::isnan(x)) {
                EXPECT_TRUE(std::isnan(f[k]) && std::isnan(d[k]));
            } else {
                EXPECT_EQ(f[k], static_cast<float>(x));
                EXPECT_EQ(d[k], x);
            }
            // A copy keeps the bits, those of NaNs too.
            EXPECT_EQ(r[k], a[k]);
            EXPECT_EQ(r[k + 65536], a[k]);
            EXPECT_EQ(r[k + 131072], a[k]);
            EXPECT_EQ(r[k + 196608], halfOf(static_cast<int>(k) - 32768));
            EXPECT_EQ(r[k + 262144], halfOf(static_cast<long double>(k) * k));
            if (std::isinf(x)) continue;
            EXPECT_EQ(i[k], cut(x, -1e9, 1e9));
            EXPECT_EQ(i[k + 65536], cut(std::fabs(x), 0, 65535));
            EXPECT_EQ(i[k + 131072], cut(x, -32768, 32767));
            EXPECT_EQ(i[k + 196608], cut(x, -128, 127));
            if (HasFailure()) return;
        }
    }
}

// Values between halves, at and next to the middle: a double must not be rounded to a float on the way.
TEST(Halves, NarrowingFromFloatAndDouble) {
    std::vector<double> values;
    for (uint32_t k = 0; k < 0x7C00; k += 7) {
        const double low = valueOf(static_cast<uint16_t>(k)),
                     high = k == 0x7BFF ? 65536 : valueOf(static_cast<uint16_t>(k + 1));
        const double middle = (low + high) / 2;
        for (const double x :
             {middle, std::nextafter(middle, 0.0), std::nextafter(middle, 1e9), low, low + (high - low) / 4}) {
            values.push_back(x);
            values.push_back(-x);
        }
    }
    for (const double x :
         {65519.99999, 65520.0, 65535.0, 65536.0, 1e30, 1e300, HUGE_VAL, 1e-30, 1e-300, 5e-324, 2.98e-8, 2.99e-8}) {
        values.push_back(x);
        values.push_back(-x);
    }
    while (values.size() % 64 != 0) values.push_back(1.0 / 3.0);
    const auto perLane = values.size() / 64;
    ShaderRun shader;
    shader.words = laneShader(
        kExtensions, "layout(binding=0) buffer D { double d[]; }; layout(binding=1) buffer R { float16_t r[]; };",
        "for (int n = 0; n < " + std::to_string(perLane) + "; ++n) { int k = lane * " + std::to_string(perLane) +
            " + n; r[2 * k] = float16_t(d[k]); r[2 * k + 1] = float16_t(float(d[k])); }");
    shader.buffers[0] = bytesOf(values);
    // The same conversions rounding towards zero: the decoration is put on both.
    Words zero;
    {
        std::vector<uint32_t> targets;
        for (size_t at = 5; at < shader.words.size(); at += shader.words[at] >> 16) {
            if ((shader.words[at] & 0xFFFF) == 115) targets.push_back(shader.words[at + 2]);  // OpFConvert
        }
        for (size_t at = 5; at < shader.words.size(); at += shader.words[at] >> 16) {
            if ((shader.words[at] & 0xFFFF) != 71) continue;  // before the first OpDecorate
            zero.assign(shader.words.begin(), shader.words.begin() + static_cast<ptrdiff_t>(at));
            // FPRoundingMode RTZ, where the result is a half: the float of the second conversion is not.
            for (const size_t which : {size_t{0}, targets.size() - 1}) {
                const uint32_t decorate[] = {4u << 16 | 71, targets[which], 39, 1};
                zero.insert(zero.end(), decorate, decorate + 4);
            }
            zero.insert(zero.end(), shader.words.begin() + static_cast<ptrdiff_t>(at), shader.words.end());
            break;
        }
    }
    const Words nearest = shader.words;
    for (const bool towardsZero : {false, true}) {
        shader.words = towardsZero ? zero : nearest;
        for (const Isa isa : isas()) {
            shader.buffers[1] = Bytes(values.size() * 4);
            ASSERT_TRUE(shader.run(isa));
            const auto r = valuesOf<uint16_t>(shader.buffers[1]);
            for (size_t k = 0; k < values.size(); ++k) {
                const float single = static_cast<float>(values[k]);
                EXPECT_EQ(r[2 * k], halfOf(values[k], towardsZero)) << values[k];
                EXPECT_EQ(r[2 * k + 1], halfOf(single, towardsZero)) << single;
            }
            if (HasFailure()) return;
        }
    }
}

// Vectors, matrices and functions of GLSL.std.450: exact where the steps are, and within the digits of a half
// elsewhere.
TEST(Halves, VectorsMatricesFunctions) {
    ShaderRun shader;
    shader.words = laneShader(kExtensions,
                              "layout(binding=0) buffer A { f16vec4 a[]; }; layout(binding=1) buffer M { f16mat3 m; "
                              "layout(row_major) f16mat2x4 t; };"
                              "layout(binding=2) buffer R { float r[]; };",
                              R"(
f16vec4 v = a[lane];
f16vec3 p = m * v.xyz;
f16vec4 q = t * v.xy;
int ex;
float16_t ma = frexp(v.x, ex);
float16_t whole;
float16_t part = modf(v.y, whole);
float16_t o[] = float16_t[](p.x, p.y, p.z, q.x, q.w, dot(v, v), length(v.xy), distance(v.x, v.y), ma, float16_t(ex), part, whole,
    sin(v.x), exp2(v.y), pow(abs(v.x), v.y), atan(v.x, v.y), inversesqrt(abs(v.z) + 1.0hf), normalize(v).y,
    mix(v.x, v.y, 0.25hf), smoothstep(-2.0hf, 2.0hf, v.x), fract(v.x), sign(v.x), step(v.x, v.y), clamp(v.x, -1.0hf, 1.0hf),
    reflect(v.xyz, f16vec3(0, 1, 0)).y, cross(v.xyz, v.yzw).x, determinant(m), mod(v.x, 0.75hf), radians(v.x), v[lane & 3]);
for (int i = 0; i < 30; ++i) r[lane * 30 + i] = float(o[i]);
)");
    std::mt19937 random(17);
    std::vector<uint16_t> a(256), matrices(24);
    for (uint16_t& x : a) x = halfOf((static_cast<int>(random() % 1024) - 512) / 128.0);
    for (uint16_t& x : matrices) x = halfOf((static_cast<int>(random() % 64) - 32) / 16.0);
    const auto M = [&](int column, int row) { return valueOf(matrices[static_cast<size_t>(column * 4 + row)]); };
    // std430: columns of three halves take 8 bytes; two columns of four by rows: four rows of 4 bytes.
    const auto T = [&](int column, int row) { return valueOf(matrices[static_cast<size_t>(12 + row * 2 + column)]); };
    shader.buffers[0] = bytesOf(a);
    shader.buffers[1] = bytesOf(matrices);
    for (const Isa isa : isas()) {
        shader.buffers[2] = Bytes(64 * 30 * 4);
        ASSERT_TRUE(shader.run(isa));
        const auto r = valuesOf<float>(shader.buffers[2]);
        for (size_t lane = 0; lane < 64; ++lane) {
            double v[4];
            for (size_t i = 0; i < 4; ++i) v[i] = valueOf(a[lane * 4 + i]);
            const double* w = v;
            const auto row3 = [&](int k) { return M(0, k) * w[0] + M(1, k) * w[1] + M(2, k) * w[2]; };
            int ex = 0;
            const double ma = std::frexp(v[0], &ex);
            const double s = std::fmin(std::fmax((v[0] + 2) / 4, 0.0), 1.0);
            const double det = M(0, 0) * (M(1, 1) * M(2, 2) - M(2, 1) * M(1, 2)) -
                               M(0, 1) * (M(1, 0) * M(2, 2) - M(2, 0) * M(1, 2)) +
                               M(0, 2) * (M(1, 0) * M(2, 1) - M(2, 0) * M(1, 1));
            const double norm = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
            const double expected[30] = {row3(0),
                                         row3(1),
                                         row3(2),
                                         T(0, 0) * v[0] + T(1, 0) * v[1],
                                         T(0, 3) * v[0] + T(1, 3) * v[1],
                                         norm * norm,
                                         std::hypot(v[0], v[1]),
                                         std::fabs(v[0] - v[1]),
                                         ma,
                                         static_cast<double>(ex),
                                         v[1] - std::trunc(v[1]),
                                         std::trunc(v[1]),
                                         std::sin(v[0]),
                                         std::exp2(v[1]),
                                         std::pow(std::fabs(v[0]), v[1]),
                                         std::atan2(v[0], v[1]),
                                         1 / std::sqrt(std::fabs(v[2]) + 1),
                                         v[1] / norm,
                                         v[0] * 0.75 + v[1] * 0.25,
                                         s * s * (3 - 2 * s),
                                         v[0] - std::floor(v[0]),
                                         v[0] > 0   ? 1.0
                                         : v[0] < 0 ? -1.0
                                                    : 0.0,
                                         v[1] < v[0] ? 0.0 : 1.0,
                                         std::fmin(std::fmax(v[0], -1.0), 1.0),
                                         -v[1],
                                         v[1] * v[3] - v[2] * v[2],
                                         det,
                                         v[0] - 0.75 * std::floor(v[0] / 0.75),
                                         v[0] * 0.017453292519943295,
                                         v[lane & 3]};
            for (size_t i = 0; i < 30; ++i) {
                const float got = r[lane * 30 + i];
                const double want = expected[i];
                if (std::isnan(want)) continue;
                EXPECT_EQ(valueOf(halfOf(got)), got) << "result " << i << " is no half";
                if (std::fabs(want) > 65504) continue;
                EXPECT_NEAR(got, want, std::fmax(std::fabs(want) * 0x1p-10, 0x1p-13))
                    << "lane " << lane << " result " << i;
            }
        }
    }
}

}  // namespace
}  // namespace vernier::test
