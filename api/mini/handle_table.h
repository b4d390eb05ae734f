// Handles by value: an index, a generation that tells a reused slot from the object that was there before, and the salt
// of the device, so that a destroyed or foreign handle is recognised and never followed.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace vernier::mini {

/// Thread-safe.
template <class Object>
class HandleTable {
  public:
    explicit HandleTable(uint16_t salt) : salt_(salt) {}

    uint64_t insert(std::shared_ptr<Object> object) {
        const std::lock_guard lock(mutex_);
        uint32_t index = 0;
        if (free_.empty()) {
            index = static_cast<uint32_t>(slots_.size());
            slots_.emplace_back();
        } else {
            index = free_.back();
            free_.pop_back();
        }
        slots_[index].object = std::move(object);
        return uint64_t{salt_} << 48 | uint64_t{slots_[index].generation} << 32 | (index + 1u);
    }

    /// nullptr for a handle that is 0, destroyed, or of another device.
    std::shared_ptr<Object> find(uint64_t id) const {
        const std::lock_guard lock(mutex_);
        const Slot* slot = slotOf(id);
        return slot ? slot->object : nullptr;
    }

    /// Takes the object out; what still uses it keeps it alive. nullptr as in find().
    std::shared_ptr<Object> remove(uint64_t id) {
        const std::lock_guard lock(mutex_);
        auto* slot = const_cast<Slot*>(slotOf(id));
        if (!slot) return nullptr;
        // A slot whose generations are used up is given up, so that no handle is ever valid again.
        if (slot->generation != UINT16_MAX) {
            free_.push_back(static_cast<uint32_t>(id) - 1u);
            ++slot->generation;
        }
        return std::move(slot->object);
    }

  private:
    struct Slot {
        std::shared_ptr<Object> object;
        uint16_t generation = 1;
    };

    const Slot* slotOf(uint64_t id) const {
        const uint32_t index = static_cast<uint32_t>(id) - 1u;
        if (index >= slots_.size() || static_cast<uint16_t>(id >> 48) != salt_) return nullptr;
        const Slot& slot = slots_[index];
        return slot.object && slot.generation == static_cast<uint16_t>(id >> 32) ? &slot : nullptr;
    }

    uint16_t salt_;
    mutable std::mutex mutex_;
    std::vector<Slot> slots_;
    std::vector<uint32_t> free_;
};

}  // namespace vernier::mini
