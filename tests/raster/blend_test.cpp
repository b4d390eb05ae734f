// Blending, write masks and logic operations against a model in double.
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

using Color = std::array<float, 4>;

class Blend : public testing::Test {
  protected:
    /// Draws one full-screen triangle per colour, in order, over `clear`, and returns pixel (1, 1).
    VkClearColorValue draw(VkFormat format, const VkClearColorValue& clear, const std::vector<Color>& colors,
                           const std::function<void(GraphicsState&)>& change, const Color& constants = {},
                           const std::string& fragment = "color_frag", std::byte* texel = nullptr) {
        PipelineOptions options;
        options.fragment = fragment;
        options.state = plainState(format);
        options.state.blend[0].blendEnable = VK_TRUE;
        change(options.state);
        DynamicState dynamic = dynamicFor(4, 4);
        dynamic.blendConstants = constants;
        Surface surface(format, 4, 4);
        VkClearValue value{};
        value.color = clear;
        Pass pass(pool_, {surface.cleared(value)}, {}, 4, 4);
        const auto pipeline = makePipeline(options);
        pass.begin();
        for (const Color& c : colors)
            pass.draw(pipeline, dynamic, {at(-9, -9, 4, 4, c), at(50, -9, 4, 4, c), at(-9, 50, 4, 4, c)});
        pass.end();
        statistics_ = pass.pass().statistics();
        if (texel != nullptr) std::memcpy(texel, surface.texel(1, 1), findFormat(format)->bytesPerTexel);
        return surface.color(1, 1);
    }
    ThreadPool pool_{1};
    PassStatistics statistics_;
};

VkClearColorValue floats(const Color& c) {
    return {{c[0], c[1], c[2], c[3]}};
}

void sourceOver(GraphicsState& state) {
    auto& b = state.blend[0];
    b.srcColorBlendFactor = b.srcAlphaBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    b.dstColorBlendFactor = b.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
}

double factorModel(VkBlendFactor f, const double* s, const double* s1, const double* d, const double* k, int c) {
    switch (f) {
        case VK_BLEND_FACTOR_ZERO:
            return 0;
        case VK_BLEND_FACTOR_ONE:
            return 1;
        case VK_BLEND_FACTOR_SRC_COLOR:
            return s[c];
        case VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR:
            return 1 - s[c];
        case VK_BLEND_FACTOR_DST_COLOR:
            return d[c];
        case VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR:
            return 1 - d[c];
        case VK_BLEND_FACTOR_SRC_ALPHA:
            return s[3];
        case VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA:
            return 1 - s[3];
        case VK_BLEND_FACTOR_DST_ALPHA:
            return d[3];
        case VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA:
            return 1 - d[3];
        case VK_BLEND_FACTOR_CONSTANT_COLOR:
            return k[c];
        case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR:
            return 1 - k[c];
        case VK_BLEND_FACTOR_CONSTANT_ALPHA:
            return k[3];
        case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA:
            return 1 - k[3];
        case VK_BLEND_FACTOR_SRC_ALPHA_SATURATE:
            return c == 3 ? 1 : std::min(s[3], 1 - d[3]);
        case VK_BLEND_FACTOR_SRC1_COLOR:
            return s1[c];
        case VK_BLEND_FACTOR_ONE_MINUS_SRC1_COLOR:
            return 1 - s1[c];
        case VK_BLEND_FACTOR_SRC1_ALPHA:
            return s1[3];
        default:
            return 1 - s1[3];
    }
}

double opModel(VkBlendOp op, double s, double fs, double d, double fd) {
    switch (op) {
        case VK_BLEND_OP_ADD:
            return s * fs + d * fd;
        case VK_BLEND_OP_SUBTRACT:
            return s * fs - d * fd;
        case VK_BLEND_OP_REVERSE_SUBTRACT:
            return d * fd - s * fs;
        case VK_BLEND_OP_MIN:
            return std::min(s, d);
        default:
            return std::max(s, d);
    }
}

TEST_F(Blend, AllFactorsAndOperations) {
    const Color source{0.213f, 0.557f, 0.871f, 0.347f}, destination{0.8f, 0.1f, 0.45f, 0.6f},
        constants{0.317f, 0.713f, 0.159f, 0.853f};
    for (const VkFormat format :
         {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT,
          VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_A2B10G10R10_UNORM_PACK32}) {
        const FormatInfo& info = *findFormat(format);
        for (uint32_t factor = 0; factor <= VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA; ++factor) {
            const bool dual = factor >= VK_BLEND_FACTOR_SRC1_COLOR;
            for (uint32_t op = 0; op <= VK_BLEND_OP_MAX; ++op) {
                const auto f = static_cast<VkBlendFactor>(factor),
                           g = static_cast<VkBlendFactor>((factor * 7 + 3) % 15);
                const auto got = draw(
                    format, floats(destination), {source},
                    [&](GraphicsState& s) {
                        auto& b = s.blend[0];
                        b.srcColorBlendFactor = f;
                        b.dstColorBlendFactor = g;
                        b.srcAlphaBlendFactor = g;
                        b.dstAlphaBlendFactor = f;
                        b.colorBlendOp = static_cast<VkBlendOp>(op);
                        b.alphaBlendOp = static_cast<VkBlendOp>(4 - op);
                    },
                    constants, dual ? "dual_frag" : "color_frag");
                std::byte stored[16];
                packTexel(info.color, floats(destination), stored);
                const VkClearColorValue d0 = unpackTexel(info.color, stored);
                double s[4], s1[4] = {0.25, 0.5, 0.75, 1}, d[4], k[4];
                for (int c = 0; c < 4; ++c) {
                    s[c] = double{source[static_cast<size_t>(c)]};
                    d[c] = double{d0.float32[c]};
                    k[c] = double{constants[static_cast<size_t>(c)]};
                }
                Color expected;
                for (int c = 0; c < 4; ++c) {
                    const double fs = factorModel(c < 3 ? f : g, s, s1, d, k, c),
                                 fd = factorModel(c < 3 ? g : f, s, s1, d, k, c);
                    expected[static_cast<size_t>(c)] =
                        static_cast<float>(opModel(static_cast<VkBlendOp>(c < 3 ? op : 4 - op), s[c], fs, d[c], fd));
                }
                packTexel(info.color, floats(expected), stored);
                const VkClearColorValue want = unpackTexel(info.color, stored);
                for (int c = 0; c < 4; ++c)
                    ASSERT_NEAR(got.float32[c], want.float32[c], 2e-7)
                        << info.name << " factor " << factor << " op " << op << " component " << c;
            }
        }
    }
}

TEST_F(Blend, OpaqueAndTransparentAreExactForAllPairs) {
    // 256 destinations in a row of pixels against 16 sources at a time would do; one pixel per pair is
    // exhaustive enough.
    PipelineOptions options;
    options.state = plainState(VK_FORMAT_R8G8B8A8_UNORM);
    options.state.blend[0].blendEnable = VK_TRUE;
    sourceOver(options.state);
    const auto pipeline = makePipeline(options);
    for (const float alpha : {0.0f, 1.0f}) {
        Surface surface(VK_FORMAT_R8G8B8A8_UNORM, 256, 256);
        for (uint32_t y = 0; y < 256; ++y)
            for (uint32_t x = 0; x < 256; ++x) std::memset(surface.texel(x, y), static_cast<int>(x), 4);
        Pass pass(pool_, {surface.target()}, {}, 256, 256);
        pass.begin();
        for (uint32_t y = 0; y < 256; ++y) {
            const float v = static_cast<float>(y) / 255;
            const Color c{v, v, v, alpha};
            pass.draw(pipeline, dynamicFor(256, 256),
                      {at(0, y, 256, 256, c), at(256, y, 256, 256, c), at(0, y + 1, 256, 256, c),
                       at(256, y, 256, 256, c), at(256, y + 1, 256, 256, c), at(0, y + 1, 256, 256, c)});
        }
        pass.end();
        for (uint32_t y = 0; y < 256; ++y) {
            for (uint32_t x = 0; x < 256; ++x) {
                const auto* texel = reinterpret_cast<const uint8_t*>(surface.texel(x, y));
                ASSERT_EQ(texel[0], alpha == 0 ? x : y) << x << "," << y;
            }
        }
    }
}

TEST_F(Blend, TwoHundredFiftyFiveAdditions) {
    const std::vector<Color> steps(255, Color{1.0f / 255, 1.0f / 255, 1.0f / 255, 1.0f / 255});
    std::byte texel[4];
    draw(VK_FORMAT_R8G8B8A8_UNORM, {}, steps, setAdditive, {}, "color_frag", texel);
    for (const std::byte b : texel) EXPECT_EQ(static_cast<int>(b), 255);
}

TEST_F(Blend, FixedPointClampsFloatDoesNot) {
    const auto additive = [](GraphicsState& s) { setAdditive(s); };
    EXPECT_EQ(draw(VK_FORMAT_R8G8B8A8_UNORM, floats({0.5f, 0.5f, 0.5f, 0.5f}), {{-3, 4, 0, 0}}, additive).float32[0],
              128.0f / 255);
    EXPECT_EQ(
        draw(VK_FORMAT_R32G32B32A32_SFLOAT, floats({0.5f, 0.5f, 0.5f, 0.5f}), {{-3, 4, 0, 0}}, additive).float32[0],
        -2.5f);
    const auto subtract = [](GraphicsState& s) {
        setAdditive(s);
        s.blend[0].colorBlendOp = VK_BLEND_OP_SUBTRACT;
    };
    EXPECT_EQ(draw(VK_FORMAT_R8G8B8A8_UNORM, floats({0.5f, 0.5f, 0.5f, 0.5f}), {{0.25f, 0, 0, 0}}, subtract).float32[0],
              0);
    EXPECT_EQ(
        draw(VK_FORMAT_R16G16B16A16_SFLOAT, floats({0.5f, 0.5f, 0.5f, 0.5f}), {{0.25f, 0, 0, 0}}, subtract).float32[0],
        -0.25f);
}

TEST_F(Blend, AbsentDestinationAlphaIsOne) {
    const auto got = draw(VK_FORMAT_R8G8_UNORM, floats({1, 0.4f, 0, 0}), {{1, 1, 1, 1}}, [](GraphicsState& s) {
        s.blend[0].srcColorBlendFactor = VK_BLEND_FACTOR_DST_ALPHA;
        s.blend[0].dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA;
    });
    EXPECT_EQ(got.float32[1], 1);
}

TEST_F(Blend, WriteMasksKeepBits) {
    for (uint32_t mask = 0; mask < 16; ++mask) {
        for (const VkFormat format :
             {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R5G6B5_UNORM_PACK16, VK_FORMAT_R32G32B32A32_SFLOAT}) {
            const FormatInfo& info = *findFormat(format);
            const auto got = draw(format, floats({0, 0, 0, 0}), {{1, 1, 1, 1}}, [&](GraphicsState& s) {
                s.blend[0].blendEnable = VK_FALSE;
                s.blend[0].colorWriteMask = mask;
            });
            for (uint32_t c = 0; c < info.componentCount; ++c)
                EXPECT_EQ(got.float32[c], (mask >> c & 1) != 0 ? 1.0f : 0.0f);
        }
    }
}

TEST_F(Blend, LogicOperationsOnStoredBits) {
    for (uint32_t op = 0; op < 16; ++op) {
        std::byte texel[4];
        draw(
            VK_FORMAT_R8G8B8A8_UNORM, floats({0xCC / 255.0f, 0xAA / 255.0f, 1, 0}),
            {{0xF0 / 255.0f, 0x99 / 255.0f, 0, 1}},
            [&](GraphicsState& s) {
                s.logicOpEnable = true;
                s.logicOp = static_cast<VkLogicOp>(op);
            },
            {}, "color_frag", texel);
        const auto model = [&](uint32_t s, uint32_t d) -> uint32_t {
            switch (op) {
                case VK_LOGIC_OP_CLEAR:
                    return 0;
                case VK_LOGIC_OP_AND:
                    return s & d;
                case VK_LOGIC_OP_AND_REVERSE:
                    return s & ~d;
                case VK_LOGIC_OP_COPY:
                    return s;
                case VK_LOGIC_OP_AND_INVERTED:
                    return ~s & d;
                case VK_LOGIC_OP_NO_OP:
                    return d;
                case VK_LOGIC_OP_XOR:
                    return s ^ d;
                case VK_LOGIC_OP_OR:
                    return s | d;
                case VK_LOGIC_OP_NOR:
                    return ~(s | d);
                case VK_LOGIC_OP_EQUIVALENT:
                    return ~(s ^ d);
                case VK_LOGIC_OP_INVERT:
                    return ~d;
                case VK_LOGIC_OP_OR_REVERSE:
                    return s | ~d;
                case VK_LOGIC_OP_COPY_INVERTED:
                    return ~s;
                case VK_LOGIC_OP_OR_INVERTED:
                    return ~s | d;
                case VK_LOGIC_OP_NAND:
                    return ~(s & d);
                default:
                    return ~0u;
            }
        };
        EXPECT_EQ(static_cast<uint32_t>(texel[0]), model(0xF0, 0xCC) & 255) << op;
        EXPECT_EQ(static_cast<uint32_t>(texel[1]), model(0x99, 0xAA) & 255) << op;
    }
}

TEST_F(Blend, LaterPrimitivesOverEarlierOnes) {
    // 50 transparent layers in one draw and one batch after the other: the order is the model's.
    std::mt19937 random(15);
    std::vector<Color> colors;
    for (int n = 0; n < 50; ++n) {
        Color c;
        for (float& v : c) v = static_cast<float>(random() % 256) / 255;
        colors.push_back(c);
    }
    const auto got = draw(VK_FORMAT_R32G32B32A32_SFLOAT, {}, colors, sourceOver);
    Color model{};
    for (const Color& c : colors)
        for (size_t k = 0; k < 4; ++k) model[k] = c[k] * c[3] + model[k] * (1 - c[3]);
    for (size_t k = 0; k < 4; ++k) EXPECT_EQ(got.float32[k], model[k]);
}

TEST_F(Blend, OpaqueReadsNothing) {
    draw(VK_FORMAT_R8G8B8A8_UNORM, {}, {{1, 1, 1, 1}}, [](GraphicsState& s) { s.blend[0].blendEnable = VK_FALSE; });
    EXPECT_EQ(statistics_.destinationReads, 0u);
    draw(VK_FORMAT_R8G8B8A8_UNORM, {}, {{1, 1, 1, 1}}, sourceOver);
    EXPECT_EQ(statistics_.destinationReads, 16u);
}

}  // namespace
}  // namespace vernier::raster_test
