#include "runtime/raster/depth_test.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/raster/depth_test.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "runtime/raster/planes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F8 = hn::CappedTag<float, 8>;
using U8 = hn::RebindToUnsigned<F8>;
using I8 = hn::RebindToSigned<F8>;
using VF = hn::Vec<F8>;
using VU = hn::Vec<U8>;

/// round(z * scale), exactly: the product of two 24-bit numbers is exact in double.
HWY_INLINE VU quantize(VF z, double scale) {
    const hn::Half<F8> half;
    const hn::RepartitionToWide<F8> d;
    const hn::Half<I8> halfInt;
    const auto round = [&](auto part) HWY_ATTR {
        return hn::DemoteTo(halfInt, hn::Round(hn::Mul(hn::PromoteTo(d, part), hn::Set(d, scale))));
    };
    const auto codes = hn::Combine(I8(), round(hn::UpperHalf(half, z)), round(hn::LowerHalf(half, z)));
    return hn::BitCast(U8(), codes);
}

// How each format keeps 8 (or 4, on SSE4) depths of a row: `Value` is what is compared.

struct Unorm16 {
    using Value = VU;
    static constexpr uint32_t kTexelBytes = 2;
    static VU encode(VF z) { return quantize(z, 65535.0); }
    static VU load(const std::byte* p) {
        const hn::Rebind<uint16_t, U8> u16;
        return hn::PromoteTo(U8(), hn::LoadU(u16, reinterpret_cast<const uint16_t*>(p)));
    }
    static void store(VU value, std::byte* p) {
        const hn::Rebind<uint16_t, U8> u16;
        hn::StoreU(hn::DemoteTo(u16, hn::BitCast(I8(), value)), u16, reinterpret_cast<uint16_t*>(p));
    }
};

struct Unorm24 {
    using Value = VU;
    static constexpr uint32_t kTexelBytes = 4;
    static VU encode(VF z) { return quantize(z, 16777215.0); }
    static VU load(const std::byte* p) {
        return hn::And(hn::LoadU(U8(), reinterpret_cast<const uint32_t*>(p)), hn::Set(U8(), 0xFFFFFFu));
    }
    static void store(VU value, std::byte* p) {
        auto* texels = reinterpret_cast<uint32_t*>(p);
        const VU other = hn::AndNot(hn::Set(U8(), 0xFFFFFFu), hn::LoadU(U8(), texels));
        hn::StoreU(hn::Or(other, value), U8(), texels);
    }
};

struct Float32 {
    using Value = VF;
    static constexpr uint32_t kTexelBytes = 4;
    static VF encode(VF z) { return z; }
    static VF load(const std::byte* p) { return hn::LoadU(F8(), reinterpret_cast<const float*>(p)); }
    static void store(VF value, std::byte* p) { hn::StoreU(value, F8(), reinterpret_cast<float*>(p)); }
};

struct Float32Stencil8 {
    using Value = VF;
    static constexpr uint32_t kTexelBytes = 8;
    static VF encode(VF z) { return z; }
    static VF load(const std::byte* p) {
        VF depth, stencil;
        hn::LoadInterleaved2(F8(), reinterpret_cast<const float*>(p), depth, stencil);
        return depth;
    }
    static void store(VF value, std::byte* p) {
        VF depth, stencil;
        hn::LoadInterleaved2(F8(), reinterpret_cast<const float*>(p), depth, stencil);
        hn::StoreInterleaved2(value, stencil, F8(), reinterpret_cast<float*>(p));
    }
};

/// VkCompareOp as three masks: what it lets through when less, equal, greater.
template <class D>
struct Comparison {
    using M = hn::Mask<D>;
    M ifLess, ifEqual, ifGreater;

    explicit Comparison(uint32_t op) {
        const auto zero = hn::Zero(D());
        const auto enable = [&](uint32_t bit)
                                HWY_ATTR { return (op & bit) != 0 ? hn::Eq(zero, zero) : hn::Ne(zero, zero); };
        ifLess = enable(1);
        ifEqual = enable(2);
        ifGreater = enable(4);
    }
    HWY_INLINE M operator()(hn::Vec<D> a, hn::Vec<D> b) const {
        return hn::Or(hn::Or(hn::And(hn::Lt(a, b), ifLess), hn::And(hn::Eq(a, b), ifEqual)),
                      hn::And(hn::Gt(a, b), ifGreater));
    }
};

// How each format with stencil keeps depth and stencil of a row. `rest` is what store() needs of what load() found.

template <class Value>
struct DepthStencilTexels {
    Value depth;
    VU stencil, rest;
};

struct Unorm24Stencil8 {
    using Value = VU;
    static constexpr uint32_t kTexelBytes = 4;
    static VU encode(VF z) { return Unorm24::encode(z); }
    static DepthStencilTexels<VU> load(const std::byte* p) {
        const VU word = hn::LoadU(U8(), reinterpret_cast<const uint32_t*>(p));
        return {hn::And(word, hn::Set(U8(), 0xFFFFFFu)), hn::ShiftRight<24>(word), word};
    }
    static void store(const DepthStencilTexels<VU>& texels, std::byte* p) {
        hn::StoreU(hn::Or(texels.depth, hn::ShiftLeft<24>(texels.stencil)), U8(), reinterpret_cast<uint32_t*>(p));
    }
};

struct Float32AndStencil8 {
    using Value = VF;
    static constexpr uint32_t kTexelBytes = 8;
    static VF encode(VF z) { return z; }
    static DepthStencilTexels<VF> load(const std::byte* p) {
        VF depth, second;
        hn::LoadInterleaved2(F8(), reinterpret_cast<const float*>(p), depth, second);
        const VU rest = hn::BitCast(U8(), second);
        return {depth, hn::And(rest, hn::Set(U8(), 0xFFu)), rest};
    }
    static void store(const DepthStencilTexels<VF>& texels, std::byte* p) {
        const VU second = hn::Or(hn::AndNot(hn::Set(U8(), 0xFFu), texels.rest), texels.stencil);
        hn::StoreInterleaved2(texels.depth, hn::BitCast(F8(), second), F8(), reinterpret_cast<float*>(p));
    }
};

struct Stencil8 {
    using Value = VU;
    static constexpr uint32_t kTexelBytes = 1;
    static VU encode(VF) { return hn::Zero(U8()); }
    static DepthStencilTexels<VU> load(const std::byte* p) {
        const hn::Rebind<uint8_t, U8> u8;
        const VU stencil = hn::PromoteTo(U8(), hn::LoadU(u8, reinterpret_cast<const uint8_t*>(p)));
        return {hn::Zero(U8()), stencil, stencil};
    }
    static void store(const DepthStencilTexels<VU>& texels, std::byte* p) {
        const hn::Rebind<uint8_t, U8> u8;
        hn::StoreU(hn::DemoteTo(u8, hn::BitCast(I8(), texels.stencil)), u8, reinterpret_cast<uint8_t*>(p));
    }
};

HWY_INLINE VU applyStencilOp(VkStencilOp op, VU stored, VU reference) {
    const auto set = [](uint32_t value) HWY_ATTR { return hn::Set(U8(), value); };
    switch (op) {
        case VK_STENCIL_OP_ZERO:
            return hn::Zero(U8());
        case VK_STENCIL_OP_REPLACE:
            return reference;
        case VK_STENCIL_OP_INCREMENT_AND_CLAMP:
            return hn::Min(hn::Add(stored, set(1)), set(255));
        case VK_STENCIL_OP_DECREMENT_AND_CLAMP:
            return hn::Sub(hn::Max(stored, set(1)), set(1));
        case VK_STENCIL_OP_INVERT:
            return hn::Xor(stored, set(255));
        case VK_STENCIL_OP_INCREMENT_AND_WRAP:
            return hn::And(hn::Add(stored, set(1)), set(255));
        case VK_STENCIL_OP_DECREMENT_AND_WRAP:
            return hn::And(hn::Add(stored, set(255)), set(255));
        default:
            return stored;
    }
}

alignas(64) constexpr float kColumns[8] = {0, 1, 2, 3, 4, 5, 6, 7};

/// The depths of a block's pixels at one sample, as the format keeps them: the operations of depthOf(), those that all
/// rows have in common done once.
template <class Format>
class BlockDepths {
  public:
    static constexpr uint32_t kLanes = hn::MaxLanes(F8()), kParts = 8 / kLanes;

    HWY_INLINE BlockDepths(const DepthTestInput& in, const BlockCoverage& block, uint32_t sample)
        : planes_(*in.planes), y_(in.tileY + block.y - planes_.anchorY) {
        const F8 f;
        offsetX_ = in.positions[sample].x() - planes_.fractionX;
        offsetY_ = in.positions[sample].y() - planes_.fractionY;
        const auto x = static_cast<float>(in.tileX + block.x - planes_.anchorX);
        for (uint32_t part = 0; part < kParts; ++part) {
            // Whole numbers below 2^16: the sum is exact.
            columns_[part] = hn::Add(hn::Load(f, kColumns + part * kLanes), hn::Set(f, x));
            slopes_[part] = hn::Mul(hn::Set(f, planes_.zx), hn::Add(columns_[part], hn::Set(f, offsetX_)));
        }
    }

    HWY_INLINE typename Format::Value at(int32_t row, uint32_t part) const {
        const F8 f;
        const auto y = static_cast<float>(y_ + row);
        if (HWY_UNLIKELY(planes_.precise))
            return Format::encode(
                depthOf(f, planes_, columns_[part], hn::Set(f, y), hn::Set(f, offsetX_), hn::Set(f, offsetY_)));
        const VF rise = hn::Set(f, planes_.zy * (y + offsetY_));
        return Format::encode(clampDepth(f, planes_, hn::Add(hn::Set(f, planes_.z0), hn::Add(slopes_[part], rise))));
    }

  private:
    const TrianglePlanes& planes_;
    int32_t y_;
    float offsetX_, offsetY_;
    VF columns_[kParts], slopes_[kParts];
};

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
HWY_INLINE hn::MFromD<hn::DFromV<V>> atMost(V a, V b) {
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

/// Depth and stencil of a row (specification, "Stencil Test"): the same as testSample() for 8 (or 4) pixels.
template <class Format>
class StencilTest {
  public:
    explicit StencilTest(const DepthTestInput& in)
        : plan_(*in.plan),
          planes_(*in.planes),
          ops_(in.face->ops),
          reference_(hn::Set(U8(), in.face->values.reference & 0xFF)),
          compareMask_(hn::Set(U8(), in.face->values.compareMask & 0xFF)),
          writeMask_(hn::Set(U8(), in.face->values.writeMask & 0xFF)),
          depthCompare_(in.plan->compare),
          stencilCompare_(in.face->ops.compareOp) {}

    /// Returns which of the pixels that `bits` names pass.
    HWY_INLINE uint8_t run(uint8_t bits, VF x, VF y, VF ox, VF oy, std::byte* place) const {
        const DV dv;
        const uint8_t maskBytes[8] = {bits};
        const auto covered = hn::LoadMaskBits(U8(), maskBytes);
        DepthStencilTexels<Value> texels = Format::load(place);
        const VU stored = texels.stencil;
        const auto stencilPass = stencilCompare_(hn::And(reference_, compareMask_), hn::And(stored, compareMask_));
        auto depthPass = stencilPass;
        if (plan_.test) {
            const Value z = Format::encode(depthOf(F8(), planes_, x, y, ox, oy));
            depthPass = hn::And(stencilPass, hn::RebindMask(U8(), depthCompare_(z, texels.depth)));
            const auto written = hn::RebindMask(dv, hn::And(depthPass, covered));
            if (plan_.write) texels.depth = hn::IfThenElse(written, z, texels.depth);
        }
        const VU failed = hn::IfThenElse(stencilPass, applyStencilOp(ops_.depthFailOp, stored, reference_),
                                         applyStencilOp(ops_.failOp, stored, reference_));
        const VU value = hn::IfThenElse(depthPass, applyStencilOp(ops_.passOp, stored, reference_), failed);
        const VU merged = hn::Or(hn::AndNot(writeMask_, stored), hn::And(value, writeMask_));
        texels.stencil = hn::IfThenElse(covered, merged, stored);
        Format::store(texels, place);
        uint8_t passBits[8] = {};
        hn::StoreMaskBits(U8(), hn::And(depthPass, covered), passBits);
        return passBits[0];
    }

  private:
    using Value = typename Format::Value;
    using DV = hn::DFromV<Value>;
    const DepthPlan& plan_;
    const TrianglePlanes& planes_;
    VkStencilOpState ops_;
    VU reference_, compareMask_, writeMask_;
    Comparison<DV> depthCompare_;
    Comparison<U8> stencilCompare_;
};

template <class Format>
uint32_t testStencilBlocks(const DepthTestInput& in, BlockCoverage* blocks, uint32_t count) {
    const F8 f;
    constexpr uint32_t kLanes = hn::MaxLanes(F8());
    const TrianglePlanes& planes = *in.planes;
    const StencilTest<Format> test(in);
    uint32_t kept = 0;
    for (uint32_t b = 0; b < count; ++b) {
        BlockCoverage& block = blocks[b];
        uint64_t any = 0;
        const int32_t blockX = in.tileX + block.x, blockY = in.tileY + block.y;
        const VF firstX = hn::Set(f, static_cast<float>(blockX - planes.anchorX));
        for (uint32_t s = 0; s < in.samples; ++s) {
            const VF ox = hn::Set(f, in.positions[s].x() - planes.fractionX);
            const VF oy = hn::Set(f, in.positions[s].y() - planes.fractionY);
            uint64_t passed = 0;
            for (int32_t row = 0; row < kBlockSize; ++row) {
                const auto covered = static_cast<uint8_t>(block.masks[s] >> (8 * row) & 0xFF);
                if (covered == 0) continue;
                std::byte* texels = in.target.texel(blockX, blockY + row, s);
                const VF y = hn::Set(f, static_cast<float>(blockY + row - planes.anchorY));
                for (uint32_t x = 0; x < 8; x += kLanes) {
                    const VF column = hn::Add(hn::Load(f, kColumns + x), firstX);
                    const uint8_t bits = test.run(static_cast<uint8_t>(covered >> x), column, y, ox, oy,
                                                  texels + x * Format::kTexelBytes);
                    passed |= static_cast<uint64_t>(bits) << (8 * row + static_cast<int32_t>(x));
                }
            }
            block.masks[s] = passed;
            any |= passed;
        }
        if (any != 0) moveBlock(blocks, b, kept++, in.samples);
    }
    return kept;
}

uint32_t depthTest(const DepthTestInput& in, BlockCoverage* blocks, uint32_t count) {
    const bool stencil = in.face != nullptr;
    switch (in.plan->storage) {
        case DepthStorage::d16:
            return testBlocks<Unorm16>(in, blocks, count);
        case DepthStorage::d24:
            return stencil ? testStencilBlocks<Unorm24Stencil8>(in, blocks, count)
                           : testBlocks<Unorm24>(in, blocks, count);
        case DepthStorage::d32f:
            return testBlocks<Float32>(in, blocks, count);
        case DepthStorage::d32fs8:
            return stencil ? testStencilBlocks<Float32AndStencil8>(in, blocks, count)
                           : testBlocks<Float32Stencil8>(in, blocks, count);
        case DepthStorage::none:
            return stencil ? testStencilBlocks<Stencil8>(in, blocks, count) : count;
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
