// Device memory and buffers. Device memory is host memory: there is one heap, host-visible, coherent and cached.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <memory>

#include "base/result.h"
#include "base/shared_pages.h"

namespace vernier {

/// Where big allocations come from; the caller of a device can bring its own. Thread-safe if the callbacks are.
struct HostAllocator {
    void* user = nullptr;
    void* (*allocate)(void* user, size_t bytes, size_t alignment) = nullptr;  // nullptr: operator new
    void (*release)(void* user, void* memory, size_t bytes) = nullptr;

    void* get(size_t bytes, size_t alignment) const;  // nullptr when out of memory
    void put(void* memory, size_t bytes) const;
};

/// One allocation of device memory, 64-byte aligned, with kMemorySlack readable bytes after its end so that a vector
/// load of the last element stays inside. It starts as zeros: no program sees another's data. Large allocations take
/// memory only where they are touched, unless the caller brought an allocator.
class Memory {
  public:
    static constexpr size_t kSlack = 64;
    static Result<std::unique_ptr<Memory>> create(const HostAllocator& allocator, VkDeviceSize size);
    /// Memory that other processes can have, too, through exportFd().
    static Result<std::unique_ptr<Memory>> createShared(VkDeviceSize size);
    /// What exportFd() of some process gave, of the size that it was created with. Owns the descriptor if, and only if,
    /// it succeeds.
    static Result<std::unique_ptr<Memory>> import(int fd, VkDeviceSize size);
    /// Whole pages of the caller's, who keeps them as long as the memory. Fails when the page after them cannot be read
    /// and cannot be made readable either.
    static Result<std::unique_ptr<Memory>> wrap(void* pages, VkDeviceSize size);
    ~Memory();
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    std::byte* data() const { return data_; }
    VkDeviceSize size() const { return size_; }
    /// Whether exportFd() has something to give.
    bool shared() const { return pages_ != nullptr; }
    /// A new descriptor, which the caller owns; -1 when the process has no more.
    int exportFd() const { return pages_->exportFd(); }

  private:
    Memory(const HostAllocator& allocator, VkDeviceSize size) : allocator_(allocator), size_(size) {}
    static Result<std::unique_ptr<Memory>> of(std::unique_ptr<SharedPages> pages);

    enum class Origin : uint8_t { allocator, system, elsewhere };
    HostAllocator allocator_;
    std::byte* data_ = nullptr;
    VkDeviceSize size_;
    Origin origin_ = Origin::elsewhere;  // who gets the bytes back
    std::unique_ptr<SharedPages> pages_;
    void* guard_ = nullptr;  // a page behind those of the caller, made only to be readable
};

/// A range of memory with a usage. Unbound until bind(): data() is nullptr then.
class Buffer {
  public:
    Buffer(VkDeviceSize size, VkBufferUsageFlags usage) : size_(size), usage_(usage) {}

    void bind(Memory& memory, VkDeviceSize offset) { data_ = memory.data() + offset; }
    std::byte* data() const { return data_; }
    VkDeviceSize size() const { return size_; }
    VkBufferUsageFlags usage() const { return usage_; }

  private:
    std::byte* data_ = nullptr;
    VkDeviceSize size_;
    VkBufferUsageFlags usage_;
};

inline constexpr VkDeviceSize kBufferAlignment = 64;

}  // namespace vernier
