// Integers of 8 and 16 bits against C++: every pair of bytes, and many pairs of 16-bit numbers.
#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <random>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/shader_run.h"

namespace vernier::test {
namespace {

constexpr const char* kExtensions =
    "#extension GL_EXT_shader_explicit_arithmetic_types : require\n"
    "#extension GL_EXT_shader_8bit_storage : require\n#extension GL_EXT_shader_16bit_storage : require\n";

/// An operation in GLSL on S x, S y (signed) and U u, U v (unsigned, the same bits), and what it gives, as bits.
/// Divisions are only looked at where they are defined.
template <class S, class U>
struct Case {
    const char* glsl;
    std::function<U(S, S, U, U)> expected;
    bool divides = false;
};

template <class S, class U>
std::vector<Case<S, U>> cases() {
    constexpr int kBits = sizeof(S) * 8;
    const auto u = [](auto value) { return static_cast<U>(value); };
    return {
        {"U(x + y)", [=](S x, S y, U, U) { return u(x + y); }},
        {"u - v", [=](S, S, U a, U b) { return u(a - b); }},
        {"U(x * y)", [=](S x, S y, U, U) { return u(x * y); }},
        {"U(-x)", [=](S x, S, U, U) { return u(-x); }},
        {"~u", [=](S, S, U a, U) { return u(~a); }},
        {"U(x / y)", [=](S x, S y, U, U) { return u(x / y); }, true},
        {"u / v", [=](S, S, U a, U b) { return u(a / b); }, true},
        {"u % v", [=](S, S, U a, U b) { return u(a % b); }, true},
        {"u << (v % U(BITS))", [=](S, S, U a, U b) { return u(a << (b % kBits)); }},
        {"u >> (v % U(BITS))", [=](S, S, U a, U b) { return u(a >> (b % kBits)); }},
        {"U(x >> (v % U(BITS)))", [=](S x, S, U, U b) { return u(x >> (b % kBits)); }},
        {"u & v", [=](S, S, U a, U b) { return u(a & b); }},
        {"u | v", [=](S, S, U a, U b) { return u(a | b); }},
        {"u ^ v", [=](S, S, U a, U b) { return u(a ^ b); }},
        {"U(min(x, y))", [=](S x, S y, U, U) { return u(std::min(x, y)); }},
        {"U(max(x, y))", [=](S x, S y, U, U) { return u(std::max(x, y)); }},
        {"min(u, v)", [=](S, S, U a, U b) { return std::min(a, b); }},
        {"max(u, v)", [=](S, S, U a, U b) { return std::max(a, b); }},
        {"U(abs(x))", [=](S x, S, U, U) { return u(x < 0 ? -x : x); }},
        {"U(sign(x))", [=](S x, S, U, U) { return u(x > 0   ? 1
                                                    : x < 0 ? -1
                                                            : 0); }},
        {"U(clamp(x, S(-5), S(7)))", [=](S x, S, U, U) { return u(x < -5  ? -5
                                                                  : x > 7 ? 7
                                                                          : x); }},
        {"clamp(u, U(5), U(200))", [=](S, S, U a, U) { return u(a < 5     ? 5
                                                                : a > 200 ? 200
                                                                          : a); }},
        {"U(x < y)", [=](S x, S y, U, U) { return u(x < y); }},
        {"U(x >= y)", [=](S x, S y, U, U) { return u(x >= y); }},
        {"U(u < v)", [=](S, S, U a, U b) { return u(a < b); }},
        {"U(u == v)", [=](S, S, U a, U b) { return u(a == b); }},
        {"x < y ? u : v", [=](S x, S y, U a, U b) { return x < y ? a : b; }},
        // Conversions to other types and back.
        {"U(int(x) >> 3)", [=](S x, S, U, U) { return u(static_cast<int>(x) >> 3); }},
        {"U(uint(u) * 3u)", [=](S, S, U a, U) { return u(a * 3u); }},
        {"U(int64_t(x) * int64_t(y) >> 5)",
         [=](S x, S y, U, U) { return u(static_cast<int64_t>(x) * static_cast<int64_t>(y) >> 5); }},
        {"U(uint64_t(u) >> 2)", [=](S, S, U a, U) { return u(static_cast<uint64_t>(a) >> 2); }},
        {"U(uint(x) >> 9)", [=](S x, S, U, U) { return u(static_cast<uint32_t>(x) >> 9); }},
        {"U(int(float(x) * 0.5))", [=](S x, S, U, U) { return u(static_cast<int>(static_cast<float>(x) * 0.5f)); }},
        {"U(float(u) * 0.25)", [=](S, S, U a, U) { return u(static_cast<float>(a) * 0.25f); }},
        {"U(S(float(x) * 0.5))", [=](S x, S, U, U) { return u(static_cast<S>(static_cast<float>(x) * 0.5f)); }},
        {"U(S(double(x) * 0.5))", [=](S x, S, U, U) { return u(static_cast<S>(x * 0.5)); }},
        {"U(u8vec2(uint8_t(u), uint8_t(v)).y)", [=](S, S, U, U b) { return u(static_cast<uint8_t>(b)); }},
        {"U(int16_t(x) + int16_t(y))", [=](S x, S y, U, U) { return u(static_cast<int16_t>(x + y)); }},
        {"U(int(int8_t(x)) + 1)", [=](S x, S, U, U) { return u(static_cast<int8_t>(x) + 1); }},
        {"U(bool(u & v))", [=](S, S, U a, U b) { return u((a & b) != 0); }},
    };
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

template <class S, class U>
void check(const char* signedName, const char* unsignedName, const std::vector<U>& a, const std::vector<U>& b) {
    const auto all = cases<S, U>();
    ASSERT_EQ(a.size() % 64, 0u);
    const auto perLane = static_cast<uint32_t>(a.size() / 64);
    std::string globals = "#define S " + std::string(signedName) + "\n#define U " + unsignedName +
                          "\nlayout(binding=0) buffer A { U a[]; }; layout(binding=1) buffer B { U b[]; };"
                          "layout(binding=2) buffer R { U r[]; };";
    std::string body = "for (int i = 0; i < " + std::to_string(perLane) + "; ++i) { int k = lane * " +
                       std::to_string(perLane) + " + i; U u = a[k], v = b[k]; S x = S(u), y = S(v);\n";
    for (size_t c = 0; c < all.size(); ++c) {
        body += "r[k + " + std::to_string(c * a.size()) + "] = U(" +
                replaced(all[c].glsl, "BITS", std::to_string(sizeof(S) * 8)) + ");\n";
    }
    ShaderRun shader;
    shader.words = laneShader(kExtensions, globals, body + "}");
    shader.buffers[0] = bytesOf(a);
    shader.buffers[1] = bytesOf(b);
    for (const Isa isa : isas()) {
        shader.buffers[2] = bytesOf(std::vector<U>(a.size() * all.size()));
        ASSERT_TRUE(shader.run(isa));
        const std::vector<U> result = valuesOf<U>(shader.buffers[2]);
        for (size_t c = 0; c < all.size(); ++c) {
            uint32_t failures = 0;
            for (size_t k = 0; k < a.size() && failures < 3; ++k) {
                const auto x = static_cast<S>(a[k]), y = static_cast<S>(b[k]);
                if (all[c].divides && y == 0) continue;
                const U expected = all[c].expected(x, y, a[k], b[k]);
                if (expected == result[c * a.size() + k]) continue;
                ++failures;
                ADD_FAILURE() << all[c].glsl << " of " << +a[k] << ", " << +b[k] << " is " << +result[c * a.size() + k]
                              << " instead of " << +expected;
            }
        }
    }
}

TEST(NarrowIntegers, EveryPairOfBytes) {
    std::vector<uint8_t> a, b;
    for (uint32_t k = 0; k < 65536; ++k) {
        a.push_back(static_cast<uint8_t>(k));
        b.push_back(static_cast<uint8_t>(k >> 8));
    }
    check<int8_t, uint8_t>("int8_t", "uint8_t", a, b);
}

TEST(NarrowIntegers, SixteenBits) {
    std::mt19937 random(5);
    const uint16_t special[] = {0,      1,      2,      0x7F,   0x80,   0xFF,   0x100,
                                0x7FFE, 0x7FFF, 0x8000, 0x8001, 0xFFFE, 0xFFFF, 0x1234};
    std::vector<uint16_t> a, b;
    for (const uint16_t x : special) {
        for (const uint16_t y : special) a.push_back(x), b.push_back(y);
    }
    while (a.size() < 8192) {
        a.push_back(static_cast<uint16_t>(random()));
        b.push_back(static_cast<uint16_t>(random() >> random() % 16));
    }
    check<int16_t, uint16_t>("int16_t", "uint16_t", a, b);
}

TEST(NarrowIntegers, PackAndUnpack) {
    ShaderRun shader;
    shader.words = laneShader(kExtensions,
                              "layout(binding=0) buffer A { uint a[]; }; layout(binding=1) buffer R { uint r[]; };"
                              "layout(binding=2) buffer W { uint64_t w[]; };",
                              R"(
uint x = a[lane];
u8vec4 bytes = unpack8(x);
u16vec2 shorts = unpack16(x);
r[lane * 4] = pack32(bytes.wzyx);
r[lane * 4 + 1] = pack32(shorts.yx);
r[lane * 4 + 2] = pack32(u16vec2(pack16(bytes.zw), pack16(bytes.xy)));
uint64_t wide = packUint2x32(uvec2(x, ~x));
u16vec4 four = unpack16(wide);
w[lane] = pack64(four.wzyx);
r[lane * 4 + 3] = uint(unpack8(four.y).y) | uint(int(int8_t(bytes.x))) << 8;
)");
    std::mt19937 random(9);
    std::vector<uint32_t> a(64);
    for (uint32_t& x : a) x = static_cast<uint32_t>(random());
    for (const Isa isa : isas()) {
        shader.buffers[0] = bytesOf(a);
        shader.buffers[1] = Bytes(64 * 16);
        shader.buffers[2] = Bytes(64 * 8);
        ASSERT_TRUE(shader.run(isa));
        const auto r = valuesOf<uint32_t>(shader.buffers[1]);
        const auto w = valuesOf<uint64_t>(shader.buffers[2]);
        for (uint32_t lane = 0; lane < 64; ++lane) {
            const uint32_t x = a[lane];
            EXPECT_EQ(r[lane * 4], __builtin_bswap32(x));
            EXPECT_EQ(r[lane * 4 + 1], std::rotl(x, 16));
            EXPECT_EQ(r[lane * 4 + 2], std::rotl(x, 16));
            const auto signedByte = static_cast<uint32_t>(static_cast<int8_t>(x));
            EXPECT_EQ(r[lane * 4 + 3], (x >> 24) | signedByte << 8);
            const uint32_t y = std::rotl(x, 16);
            EXPECT_EQ(w[lane], static_cast<uint64_t>(y) << 32 | static_cast<uint32_t>(~y));
        }
    }
}

TEST(NarrowIntegers, ConstantsAndSpecialisation) {
    ShaderRun shader;
    shader.words =
        laneShader(kExtensions,
                   "layout(constant_id=1) const int8_t k8 = int8_t(-3);\n"
                   "layout(constant_id=2) const uint16_t k16 = uint16_t(65535);\n"
                   "layout(binding=0) buffer R { int r[]; };"
                   "const int8_t table[4] = int8_t[](int8_t(-128), int8_t(127), int8_t(-1), int8_t(5));",
                   // Before SPIR-V 1.4, conversions of specialisation constants are not operations on constants.
                   "int8_t c8 = k8; uint16_t c16 = k16; r[lane * 4] = int(c8);"
                   "r[lane * 4 + 1] = int(c16) + int(uint16_t(c16 + uint16_t(2)));"
                   "r[lane * 4 + 2] = int(table[lane & 3]); r[lane * 4 + 3] = int(int8_t(c8 * int8_t(50)));");
    for (const Isa isa : isas()) {
        for (const bool specialised : {false, true}) {
            const int8_t eight = 100;
            const uint16_t sixteen = 40000;
            std::array<std::byte, 4> data{};
            std::memcpy(data.data(), &eight, 1);
            std::memcpy(data.data() + 2, &sixteen, 2);
            const Specialization::Entry entries[] = {{1, 0, 1}, {2, 2, 2}};
            shader.specialization = specialised ? Specialization{entries, data} : Specialization{};
            shader.buffers[0] = Bytes(64 * 16);
            ASSERT_TRUE(shader.run(isa));
            const auto r = valuesOf<int32_t>(shader.buffers[0]);
            const int table[] = {-128, 127, -1, 5};
            for (int lane = 0; lane < 64; ++lane) {
                EXPECT_EQ(r[lane * 4], specialised ? 100 : -3);
                EXPECT_EQ(r[lane * 4 + 1], specialised ? 40000 + 40002 : 65535 + 1);
                EXPECT_EQ(r[lane * 4 + 2], table[lane & 3]);
                EXPECT_EQ(r[lane * 4 + 3], specialised ? static_cast<int8_t>(5000) : static_cast<int8_t>(-150));
            }
        }
    }
}

// Bytes and halfwords are stored alone: their neighbours keep what they had, and the last ones of a buffer can be
// reached.
TEST(NarrowIntegers, StorageLeavesNeighboursAlone) {
    ShaderRun shader;
    shader.words =
        laneShader(kExtensions,
                   "layout(binding=0) buffer A { uint8_t a[]; }; layout(binding=1) buffer B { uint16_t b[]; };"
                   "layout(push_constant) uniform P { uint8_t p0; int16_t p1; uint8_t p2[3]; };"
                   "layout(binding=2, std140) uniform Q { uint8_t q0; u8vec3 q1; uint16_t q2; };",
                   "a[lane * 3] = uint8_t(lane + int(p0)); b[lane * 2 + 1] = uint16_t(lane * 1000 + int(p1));"
                   "if (lane == 5) { a[190] = p2[2]; b[126] = q2; a[0] = q1.z; b[1000] = uint16_t(7); }"
                   "if (lane == 6) b[124] = uint16_t(a[500] + a[200]) + uint16_t(b.length());");
    std::vector<std::byte> uniform(8, std::byte{0});
    uniform[6] = std::byte{77};
    const uint16_t q2 = 4321;
    uniform.resize(12);
    std::memcpy(uniform.data() + 8, &q2, 2);
    for (const Isa isa : isas()) {
        shader.buffers[0] = Bytes(192, std::byte{0xEE});
        shader.buffers[1] = bytesOf(std::vector<uint16_t>(128, 0xABCD));
        shader.buffers[2] = uniform;
        shader.push = {std::byte{9},    std::byte{0}, std::byte{0xFE}, std::byte{0xFF},
                       std::byte{0x11}, std::byte{2}, std::byte{0xC3}, std::byte{0}};
        ASSERT_TRUE(shader.run(isa));
        std::vector<uint8_t> a(192, 0xEE);
        std::vector<uint16_t> b(128, 0xABCD);
        for (uint32_t lane = 0; lane < 64; ++lane) {
            a[lane * 3] = static_cast<uint8_t>(lane + 9);
            b[lane * 2 + 1] = static_cast<uint16_t>(lane * 1000 - 2);
        }
        a[190] = 0xC3;
        a[0] = 77;
        b[126] = 4321;
        b[124] = 128;
        EXPECT_EQ(valuesOf<uint8_t>(shader.buffers[0]), a);
        EXPECT_EQ(valuesOf<uint16_t>(shader.buffers[1]), b);
    }
}

TEST(NarrowIntegers, InputsAndOutputs) {
    ShaderRun shader;
    shader.words = laneShader(
        kExtensions,
        "layout(location=1) flat in i16vec2 i; layout(location=2) in f16vec2 f;"
        "layout(location=0) out i16vec2 o; layout(location=1) out f16vec2 g; layout(location=2) out uint16_t w;",
        "o = i16vec2(i.x + int16_t(lane), -i.y); g = f * float16_t(2.0); w = uint16_t(i.x);");
    for (uint32_t lane = 0; lane < 64; ++lane) {
        shader.inputs[4].push_back(static_cast<uint32_t>(-5));
        shader.inputs[5].push_back(lane);
        shader.inputs[8].push_back(std::bit_cast<uint32_t>(1.0f + static_cast<float>(lane) * 0x1p-13f));
        shader.inputs[9].push_back(std::bit_cast<uint32_t>(0.5f));
    }
    for (const Isa isa : isas()) {
        ASSERT_TRUE(shader.run(isa));
        for (uint32_t lane = 0; lane < 64; ++lane) {
            EXPECT_EQ(static_cast<int32_t>(shader.output(0, lane)), static_cast<int32_t>(lane) - 5);
            EXPECT_EQ(static_cast<int32_t>(shader.output(1, lane)), -static_cast<int32_t>(lane));
            EXPECT_EQ(shader.output(8, lane), 65531u);
            // To the nearest half first: units of 2^-10, eight lanes each, ties to even.
            const float half = 1.0f + std::nearbyint(static_cast<float>(lane) / 8.0f) * 0x1p-10f;
            EXPECT_EQ(std::bit_cast<float>(shader.output(4, lane)), 2.0f * half) << lane;
        }
    }
}

}  // namespace
}  // namespace vernier::test
