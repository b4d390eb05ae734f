#include "runtime/raster/attachment_ops.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "runtime/format/format.h"
#include "runtime/format/resolve.h"
#include "runtime/geometry/chunk.h"

namespace vernier {
namespace {

constexpr uint32_t kRow = static_cast<uint32_t>(kTileSize);

std::byte* pixel(const RenderTarget& target, int32_t x, int32_t y, uint32_t sample, uint32_t layer, uint32_t bytes) {
    return target.data + layer * target.layerPitch + sample * target.samplePitch +
           static_cast<size_t>(y) * target.rowPitch + static_cast<size_t>(x) * bytes;
}

/// Calls function(x, y, n) for runs of up to kRow pixels.
template <class Function>
void eachRun(const PixelRect& rect, const Function& function) {
    for (int32_t y = rect.y0; y < rect.y1; ++y)
        for (int32_t x = rect.x0; x < rect.x1; x += kTileSize)
            function(x, y, static_cast<uint32_t>(std::min(rect.x1 - x, kTileSize)));
}

}  // namespace

void clearPixels(const RenderTarget& target, VkImageAspectFlags aspects, const VkClearValue& value,
                 const PixelRect& rect, uint32_t layer) {
    const FormatInfo* info = findFormat(target.format);
    if (info == nullptr || target.data == nullptr) return;
    aspects &= info->aspects;
    if (aspects == 0) return;
    const uint32_t bytes = info->bytesPerTexel;
    std::array<std::byte, 16> texel{}, kept;
    packClear(*info, aspects, value, texel.data());
    // One aspect of two: the other one's bits stay, which are those that packing leaves as they were.
    const bool partial = aspects != info->aspects;
    kept.fill(std::byte{0xFF});
    packClear(*info, aspects, value, kept.data());
    for (uint32_t k = 0; k < bytes; ++k) kept[k] ^= texel[k];
    std::array<std::byte, 16 * kRow> row, keptRow;
    for (uint32_t n = 0; n < kRow; ++n) {
        std::memcpy(row.data() + n * bytes, texel.data(), bytes);
        std::memcpy(keptRow.data() + n * bytes, kept.data(), bytes);
    }
    for (uint32_t s = 0; s < target.samples; ++s) {
        eachRun(rect, [&](int32_t x, int32_t y, uint32_t n) {
            std::byte* place = pixel(target, x, y, s, layer, bytes);
            if (!partial) {
                std::memcpy(place, row.data(), n * bytes);
            } else {
                for (uint32_t k = 0; k < n * bytes; ++k) place[k] = (place[k] & keptRow[k]) | row[k];
            }
        });
    }
}

void resolvePixels(const RenderTarget& source, const RenderTarget& destination, const PixelRect& rect, uint32_t layer,
                   Isa isa) {
    const FormatInfo* info = findFormat(source.format);
    if (info == nullptr || source.data == nullptr || destination.data == nullptr) return;
    const uint32_t bytes = info->bytesPerTexel;
    const FormatOps ops = formatOps(source.format, isa);
    for (int32_t y = rect.y0; y < rect.y1; ++y) {
        resolveTexels(ops, pixel(source, rect.x0, y, 0, layer, bytes), source.samplePitch, source.samples,
                      static_cast<size_t>(std::max(rect.x1 - rect.x0, 0)),
                      pixel(destination, rect.x0, y, 0, layer, bytes));
    }
}

}  // namespace vernier
