// What most graphics pipelines of tests have in common, as descriptions: nothing here calls Vulkan.
#pragma once

#include <span>

#include "tests/vulkan/structures.h"

namespace vernier::test {

inline VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, VkShaderModule module,
                                               const VkSpecializationInfo* specialization = nullptr) {
    auto info = make<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage = stage;
    info.module = module;
    info.pName = "main";
    info.pSpecializationInfo = specialization;
    return info;
}

/// The states of a pipeline that draws opaque triangles without vertex buffers all over an image of one sample. The
/// structures point to each other, so it stays where it is.
struct PlainStates {
    explicit PlainStates(VkExtent2D extent)
        : area{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1}, scissor{{}, extent} {
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        viewports.viewportCount = viewports.scissorCount = 1;
        viewports.pViewports = &area;
        viewports.pScissors = &scissor;
        raster.lineWidth = 1;
        multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
        blend.colorWriteMask = 0xF;
        colors.attachmentCount = 1;
        colors.pAttachments = &blend;
    }
    PlainStates(const PlainStates&) = delete;
    PlainStates& operator=(const PlainStates&) = delete;

    /// The pipeline of these states and stages, as long as both last.
    VkGraphicsPipelineCreateInfo with(std::span<const VkPipelineShaderStageCreateInfo> stages, VkPipelineLayout layout,
                                      VkRenderPass pass) const {
        auto info = make<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
        info.stageCount = static_cast<uint32_t>(stages.size());
        info.pStages = stages.data();
        info.pVertexInputState = &input;
        info.pInputAssemblyState = &assembly;
        info.pViewportState = &viewports;
        info.pRasterizationState = &raster;
        info.pMultisampleState = &multisample;
        info.pColorBlendState = &colors;
        info.layout = layout;
        info.renderPass = pass;
        return info;
    }

    VkViewport area;
    VkRect2D scissor;
    VkPipelineVertexInputStateCreateInfo input =
        make<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    VkPipelineInputAssemblyStateCreateInfo assembly =
        make<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    VkPipelineViewportStateCreateInfo viewports =
        make<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    VkPipelineRasterizationStateCreateInfo raster =
        make<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    VkPipelineMultisampleStateCreateInfo multisample =
        make<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    VkPipelineColorBlendAttachmentState blend{};
    VkPipelineColorBlendStateCreateInfo colors =
        make<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
};

}  // namespace vernier::test
