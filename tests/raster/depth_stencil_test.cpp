// Depth, depth bias and stencil.
#include <bit>
#include <cmath>
#include <random>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

constexpr uint32_t kSize = 32;
constexpr VkFormat kColor = VK_FORMAT_R32_SFLOAT;

std::vector<Vertex> triangle(float z0, float z1, float z2, std::array<float, 4> color = {1, 1, 1, 1}) {
    return {at(0, 0, kSize, kSize, color, z0), at(2 * kSize, 0, kSize, kSize, color, z1),
            at(0, 2 * kSize, kSize, kSize, color, z2)};
}
std::vector<Vertex> reversed(std::vector<Vertex> v) {
    std::swap(v[1], v[2]);
    return v;
}

class Depth : public testing::TestWithParam<VkFormat> {
  protected:
    struct Draw {
        std::vector<Vertex> vertices;
        std::function<void(GraphicsState&)> state;
        std::function<void(DynamicState&)> dynamic;
        std::string fragment = "one_frag";
    };
    void run(const std::vector<Draw>& draws, VkFormat format, float clearDepth = 1, uint32_t clearStencil = 0,
             Isa isa = bestIsa()) {
        color_ = std::make_unique<Surface>(kColor, kSize, kSize);
        depth_ = std::make_unique<Surface>(format, kSize, kSize);
        VkClearValue clear{};
        clear.depthStencil = {clearDepth, clearStencil};
        Pass pass(pool_, {color_->cleared({})}, depth_->cleared(clear), kSize, kSize);
        pass.begin();
        for (const Draw& draw : draws) {
            PipelineOptions options;
            options.isa = isa;
            options.fragment = draw.fragment;
            options.state = plainState(kColor, format);
            options.state.depthTest = options.state.depthWrite = true;
            setAdditive(options.state);
            if (draw.state) draw.state(options.state);
            DynamicState dynamic = dynamicFor(kSize, kSize);
            if (draw.dynamic) draw.dynamic(dynamic);
            pass.draw(makePipeline(options), dynamic, draw.vertices);
        }
        pass.end();
        statistics_ = pass.pass().statistics();
    }
    void expectColor(float value) {
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x) ASSERT_EQ(color_->red(x, y), value) << x << "," << y;
    }
    ThreadPool pool_{2};
    std::unique_ptr<Surface> color_, depth_;
    PassStatistics statistics_;
};

uint32_t maxCode(VkFormat format) {
    return format == VK_FORMAT_D16_UNORM ? 65535 : 16777215;
}
bool isFloat(VkFormat format) {
    return format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_D32_SFLOAT_S8_UINT;
}

TEST_P(Depth, ConstantDepthIsRoundedToNearest) {
    for (const float z : {0.0f, 1.0f, 0.25f, 0.1f, 0.7f}) {
        run({{triangle(z, z, z), {}, {}}}, GetParam());
        const double expected =
            isFloat(GetParam()) ? double{z} : std::nearbyint(double{z} * maxCode(GetParam())) / maxCode(GetParam());
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x) ASSERT_EQ(depth_->depth(x, y), static_cast<float>(expected));
    }
}

TEST_P(Depth, AllCompareOperations) {
    for (uint32_t op = 0; op < 8; ++op) {
        for (const auto& [z, relation] : {std::pair{0.25f, 1u}, {0.5f, 2u}, {0.75f, 4u}}) {
            for (const Isa isa : {kLowestIsa, bestIsa()}) {
                run({{triangle(0.5f, 0.5f, 0.5f), {}, {}},
                     {triangle(z, z, z), [&](GraphicsState& s) { s.depthCompare = static_cast<VkCompareOp>(op); }, {}}},
                    GetParam(), 1, 0, isa);
                const bool passes = (op & relation) != 0;
                expectColor(passes ? 2 : 1);
                EXPECT_NEAR(depth_->depth(5, 5), passes ? z : 0.5f, 1e-5f);
            }
        }
    }
}

TEST_P(Depth, DrawnTwiceIsEqualEverywhere) {
    std::mt19937 random(11);
    for (int n = 0; n < 20; ++n) {
        std::vector<Vertex> v;
        for (int k = 0; k < 3; ++k)
            v.push_back(at(static_cast<double>(random() % 6400) / 100 - 10,
                           static_cast<double>(random() % 6400) / 100 - 10, kSize, kSize, {1, 1, 1, 1},
                           static_cast<float>(random() % 1000) / 1000));
        const auto equal = [](GraphicsState& s) {
            s.depthCompare = VK_COMPARE_OP_EQUAL;
            s.depthWrite = false;
        };
        // Early, late through gl_FragDepth, late through a discard, and the other way round the triangle.
        run({{v, {}, {}}, {v, equal, {}}, {v, equal, {}, "fragdepth_frag"}, {reversed(v), equal, {}}}, GetParam());
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x)
                ASSERT_TRUE(color_->red(x, y) == 0 || color_->red(x, y) == 4)
                    << color_->red(x, y) << " at " << x << "," << y;
    }
}

TEST_P(Depth, EarlyAndLateTestsAgree) {
    std::mt19937 random(12);
    const auto scene = [&](const std::string& fragment) {
        std::mt19937 same(13);
        std::vector<Draw> draws;
        for (int n = 0; n < 12; ++n) {
            std::vector<Vertex> v;
            for (int k = 0; k < 9; ++k)
                v.push_back(
                    at(same() % 40, same() % 40, kSize, kSize, {1, 1, 1, 1}, static_cast<float>(same() % 100) / 100));
            draws.push_back({v, [](GraphicsState& s) { s.depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL; }, {}, fragment});
        }
        return draws;
    };
    run(scene("one_frag"), GetParam());
    const uint64_t color = color_->hash(), depth = depth_->hash();
    run(scene("fragdepth_frag"), GetParam());
    EXPECT_EQ(color_->hash(), color);
    EXPECT_EQ(depth_->hash(), depth);
    run(scene("discard_frag"), GetParam());
    EXPECT_EQ(depth_->hash(), depth);
}

TEST_P(Depth, OverlapInsideOneBatchWithoutBlending) {
    // Small opaque triangles over each other: one batch holds a pixel several times, and the late test decides in
    // order.
    const auto scene = [](const std::string& fragment) {
        std::mt19937 random(18);
        std::vector<Vertex> v;
        for (int n = 0; n < 400; ++n) {
            const auto x = static_cast<double>(random() % 28), y = static_cast<double>(random() % 28);
            const float value = 0.5f + static_cast<float>(n) / 1024;  // discard_frag keeps it
            const float z = static_cast<float>(random() % 1000) / 1000;
            for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {3.0, 0.5}, {0.5, 3.0}})
                v.push_back(at(x + dx, y + dy, kSize, kSize, {value, 0, 0, 1}, z));
        }
        const auto state = [](GraphicsState& s) {
            s.blend[0].blendEnable = VK_FALSE;
            s.depthCompare = VK_COMPARE_OP_LESS;
        };
        return std::vector<Draw>{{v, state, {}, fragment}};
    };
    run(scene("color_frag"), GetParam());
    const uint64_t color = color_->hash(), depth = depth_->hash();
    run(scene("discard_frag"), GetParam());
    EXPECT_EQ(color_->hash(), color);
    EXPECT_EQ(depth_->hash(), depth);
}

TEST_P(Depth, HiddenBlocksAreDroppedUnread) {
    const auto with = [](VkCompareOp compare) { return [=](GraphicsState& s) { s.depthCompare = compare; }; };
    for (const bool greater : {false, true}) {
        const float nearer = greater ? 0.8f : 0.2f, farther = greater ? 0.3f : 0.7f;
        const auto test = with(greater ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS);
        run({{triangle(nearer, nearer, nearer), test, {}}, {triangle(farther, farther, farther), test, {}}}, GetParam(),
            greater ? 0.0f : 1.0f);
        EXPECT_EQ(statistics_.coarseDepthRejects, kSize / 8 * kSize / 8);
        // What was cleared to the farthest depth need not be read either.
        EXPECT_EQ(statistics_.depthReads, 0u);
        expectColor(1);
    }
    // Equal depths pass "less or equal": one must not be taken for hidden by the other.
    const auto equal = with(VK_COMPARE_OP_LESS_OR_EQUAL);
    run({{triangle(0.2f, 0.7f, 0.4f), equal, {}}, {triangle(0.2f, 0.7f, 0.4f), equal, {}}}, GetParam());
    expectColor(2);
}

TEST_P(Depth, LateTestsDropWhatIsHidden) {
    // Of what may be discarded, too, nothing is shaded that cannot pass; unless it could pass after what waits before
    // it, or its depth is its own.
    const auto with = [](VkCompareOp compare) { return [=](GraphicsState& s) { s.depthCompare = compare; }; };
    const std::vector<Vertex> near = triangle(0.2f, 0.3f, 0.2f), far = triangle(0.6f, 0.7f, 0.6f);
    constexpr uint64_t kPixels = uint64_t{kSize} * kSize;
    run({{near, with(VK_COMPARE_OP_LESS), {}, "discard_frag"}, {far, with(VK_COMPARE_OP_LESS), {}, "discard_frag"}},
        GetParam());
    EXPECT_EQ(statistics_.fragmentInvocations, kPixels);
    expectColor(1);
    run({{near, with(VK_COMPARE_OP_LESS), {}, "fragdepth_frag"}, {far, with(VK_COMPARE_OP_LESS), {}, "fragdepth_frag"}},
        GetParam());
    EXPECT_EQ(statistics_.fragmentInvocations, 2 * kPixels);
    expectColor(1);
    run({{near, with(VK_COMPARE_OP_LESS), {}, "discard_frag"},
         {near, with(VK_COMPARE_OP_NOT_EQUAL), {}, "discard_frag"}},
        GetParam());
    EXPECT_EQ(statistics_.fragmentInvocations, 2 * kPixels);
    expectColor(1);
}

TEST_P(Depth, DiscardedFragmentsLeaveNoDepth) {
    run({{triangle(0.2f, 0.2f, 0.2f, {0, 1, 1, 1}), {}, {}, "discard_frag"}}, GetParam());
    EXPECT_EQ(depth_->depth(3, 3), 1);
    expectColor(0);
}

TEST_P(Depth, BiasIsOneToTwoUnits) {
    run({{triangle(0.3f, 0.6f, 0.6f), {}, {}}}, GetParam());
    std::vector<float> plain;
    for (uint32_t x = 0; x < kSize; ++x) plain.push_back(depth_->depth(x, 7));
    for (int rotation = 0; rotation < 3; ++rotation) {
        std::vector<Vertex> v = triangle(0.3f, 0.6f, 0.6f);
        std::rotate(v.begin(), v.begin() + rotation, v.end());
        const double r = isFloat(GetParam()) ? std::ldexp(1.0, -24) : 1.0 / maxCode(GetParam());
        for (const float units : {1.0f, -1.0f, 16.0f}) {
            run({{v, [](GraphicsState& s) { s.depthBiasEnable = true; },
                  [&](DynamicState& d) { d.depthBiasConstant = units; }}},
                GetParam());
            for (uint32_t x = 0; x < kSize; ++x) {
                const double shift = double{depth_->depth(x, 7)} - double{plain[x]};
                // One unit of the format and one of the float in which the plane is evaluated.
                EXPECT_NEAR(shift, double{units} * r, r * 0.01 + std::ldexp(1.0, -23));
            }
        }
    }
}

TEST_P(Depth, BiasSlopeAndClamp) {
    // Slope 0.5 over 64 pixels in x, 0.25 in y.
    const double slope = std::sqrt(0.5 * 0.5 + 0.25 * 0.25) / 64;
    const auto shifted = [&](float factor, float clamp) {
        run({{triangle(0.1f, 0.6f, 0.35f), {}, {}}}, GetParam());
        const double before = double{depth_->depth(9, 4)};
        run({{triangle(0.1f, 0.6f, 0.35f), [](GraphicsState& s) { s.depthBiasEnable = true; },
              [&](DynamicState& d) {
                  d.depthBiasSlope = factor;
                  d.depthBiasClamp = clamp;
              }}},
            GetParam());
        return double{depth_->depth(9, 4)} - before;
    };
    EXPECT_NEAR(shifted(1, 0), slope, 3e-5);
    EXPECT_NEAR(shifted(10, 0.03f), 0.03, 3e-5);
    EXPECT_NEAR(shifted(-10, -0.02f), -0.02, 3e-5);
    EXPECT_NEAR(shifted(10, -0.02f), slope * 10, 3e-5);
    // An edge-on triangle: no NaN, clamped.
    run({{{at(0, 0, kSize, kSize, {}, 0), at(kSize, 0.02, kSize, kSize, {}, 1), at(kSize, 0.6, kSize, kSize, {}, 0.5f)},
          [](GraphicsState& s) { s.depthBiasEnable = true; },
          [](DynamicState& d) { d.depthBiasSlope = 1e30f; }}},
        GetParam());
    for (uint32_t x = 0; x < kSize; ++x) EXPECT_EQ(depth_->depth(x, 0), depth_->depth(x, 0));
}

TEST_P(Depth, ViewportRangeAndClamp) {
    const auto range = [](float low, float high) {
        return [=](DynamicState& d) {
            d.viewports[0].minDepth = low;
            d.viewports[0].maxDepth = high;
        };
    };
    run({{triangle(0.25f, 0.25f, 0.25f), {}, range(1, 0)}}, GetParam());
    EXPECT_NEAR(depth_->depth(1, 1), 0.75f, 1e-5f);
    run({{triangle(0.25f, 0.25f, 0.25f), {}, range(0.5f, 0.5f)}}, GetParam());
    EXPECT_NEAR(depth_->depth(1, 1), 0.5f, 1e-5f);
    run({{triangle(7, 7, 7),
          [](GraphicsState& s) {
              s.depthClampEnable = true;
              s.depthClipEnable = false;
          },
          range(0.25f, 0.75f)}},
        GetParam());
    EXPECT_NEAR(depth_->depth(1, 1), 0.75f, 1e-5f);
}

TEST_P(Depth, Bounds) {
    for (const auto& [low, high, passes] : {std::tuple{0.4f, 0.6f, true}, {0.6f, 0.8f, false}, {0.0f, 0.4f, false}}) {
        run({{triangle(0.5f, 0.5f, 0.5f), {}, {}},
             {triangle(0.9f, 0.9f, 0.9f),
              [](GraphicsState& s) {
                  s.depthTest = false;
                  s.depthBoundsTest = true;
              },
              [&, l = low, h = high](DynamicState& d) {
                  d.minDepthBounds = l;
                  d.maxDepthBounds = h;
              }}},
            GetParam());
        expectColor(passes ? 2 : 1);
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, Depth,
                         testing::Values(VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32,
                                         VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT,
                                         VK_FORMAT_D32_SFLOAT_S8_UINT),
                         [](const auto& format) { return std::string(findFormat(format.param)->name); });

class Stencil : public Depth {};

uint32_t stencilModel(VkStencilOp op, uint32_t stored, uint32_t reference) {
    switch (op) {
        case VK_STENCIL_OP_KEEP:
            return stored;
        case VK_STENCIL_OP_ZERO:
            return 0;
        case VK_STENCIL_OP_REPLACE:
            return reference;
        case VK_STENCIL_OP_INCREMENT_AND_CLAMP:
            return std::min(stored + 1, 255u);
        case VK_STENCIL_OP_DECREMENT_AND_CLAMP:
            return stored == 0 ? 0 : stored - 1;
        case VK_STENCIL_OP_INVERT:
            return ~stored & 255;
        case VK_STENCIL_OP_INCREMENT_AND_WRAP:
            return (stored + 1) & 255;
        default:
            return (stored - 1) & 255;
    }
}

TEST_P(Stencil, AllOperationsOnAllValues) {
    // A 32x32 image holds the values 0..255 four times over, made by clears of single pixels.
    for (const uint32_t writeMask : {0xFFu, 0x3Cu}) {
        for (uint32_t op = 0; op < 8; ++op) {
            Surface surface(GetParam(), 16, 16);
            Pass pass(pool_, {}, surface.cleared({}), 16, 16);
            pass.begin();
            for (uint32_t value = 0; value < 256; ++value) {
                VkClearValue clear{};
                clear.depthStencil = {0.5f, value};
                pass.pass().clear(
                    VK_IMAGE_ASPECT_STENCIL_BIT, 0, clear,
                    {{{static_cast<int32_t>(value % 16), static_cast<int32_t>(value / 16)}, {1, 1}}, 0, 1});
            }
            PipelineOptions options;
            options.fragment = "";
            options.state = plainState(VK_FORMAT_UNDEFINED, GetParam());
            options.state.stencilTest = true;
            options.state.stencilFront.compareOp = options.state.stencilBack.compareOp = VK_COMPARE_OP_ALWAYS;
            options.state.stencilFront.passOp = options.state.stencilBack.passOp = static_cast<VkStencilOp>(op);
            DynamicState dynamic = dynamicFor(16, 16);
            dynamic.stencilFront = dynamic.stencilBack = {0xFF, writeMask, 0xA7};
            pass.draw(makePipeline(options), dynamic, {at(0, 0, 16, 16), at(40, 0, 16, 16), at(0, 40, 16, 16)});
            pass.end();
            for (uint32_t value = 0; value < 256; ++value) {
                const uint32_t expected =
                    (value & ~writeMask) | (stencilModel(static_cast<VkStencilOp>(op), value, 0xA7) & writeMask);
                ASSERT_EQ(surface.stencil(value % 16, value / 16), expected) << "op " << op << " value " << value;
            }
        }
    }
}

TEST_P(Stencil, FailDepthFailPass) {
    const bool hasDepth = GetParam() != VK_FORMAT_S8_UINT;
    for (const bool stencilPasses : {false, true}) {
        for (const bool depthPasses : {false, true}) {
            if (!hasDepth && !depthPasses) continue;
            for (const bool front : {false, true}) {
                const std::vector<Vertex> v = triangle(0.5f, 0.5f, 0.5f);
                // Clockwise on the screen as written.
                run({{front ? reversed(v) : v,
                      [&](GraphicsState& s) {
                          s.depthTest = hasDepth;
                          s.depthCompare = depthPasses ? VK_COMPARE_OP_LESS : VK_COMPARE_OP_GREATER;
                          s.stencilTest = true;
                          // reference & mask = 4, stored & mask = 4.
                          const VkCompareOp compare = stencilPasses ? VK_COMPARE_OP_EQUAL : VK_COMPARE_OP_NOT_EQUAL;
                          s.stencilFront = {
                              VK_STENCIL_OP_ZERO, VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_INVERT, compare, 0, 0, 0};
                          s.stencilBack = {VK_STENCIL_OP_INCREMENT_AND_WRAP,
                                           VK_STENCIL_OP_DECREMENT_AND_WRAP,
                                           VK_STENCIL_OP_INVERT,
                                           compare,
                                           0,
                                           0,
                                           0};
                      },
                      [](DynamicState& d) {
                          d.stencilFront = {0x0F, 0xFF, 0xF4};
                          d.stencilBack = {0x0F, 0xFF, 0xE4};
                      }}},
                    GetParam(), 1, 0x14);
                const uint32_t expected = !stencilPasses ? (front ? 0u : 0x15u)
                                          : !depthPasses ? 0xEBu
                                                         : (front ? 0xF4u : 0x13u);
                for (uint32_t y = 0; y < kSize; ++y)
                    for (uint32_t x = 0; x < kSize; ++x) ASSERT_EQ(depth_->stencil(x, y), expected);
                expectColor(stencilPasses && depthPasses ? 1 : 0);
            }
        }
    }
}

TEST_P(Stencil, ParityOfAWatertightMesh) {
    std::mt19937 random(14);
    std::vector<Vertex> v;
    // A closed fan drawn over itself in two different triangulations: every pixel is inverted twice or not at
    // all.
    for (int fan = 0; fan < 2; ++fan) {
        const double cx = fan == 0 ? 15.37 : 11.2, cy = fan == 0 ? 14.81 : 17.9;
        for (int k = 0; k < 23; ++k) {
            for (const auto& p :
                 {std::pair{cx, cy},
                  {16 + 14 * std::cos(k * 0.2731821), 16 + 14 * std::sin(k * 0.2731821)},
                  {16 + 14 * std::cos((k + 1) % 23 * 0.2731821), 16 + 14 * std::sin((k + 1) % 23 * 0.2731821)}})
                v.push_back(at(p.first, p.second, kSize, kSize));
        }
    }
    run({{v,
          [](GraphicsState& s) {
              s.depthTest = false;
              s.stencilTest = true;
              s.stencilFront.compareOp = s.stencilBack.compareOp = VK_COMPARE_OP_ALWAYS;
              s.stencilFront.passOp = s.stencilBack.passOp = VK_STENCIL_OP_INVERT;
          },
          {}}},
        GetParam());
    for (uint32_t y = 0; y < kSize; ++y)
        for (uint32_t x = 0; x < kSize; ++x) ASSERT_EQ(depth_->stencil(x, y), 0u) << x << "," << y;
    EXPECT_EQ(color_->red(16, 16), 2);
}

INSTANTIATE_TEST_SUITE_P(StencilFormats, Stencil,
                         testing::Values(VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_S8_UINT),
                         [](const auto& format) { return std::string(findFormat(format.param)->name); });

}  // namespace
}  // namespace vernier::raster_test
