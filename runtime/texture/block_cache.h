// Texels of block-compressed levels: blocks are decoded when a texel of them is wanted, and kept as long as a cache
// lives. A cache lives on the stack during one sampling call, in which the memory of an image does not change; the
// texels of a call lie close together, so that few blocks are decoded twice.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "runtime/texture/texture.h"

namespace vernier {

class BlockCache {
  public:
    explicit BlockCache(const TextureView& view)
        : block_(*view.block),
          texelBytes_(view.ops.layout.bytes),
          decodedBytes_(block_.width * block_.height * texelBytes_) {
        uint32_t entries = kMaxEntries;
        while (entries * decodedBytes_ > sizeof decoded_) entries /= 2;
        mask_ = entries - 1;
        std::fill_n(tags_, entries, nullptr);
    }

    /// Copies texel (x, y) of a slice that begins at `slice`, which must be inside the level, to `texel`.
    void read(const TextureView& view, const TextureLevel& level, const std::byte* slice, uint32_t x, uint32_t y,
              std::byte* texel) {
        const uint32_t column = x / block_.width, row = y / block_.height;
        const std::byte* const source = slice + uint64_t{row} * level.rowPitch + uint64_t{column} * view.texelPitch;
        // Neighbours in both directions fall into different entries.
        const uint32_t entry = (column + row * 5) & mask_;
        std::byte* const decoded = decoded_ + entry * decodedBytes_;
        if (tags_[entry] != source) {
            block_.decode(source, decoded);
            tags_[entry] = source;
        }
        const uint32_t inside = (y - row * block_.height) * block_.width + (x - column * block_.width);
        std::memcpy(texel, decoded + inside * texelBytes_, texelBytes_);
    }

  private:
    static constexpr uint32_t kMaxEntries = 32;
    const BlockCodec& block_;
    uint32_t texelBytes_, decodedBytes_;
    uint32_t mask_ = 0;
    const std::byte* tags_[kMaxEntries];
    alignas(16) std::byte decoded_[8192];
};
static_assert(kMaxBlockTexels * kMaxDecodedBytes <= 8192);

}  // namespace vernier
