// Descriptor set layouts and pipeline layouts.
#include <string>

#include "api/vulkan/allocation.h"
#include "api/vulkan/descriptor.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/resource_limits.h"
#include "runtime/limits.h"

namespace vernier::vulkan {
namespace {

bool supportedType(VkDescriptorType type) {
    return static_cast<uint32_t>(type) < kDescriptorTypeCount;
}

bool hasSampler(VkDescriptorType type) {
    return type == VK_DESCRIPTOR_TYPE_SAMPLER || type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

Status checkBindings(const VkDescriptorSetLayoutCreateInfo& info) {
    uint64_t total = 0;
    for (uint32_t i = 0; i < info.bindingCount; ++i) {
        const VkDescriptorSetLayoutBinding& binding = info.pBindings[i];
        if (binding.descriptorCount == 0) continue;  // a reserved number: its type does not count
        if (!supportedType(binding.descriptorType)) {
            return unsupported("binding " + std::to_string(binding.binding) + ": " + nameOf(binding.descriptorType) +
                               " is not supported");
        }
        total += binding.descriptorCount;
    }
    if (total > kMaxDescriptorsPerSet) return unsupported(std::to_string(total) + " descriptors are too many");
    return {};
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL CreateDescriptorSetLayout(VkDevice device,
                                                         const VkDescriptorSetLayoutCreateInfo* pCreateInfo,
                                                         const VkAllocationCallbacks* pAllocator,
                                                         VkDescriptorSetLayout* pSetLayout) {
    return guarded([&] {
        if (const Status status = checkBindings(*pCreateInfo); !status) {
            return object(device)->report("vkCreateDescriptorSetLayout", status.error());
        }
        std::vector<DescriptorBinding> bindings;
        for (uint32_t i = 0; i < pCreateInfo->bindingCount; ++i) {
            const VkDescriptorSetLayoutBinding& from = pCreateInfo->pBindings[i];
            DescriptorBinding& to = bindings.emplace_back();
            to.binding = from.binding;
            to.type = from.descriptorType;
            to.count = from.descriptorCount;
            if (from.pImmutableSamplers == nullptr || !hasSampler(from.descriptorType)) continue;
            for (uint32_t j = 0; j < from.descriptorCount; ++j) {
                to.immutableSamplers.push_back(object(from.pImmutableSamplers[j]));
            }
        }
        auto layout = std::make_shared<const DescriptorSetLayout>(DescriptorSetLayout::create(std::move(bindings)));
        return createHandle(pAllocator, pSetLayout, std::move(layout));
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyDescriptorSetLayout(VkDevice, VkDescriptorSetLayout descriptorSetLayout,
                                                      const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, descriptorSetLayout);
}

VKAPI_ATTR void VKAPI_CALL GetDescriptorSetLayoutSupport(VkDevice, const VkDescriptorSetLayoutCreateInfo* pCreateInfo,
                                                         VkDescriptorSetLayoutSupport* pSupport) {
    pSupport->supported = VK_FALSE;
    (void)guarded([&] {
        pSupport->supported = checkBindings(*pCreateInfo).ok() ? VK_TRUE : VK_FALSE;
        return VK_SUCCESS;
    });
}

VKAPI_ATTR VkResult VKAPI_CALL CreatePipelineLayout(VkDevice device, const VkPipelineLayoutCreateInfo* pCreateInfo,
                                                    const VkAllocationCallbacks* pAllocator,
                                                    VkPipelineLayout* pPipelineLayout) {
    return guarded([&] {
        if (pCreateInfo->setLayoutCount > kMaxDescriptorSets) {
            return object(device)->report("vkCreatePipelineLayout", VK_ERROR_UNKNOWN,
                                          "setLayoutCount is above maxBoundDescriptorSets");
        }
        for (uint32_t i = 0; i < pCreateInfo->pushConstantRangeCount; ++i) {
            const VkPushConstantRange& range = pCreateInfo->pPushConstantRanges[i];
            if (uint64_t{range.offset} + range.size > kMaxPushConstantBytes) {
                return object(device)->report("vkCreatePipelineLayout", VK_ERROR_UNKNOWN,
                                              "a push constant range ends above maxPushConstantsSize");
            }
        }
        return createHandle(pAllocator, pPipelineLayout);
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyPipelineLayout(VkDevice, VkPipelineLayout pipelineLayout,
                                                 const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, pipelineLayout);
}

}  // namespace vernier::vulkan
