// The surroundings of a shader under test: inputs, buffers and images made from a seed, the same for every interpreter.
// What is outside the interpreters (filtering, address modes, texel formats) is done here, once, in float, so that a
// difference between two runs is a difference between interpreters.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "spirv_interp/ir/ir.h"

namespace vernier::proof {

/// How the words of a buffer or the components of an input come about.
struct Filling {
    enum class Kind : uint8_t {
        uniform,  // floats in [low, high]
        integer,  // 32-bit integers in [low, high]
        index,    // low + k * high, k the index of the word or the invocation
        ramp,  // inputs: affine in the invocation's place in the grid, from low to high; buffers: as index, in floats
        special,  // bit patterns at the edges of every type, mixed with random ones
        zero,
    };
    Kind kind = Kind::uniform;
    double low = -1, high = 1;
};

/// Any value, often at an edge of its type: zeros, denormals, infinities, NaN, the largest and smallest integers.
uint32_t specialWord(uint64_t key);

struct Slot {
    uint32_t set = 0, binding = 0, element = 0;
    auto operator<=>(const Slot&) const = default;
};
inline constexpr Slot kPushConstants{~0u, 0, 0};

/// One access to an image by one invocation, in the terms of no interpreter in particular.
struct ImageAccess {
    ir::ImageKind kind = ir::ImageKind::fetch;
    ir::ImageDim dim = ir::ImageDim::d2;
    bool arrayed = false, compare = false;
    std::array<float, 4> coordinates{};
    std::array<int32_t, 4> texel{};
    std::array<float, 3> ddx{}, ddy{};  // sampleImplicit, sampleGrad and queryLod
    float lod = 0, bias = 0;            // sampleLod: lod; sampleImplicit: bias
    float minLod = -1000;               // sampleImplicit, sampleGrad
    int32_t level = 0;                  // fetch, querySize
    std::array<int32_t, 3> offset{};
    float reference = 0;
    int32_t sample = 0;
    uint32_t component = 0;  // gather
    ir::AtomicOp atomic = ir::AtomicOp::load;
    std::array<uint32_t, 4> value{};  // store, atomic
    uint32_t comparator = 0;
};

/// 64 x 64 x 8 texels of four words (the third dimension serves depth, layers and faces), made from noise; level n of
/// detail is every 2^n-th texel. Repeats outside; storage accesses outside read 0 and write nothing.
class TestImage {
  public:
    static constexpr int32_t kSize = 64, kDepth = 8, kLevels = 7;

    TestImage(uint64_t seed, bool integers);
    /// What the access gives, as bits; stores and atomics change the texels.
    std::array<uint32_t, 4> access(const ImageAccess& access);
    const std::vector<std::array<uint32_t, 4>>& texels() const { return texels_; }

  private:
    std::array<uint32_t, 4> texelAt(int32_t x, int32_t y, int32_t z, int32_t level) const;
    std::array<float, 4> sample(const ImageAccess& access, float lod) const;
    std::array<uint32_t, 4> storage(const ImageAccess& access);

    bool integers_;
    std::vector<std::array<uint32_t, 4>> texels_;
};

/// What a shader is given. Copied for every run: runs do not see each other's stores.
class World {
  public:
    struct BufferSpec {
        uint32_t bytes = 4096;
        Filling filling;
    };

    uint64_t seed = 1;
    Filling inputs{Filling::Kind::ramp, -1, 1};
    std::map<uint32_t, Filling> inputAt;  // by location
    Filling contents;                     // of buffers that `bufferAt` does not name
    std::map<Slot, BufferSpec> bufferAt;
    std::map<Slot, bool> integerImages;  // images of 32-bit integers; all others are of floats

    /// The word that invocation `invocation` finds in an input slot.
    uint32_t input(uint32_t invocation, const ir::InterfaceSlot& slot) const;
    /// interpolateAt...: `where` as in BatchContext::Interpolator; a sample's number comes as the bits of `a`.
    float interpolated(uint32_t invocation, const ir::InterfaceSlot& slot, uint32_t where, float a, float b) const;
    std::vector<std::byte> bufferContents(const Slot& slot) const;
    TestImage imageContents(const Slot& slot) const;

  private:
    double fraction(uint64_t key) const;
};

/// The buffers and images of one run, created when first asked for.
class Memory {
  public:
    explicit Memory(const World& world) : world_(world) {}
    std::vector<std::byte>& buffer(const Slot& slot);
    TestImage& image(const Slot& slot);
    const std::map<Slot, std::vector<std::byte>>& buffers() const { return buffers_; }
    const std::map<Slot, TestImage>& images() const { return images_; }

  private:
    const World& world_;
    std::map<Slot, std::vector<std::byte>> buffers_;
    std::map<Slot, TestImage> images_;
};

}  // namespace vernier::proof
