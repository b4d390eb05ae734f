// A scene's buffers, images and samplers on a Vulkan device, and the barriers between their uses.
#pragma once

#include "conformance/drivers/vulkan_context.h"
#include "conformance/scene/scene.h"

#include <span>
#include <vector>

namespace vernier::conformance {

/// What an image subresource is used for; decides its layout, stages and accesses.
enum class ImageUse : uint8_t {
    undefined,
    transferSource,
    transferDestination,
    sampled,
    storage,
    colorAttachment,
    depthAttachment
};

struct VulkanBuffer {
    VkBuffer handle = VK_NULL_HANDLE;
    void* mapped = nullptr;  // always in coherent host memory
};

class VulkanResources {
  public:
    explicit VulkanResources(VulkanContext& context) : context_(context) {}
    VulkanResources(const VulkanResources&) = delete;
    VulkanResources& operator=(const VulkanResources&) = delete;

    /// Creates everything the scene names and uploads the initial contents, waiting for the upload.
    Status create(const Scene& scene);

    VkBuffer buffer(uint32_t index) const { return buffers_[index].handle; }
    VkImage image(uint32_t index) const { return images_[index].handle; }
    VkSampler sampler(uint32_t index) const { return samplers_[index]; }
    /// All levels and layers, for sampling and storing.
    VkImageView sampledView(uint32_t index) const { return images_[index].view; }
    /// One level of some layers, for an attachment.
    Result<VkImageView> attachmentView(uint32_t index, uint32_t mipLevel, uint32_t layer, uint32_t layerCount);
    /// A new view of a texel buffer.
    Result<VkBufferView> texelView(const SceneBinding& binding);

    /// Records the barrier that takes subresources from their last use to the next one.
    void use(VkCommandBuffer commands, uint32_t image, ImageUse next, uint32_t mip, uint32_t mipCount, uint32_t layer,
             uint32_t layerCount);
    void useAll(VkCommandBuffer commands, uint32_t image, ImageUse next);

    /// Forgets the contents of images without initial data, so that commands recorded next may run again and
    /// again.
    void startFrame();
    /// Records the return of images with initial data to the state that startFrame() assumes.
    void endFrame(VkCommandBuffer commands);

    /// A new command buffer, begun.
    Result<VkCommandBuffer> beginCommands();
    /// Submits and waits.
    Status run(VkCommandBuffer commands);

    Result<VulkanBuffer> createHostBuffer(VkDeviceSize size, VkBufferUsageFlags usage);

    /// Destruction of what others create on the same device, before the resources themselves.
    Cleanup& cleanup() { return cleanup_; }

  private:
    struct Image {
        const SceneImage* scene = nullptr;
        VkImage handle = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkImageAspectFlags aspects = 0;
        ImageUse rest = ImageUse::undefined;  // the use between frames
        std::vector<ImageUse> uses;           // per mip * arrayLayers + layer
    };

    Result<VkDeviceMemory> allocate(const VkMemoryRequirements& requirements, VkMemoryPropertyFlags properties);
    Status createImage(const SceneImage& scene);
    Status createSampler(const SceneSampler& scene);
    Result<VkImageView> createView(const Image& image, const VkImageSubresourceRange& range, VkImageViewType type);
    Status uploadImages();

    VulkanContext& context_;
    Cleanup cleanup_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    std::vector<VulkanBuffer> buffers_;
    std::vector<Image> images_;
    std::vector<VkSampler> samplers_;
};

}  // namespace vernier::conformance
