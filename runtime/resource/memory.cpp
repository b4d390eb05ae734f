#include "runtime/resource/memory.h"

#include <sys/mman.h>

#include <cstdint>
#include <cstring>
#include <new>
#include <string>

namespace vernier {
namespace {

constexpr size_t kAlignment = 64;
/// From this size on memory comes as pages, which the system gives zeroed when they are first touched.
constexpr size_t kPagesFrom = 1 << 20;
/// Up to this size all pages are taken at once: a few images' worth, which the first frame would touch one page fault
/// after the other, at several times the cost.
constexpr size_t kPagesAtOnceUpTo = 32 << 20;

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
    memory->mapped_ = !allocator.allocate && size >= kPagesFrom;
    void* data = nullptr;
    if (memory->mapped_) {
        const int atOnce = size <= kPagesAtOnceUpTo ? MAP_POPULATE : 0;
        data = mmap(nullptr, size + kSlack, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | atOnce, -1, 0);
        if (data == MAP_FAILED) data = nullptr;
    } else {
        data = allocator.get(size + kSlack, kAlignment);
        if (data) std::memset(data, 0, size + kSlack);
    }
    if (!data)
        return Error{ErrorCode::outOfDeviceMemory, "no memory for an allocation of " + std::to_string(size) + " bytes"};
    memory->data_ = static_cast<std::byte*>(data);
    return memory;
}

Memory::~Memory() {
    if (!data_) return;
    if (mapped_) {
        munmap(data_, size_ + kSlack);
    } else {
        allocator_.put(data_, size_ + kSlack);
    }
}

}  // namespace vernier
