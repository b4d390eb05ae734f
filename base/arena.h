// A bump allocator for many small objects that die together: command streams, per-frame geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

namespace vernier {

/// Hands out memory from blocks and takes it all back at once with reset(). Not thread-safe: one thread owns an arena.
/// Objects are never destroyed, so only trivially destructible ones may be put in.
class Arena {
  public:
    explicit Arena(size_t blockBytes = 64 * 1024) : blockBytes_(blockBytes) {}
    Arena(Arena&&) noexcept = default;
    Arena& operator=(Arena&&) noexcept = default;

    /// `bytes` of uninitialised memory aligned to `alignment` (a power of two up to 64). Throws std::bad_alloc.
    void* allocate(size_t bytes, size_t alignment = alignof(std::max_align_t));

    template <class T>
    T* create(const T& value) {
        static_assert(std::is_trivially_destructible_v<T>);
        return new (allocate(sizeof(T), alignof(T))) T(value);
    }

    /// Uninitialised storage for `count` objects. Throws std::bad_alloc.
    template <class T>
    std::span<T> array(size_t count) {
        static_assert(std::is_trivially_destructible_v<T>);
        // T may well be a pointer: arrays of them are wanted. NOLINTBEGIN(bugprone-sizeof-expression)
        if (count > SIZE_MAX / sizeof(T)) throw std::bad_alloc();
        return {static_cast<T*>(allocate(sizeof(T) * count, alignof(T))), count};
        // NOLINTEND(bugprone-sizeof-expression)
    }

    template <class T>
    std::span<T> copy(std::span<const T> source) {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::span<T> target = array<T>(source.size());
        if (!source.empty()) std::memcpy(target.data(), source.data(), source.size_bytes());
        return target;
    }

    /// Everything handed out becomes invalid; the blocks are kept for reuse.
    void reset();

    /// Bytes handed out since the last reset, padding included.
    size_t used() const { return used_; }

  private:
    struct AlignedDelete {
        void operator()(std::byte* block) const;
    };
    struct Block {
        std::unique_ptr<std::byte, AlignedDelete> memory;
        size_t size = 0;
    };

    std::vector<Block> blocks_;
    size_t current_ = 0;  // index of the block in use
    size_t offset_ = 0;   // first free byte in it
    size_t used_ = 0;
    size_t blockBytes_;
};

}  // namespace vernier
