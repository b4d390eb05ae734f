// Descriptor set layouts and pipeline layouts.
#include <algorithm>
#include <string>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/descriptor.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/resource_limits.h"
#include "runtime/limits.h"

namespace vernier::vulkan {
namespace {

bool supportedType(VkDescriptorType type) {
    return placeOf(type) < kDescriptorTypeCount;
}

bool isInlineBlock(VkDescriptorType type) {
    return type == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK;
}

bool isDynamicBuffer(VkDescriptorType type) {
    return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
}

VkDescriptorBindingFlags flagsOf(const VkDescriptorSetLayoutCreateInfo& info, uint32_t index) {
    const auto* flags = findInChain<VkDescriptorSetLayoutBindingFlagsCreateInfo>(info.pNext);
    return flags != nullptr && index < flags->bindingCount ? flags->pBindingFlags[index] : 0;
}

bool hasSampler(VkDescriptorType type) {
    return type == VK_DESCRIPTOR_TYPE_SAMPLER || type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

Status checkBindings(const VkDescriptorSetLayoutCreateInfo& info) {
    uint64_t total = 0;
    const bool pushed = (info.flags & VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR) != 0;
    for (uint32_t i = 0; i < info.bindingCount; ++i) {
        const VkDescriptorSetLayoutBinding& binding = info.pBindings[i];
        if (binding.descriptorCount == 0) continue;  // a reserved number: its type does not count
        const bool refused =
            pushed && (isInlineBlock(binding.descriptorType) || isDynamicBuffer(binding.descriptorType));
        if (!supportedType(binding.descriptorType) || refused) {
            return unsupported("binding " + std::to_string(binding.binding) + ": " + nameOf(binding.descriptorType) +
                               " is not supported" + (refused ? " as a push descriptor" : ""));
        }
        if (isInlineBlock(binding.descriptorType) && binding.descriptorCount > kMaxInlineUniformBlockBytes) {
            return unsupported("binding " + std::to_string(binding.binding) + ": an inline uniform block of " +
                               std::to_string(binding.descriptorCount) + " bytes is too large");
        }
        total += isInlineBlock(binding.descriptorType) ? 1 : binding.descriptorCount;
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
            if (isInlineBlock(from.descriptorType)) {
                to.blockBytes = from.descriptorCount;
                to.count = std::min(from.descriptorCount, 1u);
            }
            const VkDescriptorBindingFlags flags = flagsOf(*pCreateInfo, i);
            to.variable = (flags & VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT) != 0;
            to.mayChange = (flags & (VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT |
                                     VK_DESCRIPTOR_BINDING_UPDATE_UNUSED_WHILE_PENDING_BIT)) != 0;
            to.mayBeInvalid = to.mayChange || (flags & VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT) != 0;
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
    auto* variable = findInChain<VkDescriptorSetVariableDescriptorCountLayoutSupport>(pSupport->pNext);
    if (variable == nullptr) return;
    // What the bindings before the variable one leave of a set.
    variable->maxVariableDescriptorCount = 0;
    uint64_t others = 0;
    for (uint32_t i = 0; i < pCreateInfo->bindingCount; ++i) {
        const VkDescriptorSetLayoutBinding& binding = pCreateInfo->pBindings[i];
        const bool isVariable = (flagsOf(*pCreateInfo, i) & VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT) != 0;
        if (!isVariable) {
            others += isInlineBlock(binding.descriptorType) ? 1 : binding.descriptorCount;
        } else if (isInlineBlock(binding.descriptorType)) {
            variable->maxVariableDescriptorCount = kMaxInlineUniformBlockBytes;
        } else {
            variable->maxVariableDescriptorCount = kMaxDescriptorsPerSet;
        }
    }
    if (variable->maxVariableDescriptorCount == kMaxDescriptorsPerSet) {
        variable->maxVariableDescriptorCount -=
            static_cast<uint32_t>(std::min<uint64_t>(others, kMaxDescriptorsPerSet));
    }
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
        PipelineLayout layout;
        for (uint32_t i = 0; i < pCreateInfo->setLayoutCount; ++i) {
            const DescriptorSetLayoutObject* set = object(pCreateInfo->pSetLayouts[i]);
            if (set != nullptr) layout.sets[i] = set->layout;
        }
        return createHandle(pAllocator, pPipelineLayout, std::move(layout));
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyPipelineLayout(VkDevice, VkPipelineLayout pipelineLayout,
                                                 const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, pipelineLayout);
}

}  // namespace vernier::vulkan
