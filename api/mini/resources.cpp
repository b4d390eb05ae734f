// Buffers, images, views, samplers.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "api/mini/errors.h"

using namespace vernier;
using namespace vernier::mini;

namespace {

/// Every image can be used for everything its format allows.
VkImageUsageFlags usageOf(const FormatInfo& format, VkImageType type) {
    constexpr VkImageUsageFlags kAlways =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const VkFormatFeatureFlags features = format.optimalTilingFeatures;
    VkImageUsageFlags usage = kAlways;
    if (features & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT) usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    if (type != VK_IMAGE_TYPE_3D && features & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT)
        usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if (features & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    return usage;
}

VkImageViewType viewTypeOf(const ImageObject& image, uint32_t layers, bool array, bool slices) {
    const VkImageType type = image.image.info().type;
    if (type == VK_IMAGE_TYPE_1D) return layers > 1 || array ? VK_IMAGE_VIEW_TYPE_1D_ARRAY : VK_IMAGE_VIEW_TYPE_1D;
    if (type == VK_IMAGE_TYPE_3D && !slices) return VK_IMAGE_VIEW_TYPE_3D;
    if (image.cube && layers % 6 == 0)
        return layers == 6 && !array ? VK_IMAGE_VIEW_TYPE_CUBE : VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
    return layers > 1 || array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
}

Result<ImageView> makeView(VnDevice device, const ImageObject& object, const VnViewDesc& desc) {
    const ImageInfo& info = object.image.info();
    ImageViewInfo view;
    view.format = desc.format ? desc.format : info.format;
    view.components = desc.swizzle;
    view.range.aspectMask = desc.aspect ? desc.aspect : object.image.format().aspects;
    view.range.baseMipLevel = desc.baseMip;
    view.range.levelCount = desc.mipCount ? desc.mipCount : std::max(info.mipLevels, desc.baseMip) - desc.baseMip;
    view.range.baseArrayLayer = desc.baseLayer;
    const bool slices = desc.slices != 0 && info.type == VK_IMAGE_TYPE_3D;
    const uint32_t layers =
        slices ? std::max(1u, desc.baseMip < 32 ? info.extent.depth >> desc.baseMip : 0) : info.arrayLayers;
    view.range.layerCount = desc.layerCount ? desc.layerCount : std::max(layers, desc.baseLayer) - desc.baseLayer;
    view.type = viewTypeOf(object, view.range.layerCount, desc.array != 0, slices);
    return ImageView::create(object.image, view, device->runtime->isa());
}

VnResult createView(VnDevice device, const char* function, std::shared_ptr<ImageObject> image, const VnViewDesc& desc,
                    VnView* view) {
    Result<ImageView> made = makeView(device, *image, desc);
    if (!made) return fail(device, function, made.error());
    view->id =
        device->views.insert(std::make_shared<ViewObject>(ViewObject{std::move(image), std::move(made).value()}));
    return VN_SUCCESS;
}

float maxLodOf(const VnSamplerDesc& desc) {
    return desc.maxLod == 0 ? VK_LOD_CLAMP_NONE : desc.maxLod;
}

VnResult checkSampler(VnDevice device, const VnSamplerDesc& desc) {
    constexpr const char* kFunction = "vnCreateSampler";
    const struct {
        const char* name;
        int64_t value, last;
    } enums[] = {{"mipmapMode", enumValue(desc.mipmapMode), VK_SAMPLER_MIPMAP_MODE_LINEAR},
                 {"addressU", enumValue(desc.addressU), VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE},
                 {"addressV", enumValue(desc.addressV), VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE},
                 {"addressW", enumValue(desc.addressW), VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE},
                 {"compareOp", enumValue(desc.compareOp), VK_COMPARE_OP_ALWAYS}};
    for (const auto& field : enums)
        if (VnResult r = checkEnum(device, kFunction, field.name, field.value, field.last)) return r;
    for (const auto& [name, filter] : {std::pair{"magFilter", desc.magFilter}, {"minFilter", desc.minFilter}}) {
        if (filter == VK_FILTER_CUBIC_EXT) {
            if (desc.maxAnisotropy > 1)
                return invalid(device, kFunction, std::string(name) + " is cubic, which maxAnisotropy excludes");
            continue;
        }
        if (VnResult r = checkEnum(device, kFunction, name, enumValue(filter), VK_FILTER_LINEAR)) return r;
    }
    const int64_t border = enumValue(desc.borderColor);
    if (border != VK_BORDER_COLOR_FLOAT_CUSTOM_EXT && border != VK_BORDER_COLOR_INT_CUSTOM_EXT)
        if (VnResult r = checkEnum(device, kFunction, "borderColor", border, VK_BORDER_COLOR_INT_OPAQUE_WHITE))
            return r;
    if (!(desc.lodBias >= -kMaxSamplerLodBias && desc.lodBias <= kMaxSamplerLodBias))
        return invalid(device, kFunction, "lodBias is " + std::to_string(desc.lodBias) + ", but must be -15 to 15");
    if (std::isnan(desc.minLod)) return invalid(device, kFunction, "minLod is nan");
    if (std::isnan(desc.maxLod)) return invalid(device, kFunction, "maxLod is nan");
    if (desc.minLod > maxLodOf(desc))
        return invalid(device, kFunction,
                       "minLod " + std::to_string(desc.minLod) + " is above maxLod " + std::to_string(maxLodOf(desc)));
    return VN_SUCCESS;
}

}  // namespace

VnResult vnCreateBuffer(VnDevice device, const VnBufferDesc* desc, VnBuffer* buffer) {
    return guarded(device, __func__, [&] {
        if (VnResult result = checkDesc(device, "vnCreateBuffer", desc, buffer)) return result;
        buffer->id = 0;
        if (desc->size == 0) return invalid(device, "vnCreateBuffer", "size is 0");
        Result<std::unique_ptr<Memory>> memory = Memory::create(device->runtime->desc().allocator, desc->size);
        if (!memory) return fail(device, "vnCreateBuffer", memory.error());
        auto object = std::make_shared<BufferObject>(BufferObject{std::move(memory).value(), Buffer(desc->size, ~0u)});
        object->buffer.bind(*object->memory, 0);
        if (desc->data) std::memcpy(object->memory->data(), desc->data, desc->size);
        buffer->id = device->buffers.insert(std::move(object));
        return VN_SUCCESS;
    });
}

VnResult vnDestroyBuffer(VnDevice device, VnBuffer buffer) {
    return guarded(device, __func__,
                   [&] { return destroyIn(device, "vnDestroyBuffer", "buffer", device->buffers, buffer.id); });
}

VnResult vnMapBuffer(VnDevice device, VnBuffer buffer, void** memory) {
    return guarded(device, __func__, [&] {
        if (!memory) return invalid(device, "vnMapBuffer", "memory is NULL");
        *memory = nullptr;
        const auto object = device->buffers.find(buffer.id);
        if (!object) return badHandle(device, "vnMapBuffer", "buffer");
        *memory = object->buffer.data();
        return VN_SUCCESS;
    });
}

VnResult vnCreateImage(VnDevice device, const VnImageDesc* desc, VnImage* image) {
    return guarded(device, __func__, [&] {
        if (VnResult result = checkDesc(device, "vnCreateImage", desc, image)) return result;
        image->id = 0;
        ImageInfo info;
        info.format = desc->format ? desc->format : VK_FORMAT_R8G8B8A8_UNORM;
        if (desc->dimensions > 3)
            return invalid(device, "vnCreateImage", "dimensions is " + std::to_string(desc->dimensions));
        info.type = desc->dimensions == 1   ? VK_IMAGE_TYPE_1D
                    : desc->dimensions == 3 ? VK_IMAGE_TYPE_3D
                                            : VK_IMAGE_TYPE_2D;
        if (info.type == VK_IMAGE_TYPE_3D) info.flags = VK_IMAGE_CREATE_2D_ARRAY_COMPATIBLE_BIT;
        const uint32_t height = desc->height == 0 && desc->dimensions == 1 ? 1 : desc->height;
        info.extent = {desc->width, height, std::max(desc->depth, 1u)};
        info.mipLevels = std::max(desc->mipLevels, 1u);
        if (desc->mipLevels == VN_ALL_MIPS) {
            const uint32_t longest = std::max({desc->width, height, info.extent.depth});
            info.mipLevels = std::max(1u, static_cast<uint32_t>(std::bit_width(longest)));
        }
        info.arrayLayers = std::max(desc->layers, 1u);
        info.samples = std::max(desc->samples, 1u);
        if (desc->cube && (info.type != VK_IMAGE_TYPE_2D || info.arrayLayers % 6 != 0 || desc->width != desc->height))
            return invalid(device, "vnCreateImage", "cube images are 2D, square and have layers in sixes");
        const FormatInfo* format = findFormat(info.format);
        if (!format)
            return fail(device, "vnCreateImage",
                        unsupported("image: format " + std::to_string(info.format) + " is not supported"));
        info.usage = usageOf(*format, info.type);
        Result<Image> made = Image::create(info);
        if (!made) return fail(device, "vnCreateImage", made.error());
        Result<std::unique_ptr<Memory>> memory = Memory::create(device->runtime->desc().allocator, made->memorySize());
        if (!memory) return fail(device, "vnCreateImage", memory.error());
        auto object = std::make_shared<ImageObject>();
        object->memory = std::move(memory).value();
        object->image = std::move(made).value();
        object->image.bind(*object->memory, 0);
        object->cube = desc->cube != 0;
        image->id = device->images.insert(std::move(object));
        return VN_SUCCESS;
    });
}

VnResult vnDestroyImage(VnDevice device, VnImage image) {
    return guarded(device, __func__, [&] {
        const auto object = device->images.remove(image.id);
        if (!object) return badHandle(device, "vnDestroyImage", "image");
        const std::lock_guard lock(object->defaultViewMutex);
        if (object->defaultView) device->views.remove(object->defaultView);
        return VN_SUCCESS;
    });
}

VnResult vnCreateView(VnDevice device, const VnViewDesc* desc, VnView* view) {
    return guarded(device, __func__, [&] {
        if (VnResult result = checkDesc(device, "vnCreateView", desc, view)) return result;
        view->id = 0;
        auto image = device->images.find(desc->image.id);
        if (!image) return badHandle(device, "vnCreateView", "image");
        return createView(device, "vnCreateView", std::move(image), *desc, view);
    });
}

VnResult vnDestroyView(VnDevice device, VnView view) {
    return guarded(device, __func__,
                   [&] { return destroyIn(device, "vnDestroyView", "view", device->views, view.id); });
}

VnResult vnGetImageView(VnDevice device, VnImage image, VnView* view) {
    return guarded(device, __func__, [&] {
        if (!view) return invalid(device, "vnGetImageView", "view is NULL");
        view->id = 0;
        const auto object = device->images.find(image.id);
        if (!object) return badHandle(device, "vnGetImageView", "image");
        const std::lock_guard lock(object->defaultViewMutex);
        // The image must not own itself through its view, so the handle is kept and the view owns the image's memory.
        if (!object->defaultView || !device->views.find(object->defaultView)) {
            if (VnResult result = createView(device, "vnGetImageView", object, VnViewDesc{}, view)) return result;
            object->defaultView = view->id;
        }
        view->id = object->defaultView;
        return VN_SUCCESS;
    });
}

VnResult vnCreateSampler(VnDevice device, const VnSamplerDesc* desc, VnSampler* sampler) {
    return guarded(device, __func__, [&] {
        if (VnResult result = checkDesc(device, "vnCreateSampler", desc, sampler)) return result;
        sampler->id = 0;
        if (VnResult result = checkSampler(device, *desc)) return result;
        VkSamplerCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
        info.magFilter = desc->magFilter;
        info.minFilter = desc->minFilter;
        info.mipmapMode = desc->mipmapMode;
        info.addressModeU = desc->addressU;
        info.addressModeV = desc->addressV;
        info.addressModeW = desc->addressW;
        info.mipLodBias = desc->lodBias;
        info.minLod = desc->minLod;
        info.maxLod = maxLodOf(*desc);
        info.compareEnable = desc->compareEnable != 0;
        info.compareOp = desc->compareOp;
        info.borderColor = desc->borderColor;
        info.unnormalizedCoordinates = desc->unnormalized != 0;
        if (desc->seams) info.flags |= VK_SAMPLER_CREATE_NON_SEAMLESS_CUBE_MAP_BIT_EXT;
        if (!(desc->maxAnisotropy >= 0 && desc->maxAnisotropy <= kMaxSamplerAnisotropy))
            return invalid(device, "vnCreateSampler", "maxAnisotropy is " + std::to_string(desc->maxAnisotropy));
        if (desc->reduction < VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE ||
            desc->reduction > VK_SAMPLER_REDUCTION_MODE_MAX)
            return invalid(device, "vnCreateSampler", "reduction is " + std::to_string(desc->reduction));
        info.anisotropyEnable = desc->maxAnisotropy > 1;
        info.maxAnisotropy = desc->maxAnisotropy;
        SamplerState state = makeSamplerState(info);
        state.reduction = desc->reduction;
        if (desc->borderColor == VK_BORDER_COLOR_FLOAT_CUSTOM_EXT ||
            desc->borderColor == VK_BORDER_COLOR_INT_CUSTOM_EXT)
            state.borderColor = desc->customBorderColor;
        sampler->id = device->samplers.insert(std::make_shared<SamplerObject>(SamplerObject{state}));
        return VN_SUCCESS;
    });
}

VnResult vnDestroySampler(VnDevice device, VnSampler sampler) {
    return guarded(device, __func__,
                   [&] { return destroyIn(device, "vnDestroySampler", "sampler", device->samplers, sampler.id); });
}
