// Images.
#include <algorithm>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/external.h"
#include "api/vulkan/format_properties.h"
#include "api/vulkan/memory.h"
#include "api/vulkan/swapchain.h"
#include "runtime/resource/image.h"

namespace vernier::vulkan {
namespace {

/// The creation parameters against what vkGetPhysicalDeviceImageFormatProperties promises.
Status checkCreateInfo(const PhysicalDevice& device, const VkImageCreateInfo& info) {
    VkImageFormatProperties limits{};
    const VkImageUsageFlags usage = usageOfAspects(info.pNext, info.usage);
    const VkResult supported =
        imageFormatProperties(device, info.format, info.imageType, info.tiling, usage, info.flags, limits);
    if (supported != VK_SUCCESS) {
        return unsupported("images of " + nameOf(info.format) + " with imageType " + std::to_string(info.imageType) +
                           ", tiling " + std::to_string(info.tiling) + ", usage " + std::to_string(usage) + ", flags " +
                           std::to_string(info.flags) + " are not supported");
    }
    const auto bad = [](const char* field, uint64_t value, uint64_t limit) {
        return invalidArgument(std::string(field) + " is " + std::to_string(value) + ", allowed are 1 to " +
                               std::to_string(limit));
    };
    const VkExtent3D& extent = info.extent;
    if (extent.width - 1 >= limits.maxExtent.width) return bad("extent.width", extent.width, limits.maxExtent.width);
    if (extent.height - 1 >= limits.maxExtent.height) {
        return bad("extent.height", extent.height, limits.maxExtent.height);
    }
    if (extent.depth - 1 >= limits.maxExtent.depth) return bad("extent.depth", extent.depth, limits.maxExtent.depth);
    if (info.mipLevels - 1 >= limits.maxMipLevels) return bad("mipLevels", info.mipLevels, limits.maxMipLevels);
    if (info.arrayLayers - 1 >= limits.maxArrayLayers) {
        return bad("arrayLayers", info.arrayLayers, limits.maxArrayLayers);
    }
    if ((info.samples & limits.sampleCounts) == 0) {
        return invalidArgument("samples is " + std::to_string(info.samples) + ", allowed is the mask " +
                               std::to_string(limits.sampleCounts));
    }
    return {};
}

Result<Image> makeImage(const PhysicalDevice& device, const VkImageCreateInfo& from) {
    if (Status status = checkCreateInfo(device, from); !status) return status.error();
    ImageInfo info;
    info.type = from.imageType;
    info.format = from.format;
    info.extent = from.extent;
    info.mipLevels = from.mipLevels;
    info.arrayLayers = from.arrayLayers;
    info.samples = static_cast<uint32_t>(from.samples);
    info.tiling = from.tiling;
    info.usage = usageOfAspects(from.pNext, from.usage);
    info.flags = from.flags;
    return Image::create(info);
}

/// To the memory of an image of a swapchain, as another name of it.
VkResult bindToSwapchain(const Device& device, Image& image, const VkBindImageMemorySwapchainInfoKHR& info) {
    const auto& images = object(info.swapchain)->images;
    if (info.imageIndex >= images.size() || images[info.imageIndex].memory->size() < image.memorySize()) {
        return device.report("vkBindImageMemory2", VK_ERROR_UNKNOWN, "the swapchain has no such image");
    }
    image.bind(*images[info.imageIndex].memory, 0);
    return VK_SUCCESS;
}

VkResult bindPlane(const Device& device, const VkBindImageMemoryInfo& bind, VkImageAspectFlags aspect) {
    Image& image = *object(bind.image);
    const VkDeviceSize size = image.ofAspect(aspect).memorySize();
    if (planeOfAspect(aspect) >= image.planes().size()) {
        return device.report("vkBindImageMemory2", VK_ERROR_UNKNOWN, "the image has no such plane");
    }
    if (const Status fits = checkBinding(object(bind.memory), bind.memoryOffset, size); !fits) {
        return device.report("vkBindImageMemory2", fits.error());
    }
    image.bindPlane(planeOfAspect(aspect), *object(bind.memory)->memory, bind.memoryOffset);
    return VK_SUCCESS;
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL CreateImage(VkDevice device, const VkImageCreateInfo* pCreateInfo,
                                           const VkAllocationCallbacks* pAllocator, VkImage* pImage) {
    return guarded([&] {
        const Device& owner = *object(device);
        const auto* external = findInChain<VkExternalMemoryImageCreateInfo>(pCreateInfo->pNext);
        if (external != nullptr && !areExternalMemoryTypes(external->handleTypes)) {
            return owner.report("vkCreateImage", VK_ERROR_FEATURE_NOT_PRESENT,
                                "handleTypes: only opaque file descriptors and host memory are supported");
        }
        Result<Image> image = makeImage(owner.physicalDevice, *pCreateInfo);
        if (!image) return owner.report("vkCreateImage", image.error());
        return createHandle(pAllocator, pImage, std::move(image).value());
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyImage(VkDevice, VkImage image, const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, image);
}

VKAPI_ATTR void VKAPI_CALL GetImageMemoryRequirements(VkDevice, VkImage image,
                                                      VkMemoryRequirements* pMemoryRequirements) {
    *pMemoryRequirements = memoryRequirements(object(image)->memorySize());
}

VKAPI_ATTR void VKAPI_CALL GetImageMemoryRequirements2(VkDevice, const VkImageMemoryRequirementsInfo2* pInfo,
                                                       VkMemoryRequirements2* pMemoryRequirements) {
    const auto* plane = findInChain<VkImagePlaneMemoryRequirementsInfo>(pInfo->pNext);
    const Image& image = object(pInfo->image)->ofAspect(plane != nullptr ? plane->planeAspect : 0);
    pMemoryRequirements->memoryRequirements = memoryRequirements(image.memorySize());
    fillRequirementChain(pMemoryRequirements->pNext);
}

VKAPI_ATTR void VKAPI_CALL GetDeviceImageMemoryRequirements(VkDevice device,
                                                            const VkDeviceImageMemoryRequirements* pInfo,
                                                            VkMemoryRequirements2* pMemoryRequirements) {
    pMemoryRequirements->memoryRequirements = {};
    (void)guarded([&] {
        const Result<Image> image = makeImage(object(device)->physicalDevice, *pInfo->pCreateInfo);
        if (!image) return object(device)->report("vkGetDeviceImageMemoryRequirements", image.error());
        const bool disjoint = (pInfo->pCreateInfo->flags & VK_IMAGE_CREATE_DISJOINT_BIT) != 0;
        const Image& part = image->ofAspect(disjoint ? pInfo->planeAspect : 0);
        pMemoryRequirements->memoryRequirements = memoryRequirements(part.memorySize());
        return VK_SUCCESS;
    });
    fillRequirementChain(pMemoryRequirements->pNext);
}

VKAPI_ATTR void VKAPI_CALL GetDeviceImageSparseMemoryRequirements(VkDevice, const VkDeviceImageMemoryRequirements*,
                                                                  uint32_t* pSparseMemoryRequirementCount,
                                                                  VkSparseImageMemoryRequirements2*) {
    *pSparseMemoryRequirementCount = 0;
}

VKAPI_ATTR void VKAPI_CALL GetImageSparseMemoryRequirements(VkDevice, VkImage, uint32_t* pSparseMemoryRequirementCount,
                                                            VkSparseImageMemoryRequirements*) {
    *pSparseMemoryRequirementCount = 0;
}

VKAPI_ATTR void VKAPI_CALL GetImageSparseMemoryRequirements2(VkDevice, const VkImageSparseMemoryRequirementsInfo2*,
                                                             uint32_t* pSparseMemoryRequirementCount,
                                                             VkSparseImageMemoryRequirements2*) {
    *pSparseMemoryRequirementCount = 0;
}

VKAPI_ATTR VkResult VKAPI_CALL BindImageMemory(VkDevice device, VkImage image, VkDeviceMemory memory,
                                               VkDeviceSize memoryOffset) {
    return guarded([&] {
        if (const Status fits = checkBinding(object(memory), memoryOffset, object(image)->memorySize()); !fits) {
            return object(device)->report("vkBindImageMemory", fits.error());
        }
        object(image)->bind(*object(memory)->memory, memoryOffset);
        return VK_SUCCESS;
    });
}

VKAPI_ATTR VkResult VKAPI_CALL BindImageMemory2(VkDevice device, uint32_t bindInfoCount,
                                                const VkBindImageMemoryInfo* pBindInfos) {
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < bindInfoCount; ++i) {
        const VkBindImageMemoryInfo& bind = pBindInfos[i];
        const auto* shown = findInChain<VkBindImageMemorySwapchainInfoKHR>(bind.pNext);
        const auto* plane = findInChain<VkBindImagePlaneMemoryInfo>(bind.pNext);
        const VkResult one = shown != nullptr && shown->swapchain != VK_NULL_HANDLE
                                 ? bindToSwapchain(*object(device), *object(bind.image), *shown)
                             : plane != nullptr
                                 ? guarded([&] { return bindPlane(*object(device), bind, plane->planeAspect); })
                                 : BindImageMemory(device, bind.image, bind.memory, bind.memoryOffset);
        if (one != VK_SUCCESS) result = one;
    }
    return result;
}

VKAPI_ATTR void VKAPI_CALL GetImageSubresourceLayout(VkDevice, VkImage image, const VkImageSubresource* pSubresource,
                                                     VkSubresourceLayout* pLayout) {
    const Image& whole = *object(image);
    const Image& of = whole.ofAspect(pSubresource->aspectMask);
    const LevelLayout& level = of.level(std::min(pSubresource->mipLevel, of.info().mipLevels - 1));
    pLayout->offset =
        whole.planeOffset(pSubresource->aspectMask) + of.layerPitch() * pSubresource->arrayLayer + level.offset;
    pLayout->size = level.slicePitch * level.extent.depth;
    pLayout->rowPitch = level.rowPitch;
    pLayout->arrayPitch = of.layerPitch();
    pLayout->depthPitch = level.slicePitch;
}

VKAPI_ATTR VkResult VKAPI_CALL CreateImageView(VkDevice device, const VkImageViewCreateInfo* pCreateInfo,
                                               const VkAllocationCallbacks* pAllocator, VkImageView* pView) {
    return guarded([&] {
        const Device& owner = *object(device);
        const Image& image = *object(pCreateInfo->image);
        ImageViewInfo info;
        info.type = pCreateInfo->viewType;
        info.format = pCreateInfo->format;
        info.components = pCreateInfo->components;
        info.range = pCreateInfo->subresourceRange;
        if (const auto* p = findInChain<VkImageViewMinLodCreateInfoEXT>(pCreateInfo->pNext)) info.minLod = p->minLod;
        const uint32_t mip = std::min(info.range.baseMipLevel, image.info().mipLevels - 1);
        const uint32_t layers = seesSlices(image, info.type) ? image.level(mip).extent.depth : image.info().arrayLayers;
        if (info.range.levelCount == VK_REMAINING_MIP_LEVELS && info.range.baseMipLevel < image.info().mipLevels) {
            info.range.levelCount = image.info().mipLevels - info.range.baseMipLevel;
        }
        if (info.range.layerCount == VK_REMAINING_ARRAY_LAYERS && info.range.baseArrayLayer < layers) {
            info.range.layerCount = layers - info.range.baseArrayLayer;
        }
        Result<ImageView> view = ImageView::create(image, info, owner.runtime->isa());
        if (!view) return owner.report("vkCreateImageView", view.error());
        return createHandle(pAllocator, pView, std::move(view).value());
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyImageView(VkDevice, VkImageView imageView, const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, imageView);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateSampler(VkDevice, const VkSamplerCreateInfo* pCreateInfo,
                                             const VkAllocationCallbacks* pAllocator, VkSampler* pSampler) {
    return guarded([&] {
        SamplerState state = makeSamplerState(*pCreateInfo);
        const auto* converts = findInChain<VkSamplerYcbcrConversionInfo>(pCreateInfo->pNext);
        if (converts != nullptr) state.ycbcr = *object(converts->conversion);
        return createHandle(pAllocator, pSampler, state);
    });
}

VKAPI_ATTR void VKAPI_CALL DestroySampler(VkDevice, VkSampler sampler, const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, sampler);
}

}  // namespace vernier::vulkan
