// Memory that several processes see: an anonymous file (memfd_create(2)), passed on by its descriptor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "base/result.h"

namespace vernier {

/// A mapping of shared memory of a fixed size, zeros at first, page-aligned, with kSlack readable bytes after its end.
/// Its file is sealed against changes of its size, so that no other process can take pages away, and ends with a note
/// of what it is, so that a descriptor of anything else is refused.
class SharedPages {
  public:
    static constexpr size_t kSlack = 64;

    /// `tag` names what the bytes are. `touch`: take all pages at once.
    static Result<std::unique_ptr<SharedPages>> create(uint64_t tag, uint64_t bytes, bool touch);
    /// Of a descriptor that exportFd() of this or another process gave, of the same tag. Owns the descriptor if, and
    /// only if, it succeeds.
    static Result<std::unique_ptr<SharedPages>> import(uint64_t tag, int fd);
    ~SharedPages();
    SharedPages(const SharedPages&) = delete;
    SharedPages& operator=(const SharedPages&) = delete;

    std::byte* data() const { return data_; }
    uint64_t size() const { return size_; }
    /// A new descriptor, which the caller owns; -1 when the process has no more.
    int exportFd() const;

  private:
    SharedPages() = default;
    Status map(uint64_t bytes, bool touch);

    int fd_ = -1;
    std::byte* data_ = nullptr;
    uint64_t size_ = 0;    // without slack and note
    uint64_t mapped_ = 0;  // the whole file
};

}  // namespace vernier
