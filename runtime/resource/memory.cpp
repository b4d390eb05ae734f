#include "runtime/resource/memory.h"

#include <cstdint>
#include <cstring>
#include <new>
#include <string>

namespace vernier {
namespace {

constexpr size_t kAlignment = 64;

}  // namespace

void* HostAllocator::get(size_t bytes, size_t alignment) const {
    if (allocate) return allocate(user, bytes, alignment);
    return ::operator new (bytes, std::align_val_t{kAlignment}, std::nothrow);
}

void HostAllocator::put(void* memory, size_t bytes) const {
    if (!memory) return;
    if (release) return release(user, memory, bytes);
    ::operator delete (memory, std::align_val_t{kAlignment});
}

Result<std::unique_ptr<Memory>> Memory::create(const HostAllocator& allocator, VkDeviceSize size) {
    // The aligned operator new of libstdc++ rounds up without a look at overflow.
    if (size > PTRDIFF_MAX - kSlack)
        return Error{ErrorCode::outOfDeviceMemory, "memory of " + std::to_string(size) + " bytes does not fit"};
    std::unique_ptr<Memory> memory(new Memory(allocator, size));
    memory->data_ = static_cast<std::byte*>(allocator.get(size + kSlack, kAlignment));
    if (!memory->data_)
        return Error{ErrorCode::outOfDeviceMemory, "no memory for an allocation of " + std::to_string(size) + " bytes"};
    std::memset(memory->data_, 0, size + kSlack);
    return memory;
}

Memory::~Memory() {
    allocator_.put(data_, size_ + kSlack);
}

}  // namespace vernier
