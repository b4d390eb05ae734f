// What one thread of the soak makes things of: buffers and images that know what should be in them, and pipelines.
#pragma once

#include <memory>
#include <vector>

#include "tests/vulkan/soak/context.h"

namespace vernier::soak {

/// Bytes of the host's that the device writes, and what should be in them.
struct SoakBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint32_t* words = nullptr;
    std::vector<uint32_t> model;
};

/// An RGBA8 image whose pixels are all known.
struct SoakImage {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    VkExtent2D extent{};
    std::vector<uint32_t> model;
    bool fresh = true;  // still in VK_IMAGE_LAYOUT_UNDEFINED
};

/// Makes things; used by one thread, which destroys all of them before the workshop. Failures go to the verdict.
class Workshop {
  public:
    Workshop(Context& context, Random& random);
    ~Workshop();
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;

    /// Random words.
    std::shared_ptr<SoakBuffer> makeBuffer(uint32_t words);
    /// Of random size; black, once it is no longer fresh.
    std::shared_ptr<SoakImage> makeImage();
    /// Draws a triangle over everything: of a pixel at x, y the word color + x + (y << 8).
    VkPipeline makeDrawing() const;
    /// Makes of word i: word * factor + added + i, in groups of 64.
    VkPipeline makeCompute() const;

    VkRenderPass pass() const { return pass_; }
    /// Push constants: color, of the fragment stage.
    VkPipelineLayout drawLayout() const { return drawLayout_; }
    /// Push constants: factor and added; the set has one storage buffer.
    VkPipelineLayout computeLayout() const { return computeLayout_; }
    const VkDescriptorSetLayout& setLayout() const { return setLayout_; }

  private:
    void makeLayouts();
    void makePass();
    VkDeviceMemory allocate(const VkMemoryRequirements& needs) const;

    Verdict& verdict_;
    VkDevice device_;
    Random& random_;
    VkRenderPass pass_ = VK_NULL_HANDLE;
    VkPipelineLayout drawLayout_ = VK_NULL_HANDLE, computeLayout_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkShaderModule vertex_ = VK_NULL_HANDLE, fragment_ = VK_NULL_HANDLE, multiply_ = VK_NULL_HANDLE;
};

}  // namespace vernier::soak
