#include "base/arena.h"

#include <algorithm>
#include <cstdint>
#include <new>

namespace vernier {
namespace {

constexpr std::align_val_t kBlockAlignment{64};

}  // namespace

void Arena::AlignedDelete::operator()(std::byte* block) const {
    ::operator delete(block, kBlockAlignment);
}

void* Arena::allocate(size_t bytes, size_t alignment) {
    for (; current_ < blocks_.size(); ++current_, offset_ = 0) {
        const size_t begin = (offset_ + alignment - 1) & ~(alignment - 1);
        const size_t size = blocks_[current_].size;
        if (begin <= size && bytes <= size - begin) {
            used_ += begin + bytes - offset_;
            offset_ = begin + bytes;
            return blocks_[current_].memory.get() + begin;
        }
    }
    // The aligned operator new of libstdc++ rounds up without a look at overflow.
    if (bytes > PTRDIFF_MAX) throw std::bad_alloc();
    const size_t size = std::max(blockBytes_, bytes);
    auto* memory = static_cast<std::byte*>(::operator new(size, kBlockAlignment));
    blocks_.push_back({std::unique_ptr<std::byte, AlignedDelete>(memory), size});
    current_ = blocks_.size() - 1;
    offset_ = bytes;
    used_ += bytes;
    return memory;
}

void Arena::reset() {
    current_ = 0;
    offset_ = 0;
    used_ = 0;
}

}  // namespace vernier
