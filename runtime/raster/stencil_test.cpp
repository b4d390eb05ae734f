#include "runtime/raster/depth_test.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/raster/stencil_test.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "runtime/raster/depth_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

// The stencil test (specification, "Stencil Test"), with the depth test where there is one: the same as testSample().

/// A stencil operation on lanes of values from 0 to 255, without branches:
/// clamp((value & keep) + add, low, high) & 255 ^ flip.
template <class D>
class StencilOperation {
  public:
    StencilOperation(VkStencilOp op, uint32_t reference) {
        const DI di;
        const int32_t value = static_cast<int32_t>(reference & 0xFF);
        const bool keeps = op != VK_STENCIL_OP_ZERO && op != VK_STENCIL_OP_REPLACE;
        const bool up = op == VK_STENCIL_OP_INCREMENT_AND_CLAMP || op == VK_STENCIL_OP_INCREMENT_AND_WRAP;
        const bool down = op == VK_STENCIL_OP_DECREMENT_AND_CLAMP || op == VK_STENCIL_OP_DECREMENT_AND_WRAP;
        keep_ = hn::Set(di, keeps ? 0xFF : 0);
        add_ = hn::Set(di, op == VK_STENCIL_OP_REPLACE ? value : up ? 1 : down ? -1 : 0);
        low_ = hn::Set(di, op == VK_STENCIL_OP_DECREMENT_AND_CLAMP ? 0 : -1);
        high_ = hn::Set(di, op == VK_STENCIL_OP_INCREMENT_AND_CLAMP ? 0xFF : 0x100);
        flip_ = hn::Set(di, op == VK_STENCIL_OP_INVERT ? 0xFF : 0);
    }
    HWY_INLINE hn::Vec<D> operator()(hn::Vec<D> stored) const {
        const VI sum = hn::Add(hn::And(hn::BitCast(DI(), stored), keep_), add_);
        const VI value = hn::And(hn::Min(hn::Max(sum, low_), high_), hn::Set(DI(), 0xFF));
        return hn::BitCast(D(), hn::Xor(value, flip_));
    }

  private:
    using DI = hn::RebindToSigned<D>;
    using VI = hn::Vec<DI>;
    VI keep_, add_, low_, high_, flip_;
};

/// What a face does, on lanes of D.
template <class D>
struct StencilFace {
    using V = hn::Vec<D>;

    explicit StencilFace(const DepthStencilState::Face& face)
        : fail(face.ops.failOp, face.values.reference),
          depthFail(face.ops.depthFailOp, face.values.reference),
          pass(face.ops.passOp, face.values.reference),
          reference(hn::Set(D(), face.values.reference & face.values.compareMask & 0xFF)),
          compareMask(hn::Set(D(), face.values.compareMask & 0xFF)),
          writeMask(hn::Set(D(), face.values.writeMask & 0xFF)),
          compare(face.ops.compareOp) {}

    HWY_INLINE hn::Mask<D> passes(V stored) const { return compare(reference, hn::And(stored, compareMask)); }
    HWY_INLINE V merged(V stored, V value) const {
        return hn::Or(hn::AndNot(writeMask, stored), hn::And(value, writeMask));
    }

    StencilOperation<D> fail, depthFail, pass;
    V reference, compareMask, writeMask;
    Comparison<D> compare;
};

// --- With a depth test

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

/// Depth and stencil of a row of 8 (or 4) pixels.
template <class Format>
class DepthStencilTest {
  public:
    explicit DepthStencilTest(const DepthTestInput& in)
        : write_(in.plan->write), face_(*in.face), depthCompare_(in.plan->compare) {}

    /// Returns which of the pixels that `bits` names pass. `z`: their depths.
    HWY_INLINE uint8_t run(uint8_t bits, typename Format::Value z, std::byte* place) const {
        const uint8_t maskBytes[8] = {bits};
        const auto covered = hn::LoadMaskBits(U8(), maskBytes);
        DepthStencilTexels<typename Format::Value> texels = Format::load(place);
        const VU stored = texels.stencil;
        const auto stencilPass = face_.passes(stored);
        const auto pass = hn::And(stencilPass, hn::RebindMask(U8(), depthCompare_(z, texels.depth)));
        if (write_) texels.depth = hn::IfThenElse(hn::RebindMask(DV(), hn::And(pass, covered)), z, texels.depth);
        const VU failed = hn::IfThenElse(stencilPass, face_.depthFail(stored), face_.fail(stored));
        const VU value = hn::IfThenElse(pass, face_.pass(stored), failed);
        texels.stencil = hn::IfThenElse(covered, face_.merged(stored, value), stored);
        Format::store(texels, place);
        uint8_t passBits[8] = {};
        hn::StoreMaskBits(U8(), hn::And(pass, covered), passBits);
        return passBits[0];
    }

  private:
    using DV = hn::DFromV<typename Format::Value>;
    bool write_;
    StencilFace<U8> face_;
    Comparison<DV> depthCompare_;
};

template <class Format>
uint64_t testDepthStencil(const DepthTestInput& in, const DepthStencilTest<Format>& test, const BlockCoverage& block,
                          uint32_t sample) {
    using Depths = BlockDepths<Format>;
    const Depths depths(in, block, sample);
    uint64_t passed = 0;
    for (int32_t row = 0; row < kBlockSize; ++row) {
        const auto covered = static_cast<uint8_t>(block.masks[sample] >> (8 * row) & 0xFF);
        if (covered == 0) continue;
        std::byte* texels = in.target.texel(in.tileX + block.x, in.tileY + block.y + row, sample);
        for (uint32_t part = 0; part < Depths::kParts; ++part) {
            const uint32_t x = part * Depths::kLanes;
            const uint8_t bits =
                test.run(static_cast<uint8_t>(covered >> x), depths.at(row, part), texels + x * Format::kTexelBytes);
            passed |= static_cast<uint64_t>(bits) << (8 * row + static_cast<int32_t>(x));
        }
    }
    return passed;
}

// --- Without: texels as lanes of 32 bits, of which the last of each texel has the stencil value

/// Depth and stencil in one word, or in two.
template <size_t kWords, int kShift>
struct WordTexels {
    using D = hn::CappedTag<uint32_t, 8 * kWords>;
    using V = hn::Vec<D>;
    static constexpr size_t kLanesPerTexel = kWords, kLaneBytes = 4;
    static V load(const std::byte* p) { return hn::LoadU(D(), reinterpret_cast<const uint32_t*>(p)); }
    static void store(V lanes, std::byte* p) { hn::StoreU(lanes, D(), reinterpret_cast<uint32_t*>(p)); }
    static V stencilOf(V lanes) { return hn::And(hn::ShiftRight<kShift>(lanes), hn::Set(D(), 0xFFu)); }
    static V withStencil(V lanes, V stencil) {
        return hn::Or(hn::AndNot(hn::Set(D(), 0xFFu << kShift), lanes), hn::ShiftLeft<kShift>(stencil));
    }
};

struct ByteTexels {
    using D = U8;
    using V = VU;
    static constexpr size_t kLanesPerTexel = 1, kLaneBytes = 1;
    static V load(const std::byte* p) {
        const hn::Rebind<uint8_t, D> u8;
        return hn::PromoteTo(D(), hn::LoadU(u8, reinterpret_cast<const uint8_t*>(p)));
    }
    static void store(V lanes, std::byte* p) {
        const hn::Rebind<uint8_t, D> u8;
        hn::StoreU(hn::DemoteTo(u8, hn::BitCast(I8(), lanes)), u8, reinterpret_cast<uint8_t*>(p));
    }
    static V stencilOf(V lanes) { return lanes; }
    static V withStencil(V, V stencil) { return stencil; }
};

/// By lane, the bit of the pixel whose stencil value it has.
template <size_t kLanesPerTexel>
struct StencilLanes {
    alignas(64) uint32_t bit[8 * kLanesPerTexel];
};

template <size_t kLanesPerTexel>
constexpr StencilLanes<kLanesPerTexel> stencilLanes() {
    StencilLanes<kLanesPerTexel> lanes{};
    for (size_t n = 0; n < 8; ++n) lanes.bit[(n + 1) * kLanesPerTexel - 1] = 1u << n;
    return lanes;
}

/// The bits of pixels from those of their lanes.
template <size_t kLanesPerTexel>
uint32_t pixelBits(uint32_t lanes) {
    if constexpr (kLanesPerTexel == 1) return lanes;
    lanes = lanes >> 1 & 0x5555;
    lanes = (lanes | lanes >> 1) & 0x3333;
    lanes = (lanes | lanes >> 2) & 0x0F0F;
    return (lanes | lanes >> 4) & 0xFF;
}

/// Returns which of the pixels of a row that `bits` names pass.
template <class Texels, bool kAlways>
HWY_INLINE uint32_t testStencilRow(const StencilFace<typename Texels::D>& face, uint32_t bits, std::byte* row) {
    using D = typename Texels::D;
    static constexpr auto kStencilLanes = stencilLanes<Texels::kLanesPerTexel>();
    constexpr size_t kLanes = hn::MaxLanes(D());
    uint32_t passed = 0;
    for (size_t lane = 0; lane < 8 * Texels::kLanesPerTexel; lane += kLanes) {
        const auto pixels = hn::And(hn::Set(D(), bits), hn::Load(D(), kStencilLanes.bit + lane));
        const auto covered = hn::Ne(pixels, hn::Zero(D()));
        std::byte* place = row + lane * Texels::kLaneBytes;
        const auto texels = Texels::load(place);
        const auto stored = Texels::stencilOf(texels);
        auto value = face.pass(stored);
        if constexpr (!kAlways) {
            const auto pass = face.passes(stored);
            value = hn::IfThenElse(pass, value, face.fail(stored));
            uint8_t passBits[8] = {};
            hn::StoreMaskBits(D(), hn::And(pass, covered), passBits);
            passed |= (passBits[0] | uint32_t{passBits[1]} << 8) << lane;
        }
        const auto written = Texels::withStencil(texels, face.merged(stored, value));
        Texels::store(hn::IfThenElse(covered, written, texels), place);
    }
    return kAlways ? bits : pixelBits<Texels::kLanesPerTexel>(passed);
}

template <class Texels, bool kAlways>
uint64_t testStencil(const DepthTestInput& in, const StencilFace<typename Texels::D>& face, const BlockCoverage& block,
                     uint32_t sample) {
    // A copy that no store can change: it stays in registers.
    const StencilFace<typename Texels::D> local = face;
    std::byte* row = in.target.texel(in.tileX + block.x, in.tileY + block.y, sample);
    const size_t pitch = in.target.rowPitch;
    const uint64_t covered = block.masks[sample];
    uint64_t passed = 0;
    for (uint32_t shift = 0; shift < 64; shift += kBlockSize, row += pitch) {
        const auto bits = static_cast<uint32_t>(covered >> shift & 0xFF);
        if (bits == 0) continue;
        const uint32_t pass = testStencilRow<Texels, kAlways>(local, bits, row);
        if constexpr (!kAlways) passed |= uint64_t{pass} << shift;
    }
    return kAlways ? covered : passed;
}

// --- Blocks

/// `test(block, sample)` gives the pixels that pass.
template <class Test>
uint32_t testEach(const DepthTestInput& in, BlockCoverage* blocks, uint32_t count, const Test& test) {
    uint32_t kept = 0;
    for (uint32_t b = 0; b < count; ++b) {
        uint64_t any = 0;
        for (uint32_t s = 0; s < in.samples; ++s) any |= blocks[b].masks[s] = test(blocks[b], s);
        if (any != 0) moveBlock(blocks, b, kept++, in.samples);
    }
    return kept;
}

template <class Format>
uint32_t depthStencilBlocks(const DepthTestInput& in, BlockCoverage* blocks, uint32_t count) {
    const DepthStencilTest<Format> test(in);
    return testEach(in, blocks, count, [&](const BlockCoverage& block, uint32_t sample) HWY_ATTR {
        return testDepthStencil<Format>(in, test, block, sample);
    });
}

template <class Texels>
uint32_t stencilBlocks(const DepthTestInput& in, BlockCoverage* blocks, uint32_t count) {
    const StencilFace<typename Texels::D> face(*in.face);
    const bool always = in.face->ops.compareOp == VK_COMPARE_OP_ALWAYS;
    return testEach(in, blocks, count, [&](const BlockCoverage& block, uint32_t sample) HWY_ATTR {
        return always ? testStencil<Texels, true>(in, face, block, sample)
                      : testStencil<Texels, false>(in, face, block, sample);
    });
}

uint32_t stencilTest(const DepthTestInput& in, BlockCoverage* blocks, uint32_t count) {
    const bool depth = in.plan->test;
    switch (in.plan->storage) {
        case DepthStorage::d24:
            return depth ? depthStencilBlocks<Unorm24Stencil8>(in, blocks, count)
                         : stencilBlocks<WordTexels<1, 24>>(in, blocks, count);
        case DepthStorage::d32fs8:
            return depth ? depthStencilBlocks<Float32AndStencil8>(in, blocks, count)
                         : stencilBlocks<WordTexels<2, 0>>(in, blocks, count);
        case DepthStorage::none:
            return stencilBlocks<ByteTexels>(in, blocks, count);
        default:
            return count;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {

DepthTestFn stencilTestFunction(Isa isa) {
    VERNIER_SELECT_ISA(isa, stencilTest)
}

}  // namespace vernier
#endif
