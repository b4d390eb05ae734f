// Conversions from Y'CbCr as objects (VK_KHR_sampler_ycbcr_conversion).
#include "api/vulkan/allocation.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "runtime/format/multi_planar.h"
#include "runtime/texture/texture.h"

namespace vernier::vulkan {

VKAPI_ATTR VkResult VKAPI_CALL CreateSamplerYcbcrConversion(VkDevice device,
                                                            const VkSamplerYcbcrConversionCreateInfo* pCreateInfo,
                                                            const VkAllocationCallbacks* pAllocator,
                                                            VkSamplerYcbcrConversion* pYcbcrConversion) {
    return guarded([&] {
        *pYcbcrConversion = VK_NULL_HANDLE;
        if (findMultiPlanar(pCreateInfo->format) == nullptr) {
            return object(device)->report("vkCreateSamplerYcbcrConversion", VK_ERROR_FEATURE_NOT_PRESENT,
                                          nameOf(pCreateInfo->format) + " has no chroma samples to reconstruct");
        }
        YcbcrConversion conversion;
        conversion.format = pCreateInfo->format;
        conversion.model = pCreateInfo->ycbcrModel;
        conversion.range = pCreateInfo->ycbcrRange;
        conversion.components = pCreateInfo->components;
        conversion.xChromaOffset = pCreateInfo->xChromaOffset;
        conversion.yChromaOffset = pCreateInfo->yChromaOffset;
        conversion.chromaFilter = pCreateInfo->chromaFilter;
        return createHandle(pAllocator, pYcbcrConversion, conversion);
    });
}

VKAPI_ATTR void VKAPI_CALL DestroySamplerYcbcrConversion(VkDevice, VkSamplerYcbcrConversion ycbcrConversion,
                                                         const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, ycbcrConversion);
}

}  // namespace vernier::vulkan
