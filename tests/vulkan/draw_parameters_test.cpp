// BaseVertex, BaseInstance and DrawIndex (VK_KHR_shader_draw_parameters), in every way to draw.
#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

/// What a vertex shader saw, by draw, instance and vertex of the draw.
struct Seen {
    int32_t baseVertex = 0, baseInstance = 0, vertex = 0, instance = 0;
    bool operator==(const Seen&) const = default;
};
void PrintTo(const Seen& seen, std::ostream* out) {
    *out << "base vertex " << seen.baseVertex << ", base instance " << seen.baseInstance << ", vertex " << seen.vertex
         << ", instance " << seen.instance;
}

constexpr uint32_t kDraws = 4, kInstances = 4, kVertices = 4;

class DrawParametersTest : public ComputeTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_KHR_SHADER_DRAW_PARAMETERS_EXTENSION_NAME, VK_EXT_MULTI_DRAW_EXTENSION_NAME,
                VK_KHR_STORAGE_BUFFER_STORAGE_CLASS_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        draws_.multiDraw = VK_TRUE;
        return &draws_;
    }
    void SetUp() override {
        ComputeTest::SetUp();
        color_ = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {8, 8}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        pass_ = makePass(color_);
        out_ = makeStorage(kDraws * kInstances * kVertices * 4);
        VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
        set_ = makeSet({storageBuffer(out_)}, &setLayout);
        PipelineDesc desc;
        desc.extent = {8, 8};
        desc.layout = layout_ = makeLayout({setLayout}, 0);
        // Writes to where it stands in the draw, whatever the draw's numbers are.
        desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 460
layout(set = 0, binding = 0) buffer Out { ivec4 seen[]; };
void main() {
    int at = (gl_DrawID * 4 + gl_InstanceIndex - gl_BaseInstance) * 4 + gl_VertexIndex - gl_BaseVertex;
    if (at >= 0 && at < 64) seen[at] = ivec4(gl_BaseVertex, gl_BaseInstance, gl_VertexIndex, gl_InstanceIndex);
    gl_Position = vec4(0, 0, 0, 1);
    gl_PointSize = 1.0;
})");
        desc.change = [](const PipelineStates& states) {
            states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;  // any number of vertices
        };
        desc.fragment = constantColor("1, 1, 1, 1");
        pipeline_ = makePipeline(pass_.pass, desc);
    }
    /// What the shader saw while the commands were run; places that nothing was written to are all -1.
    std::vector<Seen> draw(const std::function<void(VkCommandBuffer)>& record) {
        std::memset(out_.data, 0xFF, out_.size);
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass_);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set_, 0, nullptr);
        record(commands);
        vkCmdEndRenderPass(commands);
        makeVisible(commands);
        submit(commands);
        std::vector<Seen> seen(kDraws * kInstances * kVertices);
        std::memcpy(seen.data(), out_.data, out_.size);
        return seen;
    }
    /// One draw of a command, as the shader should see it.
    struct Draw {
        int32_t baseVertex = 0;
        uint32_t baseInstance = 0, vertices = 3, instances = 1;
    };
    static void check(const std::vector<Seen>& seen, const std::vector<Draw>& draws) {
        std::vector<Seen> expected(kDraws * kInstances * kVertices, Seen{-1, -1, -1, -1});
        for (size_t d = 0; d < draws.size(); ++d)
            for (uint32_t i = 0; i < draws[d].instances; ++i)
                for (uint32_t v = 0; v < draws[d].vertices; ++v) {
                    const auto first = static_cast<int32_t>(draws[d].baseInstance);
                    expected[(d * kInstances + i) * kVertices + v] = {draws[d].baseVertex, first,
                                                                      draws[d].baseVertex + static_cast<int32_t>(v),
                                                                      first + static_cast<int32_t>(i)};
                }
        for (uint32_t at = 0; at < seen.size(); ++at) {
            EXPECT_EQ(seen[at], expected[at]) << "draw " << at / (kInstances * kVertices) << ", place " << at;
        }
    }

    TestImage color_;
    Pass pass_;
    TestBuffer out_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;

  private:
    VkPhysicalDeviceMultiDrawFeaturesEXT draws_ =
        make<VkPhysicalDeviceMultiDrawFeaturesEXT>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTI_DRAW_FEATURES_EXT);
};

// DrawIndex is 0 but for the draws of one command.
TEST_F(DrawParametersTest, directDraws) {
    check(draw([&](VkCommandBuffer commands) { vkCmdDraw(commands, 3, 2, 100, 7); }), {{100, 7, 3, 2}});
    const auto twice = draw([&](VkCommandBuffer commands) {
        vkCmdDraw(commands, 3, 1, 4, 0);
        vkCmdDraw(commands, 4, 4, 9, 11);
    });
    check(twice, {{9, 11, 4, 4}});
}

// The base is the vertex offset, not the first index.
TEST_F(DrawParametersTest, indexedDraws) {
    const TestBuffer indices = makeBuffer(32, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    const std::array<uint16_t, 7> order{9, 9, 0, 1, 2, 3, 0};
    std::memcpy(indices.data, order.data(), sizeof order);
    for (const int32_t offset : {50, 0, -3}) {
        const auto seen = draw([&](VkCommandBuffer commands) {
            vkCmdBindIndexBuffer(commands, indices.buffer, 0, VK_INDEX_TYPE_UINT16);
            vkCmdDrawIndexed(commands, 3, 3, 2, offset, 5);
        });
        check(seen, {{offset, 5, 3, 3}});
    }
}

TEST_F(DrawParametersTest, indirectDraws) {
    const TestBuffer arguments = makeBuffer(256, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    const TestBuffer indices = makeBuffer(16, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    const std::array<uint16_t, 4> order{0, 1, 2, 3};
    std::memcpy(indices.data, order.data(), sizeof order);
    const std::array<VkDrawIndirectCommand, 4> plain{{{3, 1, 10, 1}, {3, 0, 0, 0}, {4, 4, 0, 0}, {3, 2, 20, 30}}};
    std::memcpy(arguments.data, plain.data(), sizeof plain);
    const auto seen =
        draw([&](VkCommandBuffer commands) { vkCmdDrawIndirect(commands, arguments.buffer, 0, 4, sizeof plain[0]); });
    check(seen, {{10, 1, 3, 1}, {0, 0, 0, 0}, {0, 0, 4, 4}, {20, 30, 3, 2}});
    const std::array<VkDrawIndexedIndirectCommand, 3> indexed{{{3, 1, 0, 70, 2}, {4, 2, 0, -2, 0}, {3, 3, 0, 1, 9}}};
    std::memcpy(arguments.data, indexed.data(), sizeof indexed);
    const auto others = draw([&](VkCommandBuffer commands) {
        vkCmdBindIndexBuffer(commands, indices.buffer, 0, VK_INDEX_TYPE_UINT16);
        vkCmdDrawIndexedIndirect(commands, arguments.buffer, 0, 3, sizeof indexed[0]);
    });
    check(others, {{70, 2, 3, 1}, {-2, 0, 4, 2}, {1, 9, 3, 3}});
}

TEST_F(DrawParametersTest, multiDraws) {
    const std::array<VkMultiDrawInfoEXT, 3> draws{{{40, 3}, {0, 4}, {8, 3}}};
    const auto seen = draw([&](VkCommandBuffer commands) {
        command<PFN_vkCmdDrawMultiEXT>("vkCmdDrawMultiEXT")(commands, 3, draws.data(), 2, 6, sizeof draws[0]);
    });
    check(seen, {{40, 6, 3, 2}, {0, 6, 4, 2}, {8, 6, 3, 2}});
}

}  // namespace
}  // namespace vernier::test
