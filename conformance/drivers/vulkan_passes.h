// A scene's render passes, framebuffers, pipelines and descriptor sets on a Vulkan device.
#pragma once

#include "conformance/drivers/vulkan_resources.h"
#include "conformance/scene/scene.h"

#include <vector>

namespace vernier::conformance {

/// Stages that see push constants and bindings: whichever the pipeline has.
constexpr VkShaderStageFlags kDrawStages = VK_SHADER_STAGE_ALL_GRAPHICS;

struct VulkanPipeline {
    std::vector<VkDescriptorSetLayout> setLayouts;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline handle = VK_NULL_HANDLE;
};

struct VulkanDraw {
    size_t pipeline = 0;  // into VulkanPass::pipelines
    std::vector<VkDescriptorSet> sets;
};

struct VulkanPass {
    VkRenderPass renderPass = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    std::vector<VkClearValue> clears;
    std::vector<VulkanPipeline> pipelines;
    std::vector<VulkanDraw> draws;  // one per ScenePass::draws
};

/// Makes passes ready to record. Everything is destroyed with the resources.
class VulkanPassBuilder {
  public:
    VulkanPassBuilder(VulkanContext& context, VulkanResources& resources, const Scene& scene)
        : context_(context), resources_(resources), scene_(scene) {}

    Result<VulkanPass> build(const ScenePass& pass);

    /// Milliseconds spent in creating shader modules, and in creating pipelines from them.
    double moduleTime() const { return moduleTime_; }
    double pipelineTime() const { return pipelineTime_; }

  private:
    /// The attachments of a pass, in the order of its clear values, and where its one subpass has them.
    struct Attachments {
        std::vector<VkAttachmentDescription> descriptions;
        std::vector<VkImageView> views;
        std::vector<VkAttachmentReference> colors, resolves;
        VkAttachmentReference depth{VK_ATTACHMENT_UNUSED, VK_IMAGE_LAYOUT_UNDEFINED};
        VkAttachmentReference depthResolve{VK_ATTACHMENT_UNUSED, VK_IMAGE_LAYOUT_UNDEFINED};
    };
    /// Adds an attachment, and what it resolves to where it does.
    Status attach(const SceneAttachment& attachment, VkImageLayout layout, VulkanPass& pass, Attachments& all,
                  VkAttachmentReference& reference, VkAttachmentReference& resolve);
    Status createAttachments(const ScenePass& scene, VulkanPass& pass, Attachments& all);
    Status createRenderPass(const ScenePass& scene, const Attachments& all, VulkanPass& pass);
    Status createFramebuffer(const ScenePass& scene, const Attachments& all, VulkanPass& pass);
    /// The same render pass with a resolve of its depth/stencil attachment to attachment `target`.
    Result<VkRenderPass> createResolvingRenderPass(const VkRenderPassCreateInfo& info, uint32_t viewMask,
                                                   const SceneAttachment& depth, uint32_t target);
    Result<VulkanPipeline> createPipeline(const SceneDraw& draw, VkRenderPass renderPass);
    Status createLayouts(const SceneDraw& draw, VulkanPipeline& pipeline);
    Result<VkShaderModule> shaderModule(uint32_t index);
    Result<std::vector<VkDescriptorSet>> createSets(const SceneDraw& draw, const VulkanPipeline& pipeline);
    Status checkFeatures(const ScenePipeline& scene, const SceneDraw& draw) const;
    Status checkStages(const ScenePipeline& scene) const;

    VulkanContext& context_;
    VulkanResources& resources_;
    const Scene& scene_;
    std::vector<VkShaderModule> modules_;
    double moduleTime_ = 0, pipelineTime_ = 0;
};

}  // namespace vernier::conformance
