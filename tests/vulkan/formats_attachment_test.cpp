// Every format that can be drawn to, blended in, tested against: what passes leave in the image.
#include "tests/vulkan/formats_test.h"

namespace vernier::test {
namespace {

class FormatAttachments : public FormatsTest {
  protected:
    /// A texel of the image, as bytes.
    static std::vector<uint8_t> texelOf(const std::vector<uint8_t>& bytes, size_t size, uint32_t x, uint32_t y) {
        const auto first = bytes.begin() + static_cast<ptrdiff_t>((size_t{y} * kFormatSize + x) * size);
        return {first, first + static_cast<ptrdiff_t>(size)};
    }
    static std::string literal(const VkClearColorValue& color, ValueType type) {
        std::string text = std::string(kPrefix[static_cast<size_t>(type)]) + "vec4(";
        for (int c = 0; c < 4; ++c) {
            text += c == 0 ? "" : ", ";
            text += type == ValueType::floating ? std::to_string(color.float32[c]) : std::to_string(color.int32[c]);
        }
        return text + ")";
    }
    VkShaderModule colorShader(const VkClearColorValue& color, ValueType type) {
        const std::string glsl = "#version 450\nlayout(location = 0) out " +
                                 std::string(kPrefix[static_cast<size_t>(type)]) +
                                 "vec4 color;\nvoid main() { color = " + literal(color, type) + "; }";
        VkShaderModule& module = shaders_[glsl];
        if (module == VK_NULL_HANDLE) module = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, glsl);
        return module;
    }
    VkShaderModule triangle() {
        if (triangle_ == VK_NULL_HANDLE) triangle_ = fullScreen("0.3");
        return triangle_;
    }

  private:
    std::map<std::string, VkShaderModule> shaders_;
    VkShaderModule triangle_ = VK_NULL_HANDLE;
};

TEST_F(FormatAttachments, clearsAndDrawsEncode) {
    forEachImageCase(VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, [&](const Case& of) {
        const TestImage image = makeImage(of, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        const VkClearColorValue drawn = plainColor(of.layout());
        VkClearColorValue cleared = drawn;
        std::swap(cleared.uint32[0], cleared.uint32[1]);
        Pass pass = makePass(image);
        pass.clears[0].color = cleared;
        PipelineDesc desc;
        desc.vertex = triangle();
        desc.fragment = colorShader(drawn, of.layout().type);
        desc.extent = {kFormatSize / 2, kFormatSize};
        drawTriangle(pass, makePipeline(pass.pass, desc));
        const std::vector<uint8_t> bytes = download(image, of, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const std::vector<uint8_t> left = packed(of, drawn), right = packed(of, cleared);
        EXPECT_EQ(texelOf(bytes, left.size(), 3, 3), left);
        EXPECT_EQ(texelOf(bytes, right.size(), kFormatSize - 2, 3), right);
    });
}

TEST_F(FormatAttachments, blendingAddsToWhatIsThere) {
    forEachImageCase(VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT, [&](const Case& of) {
        const TestImage image = makeImage(of, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        const VkClearColorValue below{.float32 = {0.25f, 0.5f, 0.125f, 0.75f}},
            above{.float32 = {0.5f, 0.25f, 0.5f, 0}};
        Pass pass = makePass(image);
        pass.clears[0].color = below;
        PipelineDesc desc;
        desc.vertex = triangle();
        desc.fragment = colorShader(above, ValueType::floating);
        desc.extent = image.extent;
        desc.change = [](const PipelineStates& states) {
            states.blends[0].blendEnable = VK_TRUE;
            states.blends[0].srcColorBlendFactor = states.blends[0].dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
            states.blends[0].srcAlphaBlendFactor = states.blends[0].dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        };
        drawTriangle(pass, makePipeline(pass.pass, desc));
        const std::vector<uint8_t> bytes = download(image, of, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const std::vector<uint8_t> stored = packed(of, below);
        uint8_t whole[16] = {};
        copyTexelsFromBuffer(*of.info, of.aspect, stored.data(), 1, whole);
        VkClearColorValue sum = unpackTexel(of.layout(), whole);
        for (int c = 0; c < 4; ++c) sum.float32[c] += above.float32[c];
        const std::vector<uint8_t> wanted = packed(of, sum);
        EXPECT_EQ(texelOf(bytes, wanted.size(), 5, 6), wanted);
    });
}

TEST_F(FormatAttachments, depthAndStencilAreTestedAndStored) {
    forEachImageCase(VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT, [&](const Case& of) {
        // The attachment has all aspects, one of which is looked at.
        const TestImage target = makeImage(of, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        const VkImageView view =
            makeView(target.image, VK_IMAGE_VIEW_TYPE_2D, target.format, {of.info->aspects, 0, 1, 0, 1});
        const VkAttachmentDescription attachment{0,
                                                 target.format,
                                                 VK_SAMPLE_COUNT_1_BIT,
                                                 VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                 VK_ATTACHMENT_STORE_OP_STORE,
                                                 VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                 VK_ATTACHMENT_STORE_OP_STORE,
                                                 VK_IMAGE_LAYOUT_UNDEFINED,
                                                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
        const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
        VkSubpassDescription subpass{};
        subpass.pDepthStencilAttachment = &reference;
        auto passInfo = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
        passInfo.attachmentCount = 1;
        passInfo.pAttachments = &attachment;
        passInfo.subpassCount = 1;
        passInfo.pSubpasses = &subpass;
        Pass pass;
        pass.extent = target.extent;
        pass.clears.resize(1);
        pass.clears[0].depthStencil = {0.7f, 0x21};
        ASSERT_EQ(vkCreateRenderPass(device, &passInfo, nullptr, &pass.pass), VK_SUCCESS);
        makeFramebuffer(pass, {view});
        PipelineDesc desc;
        desc.vertex = triangle();
        desc.colorCount = 0;
        desc.depthTest = true;
        desc.extent = {kFormatSize / 2, kFormatSize};
        desc.change = [](const PipelineStates& states) {
            states.depth.stencilTestEnable = VK_TRUE;
            states.depth.front = {
                VK_STENCIL_OP_KEEP, VK_STENCIL_OP_INVERT, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_EQUAL, 0xFF, 0xFF, 0x21};
            states.depth.back = states.depth.front;
        };
        drawTriangle(pass, makePipeline(pass.pass, desc));
        const std::vector<uint8_t> bytes = download(target, of, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const bool stencil = of.aspect == VK_IMAGE_ASPECT_STENCIL_BIT;
        const std::vector<uint8_t> left =
            packed(of, stencil ? VkClearColorValue{.uint32 = {0xDE}} : VkClearColorValue{.float32 = {0.3f}});
        const std::vector<uint8_t> right =
            packed(of, stencil ? VkClearColorValue{.uint32 = {0x21}} : VkClearColorValue{.float32 = {0.7f}});
        EXPECT_EQ(texelOf(bytes, left.size(), 3, 3), left);
        EXPECT_EQ(texelOf(bytes, right.size(), kFormatSize - 2, 3), right);
    });
}

}  // namespace
}  // namespace vernier::test
