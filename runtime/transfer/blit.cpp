#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "runtime/format/resolve.h"
#include "runtime/transfer/region.h"

namespace vernier {
namespace {

/// A row of texels as four planes of 32-bit values.
class PlaneRow {
  public:
    explicit PlaneRow(uint32_t width) : values_(size_t{width} * 4), width_(width) {
        for (size_t c = 0; c < 4; ++c) planes_[c] = writable_[c] = values_.data() + c * width;
    }
    void* const* writable() { return writable_.data(); }
    const void* const* planes() const { return planes_.data(); }
    float* plane(size_t component) { return values_.data() + component * width_; }

  private:
    std::vector<float> values_;
    size_t width_;
    std::array<void*, 4> writable_{};
    std::array<const void*, 4> planes_{};
};

/// Where the texels of one axis of the destination come from: source texel = (d + 0.5 - dst0) * scale + src0 (Vulkan
/// specification, "Image Copies With Scaling").
struct Axis {
    double scale = 1, origin = 0;
    uint32_t begin = 0, count = 0;  // destination texels, ascending and clipped
    uint32_t sourceSize = 1;

    Axis(int32_t src0, int32_t src1, uint32_t sourceLimit, int32_t dst0, int32_t dst1, uint32_t destinationLimit) {
        sourceSize = sourceLimit;
        if (dst0 == dst1 || src0 == src1) return;
        scale = (static_cast<double>(src1) - src0) / (static_cast<double>(dst1) - dst0);
        origin = src0 - dst0 * scale;
        const int64_t low = std::max<int64_t>(std::min(dst0, dst1), 0);
        const int64_t high = std::min<int64_t>(std::max(dst0, dst1), destinationLimit);
        begin = static_cast<uint32_t>(std::min<int64_t>(low, destinationLimit));
        count = high > low ? static_cast<uint32_t>(high - low) : 0;
    }

    struct Taps {
        uint32_t first = 0, second = 0;
        float weight = 0;  // of the second
    };
    Taps at(uint32_t destination, VkFilter filter) const {
        const double u = (destination + 0.5) * scale + origin;
        const auto clamp = [&](double texel) {
            return static_cast<uint32_t>(std::clamp(texel, 0.0, static_cast<double>(sourceSize - 1)));
        };
        if (filter == VK_FILTER_NEAREST) return {clamp(std::floor(u)), clamp(std::floor(u)), 0};
        const double floor = std::floor(u - 0.5);
        return {clamp(floor), clamp(floor + 1), static_cast<float>(u - 0.5 - floor)};
    }
};

/// Equal values stay what they are, bit for bit; a weight of 0 keeps infinities of the other texel out.
float mix(float a, float b, float weight) {
    return weight == 0 || a == b ? a : a + weight * (b - a);
}

/// The values of a row of texels of a compressed level.
void unpackBlocks(const FormatInfo& format, const FormatOps& ops, const std::byte* blocks, uint32_t y, uint32_t width,
                  void* const planes[4]) {
    alignas(16) std::byte texels[kMaxBlockTexels * kMaxDecodedBytes];
    const uint32_t blockWidth = format.blockWidth();
    for (uint32_t x = 0; x < width; x += blockWidth, blocks += format.bytesPerTexel) {
        format.block->decode(blocks, texels);
        void* part[4];
        for (size_t c = 0; c < 4; ++c) part[c] = static_cast<std::byte*>(planes[c]) + x * sizeof(float);
        ops.unpack(texels + size_t{y % format.blockHeight()} * blockWidth * ops.layout.bytes,
                   std::min(blockWidth, width - x), part);
    }
}

class Blitter {
  public:
    Blitter(const Image& source, uint32_t mip, FormatOps ops, Axis x, VkFilter filter)
        : source_(source), mip_(mip), ops_(ops), filter_(filter) {
        taps_.reserve(x.count);
        for (uint32_t i = 0; i < x.count; ++i) taps_.push_back(x.at(x.begin + i, filter));
    }

    /// One destination row from the source rows around (y, z).
    void row(const Axis::Taps& y, const Axis::Taps& z, PlaneRow& result) const {
        const auto width = static_cast<uint32_t>(taps_.size());
        horizontal(y.first, z.first, result);
        if (filter_ == VK_FILTER_NEAREST) return;
        PlaneRow other(width);
        blend(y, z.first, result, other);
        if (z.weight == 0) return;
        PlaneRow back(width);
        horizontal(y.first, z.second, back);
        blend(y, z.second, back, other);
        combine(result, back, z.weight);
    }

  private:
    void blend(const Axis::Taps& y, uint32_t z, PlaneRow& result, PlaneRow& scratch) const {
        if (y.weight == 0) return;
        horizontal(y.second, z, scratch);
        combine(result, scratch, y.weight);
    }

    void combine(PlaneRow& result, PlaneRow& other, float weight) const {
        for (size_t c = 0; c < 4; ++c)
            for (size_t i = 0; i < taps_.size(); ++i)
                result.plane(c)[i] = mix(result.plane(c)[i], other.plane(c)[i], weight);
    }

    void horizontal(uint32_t y, uint32_t z, PlaneRow& result) const {
        const uint32_t width = source_.level(mip_).extent.width;
        PlaneRow texels(width);
        const FormatInfo& format = source_.format();
        const std::byte* row = rowAddress(source_, mip_, y / format.blockHeight(), z, 0);
        if (format.block != nullptr) {
            unpackBlocks(format, ops_, row, y, width, texels.writable());
        } else {
            ops_.unpack(row, width, texels.writable());
        }
        for (size_t c = 0; c < 4; ++c) {
            const float* from = texels.plane(c);
            float* to = result.plane(c);
            for (size_t i = 0; i < taps_.size(); ++i) {
                const Axis::Taps& tap = taps_[i];
                if (filter_ == VK_FILTER_NEAREST)
                    std::memcpy(to + i, from + tap.first, sizeof(float));  // integers travel as bits
                else
                    to[i] = mix(from[tap.first], from[tap.second], tap.weight);
            }
        }
    }

    const Image& source_;
    uint32_t mip_;
    FormatOps ops_;
    VkFilter filter_;
    std::vector<Axis::Taps> taps_;
};

}  // namespace

void blitImage(const TransferContext& context, const Image& source, const Image& destination, const VkImageBlit& region,
               VkFilter filter) {
    const VkImageSubresourceLayers& from = region.srcSubresource;
    const VkImageSubresourceLayers& to = region.dstSubresource;
    if (from.mipLevel >= source.info().mipLevels || to.mipLevel >= destination.info().mipLevels) return;
    const VkExtent3D& fromSize = source.level(from.mipLevel).extent;
    const VkExtent3D& toSize = destination.level(to.mipLevel).extent;
    const auto& s = region.srcOffsets;
    const auto& d = region.dstOffsets;
    const Axis x(s[0].x, s[1].x, fromSize.width, d[0].x, d[1].x, toSize.width);
    const Axis y(s[0].y, s[1].y, fromSize.height, d[0].y, d[1].y, toSize.height);
    const Axis z(s[0].z, s[1].z, fromSize.depth, d[0].z, d[1].z, toSize.depth);
    const auto aspect = static_cast<VkImageAspectFlags>(from.aspectMask & -from.aspectMask);
    if (x.count == 0 || (aspect & source.format().aspects) == 0 || (aspect & destination.format().aspects) == 0) return;
    if (destination.format().block != nullptr) return;  // nothing encodes blocks
    const FormatOps pack = formatOps(destination.info().format, aspect, context.isa);
    const Blitter blitter(source, from.mipLevel, formatOps(source.info().format, aspect, context.isa), x, filter);

    const bool fromVolume = source.info().type == VK_IMAGE_TYPE_3D;
    const bool toVolume = destination.info().type == VK_IMAGE_TYPE_3D;
    const uint32_t slices = toVolume ? z.count : to.layerCount;
    const auto fits = [](const Image& image, bool volume, const VkImageSubresourceLayers& sub) {
        return volume || uint64_t{sub.baseArrayLayer} + sub.layerCount <= image.info().arrayLayers;
    };
    if (!fits(source, fromVolume, from) || !fits(destination, toVolume, to)) return;
    const TexelBox box{x.begin, y.begin, 0, x.count, y.count, slices};
    forEachRow(context, box, [&](uint32_t row, uint32_t slice) {
        const uint32_t target = toVolume ? z.begin + slice : to.baseArrayLayer + slice;
        const uint32_t layer = std::min(from.baseArrayLayer + slice, source.info().arrayLayers - 1);
        const Axis::Taps depth = fromVolume ? z.at(target, filter) : Axis::Taps{layer, layer, 0};
        PlaneRow result(x.count);
        blitter.row(y.at(y.begin + row, filter), depth, result);
        pack.pack(result.planes(), x.count,
                  rowAddress(destination, to.mipLevel, y.begin + row, target, 0) +
                      uint64_t{x.begin} * destination.format().bytesPerTexel);
    });
}

void resolveImage(const TransferContext& context, const Image& source, const Image& destination,
                  const VkImageResolve& region) {
    TexelBox from = clipBox(source, region.srcSubresource, region.srcOffset, region.extent);
    TexelBox to = clipBox(destination, region.dstSubresource, region.dstOffset, region.extent);
    if (source.info().format != destination.info().format || destination.info().samples != 1) return;
    to.width = std::min(from.width, to.width);
    to.height = std::min(from.height, to.height);
    to.depth = std::min(from.depth, to.depth);
    const FormatInfo& format = source.format();
    const auto aspect = static_cast<VkImageAspectFlags>(format.aspects & VK_IMAGE_ASPECT_COLOR_BIT);
    if (aspect == 0) return;
    const FormatOps ops = formatOps(source.info().format, aspect, context.isa);
    const uint64_t pitch = source.level(region.srcSubresource.mipLevel).samplePitch;
    forEachRow(context, to, [&](uint32_t y, uint32_t z) {
        resolveTexels(ops,
                      rowAddress(source, region.srcSubresource.mipLevel, from.y + y, from.z + z, 0) +
                          uint64_t{from.x} * format.bytesPerTexel,
                      pitch, source.info().samples, to.width,
                      rowAddress(destination, region.dstSubresource.mipLevel, to.y + y, to.z + z, 0) +
                          uint64_t{to.x} * format.bytesPerTexel);
    });
}

}  // namespace vernier
