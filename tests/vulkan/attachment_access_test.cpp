// Fragments that read the attachments they draw to as inputs, in rasterisation order
// (VK_EXT_rasterization_order_attachment_access).
#include "tests/vulkan/test_inputs.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{80, 48};  // more than one tile of the rasteriser
constexpr uint32_t kPixels = kExtent.width * kExtent.height, kInstances = 20;
constexpr VkFormat kDepthStencil = VK_FORMAT_D32_SFLOAT_S8_UINT;

/// Squares of 2x2 pixels over the whole picture, two triangles each, at a depth that falls with the instance.
constexpr const char* kSquares = R"(#version 450
layout(location = 0) flat out uint instance;
void main() {
    int square = gl_VertexIndex / 6, corner = gl_VertexIndex % 6;
    vec2 at = vec2(square % 40, square / 40) + vec2(corner == 1 || corner > 3 ? 1 : 0, corner > 1 && corner != 4 ? 1 : 0);
    instance = uint(gl_InstanceIndex);
    gl_Position = vec4(at * 4 / vec2(80, 48) - 1, float(32 - gl_InstanceIndex) / 64, 1);
})";
constexpr uint32_t kSquareVertices = kPixels / 4 * 6;

/// Two triangles as large as the picture.
constexpr const char* kRectangle = R"(#version 450
layout(location = 0) flat out uint instance;
void main() {
    vec2 at = vec2(gl_VertexIndex == 1 || gl_VertexIndex > 3 ? 1 : -1, gl_VertexIndex > 1 && gl_VertexIndex != 4 ? 1 : -1);
    instance = uint(gl_InstanceIndex);
    gl_Position = vec4(at, float(32 - gl_InstanceIndex) / 64, 1);
})";

class AttachmentAccessTest : public InputsTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME,
                VK_ARM_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME};
    }
    void* moreFeatures() override { return &access_; }

    /// A subpass that draws to `color` and `depth` and has as inputs them both.
    Pass makeAccessPass(const TestImage& color, const TestImage& depth) {
        VkAttachmentDescription attachments[2] = {};
        for (uint32_t i = 0; i < 2; ++i) {
            attachments[i].format = i == 0 ? color.format : depth.format;
            attachments[i].samples = VK_SAMPLE_COUNT_1_BIT;
            attachments[i].loadOp = attachments[i].stencilLoadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
            attachments[i].storeOp = attachments[i].stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
            attachments[i].finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        }
        const VkAttachmentReference references[] = {{0, VK_IMAGE_LAYOUT_GENERAL}, {1, VK_IMAGE_LAYOUT_GENERAL}};
        VkSubpassDescription subpass{};
        subpass.flags = VK_SUBPASS_DESCRIPTION_RASTERIZATION_ORDER_ATTACHMENT_COLOR_ACCESS_BIT_EXT |
                        VK_SUBPASS_DESCRIPTION_RASTERIZATION_ORDER_ATTACHMENT_DEPTH_ACCESS_BIT_EXT |
                        VK_SUBPASS_DESCRIPTION_RASTERIZATION_ORDER_ATTACHMENT_STENCIL_ACCESS_BIT_EXT;
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = references;
        subpass.pDepthStencilAttachment = references + 1;
        subpass.inputAttachmentCount = 2;
        subpass.pInputAttachments = references;
        auto info = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
        info.attachmentCount = 2;
        info.pAttachments = attachments;
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        Pass pass;
        pass.extent = kExtent;
        pass.clears.resize(2);
        pass.clears[1].depthStencil = {1, 3};
        EXPECT_EQ(vkCreateRenderPass(device, &info, nullptr, &pass.pass), VK_SUCCESS);
        makeFramebuffer(pass, {color.view, depth.view});
        return pass;
    }

    /// The words of the colour after kInstances of `vertices` vertices in one draw, each fragment of which runs `glsl`;
    /// `change` is done to the pipeline, which says that it reads colour, depth and stencil.
    std::vector<uint32_t> draw(VkFormat format, const char* vertex, uint32_t vertices, const std::string& glsl,
                               const std::function<void(const PipelineStates&)>& change) {
        const VkImageUsageFlags input = VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
        const TestImage color = makeImage(format, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | input);
        const TestImage depth = makeImage(kDepthStencil, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | input);
        const Pass pass = makeAccessPass(color, depth);
        const auto aspect = [&](VkImageAspectFlags bits) {
            return makeView(depth.image, VK_IMAGE_VIEW_TYPE_2D, kDepthStencil, {bits, 0, 1, 0, 1});
        };
        VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
        const VkDescriptorSet set = makeInputs({{color.view, VK_IMAGE_LAYOUT_GENERAL},
                                                {aspect(VK_IMAGE_ASPECT_DEPTH_BIT), VK_IMAGE_LAYOUT_GENERAL},
                                                {aspect(VK_IMAGE_ASPECT_STENCIL_BIT), VK_IMAGE_LAYOUT_GENERAL}},
                                               &setLayout);
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, vertex);
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, glsl);
        desc.layout = makeLayout({setLayout}, 0);
        desc.change = [&](const PipelineStates& states) {
            states.colors.flags = VK_PIPELINE_COLOR_BLEND_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_BIT_EXT;
            states.depth.flags =
                VK_PIPELINE_DEPTH_STENCIL_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_DEPTH_ACCESS_BIT_EXT |
                VK_PIPELINE_DEPTH_STENCIL_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_STENCIL_ACCESS_BIT_EXT;
            change(states);
        };
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
        vkCmdDraw(commands, vertices, kInstances, 0, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        return asWords(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4));
    }

    VkPhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT access_{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_FEATURES_EXT, nullptr, VK_TRUE, VK_TRUE,
        VK_TRUE};
};

struct Mesh {
    const char* vertex;
    uint32_t vertices;
};
constexpr Mesh kMeshes[] = {{kRectangle, 6}, {kSquares, kSquareVertices}};

constexpr const char* kInstance = "#version 450\nlayout(location = 0) flat in uint instance;\n";

// Three times what is there, and the instance: any other order, or a fragment left out, gives another number.
TEST_F(AttachmentAccessTest, colorsInOrder) {
    const std::string glsl = std::string(kInstance) + R"(
layout(input_attachment_index = 0, set = 0, binding = 0) uniform usubpassInput color;
layout(location = 0) out uint o;
void main() { o = subpassLoad(color).x * 3u + instance + 1u; })";
    uint32_t expected = 0;
    for (uint32_t i = 0; i < kInstances; ++i) expected = expected * 3 + i + 1;
    for (const Mesh& mesh : kMeshes) {
        const auto words = draw(VK_FORMAT_R32_UINT, mesh.vertex, mesh.vertices, glsl, [](const PipelineStates&) {});
        for (uint32_t n = 0; n < kPixels; ++n) ASSERT_EQ(words[n], expected) << n;
    }
}

// The depths that fragments find, added up: that of the instance before.
TEST_F(AttachmentAccessTest, depthsInOrder) {
    const std::string glsl = std::string(kInstance) + R"(
layout(input_attachment_index = 0, set = 0, binding = 0) uniform usubpassInput color;
layout(input_attachment_index = 1, set = 0, binding = 1) uniform subpassInput depth;
layout(location = 0) out uint o;
void main() { o = subpassLoad(color).x * 3u + uint(subpassLoad(depth).x * 64.0); })";
    uint32_t expected = 0, depth = 64;
    for (uint32_t i = 0; i < kInstances; ++i) {
        expected = expected * 3 + depth;
        depth = 32 - i;
    }
    for (const Mesh& mesh : kMeshes) {
        const auto words = draw(VK_FORMAT_R32_UINT, mesh.vertex, mesh.vertices, glsl, [](const PipelineStates& states) {
            states.depth.depthTestEnable = states.depth.depthWriteEnable = VK_TRUE;
        });
        for (uint32_t n = 0; n < kPixels; ++n) ASSERT_EQ(words[n], expected) << n;
    }
}

TEST_F(AttachmentAccessTest, stencilsInOrder) {
    const std::string glsl = std::string(kInstance) + R"(
layout(input_attachment_index = 0, set = 0, binding = 0) uniform usubpassInput color;
layout(input_attachment_index = 1, set = 0, binding = 2) uniform usubpassInput stencil;
layout(location = 0) out uint o;
void main() { o = subpassLoad(color).x * 3u + subpassLoad(stencil).x; })";
    uint32_t expected = 0;
    for (uint32_t i = 0; i < kInstances; ++i) expected = expected * 3 + 3 + i;
    for (const Mesh& mesh : kMeshes) {
        const auto words = draw(VK_FORMAT_R32_UINT, mesh.vertex, mesh.vertices, glsl, [](const PipelineStates& states) {
            states.depth.stencilTestEnable = VK_TRUE;
            states.depth.front = {VK_STENCIL_OP_KEEP,
                                  VK_STENCIL_OP_INCREMENT_AND_CLAMP,
                                  VK_STENCIL_OP_KEEP,
                                  VK_COMPARE_OP_ALWAYS,
                                  0xFF,
                                  0xFF,
                                  0};
            states.depth.back = states.depth.front;
        });
        for (uint32_t n = 0; n < kPixels; ++n) ASSERT_EQ(words[n], expected) << n;
    }
}

}  // namespace
}  // namespace vernier::test
