// The image operand MinLod (shaderResourceMinLod): which level a sample comes from.
#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{64, 64};

class MinLodTest : public DrawTest {
  protected:
    static constexpr uint32_t kLevels = 4;

    void SetUp() override {
        DrawTest::SetUp();
        color_ = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent,
                           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        pass_ = makePass(color_);
        makeTexture();
        makeDescriptors();
    }

    /// As large as the target, so that a full-screen draw samples level 0; level n is n / 4 throughout.
    void makeTexture() {
        auto info =
            flatImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        info.mipLevels = kLevels;
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, kLevels, 0, 1};
        texture_ = makeImage(info).image;
        view_ = makeView(texture_, VK_IMAGE_VIEW_TYPE_2D, info.format, all);
        const VkCommandBuffer commands = begin();
        const auto move = [&](VkImageLayout from, VkImageLayout to) {
            changeLayout(commands, texture_, VK_IMAGE_ASPECT_COLOR_BIT, from, to);
        };
        move(VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        for (uint32_t level = 0; level < kLevels; ++level) {
            const VkClearColorValue value{{static_cast<float>(level) / 4, 0, 0, 1}};
            const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, level, 1, 0, 1};
            vkCmdClearColorImage(commands, texture_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value, 1, &range);
        }
        move(VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        submit(commands);
    }

    void makeDescriptors() {
        auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
        samplerInfo.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
        samplerInfo.maxLod = VK_LOD_CLAMP_NONE;
        VkSampler sampler = VK_NULL_HANDLE;
        ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
        defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
        const VkDescriptorSetLayout setLayout =
            makeSetLayout({{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}});
        set_ = makeEmptySet(setLayout, {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1}});
        const VkDescriptorImageInfo image{sampler, view_, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set_;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        write.pImageInfo = &image;
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
        layout_ = makeLayout({setLayout}, 0);
    }

    /// The level of detail that a fragment shader's `sampled`, a vec4 from the sampler2D t at the vec2 at, is taken
    /// from, at two places: left and right of the middle.
    std::array<float, 2> levelOf(const std::string& sampled) {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.layout = layout_;
        desc.vertex = fullScreen();
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
#extension GL_ARB_sparse_texture_clamp : require
layout(set = 0, binding = 0) uniform sampler2D t;
layout(location = 0) out vec4 color;
void main() {
    vec2 at = gl_FragCoord.xy / 64.0;
    color = )" + sampled + ";\n}\n");
        const VkPipeline pipeline = makePipeline(pass_.pass, desc);
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass_);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set_, 0, nullptr);
        vkCmdDraw(commands, 3, 1, 0, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        const auto texels = readImage(color_, VK_IMAGE_ASPECT_COLOR_BIT, 4);
        const auto level = [&](uint32_t x) {
            return static_cast<float>(pixelAt(texels, color_, x, 30) & 0xFF) / 255.0f * 4;
        };
        return {level(10), level(50)};
    }

    TestImage color_;
    Pass pass_;
    VkImage texture_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
};

TEST_F(MinLodTest, keepsSamplesOffFinerLevels) {
    struct Case {
        const char* sampled;
        float left, right;
    };
    const Case cases[] = {
        {"texture(t, at)", 0, 0},
        {"textureClampARB(t, at, 0.0)", 0, 0},
        {"textureClampARB(t, at, 2.0)", 2, 2},
        {"textureClampARB(t, at, 1.5)", 1.5f, 1.5f},
        {"textureClampARB(t, at * 4.0, 1.0)", 2, 2},  // coarser already
        {"textureClampARB(t, at, -3.0)", 0, 0},
        {"textureClampARB(t, at, 100.0)", 3, 3},  // the last there is
        {"textureClampARB(t, at, at.x < 0.5 ? 1.0 : 3.0)", 1, 3},
        {"textureClampARB(t, at, 1.0, 2.0)", 2, 2},  // the bias comes first
        {"textureClampARB(t, at, 1.0, 0.5)", 1, 1},
        {"textureGradClampARB(t, at, vec2(2.0 / 64.0, 0), vec2(0, 2.0 / 64.0), 0.5)", 1, 1},
        {"textureGradClampARB(t, at, vec2(2.0 / 64.0, 0), vec2(0, 2.0 / 64.0), 2.5)", 2.5f, 2.5f},
        {"textureOffsetClampARB(t, at, ivec2(1), 2.0)", 2, 2},
    };
    for (const Case& c : cases) {
        const auto level = levelOf(c.sampled);
        EXPECT_NEAR(level[0], c.left, 0.02f) << c.sampled;
        EXPECT_NEAR(level[1], c.right, 0.02f) << c.sampled;
    }
}

}  // namespace
}  // namespace vernier::test
