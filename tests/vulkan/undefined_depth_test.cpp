// Depth tests where the attachment holds no numbers.
#include <algorithm>
#include <array>

#include "tests/vulkan/test_rendering.h"

namespace vernier::test {
namespace {

class UndefinedDepthTest : public RenderingTest {
  protected:
    struct Case {
        VkFormat format;
        bool stencil;
        VkShaderModule vertex, fragment;
        uint32_t vertices;
    };
    /// The components that white drawn over depths of all ones, which are NaN, leaves white.
    ptrdiff_t drawn(const Case& c, VkCompareOp compare) {
        const bool both = c.format == kDepth;
        VkImageAspectFlags aspects = VK_IMAGE_ASPECT_DEPTH_BIT;
        if (both) aspects |= VK_IMAGE_ASPECT_STENCIL_BIT;
        const TestImage depth = makeImage(c.format, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        void* data = nullptr;
        EXPECT_EQ(vkMapMemory(device, depth.memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
        std::memset(data, 0xFF, size_t{kExtent.width} * kExtent.height * (both ? 8 : 4));
        vkUnmapMemory(device, depth.memory);
        PipelineDesc desc;
        desc.vertex = c.vertex;
        desc.fragment = c.fragment;
        desc.depthTest = true;
        desc.change = [&](const PipelineStates& states) {
            states.depth.depthCompareOp = compare;
            states.depth.stencilTestEnable = c.stencil;
            states.depth.front.passOp = states.depth.back.passOp = VK_STENCIL_OP_INVERT;
            states.depth.front.compareOp = states.depth.back.compareOp = VK_COMPARE_OP_ALWAYS;
        };
        const VkPipeline pipeline = pipelineFor(desc, c.format, both ? c.format : VK_FORMAT_UNDEFINED);
        const VkCommandBuffer commands = begin();
        toColor(commands, color);
        moveTo(commands, depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, aspects);
        const VkRenderingAttachmentInfo attachment = attachColor(color);
        const VkRenderingAttachmentInfo undefined =
            attach(depth.view, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD);
        VkRenderingInfo info = rendering(attachment);
        info.pDepthAttachment = &undefined;
        if (both) info.pStencilAttachment = &undefined;
        beginRendering(commands, &info);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, c.vertices, 1, 0, 0);
        endRendering(commands);
        toSource(commands, color);
        submit(commands);
        const std::vector<uint8_t> bytes = readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
        return std::count(bytes.begin(), bytes.end(), 255);
    }
};

// Tests that pass whatever an attachment holds pass.
TEST_F(UndefinedDepthTest, depthsThatAreNoNumbers) {
    const VkShaderModule whole = fullScreen();
    const VkShaderModule cells = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
        void main() {
            const vec2 corners[6] = {{0, 0}, {1, 0}, {0, 1}, {0, 1}, {1, 0}, {1, 1}};
            const int cell = gl_VertexIndex / 6;
            gl_Position = vec4((vec2(cell % 24, cell / 24) + corners[gl_VertexIndex % 6]) / vec2(12, 10) - 1, 0.5, 1);
        })");
    constexpr uint32_t kCellVertices = 24 * 20 * 6;
    const VkShaderModule early = constantColor("1, 1, 1, 1");
    const VkShaderModule late = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
        layout(location = 0) out vec4 color;
        void main() { color = vec4(1); gl_FragDepth = 0.25; })");
    const std::array<Case, 6> cases{{{VK_FORMAT_D32_SFLOAT, false, whole, early, 3},
                                     {VK_FORMAT_D32_SFLOAT, false, whole, late, 3},
                                     {VK_FORMAT_D32_SFLOAT, false, cells, early, kCellVertices},
                                     {kDepth, false, cells, late, kCellVertices},
                                     {kDepth, false, whole, early, 3},
                                     {kDepth, true, whole, late, 3}}};
    for (size_t n = 0; n < cases.size(); ++n) {
        for (uint32_t op = VK_COMPARE_OP_NEVER; op <= VK_COMPARE_OP_ALWAYS; ++op) {
            const bool passes = op == VK_COMPARE_OP_NOT_EQUAL || op == VK_COMPARE_OP_ALWAYS;
            EXPECT_EQ(drawn(cases[n], static_cast<VkCompareOp>(op)),
                      passes ? ptrdiff_t{4} * kExtent.width * kExtent.height : 0)
                << "case " << n << ", operation " << op;
        }
    }
}

}  // namespace
}  // namespace vernier::test
