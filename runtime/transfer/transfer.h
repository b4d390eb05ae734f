// Copies, blits, resolves, clears and fills between buffers and images, as the commands of the same names in the Vulkan
// specification (chapters "Copy Commands" and "Clear Commands"). Regions have been checked by whoever recorded them;
// each function still clips to the resources, so that no input can make it touch memory outside. Rows are shared out
// over the pool.
#pragma once

#include <span>

#include "base/result.h"
#include "base/simd.h"
#include "base/thread_pool.h"
#include "runtime/resource/image.h"
#include "runtime/resource/memory.h"

namespace vernier {

struct TransferContext {
    ThreadPool& pool;
    Isa isa;
};

void copyBuffer(const TransferContext&, const Buffer& source, const Buffer& destination, const VkBufferCopy& region);
/// One sample is copied to all samples of a multisampled destination.
void copyImage(const TransferContext&, const Image& source, const Image& destination, const VkImageCopy& region);
void copyBufferToImage(const TransferContext&, const Buffer& buffer, const Image& image,
                       const VkBufferImageCopy& region);
void copyImageToBuffer(const TransferContext&, const Image& image, const Buffer& buffer,
                       const VkBufferImageCopy& region);
/// Scales and converts, from compressed formats too; nearest or linear filter, coordinates clamped to the edge of the
/// source level.
void blitImage(const TransferContext&, const Image& source, const Image& destination, const VkImageBlit& region,
               VkFilter filter);
/// Averages the samples of float and normalised formats (sRGB: of the linear values), takes sample 0 of integer
/// formats.
void resolveImage(const TransferContext&, const Image& source, const Image& destination, const VkImageResolve& region);
void clearColorImage(const TransferContext&, const Image& image, const VkClearColorValue& value,
                     const VkImageSubresourceRange& range);
void clearDepthStencilImage(const TransferContext&, const Image& image, const VkClearDepthStencilValue& value,
                            const VkImageSubresourceRange& range);
void fillBuffer(const TransferContext&, const Buffer& buffer, VkDeviceSize offset, VkDeviceSize size, uint32_t value);
void updateBuffer(const Buffer& buffer, VkDeviceSize offset, std::span<const std::byte> bytes);

/// Checks one region against an image and a buffer of `bufferSize` bytes, naming what is outside. Both front ends call
/// it when recording.
Status checkBufferImageCopy(const Image& image, VkDeviceSize bufferSize, const VkBufferImageCopy& region);

}  // namespace vernier
