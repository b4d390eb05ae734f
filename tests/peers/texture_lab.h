// One texture, one sampler, many lookups, on any Vulkan driver: the same question to Vernier and to its peers.
#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vernier::test {

using Vec4 = std::array<float, 4>;

struct LabImage {
    VkImageType type = VK_IMAGE_TYPE_2D;
    VkImageViewType viewType = VK_IMAGE_VIEW_TYPE_2D;
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkExtent3D extent{1, 1, 1};
    uint32_t levels = 1, layers = 1;
    VkImageCreateFlags flags = 0;
    VkFormat viewFormat = VK_FORMAT_UNDEFINED;  // undefined: the image's
    VkComponentMapping swizzle{};
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;  // of the view; uploads go to it too
    float minLod = 0;                                       // of the view (VK_EXT_image_view_min_lod)
    // Per level, tightly packed, all layers or slices one after the other.
    std::vector<std::vector<uint8_t>> data;
};

struct LabSampler {
    VkSamplerCreateInfo info;
    VkClearColorValue border{};
    VkSamplerReductionMode reduction = VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;
    LabSampler();
};

/// A device of one driver. Every extension and feature of the lab's list that the driver has is on.
class TextureLab {
  public:
    /// nullptr: no such driver here. `manifest`: the driver's JSON file.
    static std::unique_ptr<TextureLab> open(const std::string& manifest);
    ~TextureLab();

    VkPhysicalDevice physicalDevice() const { return physical_; }
    VkPhysicalDeviceFeatures features() const;
    bool has(const char* extension) const;

    /// Runs `glsl`, the body of `vec4 look(ivec2 at, int i)`, in the fragments of an area: at = the pixel, i = at.y *
    /// width + at.x. It sees `tex` of GLSL type `samplerType` and `vec4 in_(int i)`, the inputs.
    std::vector<Vec4> look(const LabImage& image, const LabSampler& sampler, const std::string& samplerType,
                           const std::string& glsl, const std::vector<Vec4>& inputs, VkExtent2D extent);

  private:
    TextureLab() = default;
    struct Texture;
    struct Block;
    Block allocate(VkDeviceSize size, VkBufferUsageFlags usage);
    void bind(Texture& texture, const VkImageCreateInfo& info);
    Texture makeTarget(VkFormat format, VkExtent2D extent);
    Texture makeTexture(const LabImage& image, const LabSampler& sampler);
    void destroy(const Texture& texture);
    void destroy(const Block& block);
    VkPipeline makePipeline(VkShaderModule vertex, VkShaderModule fragment, VkPipelineLayout layout, VkRenderPass pass,
                            VkExtent2D extent);
    VkCommandBuffer begin();
    void submit(VkCommandBuffer commands);
    VkShaderModule makeShader(VkShaderStageFlagBits stage, const std::string& glsl);

    VkInstance instance_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::vector<std::string> extensions_;
};

/// Random bytes, the same every time.
std::vector<uint8_t> randomBytes(size_t count, uint32_t seed);

}  // namespace vernier::test
