#include "conformance/drivers/vulkan_resources.h"

#include "conformance/scene/scene_format.h"

#include <algorithm>
#include <cstring>

namespace vernier::conformance {
namespace {

struct UseState {
    VkImageLayout layout;
    VkPipelineStageFlags stages;
    VkAccessFlags access;
    bool writes;
};

UseState stateOf(ImageUse use, VkImageAspectFlags aspects) {
    switch (use) {
        case ImageUse::undefined:
            // The frame before may still be at it, in any way.
            return {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, true};
        case ImageUse::transferSource:
            return {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT,
                    false};
        case ImageUse::transferDestination:
            return {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                    true};
        case ImageUse::sampled:
            return {aspects == VK_IMAGE_ASPECT_COLOR_BIT ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
                                                         : VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                    VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT, VK_ACCESS_SHADER_READ_BIT, false};
        case ImageUse::storage:
            return {VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT,
                    VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT, true};
        case ImageUse::colorAttachment:
            return {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                    VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, true};
        case ImageUse::depthAttachment:
            return {VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                    VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
                    VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, true};
    }
    return {};
}

VkImageType imageType(VkImageViewType view) {
    if (view == VK_IMAGE_VIEW_TYPE_3D) return VK_IMAGE_TYPE_3D;
    return view == VK_IMAGE_VIEW_TYPE_1D || view == VK_IMAGE_VIEW_TYPE_1D_ARRAY ? VK_IMAGE_TYPE_1D : VK_IMAGE_TYPE_2D;
}

VkFormatFeatureFlags neededFeatures(VkImageUsageFlags usage) {
    VkFormatFeatureFlags features = 0;
    if ((usage & VK_IMAGE_USAGE_SAMPLED_BIT) != 0) features |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
    if ((usage & VK_IMAGE_USAGE_STORAGE_BIT) != 0) features |= VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
    if ((usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) != 0) features |= VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
    if ((usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0) {
        features |= VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
    }
    return features;
}

}  // namespace

Status VulkanResources::create(const Scene& scene) {
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.queueFamilyIndex = context_.queueFamily();
    VERNIER_TRY_VK(vkCreateCommandPool(context_.device(), &poolInfo, nullptr, &pool_));
    cleanup_.add([this] { vkDestroyCommandPool(context_.device(), pool_, nullptr); });
    VkFenceCreateInfo fenceInfo{};
    fenceInfo.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VERNIER_TRY_VK(vkCreateFence(context_.device(), &fenceInfo, nullptr, &fence_));
    cleanup_.add([this] { vkDestroyFence(context_.device(), fence_, nullptr); });

    for (const SceneBuffer& each : scene.buffers) {
        Result<VulkanBuffer> buffer = createHostBuffer(each.data.size(), each.usage);
        if (!buffer) return buffer.error();
        std::memcpy(buffer->mapped, each.data.data(), each.data.size());
        buffers_.push_back(*buffer);
    }
    for (const SceneImage& each : scene.images) VERNIER_TRY(createImage(each));
    for (const SceneSampler& each : scene.samplers) VERNIER_TRY(createSampler(each));
    return uploadImages();
}

Result<VkDeviceMemory> VulkanResources::allocate(const VkMemoryRequirements& requirements,
                                                 VkMemoryPropertyFlags properties) {
    const VkDevice device = context_.device();
    const Result<uint32_t> type = context_.memoryType(requirements.memoryTypeBits, properties);
    if (!type) return type.error();
    VkMemoryAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocation.allocationSize = requirements.size;
    allocation.memoryTypeIndex = *type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VERNIER_TRY_VK(vkAllocateMemory(device, &allocation, nullptr, &memory));
    cleanup_.add([device, memory] { vkFreeMemory(device, memory, nullptr); });
    return memory;
}

Result<VulkanBuffer> VulkanResources::createHostBuffer(VkDeviceSize size, VkBufferUsageFlags usage) {
    const VkDevice device = context_.device();
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = size;
    info.usage = usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VulkanBuffer buffer;
    VERNIER_TRY_VK(vkCreateBuffer(device, &info, nullptr, &buffer.handle));
    cleanup_.add([device, handle = buffer.handle] { vkDestroyBuffer(device, handle, nullptr); });
    VkMemoryRequirements requirements{};
    vkGetBufferMemoryRequirements(device, buffer.handle, &requirements);
    const Result<VkDeviceMemory> memory =
        allocate(requirements, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    if (!memory) return memory.error();
    VERNIER_TRY_VK(vkBindBufferMemory(device, buffer.handle, *memory, 0));
    VERNIER_TRY_VK(vkMapMemory(device, *memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped));
    return buffer;
}

Status VulkanResources::createImage(const SceneImage& scene) {
    const VkDevice device = context_.device();
    const VkFormatFeatureFlags missing =
        neededFeatures(scene.usage) & ~context_.formatProperties(scene.format).optimalTilingFeatures;
    if (missing != 0) {
        return unsupported("image '" + scene.name + "': " + std::string(sceneFormat(scene.format)->name) +
                           " lacks format features " + std::to_string(missing));
    }
    Image image;
    image.scene = &scene;
    image.aspects = sceneFormat(scene.format)->aspects;
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = imageType(scene.viewType);
    if (scene.viewType == VK_IMAGE_VIEW_TYPE_CUBE || scene.viewType == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY) {
        info.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
    }
    info.format = scene.format;
    info.extent = {scene.extent.width, scene.extent.height, scene.depth};
    info.mipLevels = scene.mipLevels;
    info.arrayLayers = scene.arrayLayers;
    info.samples = scene.samples;
    info.usage = scene.usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if ((context_.sampleCounts(info.format, info.usage) & info.samples) == 0) {
        return unsupported("image '" + scene.name + "': " + std::string(sceneFormat(scene.format)->name) + " with " +
                           std::to_string(info.samples) + " samples");
    }
    VERNIER_TRY_VK(vkCreateImage(device, &info, nullptr, &image.handle));
    cleanup_.add([device, handle = image.handle] { vkDestroyImage(device, handle, nullptr); });
    VkMemoryRequirements requirements{};
    vkGetImageMemoryRequirements(device, image.handle, &requirements);
    const Result<VkDeviceMemory> memory = allocate(requirements, 0);
    if (!memory) return memory.error();
    VERNIER_TRY_VK(vkBindImageMemory(device, image.handle, *memory, 0));
    if ((scene.usage & (VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT)) != 0) {
        // A view to sample through has one aspect.
        const VkImageAspectFlags aspect = image.aspects & ~VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT};
        const Result<VkImageView> view = createView(image, {aspect, 0, scene.mipLevels, 0, scene.arrayLayers},
                                                    scene.viewType != VK_IMAGE_VIEW_TYPE_MAX_ENUM ? scene.viewType
                                                    : scene.arrayLayers == 1 ? VK_IMAGE_VIEW_TYPE_2D
                                                                             : VK_IMAGE_VIEW_TYPE_2D_ARRAY);
        if (!view) return view.error();
        image.view = *view;
    }
    if (!scene.data.empty()) {
        image.rest = (scene.usage & VK_IMAGE_USAGE_SAMPLED_BIT) != 0 ? ImageUse::sampled : ImageUse::transferSource;
    }
    image.uses.assign(size_t{scene.mipLevels} * scene.arrayLayers, ImageUse::undefined);
    images_.push_back(std::move(image));
    return {};
}

Result<VkImageView> VulkanResources::createView(const Image& image, const VkImageSubresourceRange& range,
                                                VkImageViewType type) {
    const VkDevice device = context_.device();
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = image.handle;
    info.viewType = type;
    info.format = image.scene->format;
    info.subresourceRange = range;
    VkImageView view = VK_NULL_HANDLE;
    VERNIER_TRY_VK(vkCreateImageView(device, &info, nullptr, &view));
    cleanup_.add([device, view] { vkDestroyImageView(device, view, nullptr); });
    return view;
}

Result<VkImageView> VulkanResources::attachmentView(uint32_t index, uint32_t mipLevel, uint32_t layer,
                                                    uint32_t layerCount) {
    const Image& image = images_[index];
    return createView(image, {image.aspects, mipLevel, 1, layer, layerCount},
                      layerCount == 1 ? VK_IMAGE_VIEW_TYPE_2D : VK_IMAGE_VIEW_TYPE_2D_ARRAY);
}

Result<VkBufferView> VulkanResources::texelView(const SceneBinding& binding) {
    const VkFormatFeatureFlags needed = binding.type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER
                                            ? VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT
                                            : VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT;
    if ((context_.formatProperties(binding.texelFormat).bufferFeatures & needed) == 0) {
        return unsupported("texel buffers of format " + std::to_string(binding.texelFormat));
    }
    VkBufferViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
    info.buffer = buffer(binding.buffer);
    info.format = binding.texelFormat;
    info.offset = binding.offset;
    info.range = binding.range;
    VkBufferView view = VK_NULL_HANDLE;
    VERNIER_TRY_VK(vkCreateBufferView(context_.device(), &info, nullptr, &view));
    cleanup_.add([device = context_.device(), view] { vkDestroyBufferView(device, view, nullptr); });
    return view;
}

Status VulkanResources::createSampler(const SceneSampler& scene) {
    const VkDevice device = context_.device();
    if (scene.maxAnisotropy > 0 && context_.features().samplerAnisotropy == VK_FALSE)
        return unsupported("the device lacks feature samplerAnisotropy");
    const bool cubic = scene.magFilter == VK_FILTER_CUBIC_EXT || scene.minFilter == VK_FILTER_CUBIC_EXT;
    if (cubic && !context_.extensions().cubicFilters) return unsupported("the device lacks cubic filters");
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = scene.magFilter;
    info.minFilter = scene.minFilter;
    info.mipmapMode = scene.mipmapMode;
    info.addressModeU = scene.addressModeU;
    info.addressModeV = scene.addressModeV;
    info.addressModeW = scene.addressModeW;
    info.mipLodBias = scene.mipLodBias;
    info.anisotropyEnable = scene.maxAnisotropy > 0 ? VK_TRUE : VK_FALSE;
    info.maxAnisotropy = std::max(scene.maxAnisotropy, 1.0f);
    VkSamplerCustomBorderColorCreateInfoEXT border{};
    border.sType = VK_STRUCTURE_TYPE_SAMPLER_CUSTOM_BORDER_COLOR_CREATE_INFO_EXT;
    std::copy(scene.customBorderColor.begin(), scene.customBorderColor.end(), border.customBorderColor.float32);
    if (scene.borderColor == VK_BORDER_COLOR_FLOAT_CUSTOM_EXT) {
        if (context_.extensions().customBorders.customBorderColors == VK_FALSE) {
            return unsupported("the device lacks custom border colours");
        }
        info.pNext = &border;
    }
    VkSamplerReductionModeCreateInfo reduction{};
    reduction.sType = VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO;
    reduction.reductionMode = scene.reduction;
    if (scene.reduction != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE) {
        if (!context_.extensions().reductions) return unsupported("the device lacks minimum and maximum filters");
        reduction.pNext = info.pNext;
        info.pNext = &reduction;
    }
    info.compareEnable = scene.compareEnable ? VK_TRUE : VK_FALSE;
    info.compareOp = scene.compareOp;
    info.minLod = scene.minLod;
    info.maxLod = scene.maxLod;
    info.unnormalizedCoordinates = scene.unnormalized ? VK_TRUE : VK_FALSE;
    info.borderColor = scene.borderColor;
    VkSampler sampler = VK_NULL_HANDLE;
    VERNIER_TRY_VK(vkCreateSampler(device, &info, nullptr, &sampler));
    cleanup_.add([device, sampler] { vkDestroySampler(device, sampler, nullptr); });
    samplers_.push_back(sampler);
    return {};
}

Status VulkanResources::uploadImages() {
    Result<VkCommandBuffer> commands = beginCommands();
    if (!commands) return commands.error();
    for (uint32_t index = 0; index < images_.size(); ++index) {
        const SceneImage& scene = *images_[index].scene;
        if (scene.data.empty()) continue;
        useAll(*commands, index, ImageUse::transferDestination);
        for (size_t i = 0; i < scene.data.size(); ++i) {
            if (scene.data[i].empty()) continue;
            const Result<VulkanBuffer> staging =
                createHostBuffer(scene.data[i].size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
            if (!staging) return staging.error();
            std::memcpy(staging->mapped, scene.data[i].data(), scene.data[i].size());
            const auto mip = static_cast<uint32_t>(i / scene.arrayLayers);
            const auto layer = static_cast<uint32_t>(i % scene.arrayLayers);
            VkBufferImageCopy region{};
            region.imageSubresource = {images_[index].aspects & ~VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT}, mip,
                                       layer, 1};
            region.imageExtent = {std::max(1u, scene.extent.width >> mip), std::max(1u, scene.extent.height >> mip),
                                  std::max(1u, scene.depth >> mip)};
            vkCmdCopyBufferToImage(*commands, staging->handle, images_[index].handle,
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        }
        useAll(*commands, index, images_[index].rest);
    }
    VERNIER_TRY_VK(vkEndCommandBuffer(*commands));
    return run(*commands);
}

void VulkanResources::use(VkCommandBuffer commands, uint32_t index, ImageUse next, uint32_t mip, uint32_t mipCount,
                          uint32_t layer, uint32_t layerCount) {
    Image& image = images_[index];
    const UseState after = stateOf(next, image.aspects);
    for (uint32_t m = mip; m < mip + mipCount; ++m) {
        for (uint32_t l = layer; l < layer + layerCount; ++l) {
            ImageUse& last = image.uses[size_t{m} * image.scene->arrayLayers + l];
            const UseState before = stateOf(last, image.aspects);
            if (last == next && !before.writes) continue;  // a read after a read
            VkImageMemoryBarrier barrier{};
            barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
            barrier.srcAccessMask = before.writes ? before.access : 0;
            barrier.dstAccessMask = after.access;
            barrier.oldLayout = before.layout;
            barrier.newLayout = after.layout;
            barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
            barrier.image = image.handle;
            barrier.subresourceRange = {image.aspects, m, 1, l, 1};
            vkCmdPipelineBarrier(commands, before.stages, after.stages, 0, 0, nullptr, 0, nullptr, 1, &barrier);
            last = next;
        }
    }
}

void VulkanResources::useAll(VkCommandBuffer commands, uint32_t image, ImageUse next) {
    use(commands, image, next, 0, images_[image].scene->mipLevels, 0, images_[image].scene->arrayLayers);
}

void VulkanResources::startFrame() {
    for (Image& image : images_) std::fill(image.uses.begin(), image.uses.end(), image.rest);
}

void VulkanResources::endFrame(VkCommandBuffer commands) {
    for (uint32_t i = 0; i < images_.size(); ++i) {
        if (images_[i].rest != ImageUse::undefined) useAll(commands, i, images_[i].rest);
    }
}

Result<VkCommandBuffer> VulkanResources::beginCommands() {
    VkCommandBufferAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocation.commandPool = pool_;
    allocation.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocation.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VERNIER_TRY_VK(vkAllocateCommandBuffers(context_.device(), &allocation, &commands));
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    VERNIER_TRY_VK(vkBeginCommandBuffer(commands, &info));
    return commands;
}

Status VulkanResources::run(VkCommandBuffer commands) {
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    VERNIER_TRY_VK(vkQueueSubmit(context_.queue(), 1, &info, fence_));
    VERNIER_TRY_VK(vkWaitForFences(context_.device(), 1, &fence_, VK_TRUE, UINT64_MAX));
    VERNIER_TRY_VK(vkResetFences(context_.device(), 1, &fence_));
    return {};
}

}  // namespace vernier::conformance
