// Descriptor pools and the sets allocated from them.
#include <algorithm>
#include <functional>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/descriptor.h"
#include "api/vulkan/entry_points.h"

namespace vernier::vulkan {

DescriptorPool::DescriptorPool(const VkAllocationCallbacks* given, const VkDescriptorPoolCreateInfo& info)
    : hasCallbacks_(given != nullptr), setsLeft_(info.maxSets) {
    if (given != nullptr) callbacks_ = *given;
    for (uint32_t i = 0; i < info.poolSizeCount; ++i) {
        const size_t type = placeOf(info.pPoolSizes[i].type);
        if (type < left_.of.size()) left_.of[type] += info.pPoolSizes[i].descriptorCount;
    }
    const auto* blocks = findInChain<VkDescriptorPoolInlineUniformBlockCreateInfo>(info.pNext);
    if (blocks != nullptr) left_.blocks = blocks->maxInlineUniformBlockBindings;
}

DescriptorPool::Counts DescriptorPool::countsOf(const DescriptorSetLayout& layout, uint32_t variableCount) {
    Counts counts;
    for (const DescriptorBinding& binding : layout.bindings) {
        const bool isBlock = binding.type == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK;
        const uint32_t most = isBlock ? binding.blockBytes : binding.count;
        const uint32_t count = binding.variable ? std::min(most, variableCount) : most;
        if (count == 0) continue;  // whose type does not count
        counts.of[placeOf(binding.type)] += count;
        if (isBlock) ++counts.blocks;
    }
    return counts;
}

bool DescriptorPool::Counts::take(const Counts& wanted) {
    const auto holds = [](uint64_t has, uint64_t wants) { return has >= wants; };
    if (blocks < wanted.blocks || !std::equal(of.begin(), of.end(), wanted.of.begin(), holds)) return false;
    std::transform(of.begin(), of.end(), wanted.of.begin(), of.begin(), std::minus<>{});
    blocks -= wanted.blocks;
    return true;
}

void DescriptorPool::Counts::put(const Counts& back) {
    std::transform(of.begin(), of.end(), back.of.begin(), of.begin(), std::plus<>{});
    blocks += back.blocks;
}

DescriptorPool::~DescriptorPool() {
    reset();
}

VkResult DescriptorPool::allocate(const std::shared_ptr<const DescriptorSetLayout>& layout, uint32_t variableCount,
                                  VkDescriptorSet* out) {
    if (setsLeft_ == 0) return VK_ERROR_OUT_OF_POOL_MEMORY;
    Counts left = left_;
    if (!left.take(countsOf(*layout, variableCount))) return VK_ERROR_OUT_OF_POOL_MEMORY;
    // Room first, and twice of it each time: nothing may fail once the object is made.
    if (sets_.size() == sets_.capacity()) sets_.reserve(2 * sets_.size() + 1);
    auto* set = newObject<DescriptorSetObject>(callbacks(), VK_SYSTEM_ALLOCATION_SCOPE_OBJECT, layout, variableCount);
    if (set == nullptr) return VK_ERROR_OUT_OF_HOST_MEMORY;
    sets_.push_back(set);
    left_ = left;
    --setsLeft_;
    *out = handleOf<VkDescriptorSet>(set);
    return VK_SUCCESS;
}

void DescriptorPool::free(DescriptorSetObject* set) {
    const auto found = std::find(sets_.begin(), sets_.end(), set);
    if (found == sets_.end()) return;
    *found = sets_.back();
    sets_.pop_back();
    left_.put(countsOf(*set->layout, set->variableCount));
    ++setsLeft_;
    deleteObject(callbacks(), set);
}

void DescriptorPool::reset() {
    while (!sets_.empty()) free(sets_.back());
}

VKAPI_ATTR VkResult VKAPI_CALL CreateDescriptorPool(VkDevice, const VkDescriptorPoolCreateInfo* pCreateInfo,
                                                    const VkAllocationCallbacks* pAllocator,
                                                    VkDescriptorPool* pDescriptorPool) {
    return createHandle(pAllocator, pDescriptorPool, pAllocator, *pCreateInfo);
}

VKAPI_ATTR void VKAPI_CALL DestroyDescriptorPool(VkDevice, VkDescriptorPool descriptorPool,
                                                 const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, descriptorPool);
}

VKAPI_ATTR VkResult VKAPI_CALL ResetDescriptorPool(VkDevice, VkDescriptorPool descriptorPool,
                                                   VkDescriptorPoolResetFlags) {
    object(descriptorPool)->reset();
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL AllocateDescriptorSets(VkDevice, const VkDescriptorSetAllocateInfo* pAllocateInfo,
                                                      VkDescriptorSet* pDescriptorSets) {
    DescriptorPool& pool = *object(pAllocateInfo->descriptorPool);
    const uint32_t count = pAllocateInfo->descriptorSetCount;
    const auto* variable = findInChain<VkDescriptorSetVariableDescriptorCountAllocateInfo>(pAllocateInfo->pNext);
    const bool counts = variable != nullptr && variable->descriptorSetCount != 0;
    std::fill_n(pDescriptorSets, count, VkDescriptorSet{VK_NULL_HANDLE});
    const VkResult result = guarded([&] {
        for (uint32_t i = 0; i < count; ++i) {
            const uint32_t last = counts && i < variable->descriptorSetCount ? variable->pDescriptorCounts[i] : 0;
            const VkResult one =
                pool.allocate(object(pAllocateInfo->pSetLayouts[i])->layout, last, &pDescriptorSets[i]);
            if (one != VK_SUCCESS) return one;
        }
        return VK_SUCCESS;
    });
    if (result != VK_SUCCESS) {
        // All or nothing ("vkAllocateDescriptorSets": on failure every entry is VK_NULL_HANDLE).
        for (uint32_t i = 0; i < count; ++i) {
            if (pDescriptorSets[i] != VK_NULL_HANDLE) pool.free(object(pDescriptorSets[i]));
            pDescriptorSets[i] = VK_NULL_HANDLE;
        }
    }
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL FreeDescriptorSets(VkDevice, VkDescriptorPool descriptorPool,
                                                  uint32_t descriptorSetCount, const VkDescriptorSet* pDescriptorSets) {
    for (uint32_t i = 0; i < descriptorSetCount; ++i) {
        if (pDescriptorSets[i] != VK_NULL_HANDLE) object(descriptorPool)->free(object(pDescriptorSets[i]));
    }
    return VK_SUCCESS;
}

}  // namespace vernier::vulkan
