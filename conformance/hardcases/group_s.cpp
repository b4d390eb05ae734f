// S: stencil.
#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/judges.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <cmath>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_D32_SFLOAT_S8_UINT;

VkStencilOpState state(VkStencilOp fail, VkStencilOp pass, VkStencilOp depthFail, VkCompareOp compare,
                       uint32_t compareMask, uint32_t writeMask, uint32_t reference) {
    return {fail, pass, depthFail, compare, compareMask, writeMask, reference};
}

VkStencilOpState always(VkStencilOp op, uint32_t writeMask, uint32_t reference) {
    return state(op, op, op, VK_COMPARE_OP_ALWAYS, 0xff, writeMask, reference);
}

const char* const kBitFragmentGlsl = R"(#version 450
layout(push_constant) uniform Bit { uint bit; };
layout(location = 0) out vec4 color;
void main() {
    if (((uint(gl_FragCoord.x) >> bit) & 1u) == 0u) discard;
    color = vec4(0.0);
}
)";
const char* const kNothingFragmentGlsl = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(0.0); }
)";

// A target whose stencil is written, changed, and at last shown in red, bit by bit.
class StencilScene {
  public:
    StencilScene(std::string_view name, VkExtent2D extent, float depth = 1)
        : record(name, "Stencil values shown as red codes."), extent_(extent) {
        color_ = record.colorTarget("stencil", VK_FORMAT_R8G8B8A8_UNORM, extent);
        const uint32_t stencil = record.depthTarget("depth", kFormat, extent);
        record.pass(extent).color(color_, {0, 0, 0, 0}).depthStencil(stencil, depth, 0);
        cover_ = record.vertex(kCoverVertexGlsl);
    }

    /// Every column holds its number.
    void fillColumns() {
        const uint32_t fragment = record.fragment(kBitFragmentGlsl);
        for (uint32_t bit = 0; bit < 8; ++bit) {
            const VkStencilOpState op = always(VK_STENCIL_OP_REPLACE, 1u << bit, 0xff);
            const uint32_t pipeline = record.pipeline(cover_, fragment).stencil(op, op).writeMask(0).pushConstants(4);
            record.draw(pipeline, 3).push(bit);
        }
    }

    /// A covering draw in one row.
    void drawRow(uint32_t row, const VkStencilOpState& op, bool depthTest = false) {
        auto pipeline = record.pipeline(cover_, record.fragment(kNothingFragmentGlsl)).stencil(op, op).writeMask(0);
        if (depthTest) pipeline.depth(VK_COMPARE_OP_LESS, false);
        record.draw(pipeline, 3).scissor(0, static_cast<int32_t>(row), extent_.width, 1);
    }

    size_t show(CaseInput& input) {
        for (uint32_t bit = 0; bit < 8; ++bit) {
            const VkStencilOpState op = state(VK_STENCIL_OP_KEEP, VK_STENCIL_OP_KEEP, VK_STENCIL_OP_KEEP,
                                              VK_COMPARE_OP_EQUAL, 1u << bit, 0, 0xff);
            const std::string glsl = "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(" +
                                     std::to_string(1u << bit) + ".0 / 255.0, 0.0, 0.0, 0.0); }\n";
            record.draw(record.pipeline(cover_, record.fragment(glsl)).stencil(op, op).blend(countingBlend()), 3);
        }
        record.output(color_);
        return input.scene(record.finish());
    }

    SceneRecorder record;

  private:
    VkExtent2D extent_;
    uint32_t color_ = 0, cover_ = 0;
};

using Expected = std::function<uint32_t(uint32_t x, uint32_t y)>;

void judgeStencil(CaseInput& input, size_t scene, VkExtent2D extent, Expected expected, std::string rule) {
    judgePixels(input, scene, 0, extent, [=](const PixelReader& pixels, const Declared&) -> Verdict {
        for (uint32_t y = 0; y < extent.height; ++y) {
            for (uint32_t x = 0; x < extent.width; ++x) {
                const uint64_t code = pixels.code(x, y, 0);
                if (code == expected(x, y)) continue;
                return Verdict::wrong(pixelText(x, y) + " holds " + std::to_string(code) + ", exactly " +
                                      std::to_string(expected(x, y)) + "; " + rule);
            }
        }
        return {};
    });
}

// Vulkan, Stencil Test, table of VkStencilOp.
uint32_t applied(VkStencilOp op, uint32_t stored, uint32_t reference) {
    switch (op) {
        case VK_STENCIL_OP_ZERO:
            return 0;
        case VK_STENCIL_OP_REPLACE:
            return reference;
        case VK_STENCIL_OP_INCREMENT_AND_CLAMP:
            return stored == 255 ? 255 : stored + 1;
        case VK_STENCIL_OP_DECREMENT_AND_CLAMP:
            return stored == 0 ? 0 : stored - 1;
        case VK_STENCIL_OP_INVERT:
            return ~stored & 0xff;
        case VK_STENCIL_OP_INCREMENT_AND_WRAP:
            return (stored + 1) & 0xff;
        case VK_STENCIL_OP_DECREMENT_AND_WRAP:
            return (stored - 1) & 0xff;
        default:
            return stored;
    }
}

void s01(CaseInput& input) {
    constexpr VkExtent2D kTarget{256, 8};
    for (const uint32_t mask : {0xffu, 0x0fu, 0xf0u, 0x5au, 0x80u, 0x00u}) {
        StencilScene scene("S01", kTarget);
        scene.fillColumns();
        for (uint32_t op = 0; op < 8; ++op) scene.drawRow(op, always(static_cast<VkStencilOp>(op), mask, 0x35));
        judgeStencil(
            input, scene.show(input), kTarget,
            [mask](uint32_t x, uint32_t op) {
                return (x & ~mask) | (applied(static_cast<VkStencilOp>(op), x, 0x35) & mask);
            },
            "row " + std::string("= operation, column = value before, write mask ") + std::to_string(mask));
    }
}

// A quad on the left that turns one way and one on the right that turns the other way, and triangles without area.
void s02(CaseInput& input) {
    constexpr VkExtent2D kTarget{64, 4};
    for (const VkFrontFace frontFace : {VK_FRONT_FACE_COUNTER_CLOCKWISE, VK_FRONT_FACE_CLOCKWISE}) {
        StencilScene scene("S02", kTarget);
        scene.fillColumns();
        const std::vector<ClipPosition> positions{{-1, -1, 0, 1},     {-1, 1, 0, 1}, {0, 1, 0, 1}, {-1, -1, 0, 1},
                                                  {0, 1, 0, 1},       {0, -1, 0, 1},  // counter-clockwise
                                                  {0, -1, 0, 1},      {1, 1, 0, 1},  {0, 1, 0, 1}, {0, -1, 0, 1},
                                                  {1, -1, 0, 1},      {1, 1, 0, 1},  // clockwise
                                                  {-1, -1, 0, 1},     {1, 1, 0, 1},  {0, 0, 0, 1}, {0.5f, 0.5f, 0, 1},
                                                  {0.5f, 0.5f, 0, 1}, {1, 1, 0, 1}};
        const VkStencilOpState front = state(VK_STENCIL_OP_ZERO, VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_INVERT,
                                             VK_COMPARE_OP_LESS, 0x1c, 0x3f, 0x0f);
        const VkStencilOpState back = state(VK_STENCIL_OP_INVERT, VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_ZERO,
                                            VK_COMPARE_OP_GREATER_OR_EQUAL, 0x33, 0xf5, 0x92);
        const uint32_t pipeline =
            scene.record.pipeline(scene.record.vertex(kPositionVertexGlsl), scene.record.fragment(kNothingFragmentGlsl))
                .binding(sizeof(ClipPosition))
                .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                .cull(VK_CULL_MODE_NONE, frontFace)
                .stencil(front, back)
                .writeMask(0);
        scene.record.draw(pipeline, static_cast<uint32_t>(positions.size()))
            .vertices(scene.record.vertexBuffer("positions", positions));
        judgeStencil(
            input, scene.show(input), kTarget,
            [=](uint32_t x, uint32_t) {
                const bool isFront = (x < 32) == (frontFace == VK_FRONT_FACE_COUNTER_CLOCKWISE);
                const VkStencilOpState& s = isFront ? front : back;
                const uint32_t reference = s.reference & s.compareMask, stored = x & s.compareMask;
                const bool passes = isFront ? reference < stored : reference >= stored;
                return (x & ~s.writeMask) | (applied(passes ? s.passOp : s.failOp, x, s.reference) & s.writeMask);
            },
            "reference and stored value are compared under the mask of the triangle's side");
    }
}

void s03(CaseInput& input) {
    constexpr VkExtent2D kTarget{64, 6};
    // Replaced by 1, 2 or 3 when the stencil test fails, the depth test fails, or both pass.
    const auto op = [](VkCompareOp compare) {
        return state(VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_INVERT, compare, 0xff, 0xff,
                     20);
    };
    StencilScene passing("S03_depth_passes", kTarget, 1), failing("S03_depth_fails", kTarget, 0);
    for (StencilScene* scene : {&passing, &failing}) {
        scene->fillColumns();
        scene->drawRow(0, op(VK_COMPARE_OP_ALWAYS));
        scene->drawRow(1, op(VK_COMPARE_OP_NEVER));
        scene->drawRow(2, op(VK_COMPARE_OP_ALWAYS), true);
        scene->drawRow(3, op(VK_COMPARE_OP_NEVER), true);
        scene->drawRow(4, op(VK_COMPARE_OP_GREATER), true);
        scene->drawRow(5, op(VK_COMPARE_OP_NOT_EQUAL));
        const bool depthPasses = scene == &passing;
        judgeStencil(
            input, scene->show(input), kTarget,
            [depthPasses](uint32_t x, uint32_t row) {
                const bool stencilPasses = row == 0 || row == 2 || (row == 4 && 20 > x) || (row == 5 && x != 20);
                const bool depthTest = row >= 2 && row <= 4;
                if (!stencilPasses) return applied(VK_STENCIL_OP_INCREMENT_AND_WRAP, x, 20);
                if (depthTest && !depthPasses) return applied(VK_STENCIL_OP_INVERT, x, 20);
                return applied(VK_STENCIL_OP_REPLACE, x, 20);
            },
            "a failed stencil test comes first, then a failed depth test; without a depth test depth passes");
    }
}

// A closed surface: a sphere of triangles with a bumpy radius, in perspective, beyond the target on all sides or not.
std::vector<ClipPosition> closedSurface(double scale, double shift) {
    constexpr uint32_t kSlices = 23, kStacks = 17;
    const auto vertex = [&](uint32_t slice, uint32_t stack) {
        slice %= kSlices;
        if (stack == 0 || stack == kStacks) slice = 0;  // the poles are one vertex each
        const double azimuth = 6.283185307179586 * slice / kSlices, polar = 3.141592653589793 * stack / kStacks;
        const double radius = scale * (0.8 + 0.2 * std::sin(slice * 5.1 + stack * 3.7));
        const double x = radius * std::sin(polar) * std::cos(azimuth) + shift, y = radius * std::cos(polar);
        const double z = radius * std::sin(polar) * std::sin(azimuth) + 3 * scale;
        const double w = z / (2 * scale);
        return ClipPosition{static_cast<float>(x), static_cast<float>(y), static_cast<float>(w * 0.5),
                            static_cast<float>(w)};
    };
    std::vector<ClipPosition> positions;
    for (uint32_t stack = 0; stack < kStacks; ++stack) {
        for (uint32_t slice = 0; slice < kSlices; ++slice) {
            const ClipPosition a = vertex(slice, stack), b = vertex(slice + 1, stack);
            const ClipPosition c = vertex(slice, stack + 1), d = vertex(slice + 1, stack + 1);
            if (stack != 0) positions.insert(positions.end(), {a, b, c});
            if (stack + 1 != kStacks) positions.insert(positions.end(), {b, d, c});
        }
    }
    return positions;
}

void s04(CaseInput& input) {
    constexpr VkExtent2D kTarget{128, 96};
    for (const auto& [scale, shift] : {std::pair{0.9, 0.0}, {1.3, 0.7}, {4.0, -1.5}}) {
        for (const bool counting : {false, true}) {
            StencilScene scene("S04", kTarget);
            const std::vector<ClipPosition> positions = closedSurface(scale, shift);
            const VkStencilOpState front =
                always(counting ? VK_STENCIL_OP_INCREMENT_AND_WRAP : VK_STENCIL_OP_INVERT, 0xff, 0);
            const VkStencilOpState back =
                always(counting ? VK_STENCIL_OP_DECREMENT_AND_WRAP : VK_STENCIL_OP_INVERT, 0xff, 0);
            const uint32_t pipeline =
                scene.record
                    .pipeline(scene.record.vertex(kPositionVertexGlsl), scene.record.fragment(kNothingFragmentGlsl))
                    .binding(sizeof(ClipPosition))
                    .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                    .stencil(front, back)
                    .writeMask(0);
            scene.record.draw(pipeline, static_cast<uint32_t>(positions.size()))
                .vertices(scene.record.vertexBuffer("positions", positions));
            judgeStencil(
                input, scene.show(input), kTarget, [](uint32_t, uint32_t) { return 0u; },
                counting ? "a closed surface has as many front faces as back faces over every sample"
                         : "a closed surface covers every sample an even number of times");
        }
    }
}

constexpr std::string_view kStencil = "Vulkan, Stencil Test";

// Each sample exports its own value; a pass per column and sample then draws where the stencil is what it should be.
constexpr VkExtent2D kExported{32, 8};

uint32_t exportedValue(uint32_t column, uint32_t sample) {
    return (sample * 67 + column * 29 + 200) & 0xff;
}

void s05(CaseInput& input) {
    constexpr VkSampleCountFlagBits kSamples = VK_SAMPLE_COUNT_4_BIT;
    SceneRecorder record("S05", "Stencil references by sample, compared with what they should be.");
    const uint32_t color = record.colorTarget("samples", VK_FORMAT_R8G8B8A8_UNORM, kExported, kSamples);
    const uint32_t resolved = record.colorTarget("resolved", VK_FORMAT_R8G8B8A8_UNORM, kExported);
    const uint32_t stencil = record.depthTarget("stencil", kFormat, kExported, kSamples);
    const uint32_t cover = record.vertex(kCoverVertexGlsl);
    // 256 more than the value: what is beyond eight bits is dropped.
    const uint32_t exporting = record.fragment(R"(#version 450
#extension GL_ARB_shader_stencil_export : require
layout(location = 0) out vec4 color;
void main() {
    int column = int(gl_FragCoord.x) / 8;
    gl_FragStencilRefARB = ((gl_SampleID * 67 + column * 29 + 200) & 255) + 256;
    color = vec4(0.0);
}
)");
    const uint32_t white = record.fragment(R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); }
)");
    record.pass(kExported).color(color, {0, 0, 0, 0}, resolved).depthStencil(stencil, 1, 0);
    const VkStencilOpState replace = always(VK_STENCIL_OP_REPLACE, 0xff, 7);
    record.draw(record.pipeline(cover, exporting).samples(kSamples).stencil(replace, replace).writeMask(0), 3);
    for (uint32_t column = 0; column < 4; ++column) {
        for (uint32_t sample = 0; sample < 4; ++sample) {
            const VkStencilOpState equal = state(VK_STENCIL_OP_KEEP, VK_STENCIL_OP_KEEP, VK_STENCIL_OP_KEEP,
                                                 VK_COMPARE_OP_EQUAL, 0xff, 0, exportedValue(column, sample));
            auto pipeline = record.pipeline(cover, white).samples(kSamples).sampleMask(1u << sample);
            pipeline.stencil(equal, equal);
            record.draw(pipeline, 3).scissor(static_cast<int32_t>(column * 8), 0, 8, kExported.height);
        }
    }
    record.output(resolved);
    judgeCodes(input, input.scene(record.finish()), 0, kExported, {255, 255, 255, 255},
               "each quarter is a sample that holds what it exported");
}

const std::vector<HardCase> kCases{
    {"S01", "All 8 operations on all 256 values under six write masks",
     "The table of VkStencilOp; clamping stays, wrapping passes.", kStencil, s01},
    {"S02", "Different states for front and back, and triangles without area",
     "Each side is compared and written under its own masks.", kStencil, s02},
    {"S03", "Operations on failed stencil, failed depth and pass, with and without a depth test",
     "Stencil fails first, then depth; without a depth test depth passes.", kStencil, s03},
    {"S04", "Closed surfaces in perspective, inverted and counted",
     "Parity and count are 0 at every sample: watertight.", "Vulkan, Basic Polygon Rasterization", s04},
    {"S05", "Stencil export of another value for each of four samples",
     "Every sample gets the exported value modulo 2^8.", "VK_EXT_shader_stencil_export", s05},
};

}  // namespace

std::span<const HardCase> stencilCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
