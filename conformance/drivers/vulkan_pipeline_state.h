// The state of a scene's pipeline as Vulkan takes it.
#pragma once

#include "conformance/scene/scene.h"

#include <array>
#include <vector>

#include <vulkan/vulkan.h>

namespace vernier::conformance {

/// The shaders of a pipeline, in the order of its stages; kNone where there is no such stage.
std::array<uint32_t, 5> stagesOf(const ScenePipeline& scene);
/// Whether clipping by depth has to be said: where it is the opposite of clamping it need not.
bool saysDepthClip(const ScenePipeline& scene);

/// All of VkGraphicsPipelineCreateInfo but stages, layout and render pass. What it points to lies here and in the
/// scene.
class VulkanPipelineState {
  public:
    VulkanPipelineState(const ScenePipeline& scene, uint32_t viewports);
    VulkanPipelineState(const VulkanPipelineState&) = delete;
    VulkanPipelineState& operator=(const VulkanPipelineState&) = delete;

    VkGraphicsPipelineCreateInfo info() const;

  private:
    void setVertices();
    void setViewport(uint32_t viewports);
    void setRasterization();
    void setLines();
    void setSamples();
    void setDepthStencil();
    void setBlend();

    const ScenePipeline& scene_;
    VkPipelineVertexInputStateCreateInfo vertexInput_{};
    VkPipelineInputAssemblyStateCreateInfo assembly_{};
    VkPipelineTessellationDomainOriginStateCreateInfo origin_{};
    VkPipelineTessellationStateCreateInfo tessellation_{};
    VkPipelineViewportDepthClipControlCreateInfoEXT clipControl_{};
    VkPipelineViewportStateCreateInfo viewport_{};
    VkPipelineRasterizationLineStateCreateInfoEXT lines_{};
    VkPipelineRasterizationDepthClipStateCreateInfoEXT depthClip_{};
    VkPipelineRasterizationProvokingVertexStateCreateInfoEXT provoking_{};
    VkPipelineRasterizationStateCreateInfo raster_{};
    std::vector<VkSampleLocationEXT> locations_;
    VkPipelineSampleLocationsStateCreateInfoEXT sampleLocations_{};
    VkPipelineMultisampleStateCreateInfo multisample_{};
    VkPipelineDepthStencilStateCreateInfo depth_{};
    VkPipelineColorBlendStateCreateInfo blend_{};
    VkPipelineDynamicStateCreateInfo dynamic_{};
};

}  // namespace vernier::conformance
