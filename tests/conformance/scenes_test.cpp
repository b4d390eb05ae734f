#include "conformance/scenes/scenes.h"
#include "conformance/drivers/driver.h"
#include "conformance/scene/scene_format.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vernier/vernier_glsl.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>

namespace vernier::conformance {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr const char* kRed = "#version 450\nlayout(location = 0) out vec4 c; void main() { c = vec4(1, 0, 0, 1); }";

/// A scene that is right, to be broken.
Scene smallScene() {
    SceneRecorder record("small", "For tests.");
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, {8, 4});
    const uint32_t pipeline = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(kRed));
    record.pass({8, 4}).color(target, {0, 0, 0, 1});
    record.draw(pipeline, 3);
    record.output(target);
    Result<Scene> scene = record.finish();
    EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
    return std::move(scene).value();
}

TEST(SceneRecorder, FillsInTheObvious) {
    SceneRecorder record("recorded", "For tests.");
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_SRGB, {20, 10}, VK_SAMPLE_COUNT_1_BIT,
                                               VK_IMAGE_USAGE_SAMPLED_BIT);
    const uint32_t vertices = record.vertexBuffer("vertices", std::vector<float>{1, 2, 3});
    const uint32_t fragment = record.fragment(
        "#version 450\nlayout(constant_id = 7) const int n = 1;\n"
        "layout(location = 0) out vec4 c; void main() { c = vec4(n); }");
    record.specialize(fragment, 7, 42);
    const uint32_t pipeline = record.pipeline(record.vertex(kCoverVertexGlsl), fragment)
                                  .binding(12)
                                  .attribute(VK_FORMAT_R32_SFLOAT, 0)
                                  .attribute(VK_FORMAT_R32_SFLOAT, 4)
                                  .binding(4, VK_VERTEX_INPUT_RATE_INSTANCE)
                                  .attribute(VK_FORMAT_R32_SFLOAT, 0)
                                  .depth(VK_COMPARE_OP_GREATER, false)
                                  .targets(2)
                                  .writeMask(VK_COLOR_COMPONENT_R_BIT, 1);
    record.pass({20, 10}).color(target, {0.25f, 0.5f, 0.75f, 1});
    record.draw(pipeline, 3).vertices(vertices).push(7.5f).scissor(1, 2, 3, 4);
    record.draw(pipeline, 6).viewport(1, 2, 3, -4);
    record.output(target);
    Result<Scene> finished = record.finish();
    ASSERT_TRUE(finished.ok()) << finished.error().message;
    const Scene& scene = finished.value();
    EXPECT_EQ(scene.images[target].usage, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    EXPECT_THAT(scene.buffers[vertices].data, SizeIs(12));
    EXPECT_EQ(scene.shaders[fragment].specialization[0].constantID, 7u);
    EXPECT_EQ(scene.shaders[fragment].spirv[0], 0x07230203u);
    const ScenePipeline& state = scene.pipelines[pipeline];
    ASSERT_THAT(state.vertexAttributes, SizeIs(3));
    EXPECT_EQ(state.vertexAttributes[2].location, 2u);
    EXPECT_EQ(state.vertexAttributes[2].binding, 1u);
    EXPECT_EQ(state.blend[0].colorWriteMask, 0xfu);
    EXPECT_EQ(state.blend[1].colorWriteMask, 1u);
    EXPECT_FALSE(state.depthWrite);
    const auto& pass = std::get<ScenePass>(scene.steps[0]);
    EXPECT_EQ(pass.colors[0].clear.color.float32[2], 0.75f);
    EXPECT_EQ(pass.draws[0].viewport.width, 20);
    EXPECT_EQ(pass.draws[0].scissor.offset.y, 2);
    EXPECT_THAT(pass.draws[0].pushConstants, SizeIs(4));
    EXPECT_EQ(pass.draws[1].viewport.height, -4);
    EXPECT_EQ(pass.draws[1].scissor.extent.width, 20u);
}

TEST(SceneRecorder, KeepsTheFirstShaderError) {
    SceneRecorder record("broken", "For tests.");
    record.fragment("#version 450\nvoid main() { nothing; }");
    record.fragment("#version 450\nvoid main() { later; }");
    const Result<Scene> scene = record.finish();
    ASSERT_FALSE(scene.ok());
    EXPECT_THAT(scene.error().message, HasSubstr("broken/shader0.frag:2"));
    EXPECT_THAT(scene.error().message, HasSubstr("nothing"));
}

TEST(ValidateScene, NamesWhatIsWrong) {
    EXPECT_TRUE(validateScene(smallScene()).ok());
    const auto message = [](auto breakIt) {
        Scene scene = smallScene();
        breakIt(scene);
        const Status status = validateScene(scene);
        return status.ok() ? std::string("passed") : status.error().message;
    };
    EXPECT_THAT(message([](Scene& s) { s.outputs = {3}; }), HasSubstr("outputs is 3, must be below 1"));
    EXPECT_THAT(message([](Scene& s) { s.outputs.clear(); }), HasSubstr("no outputs"));
    EXPECT_THAT(message([](Scene& s) { s.images[0].format = VK_FORMAT_G8B8G8R8_422_UNORM; }),
                HasSubstr("images[0].format"));
    EXPECT_THAT(message([](Scene& s) { s.images[0].extent.width = 0; }), HasSubstr("images[0].extent"));
    EXPECT_THAT(message([](Scene& s) { s.images[0].data = {Bytes(5)}; }), HasSubstr("5 bytes, not 128"));
    EXPECT_THAT(message([](Scene& s) { s.images[0].data = {{}, {}}; }), HasSubstr("2 entries"));
    EXPECT_THAT(message([](Scene& s) { s.images[0].samples = VK_SAMPLE_COUNT_4_BIT; }), HasSubstr("multisampled"));
    EXPECT_THAT(message([](Scene& s) { s.pipelines[0].vertexShader = kNone; }), HasSubstr("vertexShader is absent"));
    EXPECT_THAT(message([](Scene& s) { s.pipelines[0].blend.clear(); }), HasSubstr("blends 0 targets"));
    EXPECT_THAT(message([](Scene& s) { s.shaders[1].spirv.clear(); }), HasSubstr("shaders[1].spirv"));
    EXPECT_THAT(message([](Scene& s) { std::get<ScenePass>(s.steps[0]).draws[0].pipeline = 9; }),
                HasSubstr("pipeline is 9"));
    EXPECT_THAT(message([](Scene& s) { std::get<ScenePass>(s.steps[0]).draws[0].pushConstants.resize(4); }),
                HasSubstr("pushConstants has 4"));
    EXPECT_THAT(message([](Scene& s) { s.steps.push_back(SceneGenerateMips{4}); }), HasSubstr("SceneGenerateMips"));
    EXPECT_THAT(message([](Scene& s) {
                    SceneBinding binding;
                    binding.type = VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT;
                    std::get<ScenePass>(s.steps[0]).draws[0].bindings.push_back(binding);
                }),
                HasSubstr("SceneBinding::type"));
    EXPECT_THAT(message([](Scene& s) {
                    SceneBinding binding;
                    binding.type = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
                    binding.buffer = 0;
                    s.buffers.push_back({"texels", 0, Bytes(16)});
                    std::get<ScenePass>(s.steps[0]).draws[0].bindings.push_back(binding);
                }),
                HasSubstr("texelFormat is 0"));
    EXPECT_THAT(message([](Scene& s) { std::get<ScenePass>(s.steps[0]).colors[0].layerCount = 2; }),
                HasSubstr("layerCount is 2"));
    EXPECT_THAT(message([](Scene& s) { s.pipelines[0].sampleLocations.resize(2); }),
                HasSubstr("sampleLocations has 2"));
    EXPECT_THAT(message([](Scene& s) { std::get<ScenePass>(s.steps[0]).draws[0].moreViews.resize(16); }),
                HasSubstr("moreViews"));
}

/// Building all scenes once, with the compiler's tables kept in between.
class AllScenes : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        ASSERT_EQ(vnRetainGlslCompiler(), VN_GLSL_SUCCESS);
        for (const SceneEntry& entry : allScenes()) {
            Result<Scene> scene = entry.build();
            ASSERT_TRUE(scene.ok()) << entry.name << ": " << scene.error().message;
            scenes_.push_back(std::move(scene).value());
        }
    }
    static void TearDownTestSuite() {
        scenes_.clear();
        vnReleaseGlslCompiler();
    }
    static std::vector<Scene> scenes_;
};
std::vector<Scene> AllScenes::scenes_;

TEST_F(AllScenes, AreManyAndTheirNamesAreTheirFunctions) {
    EXPECT_GE(allScenes().size(), 16u);
    std::set<std::string> names;
    for (size_t i = 0; i < scenes_.size(); ++i) {
        EXPECT_EQ(scenes_[i].name, allScenes()[i].name);
        EXPECT_TRUE(names.insert(scenes_[i].name).second) << scenes_[i].name << " twice";
        EXPECT_TRUE(std::all_of(scenes_[i].name.begin(), scenes_[i].name.end(),
                                [](unsigned char c) { return std::islower(c) || std::isdigit(c) || c == '_'; }));
        EXPECT_GT(scenes_[i].description.size(), 20u) << scenes_[i].name;
        EXPECT_EQ(findScene(scenes_[i].name), &allScenes()[i]);
    }
    EXPECT_EQ(findScene("no such scene"), nullptr);
}

TEST_F(AllScenes, AreValid) {
    for (const Scene& scene : scenes_) {
        const Status status = validateScene(scene);
        EXPECT_TRUE(status.ok()) << status.error().message;
    }
}

TEST_F(AllScenes, AreTheSameEachTime) {
    for (const char* name : {"shared_edges", "lit_model", "texture_bilinear"}) {
        const Result<Scene> first = findScene(name)->build(), second = findScene(name)->build();
        ASSERT_TRUE(first.ok() && second.ok());
        for (size_t i = 0; i < first.value().buffers.size(); ++i) {
            EXPECT_EQ(first.value().buffers[i].data, second.value().buffers[i].data) << name;
        }
        for (size_t i = 0; i < first.value().images.size(); ++i) {
            EXPECT_EQ(first.value().images[i].data, second.value().images[i].data) << name;
        }
    }
}

// What a pass or a copy leaves is defined: no attachment is loaded, sampled, copied or put out before it was
// written.
TEST_F(AllScenes, ReadOnlyWhatWasWritten) {
    for (const Scene& scene : scenes_) {
        std::vector<bool> written;
        for (const SceneImage& image : scene.images) written.push_back(!image.data.empty());
        for (const SceneStep& step : scene.steps) {
            if (const auto* pass = std::get_if<ScenePass>(&step)) {
                for (const SceneDraw& draw : pass->draws) {
                    for (const SceneBinding& each : draw.bindings) {
                        EXPECT_TRUE(each.image == kNone || written[each.image]) << scene.name;
                    }
                }
                const auto attach = [&](const SceneAttachment& each) {
                    if (each.image == kNone) return;
                    EXPECT_TRUE(each.loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR || written[each.image]) << scene.name;
                    written[each.image] = true;
                    if (each.resolveImage != kNone) written[each.resolveImage] = true;
                };
                for (const SceneAttachment& color : pass->colors) attach(color);
                attach(pass->depthStencil);
            } else if (const auto* copy = std::get_if<SceneCopyImage>(&step)) {
                EXPECT_TRUE(written[copy->source] && written[copy->destination]) << scene.name;
            } else if (const auto* blit = std::get_if<SceneBlitImage>(&step)) {
                EXPECT_TRUE(written[blit->source] && written[blit->destination]) << scene.name;
            }
        }
        for (const uint32_t output : scene.outputs) EXPECT_TRUE(written[output]) << scene.name;
    }
}

TEST(Shapes, MeshesAreClosedAndFaceOutwards) {
    for (const Mesh& mesh : {cubeMesh(), sphereMesh(12, 6)}) {
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const glm::vec3 a = mesh.vertices[mesh.indices[i]].position,
                            b = mesh.vertices[mesh.indices[i + 1]].position,
                            c = mesh.vertices[mesh.indices[i + 2]].position;
            const glm::vec3 normal = glm::cross(b - a, c - a);
            EXPECT_GT(glm::dot(normal, a + b + c), 0) << "triangle " << i / 3;
        }
    }
}

TEST(Shapes, RandomNumbersAreTheSameEverywhere) {
    // The published PCG-XSH-RR step from a known state.
    SceneRandom random(42);
    const uint32_t first = random.next(), second = random.next();
    SceneRandom again(42);
    EXPECT_EQ(again.next(), first);
    EXPECT_EQ(again.next(), second);
    EXPECT_NE(first, second);
    for (int i = 0; i < 1000; ++i) {
        const float unit = random.unit();
        EXPECT_TRUE(unit >= 0 && unit < 1);
    }
}

}  // namespace
}  // namespace vernier::conformance
