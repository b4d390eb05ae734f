// The buffers that shaders may reach by their addresses, which are those of the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <shared_mutex>
#include <vector>

#include "spirv_interp/resources.h"

namespace vernier {

/// Thread-safe: buffers come and go while programs run that use others.
class AddressSpace {
  public:
    /// `data`: aligned as AddressRange asks. Ranges may overlap, and the same may be there several times.
    void add(std::byte* data, uint64_t bytes);
    /// One that was added.
    void remove(const std::byte* data, uint64_t bytes);

    /// For ResourceBindings::addresses; as long as the address space lives.
    AddressResolver resolver() const;

    /// Calls visit(data, bytes) for all ranges.
    template <class Visit>
    void forEach(Visit&& visit) const {
        const std::shared_lock lock(mutex_);
        for (const Range& range : ranges_) visit(reinterpret_cast<std::byte*>(range.begin), range.end - range.begin);
    }

  private:
    struct Range {
        uint64_t begin, end;
        uint64_t farthestBegin, farthestEnd;  // of this one and those before, the one that ends last
    };
    /// Of the ranges with this address the one that ends last: it holds the bytes of an access if any does.
    AddressRange find(uint64_t address) const;
    void refreshFarthest(size_t first);

    mutable std::shared_mutex mutex_;
    std::vector<Range> ranges_;  // by their beginnings
};

}  // namespace vernier
