// Texel fetches: integer coordinates, no sampler. Lanes outside the image read as a texel of zero bits.
#include <algorithm>
#include <cstring>

#include "runtime/texture/block_cache.h"
#include "runtime/texture/routing.h"
#include "runtime/texture/texture.h"

namespace vernier {
namespace {

alignas(16) constexpr std::byte kZeroTexel[16] = {};

/// What an axis of FetchRequest::coord ranges over for a view type.
struct FetchShape {
    bool y, z, layer;
};

FetchShape shapeOf(VkImageViewType type) {
    switch (type) {
        case VK_IMAGE_VIEW_TYPE_1D:
            return {false, false, false};
        case VK_IMAGE_VIEW_TYPE_1D_ARRAY:
            return {false, false, true};
        case VK_IMAGE_VIEW_TYPE_2D:
            return {true, false, false};
        case VK_IMAGE_VIEW_TYPE_3D:
            return {true, true, false};
        default:
            return {true, false, true};
    }
}

/// Coordinates as unsigned numbers: negative ones are out of range too.
uint32_t at(const int32_t* values, uint32_t lane, int32_t offset = 0) {
    return values == nullptr ? 0 : static_cast<uint32_t>(values[lane]) + static_cast<uint32_t>(offset);
}

/// Calls read(lane, level, slice, x, y, sample) for the active lanes whose texel exists.
template <class Read>
void forEachTexel(const TextureView& view, const FetchRequest& request, Read read) {
    const FetchShape shape = shapeOf(view.type);
    for (uint32_t i = 0; i < request.lanes; ++i) {
        if (request.mask != nullptr && request.mask[i] == 0) continue;
        const uint32_t levelIndex = at(request.lod, i), sample = at(request.sample, i);
        if (levelIndex >= view.levelCount || sample >= view.samples) continue;
        if (levelIndex < static_cast<uint32_t>(view.minLod)) continue;
        const TextureLevel& level = view.levels[levelIndex];
        const uint32_t x = at(request.coord[0], i, request.offset[0]);
        const uint32_t y = shape.y ? at(request.coord[1], i, request.offset[1]) : 0;
        const uint32_t z = shape.z ? at(request.coord[2], i, request.offset[2]) : 0;
        const uint32_t layer = shape.layer ? at(request.coord[3], i) : 0;
        if (x >= level.width || y >= level.height || z >= level.depth || layer >= view.layerCount) continue;
        read(i, level, level.data + (uint64_t{z} + layer) * level.slicePitch, x, y, sample);
    }
}

/// Converts the texels that `unpack(planes)` gives to the outputs, by the view's swizzle.
template <class Unpack>
void deliver(const TextureView& view, const FetchRequest& request, Unpack unpack) {
    // Each converted component goes straight to the first output that takes it.
    void* planes[4] = {};
    for (uint32_t c = 0; c < 4; ++c) {
        const Route route = routeOf(view.swizzle, c);
        if (request.out[c] != nullptr && route <= Route::a && planes[static_cast<size_t>(route)] == nullptr) {
            planes[static_cast<size_t>(route)] = request.out[c];
        }
    }
    unpack(planes);
    for (uint32_t c = 0; c < 4; ++c) {
        if (request.out[c] == nullptr) continue;
        const Route route = routeOf(view.swizzle, c);
        if (route <= Route::a) {
            const void* const source = planes[static_cast<size_t>(route)];
            if (source != request.out[c]) std::memcpy(request.out[c], source, request.lanes * sizeof(float));
        } else {
            const uint32_t bits = constantBits(view.ops.layout, route == Route::one);
            for (uint32_t i = 0; i < request.lanes; ++i) std::memcpy(request.out[c] + i, &bits, sizeof bits);
        }
    }
}

void fetch(const TextureView& view, const FetchRequest& request) {
    const std::byte* texels[kMaxSampleLanes];
    std::fill_n(texels, request.lanes, kZeroTexel);
    forEachTexel(
        view, request,
        [&](uint32_t lane, const TextureLevel& level, const std::byte* slice, uint32_t x, uint32_t y, uint32_t sample) {
            texels[lane] =
                slice + uint64_t{y} * level.rowPitch + uint64_t{x} * view.texelPitch + sample * view.samplePitch;
        });
    deliver(view, request, [&](void* const(&planes)[4]) { view.ops.unpackEach(texels, request.lanes, planes); });
}

void fetchBlocks(const TextureView& view, const FetchRequest& request) {
    alignas(16) std::byte texels[kMaxSampleLanes * kMaxDecodedBytes];
    const uint32_t bytes = view.ops.layout.bytes;
    std::memset(texels, 0, request.lanes * bytes);
    BlockCache cache(view);
    forEachTexel(view, request,
                 [&](uint32_t lane, const TextureLevel& level, const std::byte* slice, uint32_t x, uint32_t y,
                     uint32_t) { cache.read(view, level, slice, x, y, texels + lane * bytes); });
    deliver(view, request, [&](void* const(&planes)[4]) { view.ops.unpack(texels, request.lanes, planes); });
}

}  // namespace

// The conversion in view.ops is the part that depends on the instruction set.
FetchFn selectFetch(const TextureView& view, Isa) {
    return view.block != nullptr ? fetchBlocks : fetch;
}

}  // namespace vernier
