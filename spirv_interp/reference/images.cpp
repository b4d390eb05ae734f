// Image instructions: operands are gathered into one request, the caller's Resources answer it.
#include "spirv_interp/reference/machine.h"

namespace vernier::reference {
namespace {

/// What the name of an OpImageSample* instruction says.
struct SampleKind {
    bool explicitLod = false, dref = false, projective = false;
};

std::optional<SampleKind> sampleKind(spv::Op op) {
    switch (op) {
        case spv::OpImageSampleImplicitLod:
            return SampleKind{false, false, false};
        case spv::OpImageSampleExplicitLod:
            return SampleKind{true, false, false};
        case spv::OpImageSampleDrefImplicitLod:
            return SampleKind{false, true, false};
        case spv::OpImageSampleDrefExplicitLod:
            return SampleKind{true, true, false};
        case spv::OpImageSampleProjImplicitLod:
            return SampleKind{false, false, true};
        case spv::OpImageSampleProjExplicitLod:
            return SampleKind{true, false, true};
        case spv::OpImageSampleProjDrefImplicitLod:
            return SampleKind{false, true, true};
        case spv::OpImageSampleProjDrefExplicitLod:
            return SampleKind{true, true, true};
        default:
            return std::nullopt;
    }
}

size_t spatialDimensions(spv::Dim dim) {
    switch (dim) {
        case spv::Dim1D:
        case spv::DimBuffer:
            return 1;
        case spv::Dim3D:
        case spv::DimCube:
            return 3;
        default:
            return 2;
    }
}

}  // namespace

template <class Number>
ImageHandle Machine<Number>::imageHandle(Id id) const {
    const Value<Number>& v = value(id);
    if (!v.image) fail(name(id) + " is no image or sampler");
    return *v.image;
}

template <class Number>
ImageRequest<Number> Machine<Number>::request(const ImageHandle& handle) const {
    const Type& type = module_.types[handle.type];
    if (type.kind != TypeKind::image) fail("an image instruction on type " + name(type.id));
    ImageRequest<Number> r;
    r.image = handle.image;
    r.sampler = handle.sampler;
    r.shape = type.shape;
    r.invocation = invocation_;
    return r;
}

template <class Number>
size_t Machine<Number>::coordinateCount(const ImageShape& shape) const {
    return spatialDimensions(shape.dim) + (shape.arrayed ? 1 : 0);
}

/// The optional image operands: a mask at i.operand(maskIndex), then the operands of its bits from low to
/// high.
template <class Number>
void Machine<Number>::applyOperands(ImageRequest<Number>& r, const Instruction& i, size_t maskIndex) const {
    if (maskIndex >= i.operands.size()) return;
    const uint32_t mask = i.operand(maskIndex);
    size_t next = maskIndex + 1;
    const size_t dimensions = spatialDimensions(r.shape.dim);
    const auto has = [mask](uint32_t bit) { return (mask & bit) != 0; };
    const auto vector = [&](auto& target) {
        const Scalars<Number>& v = data(i.operand(next++));
        for (size_t k = 0; k < target.size() && k < v.size() && k < dimensions; ++k) {
            if constexpr (std::is_same_v<std::decay_t<decltype(target[0])>, int32_t>)
                target[k] = static_cast<int32_t>(static_cast<uint32_t>(v[k].bits));
            else
                target[k] = v[k].number;
        }
    };
    if (has(spv::ImageOperandsBiasMask)) r.bias = scalar(i.operand(next++)).number;
    if (has(spv::ImageOperandsLodMask)) {
        const Scalar<Number>& lod = scalar(i.operand(next++));
        r.lodMode = LodMode::explicitLod;
        r.lod = lod.number;
        r.texelLod = static_cast<int32_t>(static_cast<uint32_t>(lod.bits));
    }
    if (has(spv::ImageOperandsGradMask)) {
        r.lodMode = LodMode::gradients;
        vector(r.ddx);
        vector(r.ddy);
    }
    if (has(spv::ImageOperandsConstOffsetMask)) vector(r.offset);
    if (has(spv::ImageOperandsOffsetMask)) vector(r.offset);
    if (has(spv::ImageOperandsConstOffsetsMask)) {
        const Scalars<Number>& v = data(i.operand(next++), 8);
        r.gatherOffsets.emplace();
        for (size_t k = 0; k < 8; ++k)
            (*r.gatherOffsets)[k / 2][k % 2] = static_cast<int32_t>(static_cast<uint32_t>(v[k].bits));
    }
    if (has(spv::ImageOperandsSampleMask)) r.sample = static_cast<int32_t>(signedInteger(i.operand(next++)));
    if (has(spv::ImageOperandsMinLodMask)) r.minLod = scalar(i.operand(next++)).number;
    // What remains are memory-model flags, which mean nothing to one invocation at a time.
}

template <class Number>
void Machine<Number>::setTexel(const Instruction& i, const Texel<Number>& texel, const ImageShape& shape) {
    Scalars<Number> result;
    for (size_t k = 0; k < resultCount(i) && k < 4; ++k)
        result.push_back(shape.floating ? Scalar<Number>::ofNumber(texel[k].number)
                                        : Scalar<Number>::ofBits(texel[k].bits & 0xFFFFFFFFu));
    setResult(i, std::move(result));
}

/// Fills in the quad's derivatives of the coordinates; false while the other invocations are waited for.
template <class Number>
bool Machine<Number>::implicitDerivatives(ImageRequest<Number>& r) {
    const size_t dimensions = spatialDimensions(r.shape.dim);
    std::vector<Number> offer(r.coordinates.begin(), r.coordinates.begin() + static_cast<ptrdiff_t>(dimensions));
    if (!exchange(offer)) return false;
    for (size_t k = 0; k < dimensions; ++k) {
        r.ddx[k] = rounded(difference(k, true, program_.options.coarseDerivatives));
        r.ddy[k] = rounded(difference(k, false, program_.options.coarseDerivatives));
    }
    group_.reset();
    return true;
}

template <class Number>
void Machine<Number>::sampleImage(const Instruction& i) {
    const SampleKind kind = *sampleKind(i.op);
    ImageRequest<Number> r = request(imageHandle(i.operand(0)));
    const Scalars<Number>& coordinates = data(i.operand(1));
    const size_t count = coordinateCount(r.shape);
    if (coordinates.size() < count + (kind.projective ? 1 : 0) || count > 4)
        fail(name(i.op) + " has too few coordinates");
    for (size_t k = 0; k < count; ++k) r.coordinates[k] = coordinates[k].number;
    size_t next = 2;
    if (kind.dref) r.dref = scalar(i.operand(next++)).number;
    if (kind.projective) {
        // Vulkan specification, "Projection Operation": the reference value is divided too.
        const Number& q = coordinates[count].number;
        for (size_t k = 0; k < count; ++k) r.coordinates[k] = rounded(r.coordinates[k] / q);
        if (r.dref) r.dref = rounded(*r.dref / q);
    }
    applyOperands(r, i, next);
    if (!kind.explicitLod && !implicitDerivatives(r)) return;
    setTexel(i, resources_.sample(r), r.shape);
}

template <class Number>
void Machine<Number>::gatherImage(const Instruction& i) {
    ImageRequest<Number> r = request(imageHandle(i.operand(0)));
    const size_t count = coordinateCount(r.shape);
    const Scalars<Number>& coordinates = data(i.operand(1));
    if (coordinates.size() < count || count > 4) fail(name(i.op) + " has too few coordinates");
    for (size_t k = 0; k < count; ++k) r.coordinates[k] = coordinates[k].number;
    if (i.op == spv::OpImageDrefGather)
        r.dref = scalar(i.operand(2)).number;
    else
        r.component = static_cast<uint32_t>(bits(i.operand(2)));
    applyOperands(r, i, 3);
    setTexel(i, resources_.gather(r), r.shape);
}

template <class Number>
void Machine<Number>::fetchImage(const Instruction& i) {
    ImageRequest<Number> r = request(imageHandle(i.operand(0)));
    const Scalars<Number>& coordinates = data(i.operand(1));
    const size_t count = coordinateCount(r.shape);
    if (coordinates.size() < count || count > 4) fail(name(i.op) + " has too few coordinates");
    for (size_t k = 0; k < count; ++k) r.texel[k] = static_cast<int32_t>(static_cast<uint32_t>(coordinates[k].bits));
    r.lodMode = LodMode::explicitLod;
    applyOperands(r, i, 2);
    setTexel(i, resources_.fetch(r), r.shape);
}

template <class Number>
void Machine<Number>::writeImage(const Instruction& i) {
    ImageRequest<Number> r = request(imageHandle(i.operand(0)));
    const Scalars<Number>&coordinates = data(i.operand(1)), &source = data(i.operand(2));
    const size_t count = coordinateCount(r.shape);
    if (coordinates.size() < count || count > 4) fail(name(i.op) + " has too few coordinates");
    for (size_t k = 0; k < count; ++k) r.texel[k] = static_cast<int32_t>(static_cast<uint32_t>(coordinates[k].bits));
    applyOperands(r, i, 3);
    Texel<Number> texel{};
    for (size_t k = 0; k < source.size() && k < 4; ++k) texel[k] = source[k];
    if (!helper_) resources_.write(r, texel);
}

template <class Number>
bool Machine<Number>::executeImage(const Instruction& i) {
    if (sampleKind(i.op)) {
        sampleImage(i);
        return true;
    }
    // Queries: the image, and up to four integers as the result.
    const auto integers = [&](const std::array<int32_t, 4>& numbers) {
        Scalars<Number> result;
        for (size_t k = 0; k < resultCount(i) && k < 4; ++k) result.push_back(Scalar<Number>::ofInt(numbers[k]));
        setResult(i, std::move(result));
        return true;
    };
    switch (i.op) {
        case spv::OpSampledImage: {
            Value<Number> v;
            v.image = imageHandle(i.operand(0));
            v.image->sampler = imageHandle(i.operand(1)).sampler;
            setValue(i, std::move(v));
            return true;
        }
        case spv::OpImage: {
            Value<Number> v;
            v.image = imageHandle(i.operand(0));
            setValue(i, std::move(v));
            return true;
        }
        case spv::OpImageFetch:
        case spv::OpImageRead:
            fetchImage(i);
            return true;
        case spv::OpImageWrite:
            writeImage(i);
            return true;
        case spv::OpImageGather:
        case spv::OpImageDrefGather:
            gatherImage(i);
            return true;
        case spv::OpImageQuerySizeLod: {
            const ImageRequest<Number> r = request(imageHandle(i.operand(0)));
            const auto lod = static_cast<int32_t>(signedInteger(i.operand(1)));
            return integers(resources_.querySize(r.image, r.shape, lod));
        }
        case spv::OpImageQuerySize: {
            const ImageRequest<Number> r = request(imageHandle(i.operand(0)));
            return integers(resources_.querySize(r.image, r.shape, 0));
        }
        case spv::OpImageQueryLevels: {
            const ImageRequest<Number> r = request(imageHandle(i.operand(0)));
            return integers({resources_.queryLevels(r.image, r.shape)});
        }
        case spv::OpImageQuerySamples: {
            const ImageRequest<Number> r = request(imageHandle(i.operand(0)));
            return integers({resources_.querySamples(r.image, r.shape)});
        }
        case spv::OpImageQueryLod: {
            ImageRequest<Number> r = request(imageHandle(i.operand(0)));
            const Scalars<Number>& coordinates = data(i.operand(1));
            const size_t count = spatialDimensions(r.shape.dim);
            if (coordinates.size() < count) fail(name(i.op) + " has too few coordinates");
            for (size_t k = 0; k < count; ++k) r.coordinates[k] = coordinates[k].number;
            if (!implicitDerivatives(r)) return true;
            const std::array<Number, 2> lod = resources_.queryLod(r);
            setResult(i, {Scalar<Number>::ofNumber(lod[0]), Scalar<Number>::ofNumber(lod[1])});
            return true;
        }
        default:
            return false;
    }
}

template bool Machine<float>::executeImage(const Instruction&);
template bool Machine<double>::executeImage(const Instruction&);
template bool Machine<Real>::executeImage(const Instruction&);

}  // namespace vernier::reference
