// Regions of images as runs of rows: clipping, and sharing rows out over threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

#include "base/thread_pool.h"
#include "runtime/resource/image.h"
#include "runtime/transfer/transfer.h"

namespace vernier {

/// A box of texels in one mip level, of a compressed image a box of blocks. Layers of arrays and depth slices are both
/// counted by z, samples apart.
struct TexelBox {
    uint32_t x = 0, y = 0, z = 0;
    uint32_t width = 0, height = 0, depth = 0;
    bool empty() const { return width == 0 || height == 0 || depth == 0; }
};

/// The box a subresource, an offset and an extent (both in texels) name, clipped to the image. For 3D images z counts
/// slices; otherwise it counts layers, of which there are max(layerCount, extent.depth): copies between 3D images and
/// arrays give both.
TexelBox clipBox(const Image& image, const VkImageSubresourceLayers& subresource, const VkOffset3D& offset,
                 const VkExtent3D& extent);

/// Row `y` of slice or layer `z` of a level, first texel (or row of blocks, first block).
std::byte* rowAddress(const Image& image, uint32_t mip, uint32_t y, uint32_t z, uint32_t sample);

/// Calls row(y, z) for every row of the box, y and z relative to it, on all threads when the box is big.
void forEachRow(const TransferContext& context, const TexelBox& box,
                const std::function<void(uint32_t y, uint32_t z)>& row);

/// The same by runs of rows, for work that keeps something from one row to the next: run(begin, end), where row i is
/// y = i % box.height of z = i / box.height.
void forEachRun(const TransferContext& context, const TexelBox& box,
                const std::function<void(uint64_t begin, uint64_t end)>& run);

}  // namespace vernier
