#include "runtime/raster/depth_resolve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "runtime/format/format.h"
#include "runtime/plan/plan.h"
#include "runtime/raster/depth_stencil.h"

namespace vernier {
namespace {

template <class T>
T combine(VkResolveModeFlagBits mode, const std::array<T, kMaxSamples>& values, uint32_t samples) {
    switch (mode) {
        case VK_RESOLVE_MODE_MIN_BIT:
            return *std::min_element(values.begin(), values.begin() + samples);
        case VK_RESOLVE_MODE_MAX_BIT:
            return *std::max_element(values.begin(), values.begin() + samples);
        case VK_RESOLVE_MODE_AVERAGE_BIT: {
            // Codes and floats alike are exact in double, and so is the sum of codes.
            double sum = 0;
            for (uint32_t s = 0; s < samples; ++s) sum += static_cast<double>(values[s]);
            const double average = sum / samples;
            return static_cast<T>(std::is_integral_v<T> ? std::nearbyint(average) : average);
        }
        default:
            return values[0];
    }
}

template <class T>
T load(const std::byte* place) {
    T value;
    std::memcpy(&value, place, sizeof value);
    return value;
}

template <class T>
void store(std::byte* place, T value) {
    std::memcpy(place, &value, sizeof value);
}

/// The depth of each sample as code or float, combined, into the destination's texel.
template <class T>
void resolveDepth(VkResolveModeFlagBits mode, const std::byte* from, size_t samplePitch, uint32_t samples, T mask,
                  std::byte* to) {
    std::array<T, kMaxSamples> values{};
    for (uint32_t s = 0; s < samples; ++s) {
        values[s] = load<T>(from + s * samplePitch);
        if constexpr (std::is_integral_v<T>) values[s] &= mask;
    }
    T result = combine(mode, values, samples);
    if constexpr (std::is_integral_v<T>) result = static_cast<T>(result | (load<T>(to) & static_cast<T>(~mask)));
    store(to, result);
}

}  // namespace

bool canResolveDepthStencil(VkFormat source, VkFormat destination) {
    const auto kind = [](VkFormat format) {
        const DepthStorage storage = depthStorage(format);
        return storage == DepthStorage::d32fs8 ? DepthStorage::d32f : storage;
    };
    const FormatInfo *from = findFormat(source), *to = findFormat(destination);
    if (from == nullptr || to == nullptr) return false;
    const VkImageAspectFlags both = from->aspects & to->aspects;
    return both != 0 && ((both & VK_IMAGE_ASPECT_DEPTH_BIT) == 0 || kind(source) == kind(destination));
}

void resolveDepthStencil(const RenderTarget& source, const RenderTarget& destination, VkResolveModeFlagBits depthMode,
                         VkResolveModeFlagBits stencilMode, const PixelRect& rect, uint32_t layer) {
    const FormatInfo *from = findFormat(source.format), *to = findFormat(destination.format);
    if (source.data == nullptr || destination.data == nullptr) return;
    if (!canResolveDepthStencil(source.format, destination.format)) return;
    const VkImageAspectFlags both = from->aspects & to->aspects;
    const DepthStorage storage = depthStorage(source.format);
    const bool depth = depthMode != VK_RESOLVE_MODE_NONE && (both & VK_IMAGE_ASPECT_DEPTH_BIT) != 0;
    const bool stencil = stencilMode != VK_RESOLVE_MODE_NONE && (both & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
    const size_t fromStencil = stencilOffset(storage), toStencil = stencilOffset(depthStorage(destination.format));
    for (int32_t y = rect.y0; y < rect.y1; ++y) {
        for (int32_t x = rect.x0; x < rect.x1; ++x) {
            const auto place = [&](const RenderTarget& target, uint32_t bytes) {
                return target.data + layer * target.layerPitch + static_cast<size_t>(y) * target.rowPitch +
                       static_cast<size_t>(x) * bytes;
            };
            const std::byte* texel = place(source, from->bytesPerTexel);
            std::byte* result = place(destination, to->bytesPerTexel);
            if (depth) {
                if (storage == DepthStorage::d16) {
                    resolveDepth<uint16_t>(depthMode, texel, source.samplePitch, source.samples, 0xFFFF, result);
                } else if (storage == DepthStorage::d24) {
                    resolveDepth<uint32_t>(depthMode, texel, source.samplePitch, source.samples, 0xFFFFFF, result);
                } else {
                    resolveDepth<float>(depthMode, texel, source.samplePitch, source.samples, 0, result);
                }
            }
            if (stencil)
                resolveDepth<uint8_t>(stencilMode, texel + fromStencil, source.samplePitch, source.samples, 0xFF,
                                      result + toStencil);
        }
    }
}

}  // namespace vernier
