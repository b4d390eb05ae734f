#include "api/vulkan/private_data.h"

#include "api/vulkan/allocation.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"

namespace vernier::vulkan {
namespace {

const void* addressOf(uint64_t handle) {
    return reinterpret_cast<const void*>(handle);
}

/// nullptr for the queue, which is a part of its device.
ObjectHeader* headerOf(VkObjectType type, uint64_t handle) {
    return type == VK_OBJECT_TYPE_QUEUE ? nullptr : reinterpret_cast<ObjectHeader*>(handle) - 1;
}

}  // namespace

PrivateDataSlot::~PrivateDataSlot() {
    data.forgetSlot(*this);
}

void PrivateData::set(const PrivateDataSlot& slot, const void* object, ObjectHeader* header, uint64_t value) {
    const std::lock_guard lock(mutex_);
    objects_[object][&slot] = value;
    if (header != nullptr) header->data = this;
}

uint64_t PrivateData::get(const PrivateDataSlot& slot, const void* object) const {
    const std::lock_guard lock(mutex_);
    const auto values = objects_.find(object);
    if (values == objects_.end()) return 0;
    const auto found = values->second.find(&slot);
    return found != values->second.end() ? found->second : 0;
}

void PrivateData::forgetObject(const void* object) {
    const std::lock_guard lock(mutex_);
    objects_.erase(object);
}

void PrivateData::forgetSlot(const PrivateDataSlot& slot) {
    const std::lock_guard lock(mutex_);
    for (auto& [object, values] : objects_) values.erase(&slot);
}

VKAPI_ATTR VkResult VKAPI_CALL CreatePrivateDataSlot(VkDevice device, const VkPrivateDataSlotCreateInfo*,
                                                     const VkAllocationCallbacks* pAllocator,
                                                     VkPrivateDataSlot* pPrivateDataSlot) {
    return createHandle(pAllocator, pPrivateDataSlot, object(device)->privateData);
}

VKAPI_ATTR void VKAPI_CALL DestroyPrivateDataSlot(VkDevice, VkPrivateDataSlot privateDataSlot,
                                                  const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, privateDataSlot);
}

VKAPI_ATTR VkResult VKAPI_CALL SetPrivateData(VkDevice device, VkObjectType objectType, uint64_t objectHandle,
                                              VkPrivateDataSlot privateDataSlot, uint64_t data) {
    return guarded([&] {
        object(device)->privateData.set(*object(privateDataSlot), addressOf(objectHandle),
                                        headerOf(objectType, objectHandle), data);
        return VK_SUCCESS;
    });
}

VKAPI_ATTR void VKAPI_CALL GetPrivateData(VkDevice device, VkObjectType, uint64_t objectHandle,
                                          VkPrivateDataSlot privateDataSlot, uint64_t* pData) {
    *pData = object(device)->privateData.get(*object(privateDataSlot), addressOf(objectHandle));
}

}  // namespace vernier::vulkan
