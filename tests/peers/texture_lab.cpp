#include "tests/peers/texture_lab.h"

#include <gtest/gtest.h>
#include <vernier/vernier_glsl.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>

#include "tests/peers/texture_lab_parts.h"

namespace vernier::test {
namespace {

constexpr const char* kWantedExtensions[] = {
    VK_KHR_MAINTENANCE_1_EXTENSION_NAME,         VK_KHR_MAINTENANCE_2_EXTENSION_NAME,
    VK_EXT_CUSTOM_BORDER_COLOR_EXTENSION_NAME,   VK_EXT_SAMPLER_FILTER_MINMAX_EXTENSION_NAME,
    VK_EXT_NON_SEAMLESS_CUBE_MAP_EXTENSION_NAME, VK_KHR_SAMPLER_MIRROR_CLAMP_TO_EDGE_EXTENSION_NAME,
    VK_EXT_4444_FORMATS_EXTENSION_NAME,          VK_EXT_IMAGE_VIEW_MIN_LOD_EXTENSION_NAME,
    VK_EXT_IMAGE_2D_VIEW_OF_3D_EXTENSION_NAME,   VK_EXT_BORDER_COLOR_SWIZZLE_EXTENSION_NAME,
};

}  // namespace

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
    bind(texture, flatImage(format, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
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
    view.subresourceRange = {image.aspect, 0, image.levels, 0, VK_REMAINING_ARRAY_LAYERS};
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
