// Moving data: updates, copies, blits, resolves, mip levels, reading back.
#include <algorithm>
#include <cstring>

#include "api/mini/context_guard.h"
#include "runtime/transfer/region.h"

using namespace vernier;
using namespace vernier::mini;

namespace {

/// A VnRegion with its zeros resolved.
struct Region {
    VkImageSubresourceLayers subresource{};
    VkOffset3D offset{};
    VkExtent3D extent{};
};

VnResult resolveRegion(VnContext context, const char* function, const Image& image, const VnRegion* from, Region& to) {
    const VnRegion region = from ? *from : VnRegion{};
    if (region.mip >= image.info().mipLevels || region.layer >= image.info().arrayLayers)
        return invalid(
            context->device, function,
            "mip " + std::to_string(region.mip) + ", layer " + std::to_string(region.layer) + " is not in the image");
    const VkExtent3D& size = image.level(region.mip).extent;
    const uint32_t width = region.width ? region.width : std::max(size.width, region.x) - region.x;
    const uint32_t height = region.height ? region.height : std::max(size.height, region.y) - region.y;
    const uint32_t depth = region.depth ? region.depth : std::max(size.depth, region.z) - region.z;
    const struct {
        uint32_t offset, count, limit, block;
    } axes[] = {{region.x, width, size.width, image.format().blockWidth()},
                {region.y, height, size.height, image.format().blockHeight()},
                {region.z, depth, size.depth, 1}};
    const auto triple = [](uint32_t a, uint32_t b, uint32_t c) {
        return std::to_string(a) + " x " + std::to_string(b) + " x " + std::to_string(c);
    };
    for (const auto& axis : axes) {
        if (axis.count == 0 || axis.offset > axis.limit || axis.count > axis.limit - axis.offset)
            return invalid(context->device, function,
                           "the region " + triple(width, height, depth) + " at (" + std::to_string(region.x) + ", " +
                               std::to_string(region.y) + ", " + std::to_string(region.z) +
                               ") is not inside the level's " + triple(size.width, size.height, size.depth));
        if (axis.offset % axis.block != 0 || (axis.count % axis.block != 0 && axis.offset + axis.count != axis.limit))
            return invalid(context->device, function,
                           "the region cuts blocks of " + std::to_string(image.format().blockWidth()) + " x " +
                               std::to_string(image.format().blockHeight()) + " texels");
    }
    const VkImageAspectFlags aspect = region.aspect ? region.aspect : defaultAspect(image.format());
    if ((aspect & (aspect - 1)) != 0 || !(aspect & image.format().aspects))
        return invalid(context->device, function, "aspect " + std::to_string(aspect) + " is not one of the image's");
    to.subresource = {aspect, region.mip, region.layer, 1};
    to.offset = {static_cast<int32_t>(region.x), static_cast<int32_t>(region.y), static_cast<int32_t>(region.z)};
    to.extent = {width, height, depth};
    return VN_SUCCESS;
}

/// The image of a transfer command, outside a pass, and its region.
VnResult transferImage(VnContext context, const char* function, VnImage handle, const VnRegion* from,
                       std::shared_ptr<ImageObject>& image, Region& region, bool mayMirror = false) {
    if (context->inPass) return wrongState(context, function, "a pass is open");
    if (from && from->mirror > (mayMirror ? 7u : 0u))
        return invalid(context->device, function, "mirror is " + std::to_string(from->mirror));
    image = context->device->images.find(handle.id);
    if (!image) return badHandle(context->device, function, "image");
    return resolveRegion(context, function, image->image, from, region);
}

VnResult checkBytes(VnContext context, const char* function, const ImageObject& image, const Region& region,
                    const void* data, uint64_t size) {
    const FormatInfo& format = image.image.format();
    const uint64_t needed = uint64_t{bufferTexelBytes(format, region.subresource.aspectMask)} *
                            format.columns(region.extent.width) * format.rows(region.extent.height) *
                            region.extent.depth;
    if (image.image.info().samples > 1)
        return invalid(context->device, function, "the image is multisampled; resolve it first");
    if (data && size >= needed) return VN_SUCCESS;
    return invalid(
        context->device, function,
        "the region needs " + std::to_string(needed) + " bytes, data has " + std::to_string(data ? size : 0));
}

/// A buffer of a transfer command and a range of it.
VnResult transferBuffer(VnContext context, const char* function, VnBuffer handle, uint64_t offset, uint64_t size,
                        std::shared_ptr<BufferObject>& buffer) {
    if (context->inPass) return wrongState(context, function, "a pass is open");
    buffer = context->device->buffers.find(handle.id);
    if (!buffer) return badHandle(context->device, function, "buffer");
    if (offset <= buffer->buffer.size() && size <= buffer->buffer.size() - offset) return VN_SUCCESS;
    return invalid(context->device, function,
                   "offset " + std::to_string(offset) + " with size " + std::to_string(size) +
                       " is not inside the buffer's " + std::to_string(buffer->buffer.size()) + " bytes");
}

bool meet(uint64_t a, uint64_t b, uint64_t aSize, uint64_t bSize) {
    return a < b + bSize && b < a + aSize;
}

/// A copy within one image is in no order: what it reads it must not write.
VnResult checkDisjoint(VnContext context, const char* function, const std::shared_ptr<ImageObject>& from,
                       const Region& a, const std::shared_ptr<ImageObject>& to, const Region& b) {
    const bool same = from == to && a.subresource.mipLevel == b.subresource.mipLevel &&
                      a.subresource.baseArrayLayer == b.subresource.baseArrayLayer;
    const auto at = [](int32_t offset) { return static_cast<uint64_t>(offset); };
    if (same && meet(at(a.offset.x), at(b.offset.x), a.extent.width, b.extent.width) &&
        meet(at(a.offset.y), at(b.offset.y), a.extent.height, b.extent.height))
        return invalid(context->device, function, "the regions overlap in one image");
    return VN_SUCCESS;
}

template <class Item>
std::span<const Item> one(VnContext context, const Item& item) {
    return context->recording->commands.copy(std::span(&item, 1));
}

}  // namespace

VnResult vnUpdateBuffer(VnContext context, VnBuffer buffer, uint64_t offset, const void* data, uint64_t size) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<BufferObject> object;
        if (VnResult result = transferBuffer(context, "vnUpdateBuffer", buffer, offset, size, object)) return result;
        if (!data && size) return invalid(context->device, "vnUpdateBuffer", "data is NULL");
        CommandBuffer& commands = context->recording->commands;
        const std::span bytes(static_cast<const std::byte*>(data), size);
        commands.record(command::UpdateBuffer{&context->recording->keep(object).buffer, offset, commands.copy(bytes)});
        return VN_SUCCESS;
    });
}

VnResult vnFillBuffer(VnContext context, VnBuffer buffer, uint64_t offset, uint64_t size, uint32_t value) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<BufferObject> object;
        if (VnResult result = transferBuffer(context, "vnFillBuffer", buffer, offset, size, object)) return result;
        if (offset % 4 != 0 || size % 4 != 0)
            return invalid(context->device, "vnFillBuffer", "offset and size must be multiples of 4");
        context->recording->commands.record(
            command::FillBuffer{&context->recording->keep(object).buffer, offset, size, value});
        return VN_SUCCESS;
    });
}

VnResult vnUpdateImage(VnContext context, VnImage image, const VnRegion* region, const void* data, uint64_t size) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<ImageObject> object;
        Region resolved;
        if (VnResult result = transferImage(context, "vnUpdateImage", image, region, object, resolved)) return result;
        if (VnResult result = checkBytes(context, "vnUpdateImage", *object, resolved, data, size)) return result;
        Result<std::unique_ptr<Memory>> memory = Memory::create(context->device->runtime->desc().allocator, size);
        if (!memory) return fail(context->device, "vnUpdateImage", memory.error());
        auto staging = std::make_shared<BufferObject>(BufferObject{std::move(memory).value(), Buffer(size, ~0u)});
        staging->buffer.bind(*staging->memory, 0);
        std::memcpy(staging->memory->data(), data, size);
        VkBufferImageCopy copy{};
        copy.imageSubresource = resolved.subresource;
        copy.imageOffset = resolved.offset;
        copy.imageExtent = resolved.extent;
        context->recording->commands.record(command::CopyBufferToImage{
            &context->recording->keep(staging).buffer, &context->recording->keep(object).image, one(context, copy)});
        return VN_SUCCESS;
    });
}

VnResult vnReadImage(VnContext context, VnImage image, const VnRegion* region, void* data, uint64_t size) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<ImageObject> object;
        Region resolved;
        if (VnResult result = transferImage(context, "vnReadImage", image, region, object, resolved)) return result;
        if (VnResult result = checkBytes(context, "vnReadImage", *object, resolved, data, size)) return result;
        if (VnResult result = finish(context, "vnReadImage")) return result;
        const FormatInfo& format = object->image.format();
        const VkImageSubresourceLayers& sub = resolved.subresource;
        const TexelBox box = clipBox(object->image, sub, resolved.offset, resolved.extent);
        const uint64_t pitch = uint64_t{bufferTexelBytes(format, sub.aspectMask)} * box.width;
        for (uint32_t i = 0; i < box.height * box.depth; ++i)
            copyTexelsToBuffer(
                format, sub.aspectMask,
                rowAddress(object->image, sub.mipLevel, box.y + i % box.height, box.z + i / box.height, 0) +
                    uint64_t{box.x} * format.bytesPerTexel,
                box.width, static_cast<std::byte*>(data) + i * pitch);
        return VN_SUCCESS;
    });
}

VnResult vnReadBuffer(VnContext context, VnBuffer buffer, uint64_t offset, void* data, uint64_t size) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<BufferObject> object;
        if (VnResult result = transferBuffer(context, "vnReadBuffer", buffer, offset, size, object)) return result;
        if (!data && size) return invalid(context->device, "vnReadBuffer", "data is NULL");
        if (VnResult result = finish(context, "vnReadBuffer")) return result;
        std::memcpy(data, object->buffer.data() + offset, size);
        return VN_SUCCESS;
    });
}

VnResult vnCopyBuffer(VnContext context, VnBuffer source, uint64_t sourceOffset, VnBuffer destination,
                      uint64_t destinationOffset, uint64_t size) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<BufferObject> from, to;
        if (VnResult result = transferBuffer(context, "vnCopyBuffer", source, sourceOffset, size, from)) return result;
        if (VnResult result = transferBuffer(context, "vnCopyBuffer", destination, destinationOffset, size, to))
            return result;
        if (from == to && meet(sourceOffset, destinationOffset, size, size))
            return invalid(context->device, "vnCopyBuffer", "the ranges overlap in one buffer");
        context->recording->commands.record(
            command::CopyBuffer{&context->recording->keep(from).buffer, &context->recording->keep(to).buffer,
                                one(context, VkBufferCopy{sourceOffset, destinationOffset, size})});
        return VN_SUCCESS;
    });
}

VnResult vnCopyImage(VnContext context, VnImage source, const VnRegion* sourceRegion, VnImage destination,
                     const VnRegion* destinationRegion) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<ImageObject> from, to;
        Region a, b;
        if (VnResult result = transferImage(context, "vnCopyImage", source, sourceRegion, from, a)) return result;
        if (VnResult result = transferImage(context, "vnCopyImage", destination, destinationRegion, to, b))
            return result;
        const FormatInfo& fromFormat = from->image.format();
        const FormatInfo& toFormat = to->image.format();
        if (fromFormat.columns(a.extent.width) != toFormat.columns(b.extent.width) ||
            fromFormat.rows(a.extent.height) != toFormat.rows(b.extent.height) || a.extent.depth != b.extent.depth)
            return invalid(context->device, "vnCopyImage", "the regions have different sizes");
        if (a.subresource.aspectMask != b.subresource.aspectMask)
            return invalid(context->device, "vnCopyImage",
                           "aspect " + std::to_string(a.subresource.aspectMask) + " cannot be copied to aspect " +
                               std::to_string(b.subresource.aspectMask));
        if (VnResult result = checkDisjoint(context, "vnCopyImage", from, a, to, b)) return result;
        if (from->image.format().bytesPerTexel != to->image.format().bytesPerTexel ||
            from->image.info().samples != to->image.info().samples)
            return invalid(context->device, "vnCopyImage",
                           std::string("formats ") + from->image.format().name + " and " + to->image.format().name +
                               " differ in texel size, or the images in samples");
        context->recording->commands.record(
            command::CopyImage{&context->recording->keep(from).image, &context->recording->keep(to).image,
                               one(context, VkImageCopy{a.subresource, a.offset, b.subresource, b.offset, a.extent})});
        return VN_SUCCESS;
    });
}

VnResult vnBlitImage(VnContext context, VnImage source, const VnRegion* sourceRegion, VnImage destination,
                     const VnRegion* destinationRegion, VkFilter filter) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<ImageObject> from, to;
        Region a, b;
        if (VnResult result = transferImage(context, "vnBlitImage", source, sourceRegion, from, a)) return result;
        if (VnResult result = transferImage(context, "vnBlitImage", destination, destinationRegion, to, b, true))
            return result;
        if (filter != VK_FILTER_NEAREST && filter != VK_FILTER_LINEAR && filter != VK_FILTER_CUBIC_EXT)
            return invalid(context->device, "vnBlitImage", "filter is " + std::to_string(filter));
        if (VnResult result = checkDisjoint(context, "vnBlitImage", from, a, to, b)) return result;
        const FormatInfo& fromFormat = from->image.format();
        const FormatInfo& toFormat = to->image.format();
        const bool color = a.subresource.aspectMask == VK_IMAGE_ASPECT_COLOR_BIT;
        const bool sameKind =
            fromFormat.layout(a.subresource.aspectMask).type == toFormat.layout(b.subresource.aspectMask).type;
        const bool smooth = fromFormat.layout(a.subresource.aspectMask).type == ValueType::floating && color;
        if (a.subresource.aspectMask != b.subresource.aspectMask || !sameKind ||
            (!color && fromFormat.format != toFormat.format) || (filter != VK_FILTER_NEAREST && !smooth) ||
            (filter == VK_FILTER_CUBIC_EXT && from->image.info().type != VK_IMAGE_TYPE_2D) ||
            toFormat.block != nullptr || from->image.info().samples > 1 || to->image.info().samples > 1)
            return invalid(context->device, "vnBlitImage",
                           std::string(fromFormat.name) + " cannot be blitted to " + toFormat.name +
                               " with this filter, aspect or sample count");
        VkImageBlit blit{};
        blit.srcSubresource = a.subresource;
        blit.dstSubresource = b.subresource;
        const auto corner = [](const Region& r) {
            return VkOffset3D{r.offset.x + static_cast<int32_t>(r.extent.width),
                              r.offset.y + static_cast<int32_t>(r.extent.height),
                              r.offset.z + static_cast<int32_t>(r.extent.depth)};
        };
        blit.srcOffsets[0] = a.offset;
        blit.srcOffsets[1] = corner(a);
        blit.dstOffsets[0] = b.offset;
        blit.dstOffsets[1] = corner(b);
        const uint32_t mirror = destinationRegion ? destinationRegion->mirror : 0;
        if ((mirror & 1) != 0) std::swap(blit.dstOffsets[0].x, blit.dstOffsets[1].x);
        if ((mirror & 2) != 0) std::swap(blit.dstOffsets[0].y, blit.dstOffsets[1].y);
        if ((mirror & 4) != 0) std::swap(blit.dstOffsets[0].z, blit.dstOffsets[1].z);
        context->recording->commands.record(command::BlitImage{
            &context->recording->keep(from).image, &context->recording->keep(to).image, one(context, blit), filter});
        return VN_SUCCESS;
    });
}

VnResult vnResolveImage(VnContext context, VnImage source, VnImage destination) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<ImageObject> from, to;
        Region a, b;
        if (VnResult result = transferImage(context, "vnResolveImage", source, nullptr, from, a)) return result;
        if (VnResult result = transferImage(context, "vnResolveImage", destination, nullptr, to, b)) return result;
        const ImageInfo& f = from->image.info();
        const ImageInfo& t = to->image.info();
        if (f.samples == 1 || t.samples != 1 || f.format != t.format || f.extent.width != t.extent.width ||
            f.extent.height != t.extent.height || a.subresource.aspectMask != VK_IMAGE_ASPECT_COLOR_BIT)
            return invalid(context->device, "vnResolveImage",
                           "needs a multisampled and a single-sampled colour image of the same size and format");
        context->recording->commands.record(command::ResolveImage{
            &context->recording->keep(from).image, &context->recording->keep(to).image,
            one(context, VkImageResolve{a.subresource, a.offset, b.subresource, b.offset, a.extent})});
        return VN_SUCCESS;
    });
}

VnResult vnGenerateMips(VnContext context, VnImage image) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<ImageObject> object;
        Region region;
        if (VnResult result = transferImage(context, "vnGenerateMips", image, nullptr, object, region)) return result;
        const Image& target = context->recording->keep(object).image;
        if (region.subresource.aspectMask != VK_IMAGE_ASPECT_COLOR_BIT ||
            target.format().color.type != ValueType::floating || target.format().block != nullptr)
            return invalid(context->device, "vnGenerateMips",
                           std::string("format ") + target.format().name + " cannot be filtered");
        const auto corner = [&](uint32_t mip) {
            const VkExtent3D& e = target.level(mip).extent;
            return VkOffset3D{static_cast<int32_t>(e.width), static_cast<int32_t>(e.height),
                              static_cast<int32_t>(e.depth)};
        };
        for (uint32_t mip = 1; mip < target.info().mipLevels; ++mip) {
            VkImageBlit blit{};
            blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, target.info().arrayLayers};
            blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, target.info().arrayLayers};
            blit.srcOffsets[1] = corner(mip - 1);
            blit.dstOffsets[1] = corner(mip);
            context->recording->commands.record(
                command::BlitImage{&target, &target, one(context, blit), VK_FILTER_LINEAR});
        }
        return VN_SUCCESS;
    });
}

VnResult vnClearImage(VnContext context, VnImage image, const VkClearColorValue* value) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<ImageObject> object;
        Region region;
        if (VnResult result = transferImage(context, "vnClearImage", image, nullptr, object, region)) return result;
        if (!value) return invalid(context->device, "vnClearImage", "value is NULL");
        if (region.subresource.aspectMask != VK_IMAGE_ASPECT_COLOR_BIT)
            return invalid(context->device, "vnClearImage", "the image has no colour; clear depth in a pass");
        if (object->image.format().block)
            return invalid(context->device, "vnClearImage", "the image is block-compressed");
        const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, object->image.info().mipLevels, 0,
                                            object->image.info().arrayLayers};
        context->recording->commands.record(
            command::ClearColorImage{&context->recording->keep(object).image, *value, one(context, range)});
        return VN_SUCCESS;
    });
}
