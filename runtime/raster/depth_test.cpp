#include "runtime/raster/depth_test.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/raster/depth_test.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "runtime/raster/depth_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

/// Writes the depths of a block of which every sample passes.
template <class Format>
void writeBlock(const DepthTestInput& in, const BlockCoverage& block) {
    using Depths = BlockDepths<Format>;
    const hn::DFromV<typename Format::Value> dv;
    for (uint32_t s = 0; s < in.samples; ++s) {
        const Depths depths(in, block, s);
        for (int32_t row = 0; row < kBlockSize; ++row) {
            const auto covered = static_cast<uint8_t>(block.masks[s] >> (8 * row) & 0xFF);
            if (covered == 0) continue;
            std::byte* texels = in.target.texel(in.tileX + block.x, in.tileY + block.y + row, s);
            for (uint32_t part = 0; part < Depths::kParts; ++part) {
                std::byte* place = texels + part * Depths::kLanes * Format::kTexelBytes;
                auto z = depths.at(row, part);
                if (covered != 0xFF) {
                    const uint8_t maskBytes[8] = {static_cast<uint8_t>(covered >> part * Depths::kLanes)};
                    z = hn::IfThenElse(hn::LoadMaskBits(dv, maskBytes), z, Format::load(place));
                }
                Format::store(z, place);
            }
        }
    }
}

/// Returns the pixels of a sample that pass.
template <class Format, class Compare>
HWY_INLINE uint64_t testBlock(const DepthTestInput& in, const BlockCoverage& block, uint32_t sample,
                              const Compare& compare) {
    using Depths = BlockDepths<Format>;
    const hn::DFromV<typename Format::Value> dv;
    const uint64_t covered = block.masks[sample];
    if (covered == 0) return 0;
    const Depths depths(in, block, sample);
    const int32_t firstRow = static_cast<int32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero64(covered)) >> 3;
    const int32_t lastRow = static_cast<int32_t>(63 - hwy::Num0BitsAboveMS1Bit_Nonzero64(covered)) >> 3;
    uint64_t passed = 0;
    for (int32_t row = firstRow; row <= lastRow; ++row) {
        std::byte* texels = in.target.texel(in.tileX + block.x, in.tileY + block.y + row, sample);
        for (uint32_t part = 0; part < Depths::kParts; ++part) {
            const uint32_t x = part * Depths::kLanes;
            const uint8_t maskBytes[8] = {static_cast<uint8_t>((covered >> (8 * row) & 0xFF) >> x)};
            const auto z = depths.at(row, part);
            std::byte* place = texels + x * Format::kTexelBytes;
            const auto stored = Format::load(place);
            const auto pass = hn::And(compare(z, stored), hn::LoadMaskBits(dv, maskBytes));
            uint8_t passBits[8] = {};
            hn::StoreMaskBits(dv, pass, passBits);
            passed |= static_cast<uint64_t>(passBits[0]) << (8 * row + static_cast<int32_t>(x));
            if (in.plan->write && passBits[0] != 0) Format::store(hn::IfThenElse(pass, z, stored), place);
        }
    }
    return passed;
}

template <class Format, class Compare>
uint32_t testBlocksBy(const Compare& compare, const DepthTestInput& in, BlockCoverage* blocks, uint32_t count) {
    uint32_t kept = 0;
    for (uint32_t b = 0; b < count; ++b) {
        BlockCoverage& block = blocks[b];
        uint64_t any = 0;
        if ((in.certain >> blockIndex(block) & 1) != 0) {
            if (in.plan->write) writeBlock<Format>(in, block);
            any = ~uint64_t{0};
        } else {
            for (uint32_t s = 0; s < in.samples; ++s) any |= block.masks[s] = testBlock<Format>(in, block, s, compare);
        }
        if (any != 0) moveBlock(blocks, b, kept++, in.samples);
    }
    return kept;
}

/// a <= b; false for NaN.
template <class V>
HWY_INLINE hn::Mask<hn::DFromV<V>> atMost(V a, V b) {
    if constexpr (hwy::IsFloat<hn::TFromV<V>>())
        return hn::Le(a, b);
    else
        return hn::Not(hn::Gt(a, b));
}

template <class Format>
uint32_t testBlocks(const DepthTestInput& in, BlockCoverage* blocks, uint32_t count) {
    using V = typename Format::Value;
    // The usual comparisons are one instruction.
    switch (in.plan->compare) {
        case VK_COMPARE_OP_LESS:
            return testBlocksBy<Format>([](V a, V b) HWY_ATTR { return hn::Lt(a, b); }, in, blocks, count);
        case VK_COMPARE_OP_LESS_OR_EQUAL:
            return testBlocksBy<Format>([](V a, V b) HWY_ATTR { return atMost(a, b); }, in, blocks, count);
        case VK_COMPARE_OP_GREATER:
            return testBlocksBy<Format>([](V a, V b) HWY_ATTR { return hn::Gt(a, b); }, in, blocks, count);
        case VK_COMPARE_OP_GREATER_OR_EQUAL:
            return testBlocksBy<Format>([](V a, V b) HWY_ATTR { return atMost(b, a); }, in, blocks, count);
        default:
            return testBlocksBy<Format>(Comparison<hn::DFromV<V>>(in.plan->compare), in, blocks, count);
    }
}

uint32_t depthTest(const DepthTestInput& in, BlockCoverage* blocks, uint32_t count) {
    switch (in.plan->storage) {
        case DepthStorage::d16:
            return testBlocks<Unorm16>(in, blocks, count);
        case DepthStorage::d24:
            return testBlocks<Unorm24>(in, blocks, count);
        case DepthStorage::d32f:
            return testBlocks<Float32>(in, blocks, count);
        case DepthStorage::d32fs8:
            return testBlocks<Float32Stencil8>(in, blocks, count);
        case DepthStorage::none:
            return count;
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {

DepthTestFn depthTestFunction(Isa isa) {
    VERNIER_SELECT_ISA(isa, depthTest)
}

}  // namespace vernier
#endif
