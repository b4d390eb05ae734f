#include "runtime/resource/memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/uio.h>
#include <unistd.h>

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
/// Of SharedPages: "Memory", little-endian.
constexpr uint64_t kMemoryTag = 0x79726F6D654D;
static_assert(SharedPages::kSlack >= Memory::kSlack);

/// Whether this process may read there.
bool isReadable(const void* place) {
    std::byte byte{};
    const iovec to{&byte, 1}, from{const_cast<void*>(place), 1};
    return process_vm_readv(getpid(), &to, 1, &from, 1, 0) == 1;
}

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
    memory->origin_ = !allocator.allocate && size >= kPagesFrom ? Origin::system : Origin::allocator;
    void* data = nullptr;
    if (memory->origin_ == Origin::system) {
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

Result<std::unique_ptr<Memory>> Memory::of(std::unique_ptr<SharedPages> pages) {
    std::unique_ptr<Memory> memory(new Memory({}, pages->size()));
    memory->data_ = pages->data();
    memory->pages_ = std::move(pages);
    return memory;
}

Result<std::unique_ptr<Memory>> Memory::createShared(VkDeviceSize size) {
    auto pages = SharedPages::create(kMemoryTag, size, size <= kPagesAtOnceUpTo);
    if (!pages) return pages.error();
    return of(std::move(pages).value());
}

Result<std::unique_ptr<Memory>> Memory::import(int fd, VkDeviceSize size) {
    // A look first: the descriptor stays the caller's when the size is wrong.
    const int look = fcntl(fd, F_DUPFD_CLOEXEC, 0);
    auto pages = SharedPages::import(kMemoryTag, look);
    if (!pages) {
        if (look >= 0) close(look);
        return pages.error();
    }
    if (pages.value()->size() != size)
        return invalidArgument("the memory of the file descriptor has " + std::to_string(pages.value()->size()) +
                               " bytes, not " + std::to_string(size));
    auto memory = of(std::move(pages).value());
    close(fd);
    return memory;
}

Result<std::unique_ptr<Memory>> Memory::wrap(void* pages, VkDeviceSize size) {
    std::unique_ptr<Memory> memory(new Memory({}, size));
    memory->data_ = static_cast<std::byte*>(pages);
    std::byte* const end = memory->data_ + size;
    const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
    void* const guard =
        mmap(end, page, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE | MAP_NORESERVE, -1, 0);
    if (guard == end) {
        memory->guard_ = guard;
    } else {
        if (guard != MAP_FAILED) munmap(guard, page);  // kernels before 4.17 take the address for a hint
        if (!isReadable(end)) return invalidArgument("the page after the host memory cannot be read");
    }
    return memory;
}

Memory::~Memory() {
    if (guard_) munmap(guard_, static_cast<size_t>(sysconf(_SC_PAGESIZE)));
    if (!data_) return;
    if (origin_ == Origin::system) munmap(data_, size_ + kSlack);
    if (origin_ == Origin::allocator) allocator_.put(data_, size_ + kSlack);
}

}  // namespace vernier
