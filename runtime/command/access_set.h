// Which memory a piece of work reads and writes. Work on memory that others do not write may run beside them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/resource/address_space.h"
#include "runtime/resource/descriptor.h"
#include "runtime/resource/image.h"
#include "runtime/resource/memory.h"

namespace vernier {

/// Ranges of addresses, so that whatever aliases - images and buffers bound to the same memory, views, subresources -
/// needs no care. A set may name more than is touched, never less.
class AccessSet {
  public:
    void read(const void* begin, uint64_t bytes) { add(reads_, begin, bytes); }
    void write(const void* begin, uint64_t bytes) { add(writes_, begin, bytes); }
    void add(const AccessSet& other);
    void clear();
    /// Sorts the ranges; called after the last one was added and before conflicts().
    void finish();

    /// Whether one of the two writes what the other one reads or writes.
    static bool conflicts(const AccessSet& a, const AccessSet& b);

  private:
    struct Range {
        uintptr_t begin, end;
    };
    static void add(std::vector<Range>& ranges, const void* begin, uint64_t bytes);
    static void compact(std::vector<Range>& ranges);
    static bool meet(const std::vector<Range>& a, const std::vector<Range>& b);

    std::vector<Range> reads_, writes_;
};

/// Bytes of layers (of 3D images: slices) [first, first + count) of a mip level; other levels may lie between layers.
std::span<std::byte> layersOf(const Image& image, uint32_t mip, uint32_t first, uint32_t count);

/// What a program may read and write through the descriptors it finds in `bound`.
void addAccesses(const ir::Program& program, const BoundDescriptors& bound, AccessSet& accesses);

/// Whether a program reaches memory by address.
bool usesAddresses(const ir::Program& program);
/// What such a program may read and write beyond that: nobody knows where its addresses lead.
void addAddressAccesses(const ir::Program& program, const AddressSpace& addresses, AccessSet& accesses);

}  // namespace vernier
