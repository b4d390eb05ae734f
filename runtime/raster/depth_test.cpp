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

alignas(64) constexpr float kColumns[8] = {0, 1, 2, 3, 4, 5, 6, 7};

template <class Format>
uint32_t testBlocks(const DepthTestInput& in, BlockCoverage* blocks, uint32_t count) {
    const F8 f;
    using Value = typename Format::Value;
    const hn::DFromV<Value> dv;
    constexpr uint32_t kLanes = hn::MaxLanes(F8());
    const TrianglePlanes& planes = *in.planes;
    // A compare operation as three masks: what it lets through when less, equal, greater.
    const auto enable = [&](uint32_t bit) HWY_ATTR {
        const Value zero = hn::Zero(dv);
        return (in.plan->compare & bit) != 0 ? hn::Eq(zero, zero) : hn::Ne(zero, zero);
    };
    const auto ifLess = enable(1), ifEqual = enable(2), ifGreater = enable(4);
    const bool write = in.plan->write;
    uint32_t kept = 0;
    for (uint32_t b = 0; b < count; ++b) {
        BlockCoverage& block = blocks[b];
        uint64_t any = 0;
        const int32_t blockX = in.tileX + block.x, blockY = in.tileY + block.y;
        for (uint32_t s = 0; s < in.samples; ++s) {
            const uint64_t covered = block.masks[s];
            uint64_t passed = 0;
            if (covered == 0) continue;
            const VF ox = hn::Set(f, in.positions[s].x() - planes.fractionX);
            const VF oy = hn::Set(f, in.positions[s].y() - planes.fractionY);
            const int32_t firstRow = static_cast<int32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero64(covered)) >> 3;
            const int32_t lastRow = static_cast<int32_t>(63 - hwy::Num0BitsAboveMS1Bit_Nonzero64(covered)) >> 3;
            for (int32_t row = firstRow; row <= lastRow; ++row) {
                std::byte* texels = in.target.texel(blockX, blockY + row, s);
                const VF y = hn::Set(f, static_cast<float>(blockY + row - planes.anchorY));
                for (uint32_t x = 0; x < 8; x += kLanes) {
                    const uint8_t bits = static_cast<uint8_t>((covered >> (8 * row) & 0xFF) >> x);
                    const uint8_t maskBytes[8] = {bits};
                    // Whole numbers below 2^16: the sum is exact.
                    const VF column =
                        hn::Add(hn::Load(f, kColumns + x), hn::Set(f, static_cast<float>(blockX - planes.anchorX)));
                    const Value z = Format::encode(depthOf(f, planes, column, y, ox, oy));
                    std::byte* place = texels + x * Format::kTexelBytes;
                    const Value stored = Format::load(place);
                    auto pass = hn::Or(hn::Or(hn::And(hn::Lt(z, stored), ifLess), hn::And(hn::Eq(z, stored), ifEqual)),
                                       hn::And(hn::Gt(z, stored), ifGreater));
                    pass = hn::And(pass, hn::LoadMaskBits(dv, maskBytes));
                    uint8_t passBits[8] = {};
                    hn::StoreMaskBits(dv, pass, passBits);
                    passed |= static_cast<uint64_t>(passBits[0]) << (8 * row + static_cast<int32_t>(x));
                    if (write && passBits[0] != 0) Format::store(hn::IfThenElse(pass, z, stored), place);
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
            break;
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
