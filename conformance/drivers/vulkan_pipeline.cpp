// The part of VulkanPassBuilder that makes pipelines.
#include "conformance/drivers/stopwatch.h"
#include "conformance/drivers/vulkan_passes.h"
#include "conformance/drivers/vulkan_pipeline_state.h"

#include <array>

namespace vernier::conformance {

Result<VkShaderModule> VulkanPassBuilder::shaderModule(uint32_t index) {
    if (modules_[index] != VK_NULL_HANDLE) return modules_[index];
    const VkDevice device = context_.device();
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = scene_.shaders[index].spirv.size() * sizeof(uint32_t);
    info.pCode = scene_.shaders[index].spirv.data();
    VkShaderModule shader = VK_NULL_HANDLE;
    const Stopwatch watch;
    VERNIER_TRY_VK(vkCreateShaderModule(device, &info, nullptr, &shader));
    moduleTime_ += watch.milliseconds();
    resources_.cleanup().add([device, shader] { vkDestroyShaderModule(device, shader, nullptr); });
    modules_[index] = shader;
    return shader;
}

Result<VulkanPipeline> VulkanPassBuilder::createPipeline(const SceneDraw& draw, VkRenderPass renderPass) {
    const VkDevice device = context_.device();
    const ScenePipeline& scene = scene_.pipelines[draw.pipeline];
    VERNIER_TRY(checkFeatures(scene, draw));
    VulkanPipeline pipeline;
    VERNIER_TRY(createLayouts(draw, pipeline));

    std::vector<VkPipelineShaderStageCreateInfo> stages;
    std::array<VkSpecializationInfo, 5> specializations{};
    for (const uint32_t index : stagesOf(scene)) {
        if (index == kNone) continue;
        const Result<VkShaderModule> shader = shaderModule(index);
        if (!shader) return shader.error();
        const SceneShader& source = scene_.shaders[index];
        VkSpecializationInfo& specialization = specializations[stages.size()];
        specialization = {static_cast<uint32_t>(source.specialization.size()), source.specialization.data(),
                          source.specializationData.size(), source.specializationData.data()};
        VkPipelineShaderStageCreateInfo stage{};
        stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stage.stage = source.stage;
        stage.module = *shader;
        stage.pName = "main";
        stage.pSpecializationInfo = source.specialization.empty() ? nullptr : &specialization;
        stages.push_back(stage);
    }
    const VulkanPipelineState state(scene, static_cast<uint32_t>(1 + draw.moreViews.size()));
    VkGraphicsPipelineCreateInfo info = state.info();
    info.stageCount = static_cast<uint32_t>(stages.size());
    info.pStages = stages.data();
    info.layout = pipeline.layout;
    info.renderPass = renderPass;
    VERNIER_TRY_VK(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline.handle));
    resources_.cleanup().add([device, handle = pipeline.handle] { vkDestroyPipeline(device, handle, nullptr); });
    return pipeline;
}

}  // namespace vernier::conformance
