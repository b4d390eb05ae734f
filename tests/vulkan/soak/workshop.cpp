#include "tests/vulkan/soak/workshop.h"

#include "tests/vulkan/pipeline_states.h"

namespace vernier::soak {
namespace {

constexpr const char* kVertex = R"(#version 450
void main() { gl_Position = vec4(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1, 0, 1); })";
constexpr const char* kFragment = R"(#version 450
layout(push_constant) uniform Color { uint color; };
layout(location = 0) out vec4 pixel;
void main() { pixel = unpackUnorm4x8(color + uint(gl_FragCoord.x) + (uint(gl_FragCoord.y) << 8)); })";
constexpr const char* kMultiply = R"(#version 450
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Words { uint words[]; };
layout(push_constant) uniform Factors { uint factor, added; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < words.length()) words[i] = words[i] * factor + added + i;
})";

}  // namespace

Workshop::Workshop(Context& context, Random& random)
    : verdict_(context.verdict), device_(context.device), random_(random) {
    vertex_ = context.compile(VK_SHADER_STAGE_VERTEX_BIT, kVertex);
    fragment_ = context.compile(VK_SHADER_STAGE_FRAGMENT_BIT, kFragment);
    multiply_ = context.compile(VK_SHADER_STAGE_COMPUTE_BIT, kMultiply);
    makeLayouts();
    makePass();
}

Workshop::~Workshop() {
    for (const VkShaderModule module : {vertex_, fragment_, multiply_}) vkDestroyShaderModule(device_, module, nullptr);
    vkDestroyPipelineLayout(device_, drawLayout_, nullptr);
    vkDestroyPipelineLayout(device_, computeLayout_, nullptr);
    vkDestroyDescriptorSetLayout(device_, setLayout_, nullptr);
    vkDestroyRenderPass(device_, pass_, nullptr);
}

void Workshop::makeLayouts() {
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT,
                                               nullptr};
    auto setInfo = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    setInfo.bindingCount = 1;
    setInfo.pBindings = &binding;
    SOAK_CHECK(verdict_, vkCreateDescriptorSetLayout, device_, &setInfo, nullptr, &setLayout_);
    for (const bool compute : {false, true}) {
        const VkPushConstantRange range{compute ? VkShaderStageFlags{VK_SHADER_STAGE_COMPUTE_BIT}
                                                : VkShaderStageFlags{VK_SHADER_STAGE_FRAGMENT_BIT},
                                        0, compute ? 8u : 4u};
        auto info = make<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
        info.setLayoutCount = compute ? 1 : 0;
        info.pSetLayouts = &setLayout_;
        info.pushConstantRangeCount = 1;
        info.pPushConstantRanges = &range;
        SOAK_CHECK(verdict_, vkCreatePipelineLayout, device_, &info, nullptr, compute ? &computeLayout_ : &drawLayout_);
    }
}

VkDeviceMemory Workshop::allocate(const VkMemoryRequirements& needs) const {
    auto info = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    info.allocationSize = needs.size;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    SOAK_CHECK(verdict_, vkAllocateMemory, device_, &info, nullptr, &memory);
    return memory;
}

std::shared_ptr<SoakBuffer> Workshop::makeBuffer(uint32_t words) {
    std::shared_ptr<SoakBuffer> made(new SoakBuffer, [device = device_](SoakBuffer* buffer) {
        vkDestroyBuffer(device, buffer->buffer, nullptr);
        vkFreeMemory(device, buffer->memory, nullptr);
        delete buffer;
    });
    auto info = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = VkDeviceSize{words} * 4;
    info.usage =
        VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    SOAK_CHECK(verdict_, vkCreateBuffer, device_, &info, nullptr, &made->buffer);
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device_, made->buffer, &needs);
    made->memory = allocate(needs);
    SOAK_CHECK(verdict_, vkBindBufferMemory, device_, made->buffer, made->memory, 0);
    void* data = nullptr;
    SOAK_CHECK(verdict_, vkMapMemory, device_, made->memory, 0, VK_WHOLE_SIZE, 0, &data);
    made->words = static_cast<uint32_t*>(data);
    made->model.resize(words);
    for (uint32_t i = 0; i < words && made->words != nullptr; ++i) made->words[i] = made->model[i] = random_();
    return made;
}

std::shared_ptr<SoakImage> Workshop::makeImage() {
    std::shared_ptr<SoakImage> made(new SoakImage, [device = device_](SoakImage* image) {
        vkDestroyFramebuffer(device, image->framebuffer, nullptr);
        vkDestroyImageView(device, image->view, nullptr);
        vkDestroyImage(device, image->image, nullptr);
        vkFreeMemory(device, image->memory, nullptr);
        delete image;
    });
    made->extent = {1 + below(random_, 200), 1 + below(random_, 200)};
    made->model.resize(size_t{made->extent.width} * made->extent.height);
    const auto info = flatImage(
        VK_FORMAT_R8G8B8A8_UNORM, made->extent,
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    SOAK_CHECK(verdict_, vkCreateImage, device_, &info, nullptr, &made->image);
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device_, made->image, &needs);
    made->memory = allocate(needs);
    SOAK_CHECK(verdict_, vkBindImageMemory, device_, made->image, made->memory, 0);
    auto view = make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = made->image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = info.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    SOAK_CHECK(verdict_, vkCreateImageView, device_, &view, nullptr, &made->view);
    auto framebuffer = make<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
    framebuffer.renderPass = pass_;
    framebuffer.attachmentCount = 1;
    framebuffer.pAttachments = &made->view;
    framebuffer.width = made->extent.width;
    framebuffer.height = made->extent.height;
    framebuffer.layers = 1;
    SOAK_CHECK(verdict_, vkCreateFramebuffer, device_, &framebuffer, nullptr, &made->framebuffer);
    return made;
}

void Workshop::makePass() {
    const VkAttachmentDescription attachment{0,
                                             VK_FORMAT_R8G8B8A8_UNORM,
                                             VK_SAMPLE_COUNT_1_BIT,
                                             VK_ATTACHMENT_LOAD_OP_LOAD,
                                             VK_ATTACHMENT_STORE_OP_STORE,
                                             VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                             VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                             VK_IMAGE_LAYOUT_GENERAL,
                                             VK_IMAGE_LAYOUT_GENERAL};
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_GENERAL};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    auto info = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    info.attachmentCount = info.subpassCount = 1;
    info.pAttachments = &attachment;
    info.pSubpasses = &subpass;
    SOAK_CHECK(verdict_, vkCreateRenderPass, device_, &info, nullptr, &pass_);
}

VkPipeline Workshop::makeDrawing() const {
    const VkPipelineShaderStageCreateInfo stages[] = {test::stageOf(VK_SHADER_STAGE_VERTEX_BIT, vertex_),
                                                      test::stageOf(VK_SHADER_STAGE_FRAGMENT_BIT, fragment_)};
    const test::PlainStates states(VkExtent2D{});
    const VkDynamicState commanded[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    auto dynamic = make<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = commanded;
    auto info = states.with(stages, drawLayout_, pass_);
    info.pDynamicState = &dynamic;
    VkPipeline pipeline = VK_NULL_HANDLE;
    SOAK_CHECK(verdict_, vkCreateGraphicsPipelines, device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
    return pipeline;
}

VkPipeline Workshop::makeCompute() const {
    auto info = make<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage = test::stageOf(VK_SHADER_STAGE_COMPUTE_BIT, multiply_);
    info.layout = computeLayout_;
    VkPipeline pipeline = VK_NULL_HANDLE;
    SOAK_CHECK(verdict_, vkCreateComputePipelines, device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
    return pipeline;
}

}  // namespace vernier::soak
