#include "runtime/resource/image.h"

#include <algorithm>
#include <bit>
#include <string>

#include "runtime/limits.h"

namespace vernier {
namespace {

constexpr VkImageUsageFlags kAttachmentUsage =
    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
constexpr uint32_t kRowAlignment = 16;  // bytes
constexpr VkDeviceSize kLevelAlignment = 64;

/// Rows whose distance is a multiple of this share few sets of a first-level cache (64 sets of 64 bytes): a tile of 64
/// rows would throw its own lines out. One line more puts each row into other sets.
constexpr uint64_t kAliasingPitch = 512;
constexpr uint64_t kCacheLine = 64;

uint64_t alignUp(uint64_t value, uint64_t alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

Error wrong(const std::string& field, uint64_t value, const std::string& rule) {
    return invalidArgument("image: " + field + " is " + std::to_string(value) + ", " + rule);
}

uint32_t fullMipCount(const VkExtent3D& extent) {
    return static_cast<uint32_t>(std::bit_width(std::max({extent.width, extent.height, extent.depth})));
}

Status checkInfo(const ImageInfo& info) {
    const uint32_t limit = info.type == VK_IMAGE_TYPE_3D ? kMaxImageDimension3D : kMaxImageDimension2D;
    const struct {
        const char* name;
        uint32_t value, limit;
    } sizes[] = {{"width", info.extent.width, limit},
                 {"height", info.extent.height, info.type == VK_IMAGE_TYPE_1D ? 1 : limit},
                 {"depth", info.extent.depth, info.type == VK_IMAGE_TYPE_3D ? limit : 1},
                 {"the number of layers", info.arrayLayers, info.type == VK_IMAGE_TYPE_3D ? 1 : kMaxArrayLayers}};
    for (const auto& size : sizes)
        if (size.value == 0 || size.value > size.limit)
            return wrong(size.name, size.value, "but must be 1 to " + std::to_string(size.limit));
    const uint32_t mips = fullMipCount(info.extent);
    if (info.mipLevels == 0 || info.mipLevels > mips)
        return wrong("the number of mip levels", info.mipLevels, "but must be 1 to " + std::to_string(mips));
    if (!isSampleCount(info.samples))
        return wrong("the sample count", info.samples,
                     "but must be a power of two up to " + std::to_string(kMaxSamples));
    if (info.samples > 1 && (info.mipLevels > 1 || info.type != VK_IMAGE_TYPE_2D))
        return wrong("the sample count", info.samples, "but only 2D images of one mip level can be multisampled");
    return {};
}

}  // namespace

Result<Image> Image::create(const ImageInfo& info) {
    if (const MultiPlanarFormat* planar = findMultiPlanar(info.format)) return createPlanar(info, *planar);
    Image image;
    image.info_ = info;
    image.format_ = findFormat(info.format);
    if (!image.format_) return unsupported("image: format " + std::to_string(info.format) + " is not supported");
    if (Status status = checkInfo(info); !status) return status.error();

    const uint32_t texel = image.format_->bytesPerTexel;
    const bool padded = (info.usage & kAttachmentUsage) != 0;
    VkDeviceSize offset = 0;
    for (uint32_t mip = 0; mip < info.mipLevels; ++mip) {
        LevelLayout level;
        level.extent = {std::max(1u, info.extent.width >> mip), std::max(1u, info.extent.height >> mip),
                        std::max(1u, info.extent.depth >> mip)};
        const uint32_t width = image.format_->columns(level.extent.width);
        const uint32_t height = image.format_->rows(level.extent.height);
        const uint64_t columns = padded ? alignUp(width, kAttachmentBlock) : width;
        const uint64_t rows = padded ? alignUp(height, kAttachmentBlock) : height;
        level.offset = offset;
        uint64_t pitch = alignUp(columns * texel, kRowAlignment);
        if (pitch % kAliasingPitch == 0) pitch += kCacheLine;
        level.rowPitch = static_cast<uint32_t>(pitch);
        level.samplePitch = level.rowPitch * rows;
        level.slicePitch = level.samplePitch * info.samples;
        offset = alignUp(offset + level.slicePitch * level.extent.depth, kLevelAlignment);
        image.levels_.push_back(level);
    }
    image.layerPitch_ = offset;
    return image;
}

Result<Image> Image::createPlanar(const ImageInfo& info, const MultiPlanarFormat& format) {
    if (info.type != VK_IMAGE_TYPE_2D || info.mipLevels != 1 || info.arrayLayers != 1 || info.samples != 1)
        return invalidArgument(std::string("image: of ") + format.name +
                               " there are 2D images of one level, layer "
                               "and sample");
    if (info.extent.width % format.chromaWidthDivisor != 0 || info.extent.height % format.chromaHeightDivisor != 0)
        return invalidArgument(std::string("image: width and height of ") + format.name +
                               " must be multiples of those of its chroma");
    Image image;
    VkDeviceSize size = 0;
    for (uint32_t plane = 0; plane < format.planeCount; ++plane) {
        ImageInfo of = info;
        of.format = format.planes[plane];
        of.extent.width /= format.widthDivisor(plane);
        of.extent.height /= format.heightDivisor(plane);
        Result<Image> made = create(of);
        if (!made) return made.error();
        size += made->memorySize();  // whole alignments: levels are
        image.planes_.push_back(std::move(made).value());
    }
    image.info_ = info;
    image.format_ = image.planes_[0].format_;
    image.levels_ = image.planes_[0].levels_;
    image.layerPitch_ = size;
    return image;
}

void Image::bind(Memory& memory, VkDeviceSize offset) {
    data_ = memory.data() + offset;
    for (Image& plane : planes_) {
        plane.bind(memory, offset);
        offset += plane.memorySize();
    }
}

bool Image::bound() const {
    return data_ != nullptr && std::all_of(planes_.begin(), planes_.end(), [](const Image& p) { return p.bound(); });
}

const Image& Image::ofAspect(VkImageAspectFlags aspect) const {
    const uint32_t plane = planeOfAspect(aspect);
    return plane < planes_.size() ? planes_[plane] : *this;
}

VkDeviceSize Image::planeOffset(VkImageAspectFlags aspect) const {
    const uint32_t plane = planeOfAspect(aspect);
    VkDeviceSize offset = 0;
    for (uint32_t i = 0; plane < planes_.size() && i < plane; ++i) offset += planes_[i].memorySize();
    return offset;
}

void Image::bindPlane(uint32_t plane, Memory& memory, VkDeviceSize offset) {
    if (plane >= planes_.size()) return;
    planes_[plane].bind(memory, offset);
    if (plane == 0) data_ = planes_[0].data_;
}

std::byte* Image::address(uint32_t mip, uint32_t layer, uint32_t z, uint32_t sample) const {
    const LevelLayout& layout = levels_[mip];
    return data_ + layer * layerPitch_ + layout.offset + z * layout.slicePitch + sample * layout.samplePitch;
}

}  // namespace vernier
