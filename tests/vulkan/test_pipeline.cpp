#include "tests/vulkan/test_pipeline.h"

#include "tests/vulkan/pipeline_states.h"

namespace vernier::test {

uint32_t pixelAt(const std::vector<uint8_t>& texels, const TestImage& image, uint32_t x, uint32_t y) {
    uint32_t value = 0;
    std::memcpy(&value, texels.data() + 4 * (size_t{y} * image.extent.width + x), 4);
    return value;
}

DrawTest::Pass DrawTest::makePass(const TestImage& color, const TestImage* depth, const TestImage* resolve,
                                  VkSampleCountFlagBits samples, uint32_t layers, uint32_t viewMask) {
    if (resolve == nullptr) samples = VK_SAMPLE_COUNT_1_BIT;
    std::vector<VkAttachmentDescription> attachments;
    std::vector<VkImageView> views;
    const auto add = [&](const TestImage& image, VkSampleCountFlagBits count, VkImageLayout final) {
        attachments.push_back({0, image.format, count, VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE,
                               VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_DONT_CARE,
                               VK_IMAGE_LAYOUT_UNDEFINED, final});
        views.push_back(image.view);
        return static_cast<uint32_t>(attachments.size() - 1);
    };
    const VkAttachmentReference colorReference{add(color, samples, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
                                               VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkAttachmentReference depthReference{}, resolveReference{};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &colorReference;
    if (depth != nullptr) {
        depthReference = {add(*depth, samples, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
                          VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
        subpass.pDepthStencilAttachment = &depthReference;
    }
    if (resolve != nullptr) {
        resolveReference = {add(*resolve, VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
                            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        subpass.pResolveAttachments = &resolveReference;
    }
    Pass result;
    result.extent = color.extent;
    result.clears.resize(attachments.size());
    if (depth != nullptr) result.clears[1].depthStencil.depth = 1;
    auto info = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    info.attachmentCount = static_cast<uint32_t>(attachments.size());
    info.pAttachments = attachments.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    auto multiview = make<VkRenderPassMultiviewCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_MULTIVIEW_CREATE_INFO);
    multiview.subpassCount = 1;
    multiview.pViewMasks = &viewMask;
    if (viewMask != 0) info.pNext = &multiview;
    EXPECT_EQ(vkCreateRenderPass(device, &info, nullptr, &result.pass), VK_SUCCESS);
    makeFramebuffer(result, views, viewMask != 0 ? 1 : layers);  // views choose theirs
    return result;
}

void DrawTest::makeFramebuffer(Pass& pass, const std::vector<VkImageView>& views, uint32_t layers) {
    auto info = make<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
    info.renderPass = pass.pass;
    info.attachmentCount = static_cast<uint32_t>(views.size());
    info.pAttachments = views.data();
    info.width = pass.extent.width;
    info.height = pass.extent.height;
    info.layers = layers;
    EXPECT_EQ(vkCreateFramebuffer(device, &info, nullptr, &pass.framebuffer), VK_SUCCESS);
    defer([this, pass] {
        vkDestroyFramebuffer(device, pass.framebuffer, nullptr);
        vkDestroyRenderPass(device, pass.pass, nullptr);
    });
}

VkDescriptorSetLayout DrawTest::makeSetLayout(const std::vector<VkDescriptorSetLayoutBinding>& bindings) {
    auto info = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    info.bindingCount = static_cast<uint32_t>(bindings.size());
    info.pBindings = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout), VK_SUCCESS);
    defer([this, layout] { vkDestroyDescriptorSetLayout(device, layout, nullptr); });
    return layout;
}

VkDescriptorSet DrawTest::makeEmptySet(VkDescriptorSetLayout layout, const std::vector<VkDescriptorPoolSize>& sizes,
                                       VkDescriptorPoolCreateFlags flags) {
    auto info = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    info.flags = flags;
    info.maxSets = 1;
    info.poolSizeCount = static_cast<uint32_t>(sizes.size());
    info.pPoolSizes = sizes.data();
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateDescriptorPool(device, &info, nullptr, &descriptors), VK_SUCCESS);
    defer([this, descriptors] { vkDestroyDescriptorPool(device, descriptors, nullptr); });
    auto allocation = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocation.descriptorPool = descriptors;
    allocation.descriptorSetCount = 1;
    allocation.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    EXPECT_EQ(vkAllocateDescriptorSets(device, &allocation, &set), VK_SUCCESS);
    return set;
}

VkPipelineLayout DrawTest::makeLayout(const std::vector<VkDescriptorSetLayout>& sets, uint32_t pushBytes,
                                      VkShaderStageFlags pushStages) {
    const VkPushConstantRange range{pushStages, 0, pushBytes};
    auto info = make<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    info.setLayoutCount = static_cast<uint32_t>(sets.size());
    info.pSetLayouts = sets.data();
    info.pushConstantRangeCount = pushBytes != 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreatePipelineLayout(device, &info, nullptr, &layout), VK_SUCCESS);
    defer([this, layout] { vkDestroyPipelineLayout(device, layout, nullptr); });
    return layout;
}

VkPipeline DrawTest::makePipeline(VkRenderPass pass, const PipelineDesc& desc, VkResult expected) {
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    const auto addStage = [&](VkShaderStageFlagBits stage, VkShaderModule module, const VkSpecializationInfo* special) {
        if (module != VK_NULL_HANDLE) stages.push_back(stageOf(stage, module, special));
    };
    addStage(VK_SHADER_STAGE_VERTEX_BIT, desc.vertex, nullptr);
    addStage(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, desc.control, nullptr);
    addStage(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, desc.evaluation, nullptr);
    addStage(VK_SHADER_STAGE_GEOMETRY_BIT, desc.geometry, desc.specialization);
    addStage(VK_SHADER_STAGE_FRAGMENT_BIT, desc.fragment, desc.specialization);

    PlainStates states(desc.extent);
    states.input.vertexBindingDescriptionCount = static_cast<uint32_t>(desc.bindings.size());
    states.input.pVertexBindingDescriptions = desc.bindings.data();
    states.input.vertexAttributeDescriptionCount = static_cast<uint32_t>(desc.attributes.size());
    states.input.pVertexAttributeDescriptions = desc.attributes.data();
    states.multisample.rasterizationSamples = desc.samples;
    auto depth =
        make<VkPipelineDepthStencilStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
    depth.depthTestEnable = depth.depthWriteEnable = desc.depthTest ? VK_TRUE : VK_FALSE;
    depth.depthCompareOp = VK_COMPARE_OP_LESS;
    std::vector<VkPipelineColorBlendAttachmentState> blends(desc.colorCount, states.blend);
    states.colors.attachmentCount = desc.colorCount;
    states.colors.pAttachments = blends.data();
    auto dynamic = make<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
    dynamic.dynamicStateCount = static_cast<uint32_t>(desc.dynamic.size());
    dynamic.pDynamicStates = desc.dynamic.data();
    if (desc.change)
        desc.change({states.input, states.assembly, states.viewports, states.raster, states.multisample, depth,
                     states.colors, blends});

    auto origin = make<VkPipelineTessellationDomainOriginStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO);
    origin.domainOrigin =
        desc.domainLowerLeft ? VK_TESSELLATION_DOMAIN_ORIGIN_LOWER_LEFT : VK_TESSELLATION_DOMAIN_ORIGIN_UPPER_LEFT;
    auto tessellation =
        make<VkPipelineTessellationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO);
    tessellation.pNext = &origin;
    tessellation.patchControlPoints = desc.patchControlPoints;

    auto info = states.with(stages, desc.layout != VK_NULL_HANDLE ? desc.layout : makeLayout({}, 0), pass);
    info.pNext = desc.next;
    info.flags = desc.flags;
    info.pTessellationState = desc.patchControlPoints != 0 ? &tessellation : nullptr;
    info.pDepthStencilState = &depth;
    info.pDynamicState = &dynamic;
    info.subpass = desc.subpass;
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(createPipeline(info, &pipeline), expected) << (messages.empty() ? "" : messages.back());
    defer([this, pipeline] { vkDestroyPipeline(device, pipeline, nullptr); });
    return pipeline;
}

VkResult DrawTest::createPipeline(const VkGraphicsPipelineCreateInfo& info, VkPipeline* pipeline) {
    return vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, pipeline);
}

void DrawTest::beginPass(VkCommandBuffer commands, const Pass& pass, VkSubpassContents contents) {
    auto info = make<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    info.renderPass = pass.pass;
    info.framebuffer = pass.framebuffer;
    info.renderArea.extent = pass.extent;
    info.clearValueCount = static_cast<uint32_t>(pass.clears.size());
    info.pClearValues = pass.clears.data();
    vkCmdBeginRenderPass(commands, &info, contents);
}

void DrawTest::drawTriangle(const Pass& pass, VkPipeline pipeline, VkPipelineLayout layout, VkDescriptorSet set) {
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    if (set != VK_NULL_HANDLE)
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
}

VkShaderModule DrawTest::fullScreen(const std::string& z) {
    return makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
void main() {
    vec2 p = vec2(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1);
    gl_Position = vec4(p, )" + z + R"(, 1);
})");
}

VkShaderModule DrawTest::constantColor(const std::string& rgba) {
    return makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4()" + rgba + "); }");
}

}  // namespace vernier::test
