// Private data (VK_EXT_private_data): a number that an application, or a layer, keeps with an object, per slot.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <unordered_map>

namespace vernier::vulkan {

class PrivateData;

/// Lies directly in front of every object behind a handle that is a child of the device (allocation.h).
struct ObjectHeader {
    std::atomic<PrivateData*> data{nullptr};  // that holds something of the object
};

struct PrivateDataSlot {
    explicit PrivateDataSlot(PrivateData& of) : data(of) {}
    ~PrivateDataSlot();
    PrivateDataSlot(const PrivateDataSlot&) = delete;
    PrivateDataSlot& operator=(const PrivateDataSlot&) = delete;
    PrivateData& data;
};

/// What all slots of a device hold. Thread-safe.
class PrivateData {
  public:
    /// `header`: of the object; nullptr for one that lives as long as the device.
    void set(const PrivateDataSlot& slot, const void* object, ObjectHeader* header, uint64_t value);
    /// 0 where nothing was set.
    uint64_t get(const PrivateDataSlot& slot, const void* object) const;
    /// The object is gone: another one may get its address.
    void forgetObject(const void* object);
    void forgetSlot(const PrivateDataSlot& slot);

  private:
    using Values = std::unordered_map<const PrivateDataSlot*, uint64_t>;
    mutable std::mutex mutex_;
    std::unordered_map<const void*, Values> objects_;
};

}  // namespace vernier::vulkan
