// Depths as attachments keep them, a row of a block at a time, for the depth and the stencil test.
#if defined(VERNIER_RUNTIME_RASTER_DEPTH_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_RUNTIME_RASTER_DEPTH_ROWS_INL_H
#undef VERNIER_RUNTIME_RASTER_DEPTH_ROWS_INL_H
#else
#define VERNIER_RUNTIME_RASTER_DEPTH_ROWS_INL_H
#endif

#include <hwy/highway.h>

#include "runtime/raster/depth_test.h"
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

// How each format keeps 8 (or 4, where vectors are that short) depths of a row: `Value` is what is compared.

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

/// VkCompareOp as masks: what it lets through when less, equal, greater, and unequal, as a NaN is, which undefined
/// contents of an attachment may hold.
template <class D>
struct Comparison {
    using M = hn::Mask<D>;
    M ifLess, ifEqual, ifGreater, ifUnequal;

    explicit Comparison(uint32_t op) {
        const auto zero = hn::Zero(D());
        const auto enable = [&](uint32_t bits)
                                HWY_ATTR { return (op & bits) != 0 ? hn::Eq(zero, zero) : hn::Ne(zero, zero); };
        ifLess = enable(1);
        ifEqual = enable(2);
        ifGreater = enable(4);
        ifUnequal = enable((op & 5) == 5 ? op : 0);
    }
    HWY_INLINE M operator()(hn::Vec<D> a, hn::Vec<D> b) const {
        const M equal = hn::Eq(a, b);  // hn::Ne() is false for NaN on some targets
        return hn::Or(hn::Or(hn::And(hn::Lt(a, b), ifLess), hn::And(equal, ifEqual)),
                      hn::Or(hn::And(hn::Gt(a, b), ifGreater), hn::AndNot(equal, ifUnequal)));
    }
};

alignas(64) constexpr float kColumns[8] = {0, 1, 2, 3, 4, 5, 6, 7};

/// Depths that are exported, where NaN becomes the lower bound; else depthOf(). Out of line, for it is inlined often.
[[maybe_unused]] HWY_NOINLINE static VF specialDepth(const TrianglePlanes& planes, const float* exported, VF columns,
                                                     float y, float offsetX, float offsetY) {
    const F8 f;
    if (exported == nullptr)
        return depthOf(f, planes, columns, hn::Set(f, y), hn::Set(f, offsetX), hn::Set(f, offsetY));
    const VF low = hn::Set(f, planes.zLow), high = hn::Set(f, planes.zHigh);
    const VF z = maxOrSecond(hn::LoadU(f, exported), low);
    return hn::IfThenElse(hn::Gt(z, high), high, z);
}

/// The depths of a block's pixels at one sample, as the format keeps them: those that were exported, or the operations
/// of depthOf(), those that all rows have in common done once.
template <class Format>
class BlockDepths {
  public:
    static constexpr uint32_t kLanes = hn::MaxLanes(F8()), kParts = 8 / kLanes;

    HWY_INLINE BlockDepths(const DepthTestInput& in, const BlockCoverage& block, uint32_t sample)
        : planes_(*in.planes),
          exported_(in.exported),
          special_(in.exported != nullptr || in.planes->precise),
          y_(in.tileY + block.y - planes_.anchorY) {
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
        if (HWY_UNLIKELY(special_)) {
            const float* exported = exported_ == nullptr ? nullptr : exported_ + row * kBlockSize + part * kLanes;
            return Format::encode(specialDepth(planes_, exported, columns_[part], y, offsetX_, offsetY_));
        }
        const VF rise = hn::Set(f, planes_.zy * (y + offsetY_));
        return Format::encode(clampDepth(f, planes_, hn::Add(hn::Set(f, planes_.z0), hn::Add(slopes_[part], rise))));
    }

  private:
    const TrianglePlanes& planes_;
    const float* exported_;
    bool special_;
    int32_t y_;
    float offsetX_, offsetY_;
    VF columns_[kParts], slopes_[kParts];
};

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
