// Renderers with one deliberate fault each: the oracle catches them, and the arbiter names the fault.
#include "conformance/arbiter/arbiter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"
#include "tests/oracle/rendered.h"
#include "tests/oracle/small_scene.h"

namespace vernier::conformance {
namespace {

using namespace small_scene;

std::vector<OracleImage> answer(const Scene& scene, const OracleRules& rules = {}) {
    auto images = renderOracle(scene, rules);
    EXPECT_TRUE(images.ok()) << (images.ok() ? "" : images.error().message);
    return images ? std::move(images).value() : std::vector<OracleImage>{};
}

std::vector<RenderedImage> drawn(const std::vector<OracleImage>& images) {
    std::vector<RenderedImage> result;
    for (const OracleImage& image : images) result.push_back(renderedFrom(image));
    return result;
}

/// What the arbiter says of images of a scene.
std::optional<Explanation> explain(const Scene& scene, const std::vector<RenderedImage>& images,
                                   HeldTo heldTo = HeldTo::specification) {
    const AskOracle ask = [&scene](const Hypotheses& hypotheses) -> std::optional<std::vector<OracleImage>> {
        Scene changed = scene;
        OracleRules rules;
        for (const Hypothesis* each : hypotheses) each->apply(changed, rules);
        return answer(changed, rules);
    };
    const auto why = explainWrong(scene, images, answer(scene), ask, {}, heldTo);
    EXPECT_TRUE(why.ok()) << (why.ok() ? "" : why.error().message);
    return why ? *why : std::nullopt;
}

/// The declared rendering of what hypotheses make of the scene must be put down to them.
void expectNamed(const Scene& scene, std::initializer_list<const char*> names, HeldTo heldTo = HeldTo::specification) {
    Scene changed = scene;
    OracleRules rules;
    Hypotheses meant;
    for (const char* name : names) {
        meant.push_back(findHypothesis(name));
        ASSERT_TRUE(meant.back()->apply(changed, rules)) << name;
    }
    const auto why = explain(scene, drawn(answer(changed, rules)), heldTo);
    ASSERT_TRUE(why) << namesOf(meant) << " is not caught";
    EXPECT_TRUE(std::is_permutation(meant.begin(), meant.end(), why->hypotheses.begin(), why->hypotheses.end()))
        << "not " << namesOf(meant) << ": " << describe(*why);
    EXPECT_TRUE(why->convinces()) << describe(*why);
}

void expectNamed(const Scene& scene, const char* name) {
    expectNamed(scene, {name});
}

std::vector<Vertex> quad() {
    std::vector<Vertex> vertices;
    for (const auto& [x, y] :
         {std::pair{1.0f, 1.0f}, {15.0f, 1.0f}, {1.0f, 15.0f}, {15.0f, 15.0f}, {1.0f, 15.0f}, {15.0f, 1.0f}})
        vertices.push_back(vertex(x, y, kRed));
    return vertices;
}

/// Two planes that cross aslant.
std::vector<Vertex> crossing() {
    return {vertex(0, 0, kRed, 0.2f),    vertex(16, 0, kRed, 0.8f),    vertex(0, 16, kRed, 0.45f),
            vertex(0, 0, kGreen, 0.79f), vertex(16, 0, kGreen, 0.21f), vertex(0, 16, kGreen, 0.36f)};
}

std::vector<Vertex> colorful() {
    return {vertex(1, 1, {1, 0, 0, 1}), vertex(14, 2, {0, 1, 0, 1}), vertex(3, 13, {0, 0, 1, 1})};
}

TEST(Arbiter, HasNothingToExplainWhenAllIsRight) {
    const Scene scene = drawScene(colorful(), kSmooth);
    EXPECT_FALSE(explain(scene, drawn(answer(scene))));
}

TEST(Arbiter, NamesTheSwappedProvokingVertex) {
    expectNamed(drawScene(colorful(), kFlat), "provoking");
}

TEST(Arbiter, NamesScissorsThatAreOffByOne) {
    const Scene scene = drawScene(quad(), kFlat, [](Scene& s) { passOf(s).draws[0].scissor = {{4, 6}, {6, 4}}; });
    for (const char* name : {"scissorWide", "scissorNarrow", "scissorLate", "scissorEarly"}) expectNamed(scene, name);
}

/// Two triangles that share a diagonal through pixel centres, and whose borders run through centres, too. Colours add
/// up, so that doubles show.
Scene diagonal() {
    std::vector<Vertex> vertices;
    constexpr std::array<float, 4> kQuarter{0.25f, 0, 0, 1};
    for (const auto& [x, y] :
         {std::pair{2.5f, 2.5f}, {12.5f, 2.5f}, {2.5f, 12.5f}, {12.5f, 12.5f}, {2.5f, 12.5f}, {12.5f, 2.5f}})
        vertices.push_back(vertex(x, y, kQuarter));
    return drawScene(vertices, kFlat, [](Scene& s) {
        VkPipelineColorBlendAttachmentState& blend = s.pipelines[0].blend[0];
        blend.blendEnable = VK_TRUE;
        blend.srcColorBlendFactor = blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    });
}

TEST(Arbiter, NamesTheMissingStepOfTheFillRule) {
    expectNamed(diagonal(), {"tiesInclusive"});
    expectNamed(diagonal(), {"tiesExclusive"});
}

TEST(Arbiter, NamesTheShiftedTieRuleOfWhoeverDeclaresAnother) {
    expectNamed(diagonal(), {"tiesBottomRight"}, HeldTo::declaredRules);
    Scene changed = diagonal();
    OracleRules rules;
    ASSERT_TRUE(findHypothesis("tiesBottomRight")->apply(changed, rules));
    const std::vector<RenderedImage> shifted = drawn(answer(changed, rules));
    EXPECT_FALSE(explain(diagonal(), shifted)) << "another tie rule is permitted";
    // Beside a driver with the declared rule the differ puts it down to ties, too.
    const std::vector<OracleImage> oracle = answer(diagonal());
    const Result<ImageDiff> diff = compareImages(drawn(oracle)[0], shifted[0], &oracle[0]);
    ASSERT_TRUE(diff.ok());
    EXPECT_EQ(diff->failures(), 0u);
    EXPECT_EQ(diff->count(PixelClass::tie), 2u * 19u) << "the borders; the diagonal is covered once anyhow";
    EXPECT_FALSE(explain(diagonal(), drawn(oracle), HeldTo::declaredRules)) << "the declared rule is no departure";
}

TEST(Arbiter, NamesCoarserSnapping) {
    // The lower border lies 0.02 pixels below a row of centres: on it for 4 bits, beyond it for 8.
    std::vector<Vertex> vertices = quad();
    for (Vertex& v : vertices) {
        if (v.position[1] > 0.5f) v.position[1] = 8.52f / 8 - 1;
    }
    expectNamed(drawScene(vertices, kFlat), "snap4");
}

TEST(Arbiter, NamesFacingThatIsSwapped) {
    expectNamed(drawScene(colorful(), kFlat, [](Scene& s) { s.pipelines[0].cullMode = VK_CULL_MODE_BACK_BIT; }),
                "facing");
}

TEST(Arbiter, NamesBlitsThatGoOnBeyondTexels) {
    const auto scene = findScene("blit_mirrored")->build();
    ASSERT_TRUE(scene.ok());
    expectNamed(*scene, "truncatedBlits");
}

TEST(Arbiter, NamesDepthsAtMirroredPlaces) {
    const Scene scene = drawScene(crossing(), kFlat, [](Scene& s) {
        SceneImage samples = s.images[0], depth = s.images[0];
        samples.samples = depth.samples = VK_SAMPLE_COUNT_4_BIT;
        depth.format = VK_FORMAT_D32_SFLOAT;
        s.images.insert(s.images.end(), {samples, depth});
        ScenePass& pass = passOf(s);
        pass.colors[0].image = 1;
        pass.colors[0].resolveImage = 0;
        pass.depthStencil.image = 2;
        pass.depthStencil.clear.depthStencil.depth = 1;
        s.pipelines[0].samples = VK_SAMPLE_COUNT_4_BIT;
        s.pipelines[0].depthTest = s.pipelines[0].depthWrite = true;
    });
    expectNamed(scene, "mirroredDepths");
}

TEST(Arbiter, NamesTwoFaultsTogether) {
    const Scene scene = drawScene(colorful(), kFlat, [](Scene& s) { passOf(s).draws[0].scissor = {{3, 3}, {5, 5}}; });
    expectNamed(scene, {"provoking", "scissorWide"});
}

TEST(Arbiter, BeginsWithWhatIsDeclared) {
    EXPECT_EQ(namesOf(declaredBy("maxSamples 4, subPixelPrecisionBits 4, more 8")), "snap4");
    EXPECT_EQ(namesOf(declaredBy("subPixelPrecisionBits 8")), "") << "what all are held to";
    EXPECT_EQ(namesOf(declaredBy("")), "");
}

TEST(Arbiter, NamesAttributesAlongTheMajorAxis) {
    const auto scene = findScene("lines_bresenham")->build();
    ASSERT_TRUE(scene.ok());
    expectNamed(*scene, "majorAxis");
}

TEST(Arbiter, NamesClippingThatClampingTurnsOff) {
    const auto scene = findScene("depth_clamp")->build();
    ASSERT_TRUE(scene.ok());
    expectNamed(*scene, "clipWhenClamped");
}

// Weights cut off to so many bits, of a ramp between two texels.
TEST(Arbiter, NamesWeightsOfSevenBits) {
    SceneRecorder record("weights", "");
    const VkExtent2D wide{1024, 1};
    const std::vector<uint16_t> texels{0, 0, 0, 65535, 65535, 65535, 65535, 65535};
    const uint32_t texture = record.texture("ramp", VK_FORMAT_R16G16B16A16_UNORM, {2, 1}, {bytesOf(texels)});
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R32G32B32A32_SFLOAT, wide);
    const uint32_t pipeline = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D ramp;
layout(location = 0) out vec4 color;
void main() { color = textureLod(ramp, vec2(gl_FragCoord.x / 1024.0, 0.5), 0.0); }
)"));
    record.pass(wide).color(target, {0, 0, 0, 0});
    record.draw(pipeline, 3).texture(0, texture, record.sampler(VK_FILTER_LINEAR));
    record.output(target);
    const auto scene = record.finish();
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const std::vector<OracleImage> oracle = answer(*scene);
    const auto cut = [&oracle](int bits) {
        std::vector<OracleImage> images = oracle;
        for (uint32_t x = 0; x < 1024; ++x) {
            const double u = std::clamp((x + 0.5) / 512 - 0.5, 0.0, 1.0);
            for (size_t c = 0; c < 3; ++c)
                images[0].pixels[x].value[c] = std::ldexp(std::floor(std::ldexp(u, bits)), -bits);
        }
        return drawn(images);
    };
    EXPECT_FALSE(explain(*scene, cut(8)));
    for (const auto& [bits, name] : {std::pair{7, "weights7"}, {6, "weights6"}, {4, "weights4"}}) {
        const auto why = explain(*scene, cut(bits));
        ASSERT_TRUE(why) << bits << " bits are not caught";
        EXPECT_EQ(namesOf(why->hypotheses), name) << describe(*why);
        EXPECT_EQ(why->explained, why->wrong);
    }
}

TEST(Arbiter, SaysSoWhenNoHypothesisFits) {
    const Scene scene = drawScene(colorful(), kSmooth);
    std::vector<RenderedImage> images = drawn(answer(scene));
    for (std::byte& b : images[0].texels) b ^= std::byte{0x55};
    const auto why = explain(scene, images);
    EXPECT_FALSE(why && why->convinces()) << describe(*why);
}

TEST(Arbiter, TellsInWords) {
    const Explanation all{{findHypothesis("weights7")}, 83, 83, 0}, some{{findHypothesis("snap4")}, 100, 60, 1};
    EXPECT_EQ(describe(all), "All 83 wrong pixels are right if weights of linear filters have 7 bits");
    EXPECT_EQ(describe(some),
              "60 of 100 wrong pixels are right if vertices are snapped to 4 sub-pixel bits (no hypothesis explains "
              "them all)");
}

}  // namespace
}  // namespace vernier::conformance
