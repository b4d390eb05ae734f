#include "tests/peers/texture_lab.h"

#include <gtest/gtest.h>
#include <vernier/vernier_glsl.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>

namespace vernier::test {
namespace {

constexpr const char* kWantedExtensions[] = {
    VK_KHR_MAINTENANCE_1_EXTENSION_NAME,         VK_KHR_MAINTENANCE_2_EXTENSION_NAME,
    VK_EXT_CUSTOM_BORDER_COLOR_EXTENSION_NAME,   VK_EXT_SAMPLER_FILTER_MINMAX_EXTENSION_NAME,
    VK_EXT_NON_SEAMLESS_CUBE_MAP_EXTENSION_NAME, VK_KHR_SAMPLER_MIRROR_CLAMP_TO_EDGE_EXTENSION_NAME,
    VK_EXT_4444_FORMATS_EXTENSION_NAME,          VK_EXT_IMAGE_VIEW_MIN_LOD_EXTENSION_NAME,
    VK_EXT_IMAGE_2D_VIEW_OF_3D_EXTENSION_NAME,   VK_EXT_BORDER_COLOR_SWIZZLE_EXTENSION_NAME,
};

template <class T>
T make(VkStructureType type, const void* next = nullptr) {
    T result{};
    result.sType = type;
    result.pNext = const_cast<void*>(next);
    return result;
}

#define LAB_CHECK(call) EXPECT_EQ(call, VK_SUCCESS)

}  // namespace

struct TextureLab::Block {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint8_t* data = nullptr;
};

struct TextureLab::Texture {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkSampler sampler = VK_NULL_HANDLE;
};

LabSampler::LabSampler() : info(make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO)) {
    info.maxLod = VK_LOD_CLAMP_NONE;
    info.maxAnisotropy = 1;
}

std::unique_ptr<TextureLab> TextureLab::open(const std::string& manifest) {
    if (!std::filesystem::exists(manifest)) return nullptr;
    setenv("VK_ICD_FILENAMES", manifest.c_str(), 1);
    setenv("VK_DRIVER_FILES", manifest.c_str(), 1);
    std::unique_ptr<TextureLab> lab(new TextureLab);
    auto application = make<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.apiVersion = VK_API_VERSION_1_0;
    const char* instanceExtension = VK_KHR_GET_PHYSICAL_DEVICE_PROPERTIES_2_EXTENSION_NAME;
    auto info = make<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &application;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &instanceExtension;
    uint32_t count = 1;
    if (vkCreateInstance(&info, nullptr, &lab->instance_) != VK_SUCCESS) return nullptr;
    if (vkEnumeratePhysicalDevices(lab->instance_, &count, &lab->physical_) < 0 || count == 0) return nullptr;

    vkEnumerateDeviceExtensionProperties(lab->physical_, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> properties(count);
    vkEnumerateDeviceExtensionProperties(lab->physical_, nullptr, &count, properties.data());
    std::vector<const char*> names;
    for (const char* wanted : kWantedExtensions) {
        for (const VkExtensionProperties& p : properties) {
            if (std::strcmp(p.extensionName, wanted) != 0) continue;
            names.push_back(wanted);
            lab->extensions_.emplace_back(wanted);
        }
    }
    // Features of the extensions, all that there are.
    auto border = make<VkPhysicalDeviceCustomBorderColorFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CUSTOM_BORDER_COLOR_FEATURES_EXT);
    auto seams = make<VkPhysicalDeviceNonSeamlessCubeMapFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_NON_SEAMLESS_CUBE_MAP_FEATURES_EXT);
    auto minLod = make<VkPhysicalDeviceImageViewMinLodFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_VIEW_MIN_LOD_FEATURES_EXT);
    auto packed =
        make<VkPhysicalDevice4444FormatsFeaturesEXT>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_4444_FORMATS_FEATURES_EXT);
    auto slices = make<VkPhysicalDeviceImage2DViewOf3DFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_2D_VIEW_OF_3D_FEATURES_EXT);
    auto swizzle = make<VkPhysicalDeviceBorderColorSwizzleFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BORDER_COLOR_SWIZZLE_FEATURES_EXT);
    auto features = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
    const auto chain = [&](const char* extension, auto& structure) {
        if (!lab->has(extension)) return;
        structure.pNext = features.pNext;
        features.pNext = &structure;
    };
    chain(VK_EXT_CUSTOM_BORDER_COLOR_EXTENSION_NAME, border);
    chain(VK_EXT_NON_SEAMLESS_CUBE_MAP_EXTENSION_NAME, seams);
    chain(VK_EXT_IMAGE_VIEW_MIN_LOD_EXTENSION_NAME, minLod);
    chain(VK_EXT_4444_FORMATS_EXTENSION_NAME, packed);
    chain(VK_EXT_IMAGE_2D_VIEW_OF_3D_EXTENSION_NAME, slices);
    chain(VK_EXT_BORDER_COLOR_SWIZZLE_EXTENSION_NAME, swizzle);
    const auto getFeatures = reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2KHR>(
        vkGetInstanceProcAddr(lab->instance_, "vkGetPhysicalDeviceFeatures2KHR"));
    getFeatures(lab->physical_, &features);

    const float priority = 1;
    auto queueInfo = make<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    auto deviceInfo = make<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features);
    deviceInfo.queueCreateInfoCount = 1;
    deviceInfo.pQueueCreateInfos = &queueInfo;
    deviceInfo.enabledExtensionCount = static_cast<uint32_t>(names.size());
    deviceInfo.ppEnabledExtensionNames = names.data();
    LAB_CHECK(vkCreateDevice(lab->physical_, &deviceInfo, nullptr, &lab->device_));
    if (lab->device_ == VK_NULL_HANDLE) return nullptr;
    vkGetDeviceQueue(lab->device_, 0, 0, &lab->queue_);
    auto poolInfo = make<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    LAB_CHECK(vkCreateCommandPool(lab->device_, &poolInfo, nullptr, &lab->pool_));
    return lab;
}

TextureLab::~TextureLab() {
    if (device_ != VK_NULL_HANDLE) {
        vkDestroyCommandPool(device_, pool_, nullptr);
        vkDestroyDevice(device_, nullptr);
    }
    if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

VkPhysicalDeviceFeatures TextureLab::features() const {
    VkPhysicalDeviceFeatures features;
    vkGetPhysicalDeviceFeatures(physical_, &features);
    return features;
}

bool TextureLab::has(const char* extension) const {
    return std::find(extensions_.begin(), extensions_.end(), extension) != extensions_.end();
}

TextureLab::Block TextureLab::allocate(VkDeviceSize size, VkBufferUsageFlags usage) {
    Block block;
    auto info = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = size;
    info.usage = usage;
    LAB_CHECK(vkCreateBuffer(device_, &info, nullptr, &block.buffer));
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device_, block.buffer, &needs);
    auto memory = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    memory.allocationSize = needs.size;  // every driver here has one memory type, host-visible
    LAB_CHECK(vkAllocateMemory(device_, &memory, nullptr, &block.memory));
    LAB_CHECK(vkBindBufferMemory(device_, block.buffer, block.memory, 0));
    void* data = nullptr;
    LAB_CHECK(vkMapMemory(device_, block.memory, 0, VK_WHOLE_SIZE, 0, &data));
    block.data = static_cast<uint8_t*>(data);
    return block;
}

void TextureLab::destroy(const Block& block) {
    vkDestroyBuffer(device_, block.buffer, nullptr);
    vkFreeMemory(device_, block.memory, nullptr);
}

VkShaderModule TextureLab::makeShader(VkShaderStageFlagBits stage, const std::string& glsl) {
    VnGlslDesc desc{};
    desc.stage = stage;
    desc.source = glsl.c_str();
    desc.target = VN_GLSL_TARGET_VULKAN_1_0;
    VnGlslOutput* output = nullptr;
    const VnGlslResult result = vnCompileGlsl(&desc, &output);
    EXPECT_EQ(result, VN_GLSL_SUCCESS) << (output != nullptr ? output->log : "") << glsl;
    VkShaderModule module = VK_NULL_HANDLE;
    if (result == VN_GLSL_SUCCESS) {
        auto info = make<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
        info.codeSize = output->wordCount * 4;
        info.pCode = output->words;
        LAB_CHECK(vkCreateShaderModule(device_, &info, nullptr, &module));
    }
    vnFreeGlslOutput(output);
    return module;
}

void TextureLab::bind(Texture& texture, const VkImageCreateInfo& info) {
    LAB_CHECK(vkCreateImage(device_, &info, nullptr, &texture.image));
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device_, texture.image, &needs);
    auto memory = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    memory.allocationSize = needs.size;
    LAB_CHECK(vkAllocateMemory(device_, &memory, nullptr, &texture.memory));
    LAB_CHECK(vkBindImageMemory(device_, texture.image, texture.memory, 0));
}

TextureLab::Texture TextureLab::makeTarget(VkFormat format, VkExtent2D extent) {
    Texture texture;
    auto info = make<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    bind(texture, info);
    auto view = make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = texture.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    LAB_CHECK(vkCreateImageView(device_, &view, nullptr, &texture.view));
    return texture;
}

TextureLab::Texture TextureLab::makeTexture(const LabImage& image, const LabSampler& sampler) {
    Texture texture;
    auto info = make<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.flags = image.flags;
    info.imageType = image.type;
    info.format = image.format;
    info.extent = image.extent;
    info.mipLevels = image.levels;
    info.arrayLayers = image.layers;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    bind(texture, info);

    auto minLod = make<VkImageViewMinLodCreateInfoEXT>(VK_STRUCTURE_TYPE_IMAGE_VIEW_MIN_LOD_CREATE_INFO_EXT);
    minLod.minLod = image.minLod;
    auto view =
        make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, image.minLod != 0 ? &minLod : nullptr);
    view.image = texture.image;
    view.viewType = image.viewType;
    view.format = image.viewFormat != VK_FORMAT_UNDEFINED ? image.viewFormat : image.format;
    view.components = image.swizzle;
    view.subresourceRange = {image.aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    if (image.viewType == VK_IMAGE_VIEW_TYPE_2D) view.subresourceRange.layerCount = 1;
    LAB_CHECK(vkCreateImageView(device_, &view, nullptr, &texture.view));

    VkSamplerCreateInfo samplerInfo = sampler.info;
    auto border =
        make<VkSamplerCustomBorderColorCreateInfoEXT>(VK_STRUCTURE_TYPE_SAMPLER_CUSTOM_BORDER_COLOR_CREATE_INFO_EXT);
    border.customBorderColor = sampler.border;
    border.format = view.format;
    auto reduction = make<VkSamplerReductionModeCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO);
    reduction.reductionMode = sampler.reduction;
    if (samplerInfo.borderColor >= VK_BORDER_COLOR_FLOAT_CUSTOM_EXT) {
        border.pNext = samplerInfo.pNext;
        samplerInfo.pNext = &border;
    }
    if (sampler.reduction != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE) {
        reduction.pNext = samplerInfo.pNext;
        samplerInfo.pNext = &reduction;
    }
    LAB_CHECK(vkCreateSampler(device_, &samplerInfo, nullptr, &texture.sampler));

    std::vector<uint8_t> bytes;
    std::vector<VkBufferImageCopy> copies;
    for (uint32_t level = 0; level < image.levels; ++level) {
        VkBufferImageCopy copy{};
        copy.bufferOffset = bytes.size();
        copy.imageSubresource = {image.aspect, level, 0, image.layers};
        copy.imageExtent = {std::max(1u, image.extent.width >> level), std::max(1u, image.extent.height >> level),
                            std::max(1u, image.extent.depth >> level)};
        copies.push_back(copy);
        bytes.insert(bytes.end(), image.data[level].begin(), image.data[level].end());
        bytes.resize((bytes.size() + 15) / 16 * 16);
    }
    const Block staging = allocate(bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    std::memcpy(staging.data, bytes.data(), bytes.size());

    const VkCommandBuffer commands = begin();
    auto barrier = make<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.image = texture.image;
    VkImageAspectFlags aspects = image.aspect;
    if (image.format == VK_FORMAT_D24_UNORM_S8_UINT || image.format == VK_FORMAT_D32_SFLOAT_S8_UINT) {
        aspects = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    }
    barrier.subresourceRange = {aspects, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    const auto wait = [&] {
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                             nullptr, 0, nullptr, 1, &barrier);
    };
    wait();
    vkCmdCopyBufferToImage(commands, staging.buffer, texture.image, VK_IMAGE_LAYOUT_GENERAL,
                           static_cast<uint32_t>(copies.size()), copies.data());
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_GENERAL;
    wait();
    submit(commands);
    destroy(staging);
    return texture;
}

void TextureLab::destroy(const Texture& texture) {
    vkDestroySampler(device_, texture.sampler, nullptr);
    vkDestroyImageView(device_, texture.view, nullptr);
    vkDestroyImage(device_, texture.image, nullptr);
    vkFreeMemory(device_, texture.memory, nullptr);
}

std::vector<Vec4> TextureLab::look(const LabImage& image, const LabSampler& sampler, const std::string& samplerType,
                                   const std::string& glsl, const std::vector<Vec4>& inputs, VkExtent2D extent) {
    constexpr VkFormat kTarget = VK_FORMAT_R32G32B32A32_SFLOAT;
    const uint32_t count = extent.width * extent.height;
    const Texture texture = makeTexture(image, sampler);
    const Texture target = makeTarget(kTarget, extent);
    const Block in = allocate(std::max<size_t>(inputs.size(), 1) * sizeof(Vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    std::memcpy(in.data, inputs.data(), inputs.size() * sizeof(Vec4));
    const Block out = allocate(count * sizeof(Vec4), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkShaderModule vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
void main() { gl_Position = vec4(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1, 0, 1); })");
    const VkShaderModule fragment = makeShader(
        VK_SHADER_STAGE_FRAGMENT_BIT,
        "#version 450\n#extension GL_EXT_samplerless_texture_functions : enable\nlayout(binding = 0) uniform " +
            samplerType +
            " tex;\nlayout(binding = 1) readonly buffer In { vec4 v[]; } input_;\nlayout(location = 0) out vec4 "
            "color_;\n"
            "vec4 in_(int i) { return input_.v[i]; }\nvec4 look(ivec2 at, int i) {\n" +
            glsl + "\n}\nvoid main() { ivec2 at = ivec2(gl_FragCoord.xy); color_ = look(at, at.y * " +
            std::to_string(extent.width) + " + at.x); }\n");

    constexpr VkDescriptorType kTypes[2] = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                            VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    VkDescriptorSetLayoutBinding bindings[2]{};
    for (uint32_t i = 0; i < 2; ++i) bindings[i] = {i, kTypes[i], 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
    auto layoutInfo = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    layoutInfo.bindingCount = 2;
    layoutInfo.pBindings = bindings;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    LAB_CHECK(vkCreateDescriptorSetLayout(device_, &layoutInfo, nullptr, &setLayout));
    const VkDescriptorPoolSize sizes[2] = {{kTypes[0], 1}, {kTypes[1], 1}};
    auto poolInfo = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 2;
    poolInfo.pPoolSizes = sizes;
    VkDescriptorPool descriptorPool = VK_NULL_HANDLE;
    LAB_CHECK(vkCreateDescriptorPool(device_, &poolInfo, nullptr, &descriptorPool));
    auto setInfo = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    setInfo.descriptorPool = descriptorPool;
    setInfo.descriptorSetCount = 1;
    setInfo.pSetLayouts = &setLayout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    LAB_CHECK(vkAllocateDescriptorSets(device_, &setInfo, &set));
    const VkDescriptorImageInfo imageInfo{texture.sampler, texture.view, VK_IMAGE_LAYOUT_GENERAL};
    const VkDescriptorBufferInfo bufferInfo{in.buffer, 0, VK_WHOLE_SIZE};
    for (uint32_t i = 0; i < 2; ++i) {
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set;
        write.dstBinding = i;
        write.descriptorCount = 1;
        write.descriptorType = kTypes[i];
        write.pImageInfo = &imageInfo;
        write.pBufferInfo = &bufferInfo;
        vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
    }
    auto pipelineLayoutInfo = make<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    pipelineLayoutInfo.setLayoutCount = 1;
    pipelineLayoutInfo.pSetLayouts = &setLayout;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    LAB_CHECK(vkCreatePipelineLayout(device_, &pipelineLayoutInfo, nullptr, &layout));

    VkAttachmentDescription attachment{};
    attachment.format = kTarget;
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    const VkSubpassDependency dependency{0,
                                         VK_SUBPASS_EXTERNAL,
                                         VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                         VK_PIPELINE_STAGE_TRANSFER_BIT,
                                         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                         VK_ACCESS_TRANSFER_READ_BIT,
                                         0};
    auto passInfo = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    passInfo.attachmentCount = 1;
    passInfo.pAttachments = &attachment;
    passInfo.subpassCount = 1;
    passInfo.pSubpasses = &subpass;
    passInfo.dependencyCount = 1;
    passInfo.pDependencies = &dependency;
    VkRenderPass pass = VK_NULL_HANDLE;
    LAB_CHECK(vkCreateRenderPass(device_, &passInfo, nullptr, &pass));
    auto framebufferInfo = make<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
    framebufferInfo.renderPass = pass;
    framebufferInfo.attachmentCount = 1;
    framebufferInfo.pAttachments = &target.view;
    framebufferInfo.width = extent.width;
    framebufferInfo.height = extent.height;
    framebufferInfo.layers = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    LAB_CHECK(vkCreateFramebuffer(device_, &framebufferInfo, nullptr, &framebuffer));
    const VkPipeline pipeline = makePipeline(vertex, fragment, layout, pass, extent);

    const VkCommandBuffer commands = begin();
    auto beginInfo = make<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    beginInfo.renderPass = pass;
    beginInfo.framebuffer = framebuffer;
    beginInfo.renderArea.extent = extent;
    vkCmdBeginRenderPass(commands, &beginInfo, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {extent.width, extent.height, 1};
    vkCmdCopyImageToBuffer(commands, target.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, out.buffer, 1, &copy);
    auto barrier = make<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                         nullptr, 0, nullptr);
    submit(commands);
    std::vector<Vec4> result(count);
    std::memcpy(result.data(), out.data, count * sizeof(Vec4));

    vkDestroyPipeline(device_, pipeline, nullptr);
    vkDestroyFramebuffer(device_, framebuffer, nullptr);
    vkDestroyRenderPass(device_, pass, nullptr);
    vkDestroyPipelineLayout(device_, layout, nullptr);
    vkDestroyDescriptorPool(device_, descriptorPool, nullptr);
    vkDestroyDescriptorSetLayout(device_, setLayout, nullptr);
    vkDestroyShaderModule(device_, vertex, nullptr);
    vkDestroyShaderModule(device_, fragment, nullptr);
    destroy(in);
    destroy(out);
    destroy(target);
    destroy(texture);
    return result;
}

VkPipeline TextureLab::makePipeline(VkShaderModule vertex, VkShaderModule fragment, VkPipelineLayout layout,
                                    VkRenderPass pass, VkExtent2D extent) {
    VkPipelineShaderStageCreateInfo stages[2];
    for (VkPipelineShaderStageCreateInfo& stage : stages) {
        stage = make<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
        stage.pName = "main";
    }
    stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    stages[0].module = vertex;
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[1].module = fragment;
    const auto vertexInput =
        make<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    auto assembly =
        make<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport area{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    const VkRect2D scissor{{0, 0}, extent};
    auto viewport = make<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    viewport.viewportCount = viewport.scissorCount = 1;
    viewport.pViewports = &area;
    viewport.pScissors = &scissor;
    auto raster =
        make<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    raster.lineWidth = 1;
    auto samples = make<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineColorBlendAttachmentState blend{};
    blend.colorWriteMask = 0xf;
    auto color = make<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    color.attachmentCount = 1;
    color.pAttachments = &blend;
    auto info = make<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &vertexInput;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pColorBlendState = &color;
    info.layout = layout;
    info.renderPass = pass;
    VkPipeline pipeline = VK_NULL_HANDLE;
    LAB_CHECK(vkCreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
    return pipeline;
}

VkCommandBuffer TextureLab::begin() {
    auto info = make<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool = pool_;
    info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    LAB_CHECK(vkAllocateCommandBuffers(device_, &info, &commands));
    const auto beginInfo = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    LAB_CHECK(vkBeginCommandBuffer(commands, &beginInfo));
    return commands;
}

void TextureLab::submit(VkCommandBuffer commands) {
    LAB_CHECK(vkEndCommandBuffer(commands));
    auto info = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    LAB_CHECK(vkQueueSubmit(queue_, 1, &info, VK_NULL_HANDLE));
    LAB_CHECK(vkQueueWaitIdle(queue_));
    vkFreeCommandBuffers(device_, pool_, 1, &commands);
}

std::vector<uint8_t> randomBytes(size_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<uint8_t> bytes(count);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random() >> 11);
    return bytes;
}

}  // namespace vernier::test
