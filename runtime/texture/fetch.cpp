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

/// The level that all lanes read, if it is one that exists and may be read.
const TextureLevel* commonLevel(const TextureView& view, const FetchRequest& request) {
    const uint32_t first = at(request.lod, 0);
    uint32_t differences = 0;
    for (uint32_t i = 0; request.lod != nullptr && i < request.lanes; ++i) differences |= at(request.lod, i) ^ first;
    const bool exists = first < view.levelCount && first >= static_cast<uint32_t>(view.minLod);
    return differences == 0 && exists ? &view.levels[first] : nullptr;
}

/// Lanes that are looked at together: a row of a block, as a full-screen pass has them.
constexpr uint32_t kRun = 8;

/// Whether the values of kRun lanes from `first` on are equal, or (kStep 1) go up by one.
template <uint32_t kStep>
bool inARow(const int32_t* values, uint32_t first) {
    if (values == nullptr) return kStep == 0;
    uint32_t differences = 0;
    for (uint32_t k = 1; k < kRun; ++k) differences |= (at(values, first + k) - at(values, first)) ^ (k * kStep);
    return differences == 0;
}

/// Of 2D images with one sample and texels of kBytes, with or without layers. As fetch(), in one pass: lanes outside
/// the image, and those that are not active, read the texel of zero bits. What those hold may be the place of a texel
/// that another thread writes, where fragments read the attachments they draw to.
template <uint32_t kBytes>
void fetchPlain(const TextureView& view, const FetchRequest& request) {
    const TextureLevel* const level = commonLevel(view, request);
    if (level == nullptr || request.sample != nullptr) return fetch(view, request);
    const bool layered = view.type == VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    alignas(16) std::byte texels[kMaxSampleLanes * kBytes];
    // The texel of a lane, if it and `more` behind it are inside.
    const auto texelOf = [&](uint32_t lane, uint32_t more) -> const std::byte* {
        const uint32_t x = at(request.coord[0], lane, request.offset[0]);
        const uint32_t y = at(request.coord[1], lane, request.offset[1]);
        const uint32_t layer = layered ? at(request.coord[3], lane) : 0;
        const bool inside = x < level->width && level->width - x > more && y < level->height && layer < view.layerCount;
        const uint64_t place = layer * level->slicePitch + uint64_t{y} * level->rowPitch + uint64_t{x} * kBytes;
        return inside ? level->data + place : nullptr;
    };
    const auto active = [&](uint32_t lane) { return request.mask == nullptr || request.mask[lane] != 0; };
    for (uint32_t i = 0; i < request.lanes;) {
        // What lies between two texels of active lanes is theirs to read, too.
        const bool row = i + kRun <= request.lanes && active(i) && active(i + kRun - 1) &&
                         inARow<1>(request.coord[0], i) && inARow<0>(request.coord[1], i) &&
                         (!layered || inARow<0>(request.coord[3], i));
        const std::byte* const first = row ? texelOf(i, kRun - 1) : nullptr;
        if (first != nullptr) {
            std::memcpy(texels + i * kBytes, first, kRun * kBytes);
            i += kRun;
            continue;
        }
        for (const uint32_t end = std::min(i + kRun, request.lanes); i < end; ++i) {
            const std::byte* const texel = active(i) ? texelOf(i, 0) : nullptr;
            std::memcpy(texels + i * kBytes, texel != nullptr ? texel : kZeroTexel, kBytes);
        }
    }
    deliver(view, request, [&](void* const(&planes)[4]) { view.ops.unpack(texels, request.lanes, planes); });
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
    if (view.block != nullptr) return fetchBlocks;
    const bool flat = view.type == VK_IMAGE_VIEW_TYPE_2D || view.type == VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    if (!flat || view.samples != 1 || view.texelPitch != view.ops.layout.bytes) return fetch;
    switch (view.texelPitch) {
        case 4:
            return fetchPlain<4>;
        case 8:
            return fetchPlain<8>;
        case 16:
            return fetchPlain<16>;
        default:
            return fetch;
    }
}

}  // namespace vernier
