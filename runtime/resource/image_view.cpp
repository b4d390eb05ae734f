#include <algorithm>
#include <string>

#include "runtime/resource/image.h"
#include "runtime/resource/sample_views.h"

namespace vernier {
namespace {

Error wrong(const std::string& what) {
    return invalidArgument("image view: " + what);
}

bool typeFits(VkImageViewType view, const ImageInfo& image) {
    switch (view) {
        case VK_IMAGE_VIEW_TYPE_1D:
        case VK_IMAGE_VIEW_TYPE_1D_ARRAY:
            return image.type == VK_IMAGE_TYPE_1D;
        case VK_IMAGE_VIEW_TYPE_3D:
            return image.type == VK_IMAGE_TYPE_3D;
        case VK_IMAGE_VIEW_TYPE_2D:
        case VK_IMAGE_VIEW_TYPE_2D_ARRAY:
            // The slices of a 3D image seen as layers (VK_KHR_maintenance1), or one of them
            // (VK_EXT_image_2d_view_of_3d).
            if (image.type == VK_IMAGE_TYPE_3D) {
                const VkImageCreateFlags one =
                    view == VK_IMAGE_VIEW_TYPE_2D ? VK_IMAGE_CREATE_2D_VIEW_COMPATIBLE_BIT_EXT : 0;
                return (image.flags & (VK_IMAGE_CREATE_2D_ARRAY_COMPATIBLE_BIT | one)) != 0;
            }
            [[fallthrough]];
        default:
            return image.type == VK_IMAGE_TYPE_2D;
    }
}

/// The layers a view can choose from: slices of the level when a 3D image is seen as layers.
uint32_t layersOf(const Image& image, const ImageViewInfo& info) {
    return seesSlices(image, info.type) ? image.level(info.range.baseMipLevel).extent.depth : image.info().arrayLayers;
}

Status checkRange(const Image& image, const ImageViewInfo& info) {
    const VkImageSubresourceRange& range = info.range;
    const auto check = [](const char* name, uint64_t base, uint64_t count, uint64_t limit) -> Status {
        if (count > 0 && base + count <= limit) return {};
        return wrong(std::string(name) + " " + std::to_string(base) + " + " + std::to_string(count) +
                     " are not inside the image's " + std::to_string(limit));
    };
    if (Status s = check("mip levels", range.baseMipLevel, range.levelCount, image.info().mipLevels); !s) return s;
    if (Status s = check("layers", range.baseArrayLayer, range.layerCount, layersOf(image, info)); !s) return s;
    if (seesSlices(image, info.type) && range.levelCount != 1)
        return wrong("a view of slices has one mip level, not " + std::to_string(range.levelCount));
    if (range.aspectMask == 0 || (range.aspectMask & ~image.format().aspects) != 0)
        return wrong("aspect mask " + std::to_string(range.aspectMask) + " is not of format " + image.format().name);
    const bool cube = info.type == VK_IMAGE_VIEW_TYPE_CUBE || info.type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
    if (cube && (range.layerCount % 6 != 0 || image.info().extent.width != image.info().extent.height))
        return wrong("a cube needs square images and layers in sixes, not " + std::to_string(range.layerCount));
    return {};
}

/// Whether texels of one format can be seen as those of the other: of the same size, in equal blocks; or (VK_KHR_
/// maintenance2) the blocks of a compressed image as texels.
bool formatFits(const Image& image, const FormatInfo& view) {
    const FormatInfo& format = image.format();
    if (view.bytesPerTexel != format.bytesPerTexel || view.aspects != format.aspects) return false;
    if (view.blockWidth() == format.blockWidth() && view.blockHeight() == format.blockHeight()) return true;
    return view.block == nullptr && (image.info().flags & VK_IMAGE_CREATE_BLOCK_TEXEL_VIEW_COMPATIBLE_BIT) != 0;
}

}  // namespace

bool seesSlices(const Image& image, VkImageViewType type) {
    return image.info().type == VK_IMAGE_TYPE_3D && type != VK_IMAGE_VIEW_TYPE_3D;
}

/// A plane of a multi-planar image, seen with a format of its own; or all of them, which is plane 0 to whoever does not
/// convert.
Result<ImageView> ImageView::createPlanar(const Image& image, const ImageViewInfo& info, Isa isa) {
    const MultiPlanarFormat& format = *findMultiPlanar(image.info().format);
    ImageViewInfo one = info;
    one.range.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    if (planeOfAspect(info.range.aspectMask) < format.planeCount)
        return create(image.ofAspect(info.range.aspectMask), one, isa);
    if (info.range.aspectMask != VK_IMAGE_ASPECT_COLOR_BIT || info.format != format.format)
        return wrong(std::string("of ") + format.name +
                     " there are views of one plane, and views of all in that format");
    if (info.type != VK_IMAGE_VIEW_TYPE_2D && info.type != VK_IMAGE_VIEW_TYPE_2D_ARRAY)
        return wrong("view type " + std::to_string(info.type) + " does not fit the image's type");
    one.components = {};
    auto planar = std::make_shared<PlanarView>();
    planar->format = &format;
    ImageView view;
    for (uint32_t plane = 0; plane < format.planeCount; ++plane) {
        one.format = format.planes[plane];
        Result<ImageView> made = create(image.planes()[plane], one, isa);
        if (!made) return made.error();
        planar->planes[plane] = made->texture_;
        if (plane == 0) view = std::move(made).value();
    }
    planar->queryLod = selectQueryLod(view.texture_, {}, isa);
    view.planar_ = std::move(planar);
    view.texture_.planar = view.planar_.get();
    return view;
}

Result<ImageView> ImageView::create(const Image& image, const ImageViewInfo& info, Isa isa) {
    if (!image.planes().empty()) return createPlanar(image, info, isa);
    const FormatInfo* format = findFormat(info.format);
    if (!format) return unsupported("image view: format " + std::to_string(info.format) + " is not supported");
    if (!formatFits(image, *format))
        return wrong(std::string("format ") + format->name + " does not fit the image's " + image.format().name);
    if (!typeFits(info.type, image.info()))
        return wrong("view type " + std::to_string(info.type) + " does not fit the image's type");
    if (Status status = checkRange(image, info); !status) return status.error();
    const bool seesBlocks = format->block == nullptr && image.format().block != nullptr;
    if (seesBlocks && (info.range.levelCount != 1 || info.range.layerCount != 1))
        return wrong("a view of blocks has one mip level and one layer");
    if (!(info.minLod >= 0) || info.minLod > static_cast<float>(info.range.baseMipLevel + info.range.levelCount - 1))
        return wrong("minLod " + std::to_string(info.minLod) + " is not one of its levels");
    if (!image.bound()) return wrong("the image has no memory bound");

    ImageView view;
    view.image_ = &image;
    view.info_ = info;
    TextureView& texture = view.texture_;
    texture.type = info.type;
    texture.format = info.format;
    const VkImageAspectFlags depthStencil = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    texture.aspect = (info.range.aspectMask & depthStencil) == depthStencil
                         ? static_cast<VkImageAspectFlags>(VK_IMAGE_ASPECT_DEPTH_BIT)
                         : info.range.aspectMask;
    texture.swizzle = info.components;
    texture.levelCount = info.range.levelCount;
    texture.layerCount = info.range.layerCount;
    texture.minLod = std::max(0.0f, info.minLod - static_cast<float>(info.range.baseMipLevel));
    texture.samples = image.info().samples;
    texture.texelPitch = format->bytesPerTexel;
    texture.block = format->block;
    texture.samplePitch = image.level(info.range.baseMipLevel).samplePitch;
    texture.ops = formatOps(info.format, texture.aspect, isa);
    const bool slices = seesSlices(image, info.type);
    for (uint32_t i = 0; i < info.range.levelCount; ++i) {
        const LevelLayout& level = image.level(info.range.baseMipLevel + i);
        const uint32_t mip = info.range.baseMipLevel + i;
        const uint32_t first = info.range.baseArrayLayer;
        const bool volume = image.info().type == VK_IMAGE_TYPE_3D;
        texture.levels[i] = {.data = slices ? image.address(mip, 0, first) : image.address(mip, first),
                             .width = seesBlocks ? image.format().columns(level.extent.width) : level.extent.width,
                             .height = seesBlocks ? image.format().rows(level.extent.height) : level.extent.height,
                             .depth = slices ? 1 : level.extent.depth,
                             .rowPitch = level.rowPitch,
                             .slicePitch = volume ? level.slicePitch : image.layerPitch()};
    }
    if (image.info().type == VK_IMAGE_TYPE_2D &&
        (image.info().flags & VK_IMAGE_CREATE_MULTISAMPLED_RENDER_TO_SINGLE_SAMPLED_BIT_EXT) != 0)
        view.samples_ = std::make_shared<SampleViews>();
    return view;
}

VkExtent2D ImageView::extent() const {
    const VkExtent3D& extent = image_->level(info_.range.baseMipLevel).extent;
    return {extent.width, extent.height};
}

Result<const ImageView*> ImageView::withSamples(uint32_t samples, const HostAllocator& allocator, Isa isa) const {
    if (samples_ == nullptr)
        return wrong("not of a 2D image created with VK_IMAGE_CREATE_MULTISAMPLED_RENDER_TO_SINGLE_SAMPLED_BIT_EXT");
    return samples_->find(*this, samples, allocator, isa);
}

}  // namespace vernier
