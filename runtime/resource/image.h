// Images and views. Texels lie row by row; the samples of a multisampled image lie in planes, one after the other.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/result.h"
#include "base/simd.h"
#include "runtime/format/format.h"
#include "runtime/resource/memory.h"
#include "runtime/texture/texture.h"

namespace vernier {

struct ImageInfo {
    VkImageType type = VK_IMAGE_TYPE_2D;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent3D extent{1, 1, 1};
    uint32_t mipLevels = 1;
    uint32_t arrayLayers = 1;
    uint32_t samples = 1;
    VkImageTiling tiling = VK_IMAGE_TILING_OPTIMAL;
    VkImageUsageFlags usage = 0;
    VkImageCreateFlags flags = 0;
};

/// Where one mip level lies inside a layer of the image.
struct LevelLayout {
    VkDeviceSize offset = 0;       // from the start of the layer
    VkExtent3D extent{};           // texels: max(1, size >> level)
    uint32_t rowPitch = 0;         // bytes from a row of texels (of a compressed format: of blocks) to the next
    VkDeviceSize slicePitch = 0;   // bytes from one depth slice to the next
    VkDeviceSize samplePitch = 0;  // bytes from one sample plane to the next
};

/// The rows of an attachment are padded to whole blocks of this many texels in both directions, so that the rasteriser
/// handles whole blocks and never touches memory outside the image.
inline constexpr uint32_t kAttachmentBlock = 8;

class Image {
  public:
    /// Checks the description (sizes, counts, format support) and computes the layout; memory is bound later.
    static Result<Image> create(const ImageInfo& info);

    const ImageInfo& info() const { return info_; }
    const FormatInfo& format() const { return *format_; }
    const LevelLayout& level(uint32_t mip) const { return levels_[mip]; }
    VkDeviceSize layerPitch() const { return layerPitch_; }
    VkDeviceSize memorySize() const { return layerPitch_ * info_.arrayLayers; }

    void bind(Memory& memory, VkDeviceSize offset);
    bool bound() const;

    /// Of a multi-planar format: its planes, images of one level and layer; this one stands for plane 0 then. Otherwise
    /// empty.
    std::span<const Image> planes() const { return planes_; }
    /// What the aspect of a copy, a view or a question names: a plane, or this image.
    const Image& ofAspect(VkImageAspectFlags aspect) const;
    /// Of ofAspect(aspect), from the start of the memory that the whole image is bound to.
    VkDeviceSize planeOffset(VkImageAspectFlags aspect) const;
    /// Binds a plane of a disjoint image, whose planes() may lie anywhere.
    void bindPlane(uint32_t plane, Memory& memory, VkDeviceSize offset);

    /// Texel (0, 0, z) of a sample of a subresource.
    std::byte* address(uint32_t mip, uint32_t layer, uint32_t z = 0, uint32_t sample = 0) const;

  private:
    ImageInfo info_;
    const FormatInfo* format_ = nullptr;
    std::vector<LevelLayout> levels_;
    VkDeviceSize layerPitch_ = 0;
    std::byte* data_ = nullptr;
    std::vector<Image> planes_;

    static Result<Image> createPlanar(const ImageInfo& info, const MultiPlanarFormat& format);
};

struct ImageViewInfo {
    VkImageViewType type = VK_IMAGE_VIEW_TYPE_2D;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkComponentMapping components{};
    VkImageSubresourceRange range{};  // counts resolved: no VK_REMAINING_*
    float minLod = 0;                 // VkImageViewMinLodCreateInfoEXT: counted in levels of the image
};

/// A view of another type than 3D on a 3D image: its layers are the slices (VK_KHR_maintenance1).
bool seesSlices(const Image& image, VkImageViewType type);

class SampleViews;

class ImageView {
  public:
    /// Checks the view against the image. `isa` chooses the conversion routines of the view. The image must be bound.
    static Result<ImageView> create(const Image& image, const ImageViewInfo& info, Isa isa);

    const Image& image() const { return *image_; }
    const ImageViewInfo& info() const { return info_; }
    /// The view as the texture units see it. Addresses are resolved now: the image must be bound.
    const TextureView& texture() const { return texture_; }
    /// The extent of the view's base level.
    VkExtent2D extent() const;
    /// A view of memory of its own with `samples` samples for each texel of the base level: what passes draw to that
    /// have more samples than the image (VK_EXT_multisampled_render_to_single_sampled). It is made when it is first
    /// asked for and lives as long as this view. Thread-safe. Only of 2D images that were created for it.
    Result<const ImageView*> withSamples(uint32_t samples, const HostAllocator& allocator, Isa isa) const;

  private:
    const Image* image_ = nullptr;
    ImageViewInfo info_;
    TextureView texture_;
    std::shared_ptr<const PlanarView> planar_;  // of all planes of a multi-planar image
    std::shared_ptr<SampleViews> samples_;      // nullptr: the image was not created for withSamples()

    static Result<ImageView> createPlanar(const Image& image, const ImageViewInfo& info, Isa isa);
};

}  // namespace vernier
