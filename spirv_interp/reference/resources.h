// How the reference interpreter reaches the world outside a module: buffers, images and interpolation, all
// supplied by the caller. Nothing is known here of formats, filters or memory: the caller decides, in any
// precision it likes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <spirv/unified1/spirv.hpp>

namespace vernier::reference {

/// One scalar of a value. Floats are in `number`; integers are two's complement in the low 32 or 64 bits of
/// `bits`, the rest zero; booleans are 0 or 1 in `bits`. The type, known from the module, tells which one
/// counts.
template <class Number>
struct Scalar {
    Number number{};
    uint64_t bits = 0;

    static Scalar ofNumber(Number value) { return {value, 0}; }
    static Scalar ofBits(uint64_t value) { return {Number{}, value}; }
    static Scalar ofInt(int32_t value) { return ofBits(static_cast<uint32_t>(value)); }
};

template <class Number>
using Texel = std::array<Scalar<Number>, 4>;

/// One descriptor: element `arrayIndex` of the binding (0 when it is no array). Indices are not checked
/// against anything: the caller answers for a descriptor that is not there as for an unbound one.
struct Descriptor {
    uint32_t set = 0;
    uint32_t binding = 0;
    uint32_t arrayIndex = 0;
    auto operator<=>(const Descriptor&) const = default;
};

enum class BufferKind : uint8_t { uniform, storage, pushConstants };

/// A scalar of a storage buffer that an invocation reads or writes.
struct BufferAccess {
    Descriptor buffer;
    uint64_t offset = 0;  // bytes
    uint32_t bytes = 4;
    bool floating = false, isSigned = false;
    uint32_t invocation = 0;  // 0..3: position in the quad
};

/// The type of an image as declared in the module.
struct ImageShape {
    spv::Dim dim = spv::Dim2D;
    bool arrayed = false;
    bool multisampled = false;
    bool depth = false;    // declared as a depth image
    bool storage = false;  // used without a sampler for reads and writes
    bool floating = true;  // texels are floats (else 32-bit integers)
    bool signedTexels = false;
};

enum class LodMode : uint8_t { implicit, explicitLod, gradients };

/// One image access of one invocation. What does not apply to the operation keeps its default.
template <class Number>
struct ImageRequest {
    Descriptor image;
    Descriptor sampler;  // the same as `image` for a combined image sampler
    ImageShape shape;
    uint32_t invocation = 0;  // 0..3: position in the quad

    /// Sampling and gathering: s, t, r (those that the dimension has), then the array layer, after
    /// projection.
    std::array<Number, 4> coordinates{};
    /// Fetch, read and write: the same in texels.
    std::array<int32_t, 4> texel{};

    LodMode lodMode = LodMode::implicit;
    /// Derivatives of s, t, r along the framebuffer's x and y: from the quad (implicit) or given (gradients).
    std::array<Number, 3> ddx{}, ddy{};
    Number lod{};  // explicitLod
    Number bias{};
    std::optional<Number> minLod;
    int32_t texelLod = 0;  // fetch

    std::array<int32_t, 3> offset{};                                     // in texels
    std::optional<std::array<std::array<int32_t, 2>, 4>> gatherOffsets;  // textureGatherOffsets
    uint32_t component = 0;                                              // gather
    std::optional<Number> dref;                                          // depth comparison, after projection
    int32_t sample = 0;                                                  // multisampled images and input attachments
};

enum class InterpolationPlace : uint8_t { centroid, sample, offset };

/// A request for an input at another place than where it was given (interpolateAt*).
template <class Number>
struct InterpolationRequest {
    uint32_t location = 0;
    uint32_t invocation = 0;
    InterpolationPlace place = InterpolationPlace::centroid;
    int32_t sample = 0;              // place == sample
    std::array<Number, 2> offset{};  // place == offset: pixels from the centre
};

/// What a caller derives from to supply resources. The defaults stand for unbound ones: buffers of size 0,
/// images that read as zero. Called from one thread at a time per run()/runQuad() call.
template <class Number>
class Resources {
  public:
    virtual ~Resources() = default;

    /// The bytes of a buffer; reads outside give 0, writes outside are dropped. Written only for
    /// BufferKind::storage.
    virtual std::span<std::byte> buffer(BufferKind, const Descriptor&) { return {}; }

    /// Told of what is read from and written to storage buffers, scalar by scalar, before it happens in the bytes of
    /// buffer(). Writes of helper invocations are none.
    virtual void loaded(const BufferAccess&) {}
    virtual void stored(const BufferAccess&, const Scalar<Number>&) {}
    /// An atomic instruction that does both, with its value (1 of increments and decrements): told instead of them.
    virtual void combined(const BufferAccess&, spv::Op, const Scalar<Number>&) {}

    /// The bytes at an address of physical storage, `size` or none.
    virtual std::span<std::byte> memory(uint64_t /*address*/, uint64_t /*size*/) { return {}; }

    /// OpImageSample*: filtered and, with `dref`, compared (result in component 0).
    virtual Texel<Number> sample(const ImageRequest<Number>&) { return {}; }
    /// OpImageGather and OpImageDrefGather.
    virtual Texel<Number> gather(const ImageRequest<Number>&) { return {}; }
    /// OpImageFetch, and OpImageRead of storage images and input attachments (dim == DimSubpassData: `texel`
    /// is the offset from the invocation's own pixel).
    virtual Texel<Number> fetch(const ImageRequest<Number>&) { return {}; }
    /// OpImageWrite. Not called for helper invocations.
    virtual void write(const ImageRequest<Number>&, const Texel<Number>&) {}

    /// Width, height, depth (as many as the dimension has), then array layers.
    virtual std::array<int32_t, 4> querySize(const Descriptor&, const ImageShape&, int32_t /*lod*/) { return {}; }
    virtual int32_t queryLevels(const Descriptor&, const ImageShape&) { return 0; }
    virtual int32_t querySamples(const Descriptor&, const ImageShape&) { return 0; }
    /// OpImageQueryLod: the mipmap level(s) accessed, and the level of detail relative to the base level.
    virtual std::array<Number, 2> queryLod(const ImageRequest<Number>&) { return {}; }

    /// interpolateAt*: the four components at the location. Without a value the interpreter uses the plain
    /// input.
    virtual std::optional<Texel<Number>> interpolateAt(const InterpolationRequest<Number>&) { return std::nullopt; }
};

}  // namespace vernier::reference
