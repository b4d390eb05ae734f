#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
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
/// specification, "Image Copies With Scaling"). The scale stays a fraction: rounded, it would miss whole texels.
struct Axis {
    double sourceSpan = 1, destinationSpan = 1, source0 = 0, destination0 = 0;
    uint32_t begin = 0, count = 0;  // destination texels, ascending and clipped
    uint32_t sourceSize = 1;

    Axis(int32_t src0, int32_t src1, uint32_t sourceLimit, int32_t dst0, int32_t dst1, uint32_t destinationLimit) {
        sourceSize = sourceLimit;
        if (dst0 == dst1 || src0 == src1) return;
        sourceSpan = static_cast<double>(src1) - src0;
        destinationSpan = static_cast<double>(dst1) - dst0;
        source0 = src0;
        destination0 = dst0;
        const int64_t low = std::max<int64_t>(std::min(dst0, dst1), 0);
        const int64_t high = std::min<int64_t>(std::max(dst0, dst1), destinationLimit);
        begin = static_cast<uint32_t>(std::min<int64_t>(low, destinationLimit));
        count = high > low ? static_cast<uint32_t>(high - low) : 0;
    }

    struct Taps {
        uint32_t first = 0, second = 0;
        float weight = 0;                // of the second; of a cubic filter how far beyond the first
        uint32_t before = 0, after = 0;  // of a cubic filter
    };
    Taps at(uint32_t destination, VkFilter filter) const {
        const double u = (destination + 0.5 - destination0) * sourceSpan / destinationSpan + source0;
        const auto clamp = [&](double texel) {
            return static_cast<uint32_t>(std::clamp(texel, 0.0, static_cast<double>(sourceSize - 1)));
        };
        if (filter == VK_FILTER_NEAREST) return {clamp(std::floor(u)), clamp(std::floor(u)), 0, 0, 0};
        const double floor = std::floor(u - 0.5);
        return {clamp(floor), clamp(floor + 1), static_cast<float>(u - 0.5 - floor), clamp(floor - 1),
                clamp(floor + 2)};
    }
};

/// Equal values stay what they are, bit for bit; a weight of 0 keeps infinities of the other texel out.
float mix(float a, float b, float weight) {
    return weight == 0 || a == b ? a : a + weight * (b - a);
}

/// Catmull-Rom ("Texel Cubic Filtering"); what mix() says of equal values and of infinities holds here.
float mixCubic(const std::array<float, 4>& texels, float a) {
    const float a2 = a * a, a3 = a2 * a, base = texels[1];
    const auto term = [base](float texel, float weight) {
        return weight == 0 || texel == base ? 0 : weight * (texel - base);
    };
    return base + ((term(texels[0], a2 - 0.5f * a - 0.5f * a3) + term(texels[2], 0.5f * a + (a2 + a2) - 1.5f * a3)) +
                   term(texels[3], 0.5f * (a3 - a2)));
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

/// What all rows of a blit share.
struct BlitSource {
    const Image& image;
    uint32_t mip;
    FormatOps ops;
    VkFilter filter;
    std::vector<Axis::Taps> taps;  // along x
};

/// Makes rows of a blit, one after the other on one thread. Neighbouring rows share source rows: those read last are
/// kept, filtered along x.
class Blitter {
  public:
    explicit Blitter(const BlitSource& source)
        : source_(source),
          width_(static_cast<uint32_t>(source.taps.size())),
          texels_(source.image.level(source.mip).extent.width),
          front_(width_),
          back_(width_) {}

    /// One destination row from the source rows around (y, z); valid until the next call.
    PlaneRow& row(const Axis::Taps& y, const Axis::Taps& z) {
        PlaneRow& front = plane(y, z.first, front_);
        if (z.weight == 0) return front;
        return combine(front, plane(y, z.second, back_), z.weight, front_);
    }

  private:
    static constexpr size_t kKept = 4;  // two rows of two slices, or four rows of a cubic filter
    struct Kept {
        uint64_t key = ~uint64_t{0};
        uint64_t used = 0;  // when last
        PlaneRow row{0};
    };

    PlaneRow& plane(const Axis::Taps& y, uint32_t z, PlaneRow& result) {
        PlaneRow& first = horizontal(y.first, z);
        if (y.weight == 0) return first;
        if (source_.filter == VK_FILTER_CUBIC_EXT) {
            return combineCubic({&horizontal(y.before, z), &first, &horizontal(y.second, z), &horizontal(y.after, z)},
                                y.weight, result);
        }
        return combine(first, horizontal(y.second, z), y.weight, result);
    }

    PlaneRow& combine(PlaneRow& a, PlaneRow& b, float weight, PlaneRow& result) const {
        for (size_t c = 0; c < 4; ++c) {
            const float *from = a.plane(c), *other = b.plane(c);
            float* to = result.plane(c);
            for (size_t i = 0; i < width_; ++i) to[i] = mix(from[i], other[i], weight);
        }
        return result;
    }

    PlaneRow& combineCubic(const std::array<PlaneRow*, 4>& rows, float fraction, PlaneRow& result) const {
        for (size_t c = 0; c < 4; ++c) {
            const std::array<const float*, 4> from{rows[0]->plane(c), rows[1]->plane(c), rows[2]->plane(c),
                                                   rows[3]->plane(c)};
            float* to = result.plane(c);
            for (size_t i = 0; i < width_; ++i)
                to[i] = mixCubic({from[0][i], from[1][i], from[2][i], from[3][i]}, fraction);
        }
        return result;
    }

    /// Source row (y, z) filtered along x; it stays while no more than kKept are asked for.
    PlaneRow& horizontal(uint32_t y, uint32_t z) {
        const uint64_t key = uint64_t{z} << 32 | y;
        ++clock_;
        for (Kept& kept : kept_) {
            if (kept.key != key) continue;
            kept.used = clock_;
            return kept.row;
        }
        Kept& kept =
            *std::min_element(kept_.begin(), kept_.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
        kept.used = clock_;
        if (kept.key == ~uint64_t{0}) kept.row = PlaneRow(width_);
        kept.key = key;
        read(y, z);
        for (size_t c = 0; c < 4; ++c) {
            const float* from = texels_.plane(c);
            float* to = kept.row.plane(c);
            if (source_.filter == VK_FILTER_NEAREST) {
                // Integers travel as bits.
                for (size_t i = 0; i < width_; ++i) std::memcpy(to + i, from + source_.taps[i].first, sizeof(float));
            } else if (source_.filter == VK_FILTER_CUBIC_EXT) {
                for (size_t i = 0; i < width_; ++i) {
                    const Axis::Taps& tap = source_.taps[i];
                    to[i] =
                        mixCubic({from[tap.before], from[tap.first], from[tap.second], from[tap.after]}, tap.weight);
                }
            } else {
                for (size_t i = 0; i < width_; ++i) {
                    const Axis::Taps& tap = source_.taps[i];
                    to[i] = mix(from[tap.first], from[tap.second], tap.weight);
                }
            }
        }
        return kept.row;
    }

    void read(uint32_t y, uint32_t z) {
        const FormatInfo& format = source_.image.format();
        const uint32_t width = source_.image.level(source_.mip).extent.width;
        const std::byte* row = rowAddress(source_.image, source_.mip, y / format.blockHeight(), z, 0);
        if (format.block != nullptr) {
            unpackBlocks(format, source_.ops, row, y, width, texels_.writable());
        } else {
            source_.ops.unpack(row, width, texels_.writable());
        }
    }

    const BlitSource& source_;
    uint32_t width_;
    PlaneRow texels_, front_, back_;
    std::array<Kept, kKept> kept_;
    uint64_t clock_ = 0;
};

/// A row of texels of one format picked from another, bit for bit.
template <size_t kBytes>
void pickTexels(const std::vector<Axis::Taps>& taps, const std::byte* from, std::byte* to) {
    for (size_t i = 0; i < taps.size(); ++i) std::memcpy(to + i * kBytes, from + taps[i].first * kBytes, kBytes);
}

using PickTexels = void (*)(const std::vector<Axis::Taps>& taps, const std::byte* from, std::byte* to);

/// nullptr: no format has texels of this size.
PickTexels pickFunction(uint32_t bytes) {
    switch (bytes) {
        case 1:
            return pickTexels<1>;
        case 2:
            return pickTexels<2>;
        case 4:
            return pickTexels<4>;
        case 8:
            return pickTexels<8>;
        case 16:
            return pickTexels<16>;
        default:
            return nullptr;
    }
}

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
    if (destination.format().block != nullptr) return;                                    // nothing encodes blocks
    if (filter == VK_FILTER_CUBIC_EXT && source.info().type != VK_IMAGE_TYPE_2D) return;  // invalid use
    const FormatOps pack = formatOps(destination.info().format, aspect, context.isa);
    BlitSource blit{source, from.mipLevel, formatOps(source.info().format, aspect, context.isa), filter, {}};
    blit.taps.reserve(x.count);
    for (uint32_t i = 0; i < x.count; ++i) blit.taps.push_back(x.at(x.begin + i, filter));
    // Nothing to convert and nothing to weigh: texels move as they are.
    const PickTexels pick = filter == VK_FILTER_NEAREST && source.info().format == destination.info().format &&
                                    source.format().aspects == aspect
                                ? pickFunction(source.format().bytesPerTexel)
                                : nullptr;

    const bool fromVolume = source.info().type == VK_IMAGE_TYPE_3D;
    const bool toVolume = destination.info().type == VK_IMAGE_TYPE_3D;
    const uint32_t slices = toVolume ? z.count : to.layerCount;
    const auto fits = [](const Image& image, bool volume, const VkImageSubresourceLayers& sub) {
        return volume || uint64_t{sub.baseArrayLayer} + sub.layerCount <= image.info().arrayLayers;
    };
    if (!fits(source, fromVolume, from) || !fits(destination, toVolume, to)) return;
    const TexelBox box{x.begin, y.begin, 0, x.count, y.count, slices};
    forEachRun(context, box, [&](uint64_t begin, uint64_t end) {
        std::optional<Blitter> blitter;
        if (!pick) blitter.emplace(blit);
        for (uint64_t i = begin; i < end; ++i) {
            const auto row = static_cast<uint32_t>(i % box.height), slice = static_cast<uint32_t>(i / box.height);
            const uint32_t target = toVolume ? z.begin + slice : to.baseArrayLayer + slice;
            const uint32_t layer = std::min(from.baseArrayLayer + slice, source.info().arrayLayers - 1);
            const Axis::Taps depth = fromVolume ? z.at(target, filter) : Axis::Taps{layer, layer, 0, 0, 0};
            const Axis::Taps line = y.at(y.begin + row, filter);
            std::byte* texels = rowAddress(destination, to.mipLevel, y.begin + row, target, 0) +
                                uint64_t{x.begin} * destination.format().bytesPerTexel;
            if (pick)
                pick(blit.taps, rowAddress(source, from.mipLevel, line.first, depth.first, 0), texels);
            else
                pack.pack(blitter->row(line, depth).planes(), x.count, texels);
        }
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
    if (to.empty()) return;
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
