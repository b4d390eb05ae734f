// G and N: integer operations; NaN, infinities and denormals in shaders.
#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/robust_cases.h"
#include "conformance/hardcases/tessellation_cases.h"
#include "conformance/hardcases/value_input.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace vernier::conformance::hardcases {
namespace {

constexpr uint32_t kMostNegative = 0x80000000u;

std::vector<ValueRow> open(std::vector<std::array<uint32_t, 3>> inputs) {
    std::vector<ValueRow> rows;
    for (const auto& in : inputs) rows.push_back({in, anything()});
    return rows;
}

void g01(CaseInput& input) {
    const std::vector<std::array<uint32_t, 3>> inputs{{0, 0}, {1, 0}, {0xffffffffu, 0}, {kMostNegative, 0}};
    for (const char* expression : {"u(0) / u(1)", "u(0) % u(1)", "uint(i(0) / i(1))", "uint(i(0) % i(1))"}) {
        std::vector<ValueRow> rows = open(inputs);
        rows.push_back({{7, 7}, oneOf({std::string_view(expression).find('/') != std::string_view::npos ? 1u : 0u})});
        addValues(input, "G01", expression, std::move(rows));
    }
}

void g02(CaseInput& input) {
    for (const char* expression : {"uint(i(0) / i(1))", "uint(i(0) % i(1))"})
        addValues(input, "G02", expression, open({{kMostNegative, 0xffffffffu}}));
}

void g03(CaseInput& input) {
    for (const char* expression : {"u(0) << u(1)", "u(0) >> u(1)", "uint(i(0) >> i(1))"}) {
        addValues(input, "G03", expression,
                  open({{1, 32}, {5, 33}, {kMostNegative, 64}, {7, 0xffffffffu}, {7, kMostNegative}}));
    }
    addValues(input, "G03_inside", "u(0) << u(1)",
              {{{1, 31}, oneOf({kMostNegative})}, {{0xffffffffu, 0}, oneOf({0xffffffffu})}});
    addValues(input, "G03_arithmetic", "uint(i(0) >> i(1))", {{{kMostNegative, 31}, oneOf({0xffffffffu})}});
}

// Remainders of signed integers, whose GLSL form leaves negative operands open: SMod as the compiler writes it, and
// SRem in its place.
constexpr uint16_t kOpSRem = 138, kOpSMod = 139;

void replaceOpcode(std::vector<uint32_t>& words, uint16_t from, uint16_t to) {
    constexpr size_t kHeaderWords = 5;
    for (size_t at = kHeaderWords; at < words.size(); at += std::max(1u, words[at] >> 16)) {
        if ((words[at] & 0xffff) == from) words[at] = (words[at] & 0xffff0000u) | to;
    }
}

void g04(CaseInput& input) {
    const auto rows = [](bool modulo) {
        std::vector<ValueRow> result;
        for (const int32_t a : {7, -7, 8, -8, 1, -1, 0, INT32_MAX, INT32_MIN + 1}) {
            for (const int32_t b : {3, -3, 8, -8, 1, -1, INT32_MAX}) {
                int32_t rest = a % b;
                if (modulo && rest != 0 && (rest < 0) != (b < 0)) rest += b;
                const auto expected = static_cast<uint32_t>(rest);
                const bool defined = a >= 0 && b >= 0;
                result.push_back({{static_cast<uint32_t>(a), static_cast<uint32_t>(b)},
                                  [=](uint32_t got, const Declared&) -> Verdict {
                                      if (got == expected) return {};
                                      const std::string text =
                                          "exactly " + std::to_string(static_cast<int32_t>(expected));
                                      return defined ? Verdict::wrong(text)
                                                     : Verdict::allowed(text + "; poison before maintenance8");
                                  }});
            }
        }
        return result;
    };
    addValues(input, "G04_mod", "uint(i(0) % i(1))", rows(true));
    ValueShader remainder;
    remainder.edit = [](std::vector<uint32_t>& words) { replaceOpcode(words, kOpSMod, kOpSRem); };
    addValues(input, "G04_rem", "uint(i(0) % i(1))", rows(false), remainder);
}

void g05(CaseInput& input) {
    addValues(input, "G05_open", "bitfieldExtract(u(0), i(1), i(2))",
              open({{0xffffffffu, 20, 20}, {0xffffffffu, 32, 1}, {5, 0xffffffffu, 3}, {5, 3, 0xffffffffu}}));
    addValues(input, "G05_extract", "bitfieldExtract(u(0), i(1), i(2))",
              {{{0xabcd1234u, 8, 12}, oneOf({0xd12u})},
               {{0xabcd1234u, 0, 32}, oneOf({0xabcd1234u})},
               {{0xabcd1234u, 4, 0}, oneOf({0})}});
    addValues(input, "G05_signed", "uint(bitfieldExtract(i(0), i(1), i(2)))",
              {{{0x00000f00u, 8, 4}, oneOf({0xffffffffu})}, {{0x700u, 8, 4}, oneOf({7})}});
    addValues(input, "G05_insert", "bitfieldInsert(u(0), u(1), 8, i(2))",
              {{{0xffffffffu, 0, 12}, oneOf({0xfff000ffu})}, {{0x12345678u, 0xffu, 0}, oneOf({0x12345678u})}});
}

void g06(CaseInput& input) {
    addValues(
        input, "G06_msb", "uint(findMSB(u(0)))",
        {{{0}, oneOf({0xffffffffu})}, {{1}, oneOf({0})}, {{0xffffffffu}, oneOf({31})}, {{0x00800000u}, oneOf({23})}});
    addValues(input, "G06_msb_signed", "uint(findMSB(i(0)))",
              {{{0}, oneOf({0xffffffffu})},
               {{0xffffffffu}, oneOf({0xffffffffu})},
               {{kMostNegative}, oneOf({30})},
               {{0xfffffffeu}, oneOf({0})}});
    addValues(input, "G06_lsb", "uint(findLSB(u(0)))",
              {{{0}, oneOf({0xffffffffu})}, {{kMostNegative}, oneOf({31})}, {{12}, oneOf({2})}});
}

void g07(CaseInput& input) {
    std::vector<ValueRow> low, high, signedHigh, carry, borrow;
    for (const uint32_t a : {0u, 1u, 0xffffffffu, kMostNegative, 0x12345678u, 65537u}) {
        for (const uint32_t b : {0u, 1u, 0xffffffffu, kMostNegative, 0x9abcdef0u}) {
            const uint64_t product = uint64_t{a} * b;
            const int64_t signedProduct = int64_t{static_cast<int32_t>(a)} * static_cast<int32_t>(b);
            low.push_back({{a, b}, oneOf({static_cast<uint32_t>(product)})});
            high.push_back({{a, b}, oneOf({static_cast<uint32_t>(product >> 32)})});
            signedHigh.push_back({{a, b}, oneOf({static_cast<uint32_t>(static_cast<uint64_t>(signedProduct) >> 32)})});
            carry.push_back({{a, b}, oneOf({static_cast<uint32_t>((uint64_t{a} + b) >> 32)})});
            borrow.push_back({{a, b}, oneOf({a < b ? 1u : 0u})});
        }
    }
    const char* declarations =
        "uint high(uint a, uint b) { uint h, l; umulExtended(a, b, h, l); return h; }\n"
        "uint low(uint a, uint b) { uint h, l; umulExtended(a, b, h, l); return l; }\n"
        "uint signedHigh(int a, int b) { int h, l; imulExtended(a, b, h, l); return uint(h); }\n"
        "uint carry(uint a, uint b) { uint c; uaddCarry(a, b, c); return c; }\n"
        "uint borrow(uint a, uint b) { uint c; usubBorrow(a, b, c); return c; }\n";
    addValues(input, "G07_low", "low(u(0), u(1))", std::move(low), declarations);
    addValues(input, "G07_high", "high(u(0), u(1))", std::move(high), declarations);
    addValues(input, "G07_signed", "signedHigh(i(0), i(1))", std::move(signedHigh), declarations);
    addValues(input, "G07_carry", "carry(u(0), u(1))", std::move(carry), declarations);
    addValues(input, "G07_borrow", "borrow(u(0), u(1))", std::move(borrow), declarations);
}

// ---- N ----

constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

/// A NaN, or, as the specification permits without SignedZeroInfNanPreserve, anything.
ValueJudge bestNan() {
    return [](uint32_t bits, const Declared&) -> Verdict {
        return (bits & 0x7fffffffu) > 0x7f800000u
                   ? Verdict{}
                   : Verdict::allowed("not NaN; permitted without SignedZeroInfNanPreserve");
    };
}

void n01(CaseInput& input) {
    std::vector<ValueRow> rows;
    for (const uint32_t denormal : {1u, 0x00400000u, 0x807fffffu}) {
        rows.push_back({{denormal, bitsOf(1)}, oneOf({denormal, 0, kMostNegative})});
    }
    addValues(input, "N01", "floatBitsToUint(f(0) * f(1))", std::move(rows));
}

void n02(CaseInput& input) {
    for (const char* function : {"min", "max"}) {
        addValues(input, "N02", std::string("floatBitsToUint(") + function + "(f(0), f(1)))",
                  {{{bitsOf(3), bitsOf(kNan)}, oneOf({bitsOf(3), bitsOf(kNan)})},
                   {{bitsOf(kNan), bitsOf(3)}, oneOf({bitsOf(3), bitsOf(kNan)})}});
    }
    addValues(input, "N02_clamp", "floatBitsToUint(clamp(f(0), 1.0, 2.0))",
              {{{bitsOf(kNan)}, oneOf({bitsOf(1), bitsOf(2), bitsOf(kNan)})}});
}

void n03(CaseInput& input) {
    addValues(input, "N03_quotient", "floatBitsToUint(f(0) / f(1))", {{{bitsOf(0), bitsOf(0)}, bestNan()}});
    addValues(input, "N03_difference", "floatBitsToUint(f(0) - f(1))", {{{bitsOf(kInf), bitsOf(kInf)}, bestNan()}});
    addValues(input, "N03_product", "floatBitsToUint(f(0) * f(1))", {{{bitsOf(0), bitsOf(kInf)}, bestNan()}});
}

void n04(CaseInput& input) {
    const uint32_t minus = kMostNegative;
    addValues(input, "N04_sum", "floatBitsToUint(f(0) + f(1))",
              {{{minus, minus}, oneOf({minus, 0})}, {{minus, 0}, oneOf({0, minus})}});
    addValues(input, "N04_product", "floatBitsToUint(f(0) * f(1))",
              {{{minus, bitsOf(2)}, oneOf({minus, 0})}, {{bitsOf(-1), 0}, oneOf({minus, 0})}});
    addValues(input, "N04_negate", "floatBitsToUint(-f(0))", {{{0}, oneOf({minus, 0})}, {{minus}, oneOf({0, minus})}});
}

// Moves that are no arithmetic keep every bit.
void n05(CaseInput& input) {
    const std::vector<uint32_t> patterns{0x7fc00001u, 0x7f800001u, 0xffc12345u, 0x80000000u, 0x00000001u, 0xffffffffu};
    std::vector<ValueRow> copied, selected;
    for (const uint32_t bits : patterns) {
        copied.push_back({{bits}, oneOf({bits})});
        selected.push_back({{bits, 0, 1}, oneOf({bits, bits | 0x00400000u})});
    }
    addValues(input, "N05_copy", "u(0)", std::move(copied));
    addValues(input, "N05_select", "floatBitsToUint(u(2) == 1u ? f(0) : f(1))", std::move(selected));
}

void n06(CaseInput& input) {
    constexpr VkExtent2D kTarget{16, 16};
    SceneRecorder record("N06", "NaN written to UNORM.");
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
    const std::vector<float> nan{kNan};
    const uint32_t texture = record.texture("nan", VK_FORMAT_R32_SFLOAT, {1, 1}, {bytesOf(nan)});
    record.pass(kTarget).color(target, {1, 1, 1, 1});
    record
        .draw(record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D value;
layout(location = 0) out vec4 color;
void main() { color = vec4(texelFetch(value, ivec2(0), 0).r, 0.5, 0.25, 1.0); }
)")),
              3)
        .texture(0, texture, record.sampler(VK_FILTER_NEAREST));
    record.output(target);
    const size_t scene = input.scene(record.finish());
    judgePixels(input, scene, 0, kTarget, [](const PixelReader& pixels, const Declared&) -> Verdict {
        const uint64_t first = pixels.code(0, 0, 0);
        for (uint32_t i = 0; i < 256; ++i) {
            if (pixels.code(i % 16, i / 16, 0) != first)
                return Verdict::wrong(pixelText(i % 16, i / 16) + " differs from pixel (0, 0)");
            if (pixels.code(i % 16, i / 16, 2) != 64)
                return Verdict::wrong(pixelText(i % 16, i / 16) + ": the NaN disturbs another channel");
        }
        return first == 0 ? Verdict{}
                          : Verdict::allowed("NaN is stored as code " + std::to_string(first) + "; declared: 0");
    });
}

void n07(CaseInput& input) {
    const std::vector<std::array<uint32_t, 3>> inputs{{bitsOf(kNan)}, {bitsOf(kInf)}, {bitsOf(-kInf)},
                                                      {bitsOf(3e9f)}, {bitsOf(-1)},   {bitsOf(1e20f)}};
    addValues(input, "N07_int", "uint(int(f(0)))", open(inputs));
    addValues(input, "N07_uint", "uint(f(0))", open(inputs));
    addValues(input, "N07_inside", "uint(int(f(0)))",
              {{{bitsOf(-3.99f)}, oneOf({0xfffffffdu})}, {{bitsOf(2147483520.0f)}, oneOf({2147483520u})}});
}

// Atomic operations on a word of a row's own; the result is what the word holds afterwards.
void atomics(CaseInput& input, std::string_view name, const char* function, const char* extension,
             const std::vector<std::tuple<float, float, ValueJudge>>& operations) {
    ValueShader shader;
    shader.extensions = std::string("#extension ") + extension + " : require\n";
    shader.declarations = "layout(std430, binding = 1) buffer Data { float data[]; };\nuint after(float v) { " +
                          std::string(function) + "(data[row()], v); return floatBitsToUint(data[row()]); }\n";
    std::vector<ValueRow> rows;
    for (const auto& [stored, operand, judge] : operations) {
        rows.push_back({{bitsOf(operand)}, judge});
        shader.data.push_back(bitsOf(stored));
    }
    addValues(input, name, "after(f(0))", std::move(rows), shader);
}

void n08(CaseInput& input) {
    const uint32_t minus = kMostNegative;
    const ValueJudge nan = [](uint32_t bits, const Declared&) -> Verdict {
        return (bits & 0x7fffffffu) > 0x7f800000u ? Verdict{} : Verdict::wrong("exactly NaN");
    };
    const char* const first = "GL_EXT_shader_atomic_float";
    const char* const second = "GL_EXT_shader_atomic_float2";
    atomics(input, "N08_add", "atomicAdd", first,
            {{1.0f, 2.5f, oneOf({bitsOf(3.5f)})},
             {1.0f, kNan, nan},
             {kInf, -kInf, nan},
             {-0.0f, -0.0f, oneOf({minus, 0})},
             {0.0f, -0.0f, oneOf({0, minus})},
             {kInf, 1.0f, oneOf({bitsOf(kInf)})}});
    atomics(input, "N08_exchange", "atomicExchange", first,
            {{1.0f, -0.0f, oneOf({minus})}, {1.0f, kNan, nan}, {kNan, 2.0f, oneOf({bitsOf(2.0f)})}});
    const auto either = [](float best, float other) { return oneOf({bitsOf(best), bitsOf(other)}); };
    // They compare equal. Ours: the operand.
    const auto zero = [](float best, float operand) { return oneOf({bitsOf(best), bitsOf(-best)}, bitsOf(operand)); };
    atomics(input, "N08_min", "atomicMin", second,
            {{2.0f, 1.0f, oneOf({bitsOf(1.0f)})},
             {1.0f, kNan, either(1.0f, kNan)},
             {kNan, 1.0f, either(1.0f, kNan)},
             {0.0f, -0.0f, zero(-0.0f, -0.0f)},
             {-0.0f, 0.0f, zero(-0.0f, 0.0f)},
             {kInf, -kInf, oneOf({bitsOf(-kInf)})}});
    atomics(input, "N08_max", "atomicMax", second,
            {{2.0f, 1.0f, oneOf({bitsOf(2.0f)})},
             {1.0f, kNan, either(1.0f, kNan)},
             {kNan, 1.0f, either(1.0f, kNan)},
             {0.0f, -0.0f, zero(0.0f, -0.0f)},
             {-kInf, kInf, oneOf({bitsOf(kInf)})}});
}

constexpr std::string_view kSpirv = "SPIR-V specification, the instruction";
constexpr std::string_view kControls = "Vulkan, Floating-Point Computation; SPIR-V float controls";

const std::vector<HardCase> kIntegers{
    {"G01", "Division and remainder by 0", "Undefined, but no trap.", kSpirv, g01},
    {"G02", "The most negative integer divided by -1", "Undefined, but no trap.", kSpirv, g02},
    {"G03", "Shifts by the width, beyond it, and by negative counts",
     "Undefined, but no crash; exact inside the width.", kSpirv, g03},
    {"G04", "SRem and SMod of negative operands",
     "The sign of the first operand, of the second; poison before maintenance8.",
     "SPIR-V, OpSRem and OpSMod; VK_KHR_maintenance8", g04},
    {"G05", "bitfieldExtract and bitfieldInsert beyond the width and with count 0",
     "Count 0: 0 or unchanged; beyond: undefined.", kSpirv, g05},
    {"G06", "findMSB and findLSB of 0, -1 and the ends", "-1 where there is no bit.", kSpirv, g06},
    {"G07", "Extended products, carries and borrows", "Exact.", kSpirv, g07},
    {"G08", "Buffer indices whose byte offsets wrap around 32 bits",
     "Robust: 0 or a value of the buffer; no access outside.", "Vulkan, Robust Buffer Access", g08},
};

const std::vector<HardCase> kSpecials{
    {"N01", "Denormals through a multiplication by 1", "Kept or flushed without a float control.", kControls, n01},
    {"N02", "min, max and clamp with a NaN", "Either operand.", kSpirv, n02},
    {"N03", "0/0, Inf - Inf, 0 Inf", "NaN where it is preserved; otherwise nothing is asked.", kControls, n03},
    {"N04", "-0 through sums, products and negation", "Kept where signed zeros are preserved.", kControls, n04},
    {"N05", "NaN payloads through copies and selects", "Copies keep every bit; NaNs may be quietened by the rest.",
     kControls, n05},
    {"N06", "NaN written to UNORM", "Unspecified, the same everywhere. Declared: 0.",
     "Vulkan, Conversion From Floating-Point to Normalized Fixed-Point", n06},
    {"N07", "Floats out of range to integers", "Undefined, but no crash; exact inside the range.", kSpirv, n07},
    {"N08",
     "Atomic addition, exchange, minimum and maximum of floats with NaN and -0",
     "As the operation; a minimum with NaN may be either operand.",
     "VK_EXT_shader_atomic_float and _float2",
     n08,
     {},
     {{"lavapipe", "its CI lists failures and crashes of atomics with NaN"}}},
    {"N09", "Tessellation levels that are NaN, 0, -0, negative, infinite and denormal",
     "An outer level that counts and is NaN or not above 0 discards the patch; inner ones are clamped.",
     "Vulkan, Tessellator Patch Discard", n09},
};

}  // namespace

std::span<const HardCase> integerCases() {
    return kIntegers;
}

std::span<const HardCase> specialValueCases() {
    return kSpecials;
}

}  // namespace vernier::conformance::hardcases
