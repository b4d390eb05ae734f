#include "conformance/oracle/transfers.h"

#include "conformance/oracle/texture_unit.h"

#include <algorithm>
#include <array>
#include <utility>

namespace vernier::conformance::exact {
namespace {

StoredTexel storeFiltered(const ImageStore& target, const SampleResult& result) {
    return {quantiseColor(target.format(), result.color), result.flags};
}

/// The layers, or of a volume the slices, that a copy touches.
struct Layers {
    int64_t first = 0, count = 0;
    bool isIn(const ImageStore& image, uint32_t mip) const {
        return first >= 0 && first + count <= int64_t{image.arrayLayers()} * image.depth(mip);
    }
};

Layers layersOf(const ImageStore& image, const VkImageSubresourceLayers& range, const VkOffset3D& offset,
                const VkExtent3D& extent) {
    if (image.kind() == ImageKind::volume) return {offset.z, extent.depth};
    return {range.baseArrayLayer, range.layerCount};
}

/// One axis of a blit: destination texels first..last, and where in the source each of them is taken from.
struct BlitAxis {
    int32_t from = 0, to = 0, source = 0;
    double scale = 1;

    BlitAxis(int32_t s0, int32_t s1, int32_t d0, int32_t d1)
        : from(d0), to(d1), source(s0), scale(d0 == d1 ? 0 : static_cast<double>(s1 - s0) / (d1 - d0)) {}

    std::pair<int32_t, int32_t> span() const { return std::minmax(from, to); }
    double at(int32_t texel) const { return source + (texel + 0.5 - from) * scale; }
};

}  // namespace

void generateMips(ImageStore& image) {
    for (uint32_t mip = 1; mip < image.mipLevels(); ++mip) {
        const double depth = image.depth(mip), fromDepth = image.depth(mip - 1);
        for (uint32_t layer = 0; layer < image.arrayLayers() * image.depth(mip); ++layer) {
            const VkExtent2D from = image.level(mip - 1, 0).extent;
            ImageLevel& to = image.level(mip, layer);
            for (uint32_t y = 0; y < to.extent.height; ++y) {
                for (uint32_t x = 0; x < to.extent.width; ++x) {
                    const std::array<double, 3> place{(x + 0.5) * from.width / to.extent.width,
                                                      (y + 0.5) * from.height / to.extent.height,
                                                      (layer + 0.5) * fromDepth / depth};
                    to.at(x, y) = storeFiltered(image, blitTexel(image, mip - 1, layer, place, VK_FILTER_LINEAR));
                }
            }
        }
    }
}

Status copyImage(const SceneCopyImage& copy, std::vector<ImageStore>& images) {
    const ImageStore source = images[copy.source];  // a copy: source and destination may be the same image
    ImageStore& destination = images[copy.destination];
    if (source.format().format != destination.format().format) {
        return unsupported("oracle: a copy between images of different formats");
    }
    const VkImageCopy& r = copy.region;
    const Layers read = layersOf(source, r.srcSubresource, r.srcOffset, r.extent),
                 written = layersOf(destination, r.dstSubresource, r.dstOffset, r.extent);
    if (read.count != written.count || !read.isIn(source, r.srcSubresource.mipLevel) ||
        !written.isIn(destination, r.dstSubresource.mipLevel))
        return invalidArgument("oracle: a copy region reaches outside the layers of its images");
    for (int64_t layer = 0; layer < read.count; ++layer) {
        const ImageLevel& from = source.level(r.srcSubresource.mipLevel, static_cast<uint32_t>(read.first + layer));
        ImageLevel& to = destination.level(r.dstSubresource.mipLevel, static_cast<uint32_t>(written.first + layer));
        for (uint32_t y = 0; y < r.extent.height; ++y) {
            for (uint32_t x = 0; x < r.extent.width; ++x) {
                const uint32_t sx = static_cast<uint32_t>(r.srcOffset.x) + x,
                               sy = static_cast<uint32_t>(r.srcOffset.y) + y;
                const uint32_t dx = static_cast<uint32_t>(r.dstOffset.x) + x,
                               dy = static_cast<uint32_t>(r.dstOffset.y) + y;
                if (sx >= from.extent.width || sy >= from.extent.height || dx >= to.extent.width ||
                    dy >= to.extent.height) {
                    return invalidArgument("oracle: a copy region reaches outside its image");
                }
                for (uint32_t s = 0; s < std::min(from.samples, to.samples); ++s) to.at(dx, dy, s) = from.at(sx, sy, s);
            }
        }
    }
    return {};
}

Status blitImage(const SceneBlitImage& blit, const OracleRules& rules, std::vector<ImageStore>& images) {
    const ImageStore source = images[blit.source];
    ImageStore& destination = images[blit.destination];
    const VkImageBlit& r = blit.region;
    const auto& [s0, s1] = r.srcOffsets;
    const auto& [d0, d1] = r.dstOffsets;
    if (d0.x == d1.x || d0.y == d1.y || d0.z == d1.z) return {};
    const BlitAxis xs(s0.x, s1.x, d0.x, d1.x), ys(s0.y, s1.y, d0.y, d1.y), zs(s0.z, s1.z, d0.z, d1.z);
    // Where the first texel of the destination's image would be taken from: no clamping when that is far inside.
    const bool truncated = rules.truncatedBlits && xs.at(0) >= 0.5 && ys.at(0) >= 0.5;
    const bool volume = destination.kind() == ImageKind::volume;
    const auto [left, right] = xs.span();
    const auto [top, bottom] = ys.span();
    const auto [front, back] = zs.span();
    if (volume != (source.kind() == ImageKind::volume) && (r.srcSubresource.layerCount != 1 || back - front != 1))
        return unsupported("oracle: blits between layers and slices");
    const VkExtent2D extent = destination.level(r.dstSubresource.mipLevel, 0).extent;
    if (left < 0 || top < 0 || static_cast<uint32_t>(right) > extent.width ||
        static_cast<uint32_t>(bottom) > extent.height ||
        (volume && (front < 0 || static_cast<uint32_t>(back) > destination.depth(r.dstSubresource.mipLevel)))) {
        return invalidArgument("oracle: a blit region reaches outside its image");
    }
    for (uint32_t layer = 0; layer < r.srcSubresource.layerCount; ++layer) {
        for (int32_t z = front; z < back; ++z) {
            ImageLevel& to = destination.level(
                r.dstSubresource.mipLevel, volume ? static_cast<uint32_t>(z) : r.dstSubresource.baseArrayLayer + layer);
            for (int32_t y = top; y < bottom; ++y) {
                for (int32_t x = left; x < right; ++x) {
                    const auto texel =
                        blitTexel(source, r.srcSubresource.mipLevel, r.srcSubresource.baseArrayLayer + layer,
                                  {xs.at(x), ys.at(y), zs.at(z)}, blit.filter, truncated);
                    to.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) = storeFiltered(destination, texel);
                }
            }
        }
    }
    return {};
}

}  // namespace vernier::conformance::exact
