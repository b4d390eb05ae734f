// BC7: 8-bit RGBA in eight modes ("BPTC Compressed Texture Image Formats", BC7).
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "runtime/format/block.h"
#include "runtime/format/bptc.h"

namespace vernier {
namespace {

/// Numbers of bits per mode, named as in the specification's table.
struct Mode {
    uint8_t subsets, partitionBits, rotationBits, selectionBits, colorBits, alphaBits, endpointPBits, sharedPBits,
        indexBits, index2Bits;
};
constexpr Mode kModes[8] = {
    {3, 4, 0, 0, 4, 0, 1, 0, 3, 0}, {2, 6, 0, 0, 6, 0, 0, 1, 3, 0}, {3, 6, 0, 0, 5, 0, 0, 0, 2, 0},
    {2, 6, 0, 0, 7, 0, 1, 0, 2, 0}, {1, 0, 2, 1, 5, 6, 0, 0, 2, 3}, {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
    {1, 0, 0, 0, 7, 7, 1, 0, 4, 0}, {2, 6, 0, 0, 5, 5, 1, 0, 2, 0},
};

/// Takes fields one after the other.
struct FieldReader {
    const BlockBits& block;
    uint32_t next;
    uint32_t take(uint32_t bits) {
        const uint32_t value = block.at(next, bits);
        next += bits;
        return value;
    }
};

/// Components of endpoint 2 * subset + end.
using Endpoints = std::array<std::array<uint32_t, 4>, 6>;

Endpoints readEndpoints(FieldReader& fields, const Mode& mode) {
    Endpoints ends{};
    const uint32_t count = 2u * mode.subsets;
    for (uint32_t c = 0; c < 4; ++c) {
        for (uint32_t e = 0; e < count; ++e) ends[e][c] = fields.take(c < 3 ? mode.colorBits : mode.alphaBits);
    }
    uint32_t pBits = 0;
    if (mode.endpointPBits != 0) pBits = fields.take(count);
    if (mode.sharedPBits != 0) {
        const uint32_t shared = fields.take(2);
        pBits = (shared & 1) * 3 | (shared >> 1) * 12;
    }
    const uint32_t extra = mode.endpointPBits | mode.sharedPBits;
    for (uint32_t e = 0; e < count; ++e) {
        for (uint32_t c = 0; c < 4; ++c) {
            const uint32_t bits = c < 3 ? mode.colorBits : mode.alphaBits;
            uint32_t& value = ends[e][c];
            value = bits == 0 ? 255 : widenToByte(value << extra | (pBits >> e & extra), bits + extra);
        }
    }
    return ends;
}

}  // namespace

void decodeBc7(const std::byte* block, void* texels) {
    auto* const out = static_cast<uint8_t*>(texels);
    const BlockBits bits(block);
    const auto number = static_cast<uint32_t>(std::countr_zero(bits.at(0, 8) | 0x100));
    if (number == 8) {
        std::memset(out, 0, 64);
        return;
    }
    const Mode& mode = kModes[number];
    FieldReader fields{bits, number + 1};
    const BptcPartition partition(mode.subsets, fields.take(mode.partitionBits));
    const uint32_t rotation = fields.take(mode.rotationBits);
    const bool swapIndices = fields.take(mode.selectionBits) != 0;
    const Endpoints ends = readEndpoints(fields, mode);
    auto colorWeights = readBptcWeights(bits, fields.next, mode.indexBits, partition);
    auto alphaWeights = colorWeights;
    if (mode.index2Bits != 0) {
        fields.next += 16u * mode.indexBits - 1;  // one subset: one anchor
        alphaWeights = readBptcWeights(bits, fields.next, mode.index2Bits, partition);
        if (swapIndices) std::swap(colorWeights, alphaWeights);
    }
    for (uint32_t i = 0; i < 16; ++i) {
        const uint32_t e = 2 * partition.of(i);
        uint8_t* const texel = out + 4 * i;
        for (uint32_t c = 0; c < 4; ++c) {
            texel[c] =
                static_cast<uint8_t>(bptcMix(static_cast<int32_t>(ends[e][c]), static_cast<int32_t>(ends[e + 1][c]),
                                             c < 3 ? colorWeights[i] : alphaWeights[i]));
        }
        if (rotation != 0) std::swap(texel[3], texel[rotation - 1]);
    }
}

}  // namespace vernier
