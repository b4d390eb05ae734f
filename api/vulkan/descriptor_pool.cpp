// Descriptor pools and the sets allocated from them.
#include <algorithm>

#include "api/vulkan/allocation.h"
#include "api/vulkan/descriptor.h"
#include "api/vulkan/entry_points.h"

namespace vernier::vulkan {

DescriptorPool::DescriptorPool(const VkAllocationCallbacks* given, const VkDescriptorPoolCreateInfo& info)
    : hasCallbacks_(given != nullptr), setsLeft_(info.maxSets) {
    if (given != nullptr) callbacks_ = *given;
    for (uint32_t i = 0; i < info.poolSizeCount; ++i) {
        const auto type = static_cast<size_t>(info.pPoolSizes[i].type);
        if (type < left_.size()) left_[type] += info.pPoolSizes[i].descriptorCount;
    }
}

DescriptorPool::~DescriptorPool() {
    reset();
}

VkResult DescriptorPool::allocate(const std::shared_ptr<const DescriptorSetLayout>& layout, VkDescriptorSet* out) {
    if (setsLeft_ == 0) return VK_ERROR_OUT_OF_POOL_MEMORY;
    std::array<uint32_t, kDescriptorTypeCount> left = left_;
    for (const DescriptorBinding& binding : layout->bindings) {
        if (binding.count == 0) continue;
        uint32_t& available = left[static_cast<size_t>(binding.type)];
        if (available < binding.count) return VK_ERROR_OUT_OF_POOL_MEMORY;
        available -= binding.count;
    }
    // Room first, and twice of it each time: nothing may fail once the object is made.
    if (sets_.size() == sets_.capacity()) sets_.reserve(2 * sets_.size() + 1);
    auto* set = newObject<DescriptorSetObject>(callbacks(), VK_SYSTEM_ALLOCATION_SCOPE_OBJECT, layout);
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
    for (const DescriptorBinding& binding : set->layout->bindings) {
        if (binding.count != 0) left_[static_cast<size_t>(binding.type)] += binding.count;
    }
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
    std::fill_n(pDescriptorSets, count, VkDescriptorSet{VK_NULL_HANDLE});
    const VkResult result = guarded([&] {
        for (uint32_t i = 0; i < count; ++i) {
            const VkResult one = pool.allocate(object(pAllocateInfo->pSetLayouts[i])->layout, &pDescriptorSets[i]);
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
