// The two-call idiom: a count and an array that may be absent or too short.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace vernier::vulkan {

/// Collects elements into the array of a two-call query. The count is written by result().
template <class T>
class OutputArray {
  public:
    OutputArray(uint32_t* count, T* elements) : count_(count), elements_(elements) {}

    /// Where the next element goes, or nullptr when it is only counted or does not fit.
    T* next() {
        T* slot = elements_ != nullptr && size_ < *count_ ? elements_ + size_ : nullptr;
        ++size_;
        return slot;
    }
    void add(const T& element) {
        if (T* slot = next()) *slot = element;
    }
    VkResult result() {
        const bool incomplete = elements_ != nullptr && size_ > *count_;
        if (!incomplete) *count_ = size_;
        return incomplete ? VK_INCOMPLETE : VK_SUCCESS;
    }

  private:
    uint32_t* count_;
    T* elements_;
    uint32_t size_ = 0;
};

}  // namespace vernier::vulkan
