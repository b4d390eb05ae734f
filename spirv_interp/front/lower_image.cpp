// Images: what all image instructions share, sampling and gathering.
#include <algorithm>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {
namespace {

ir::ImageDim dimOf(spv::Dim dim) {
    switch (dim) {
        case spv::Dim::Dim1D:
            return ir::ImageDim::d1;
        case spv::Dim::Dim3D:
            return ir::ImageDim::d3;
        case spv::Dim::Cube:
            return ir::ImageDim::cube;
        case spv::Dim::Buffer:
            return ir::ImageDim::buffer;
        case spv::Dim::SubpassData:
            return ir::ImageDim::subpass;
        default:
            return ir::ImageDim::d2;
    }
}

/// Coordinates without the array layer.
uint8_t spatialCoords(ir::ImageDim dim) {
    switch (dim) {
        case ir::ImageDim::d1:
        case ir::ImageDim::buffer:
            return 1;
        case ir::ImageDim::d3:
        case ir::ImageDim::cube:
            return 3;
        default:
            return 2;
    }
}

constexpr auto kBias = static_cast<uint32_t>(spv::ImageOperandsMask::Bias);
constexpr auto kLod = static_cast<uint32_t>(spv::ImageOperandsMask::Lod);
constexpr auto kGrad = static_cast<uint32_t>(spv::ImageOperandsMask::Grad);
constexpr auto kConstOffset = static_cast<uint32_t>(spv::ImageOperandsMask::ConstOffset);
constexpr auto kOffset = static_cast<uint32_t>(spv::ImageOperandsMask::Offset);
constexpr auto kConstOffsets = static_cast<uint32_t>(spv::ImageOperandsMask::ConstOffsets);
constexpr auto kSample = static_cast<uint32_t>(spv::ImageOperandsMask::Sample);
constexpr auto kMinLod = static_cast<uint32_t>(spv::ImageOperandsMask::MinLod);
// Availability, visibility and volatility: invocations see their own accesses in order, others' at barriers. Sign and
// zero extension repeat what the sampled type says.
constexpr uint32_t bitsOf(std::initializer_list<spv::ImageOperandsMask> masks) {
    uint32_t bits = 0;
    for (const spv::ImageOperandsMask mask : masks) bits |= static_cast<uint32_t>(mask);
    return bits;
}
constexpr uint32_t kNoEffect =
    bitsOf({spv::ImageOperandsMask::MakeTexelAvailable, spv::ImageOperandsMask::MakeTexelVisible,
            spv::ImageOperandsMask::NonPrivateTexel, spv::ImageOperandsMask::VolatileTexel,
            spv::ImageOperandsMask::SignExtend, spv::ImageOperandsMask::ZeroExtend});

}  // namespace

bool Lowering::lowerImage(const Instruction& inst) {
    switch (inst.op) {
        case spv::Op::OpSampledImage: {
            Handle handle = handleOf(inst[3]);
            const Handle& sampler = handleOf(inst[4]);
            handle.samplerResource = sampler.samplerResource;
            handle.samplerIndex = sampler.samplerIndex;
            setHandle(inst[2], handle);
            return true;
        }
        case spv::Op::OpImage: {
            Handle handle = handleOf(inst[3]);
            handle.samplerResource = ir::kNoIndex;
            setHandle(inst[2], handle);
            return true;
        }
        case spv::Op::OpImageSampleImplicitLod:
        case spv::Op::OpImageSampleExplicitLod:
        case spv::Op::OpImageSampleDrefImplicitLod:
        case spv::Op::OpImageSampleDrefExplicitLod:
        case spv::Op::OpImageSampleProjImplicitLod:
        case spv::Op::OpImageSampleProjExplicitLod:
        case spv::Op::OpImageSampleProjDrefImplicitLod:
        case spv::Op::OpImageSampleProjDrefExplicitLod:
            lowerSample(inst);
            return true;
        case spv::Op::OpImageGather:
        case spv::Op::OpImageDrefGather:
            lowerGather(inst);
            return true;
        case spv::Op::OpImageFetch:
        case spv::Op::OpImageRead:
            lowerFetch(inst);
            return true;
        case spv::Op::OpImageWrite:
            lowerImageWrite(inst);
            return true;
        case spv::Op::OpImageQuerySizeLod:
        case spv::Op::OpImageQuerySize:
        case spv::Op::OpImageQueryLod:
        case spv::Op::OpImageQueryLevels:
        case spv::Op::OpImageQuerySamples:
            lowerImageQuery(inst);
            return true;
        default:
            return false;
    }
}

ir::ImageOp Lowering::imageOpOf(const Handle& handle, ir::ImageKind kind) const {
    const ImageType& image = typeInfo(handle.imageType).image;
    ir::ImageOp op;
    op.kind = kind;
    op.imageResource = handle.imageResource;
    op.samplerResource = handle.samplerResource;
    op.dim = dimOf(image.dim);
    op.arrayed = image.arrayed;
    op.multisampled = image.multisampled;
    const bool texels = kind == ir::ImageKind::read || kind == ir::ImageKind::store || kind == ir::ImageKind::atomic;
    // Texels of a cube are named by column, row and face; of an array of cubes the last counts on through the layers.
    const uint32_t spatial = texels && op.dim == ir::ImageDim::cube && op.arrayed ? 2 : spatialCoords(op.dim);
    op.coords = static_cast<uint8_t>(spatial + (image.arrayed ? 1 : 0));
    return op;
}

/// The descriptor operands that every image instruction begins with.
std::vector<ir::ValueId> Lowering::imageOperandsOf(const Handle& handle) const {
    std::vector<ir::ValueId> operands{handle.imageIndex};
    if (handle.samplerResource != ir::kNoIndex && handle.samplerResource != handle.imageResource) {
        operands.push_back(handle.samplerIndex);
    }
    return operands;
}

void Lowering::appendCoords(const Handle& handle, Leaves coords, ir::ImageOp& op, std::vector<ir::ValueId>& operands) {
    if (coords.size() < op.coords) refuseId(handle.imageType, "is accessed with too few coordinates");
    for (const ir::ValueId coord : coords.first(op.coords)) {
        if (ir::isWide(emitter_.typeOf(coord))) refuseId(handle.imageType, "is accessed with 64-bit coordinates");
        operands.push_back(coord);
    }
}

ir::ValueId Lowering::emitImage(const ir::ImageOp& op, ir::Type type, std::span<const ir::ValueId> operands) {
    program_.imageOps.push_back(op);
    return emitter_.emit(op.kind == ir::ImageKind::store ? ir::Op::imageStore : ir::Op::image,
                         op.kind == ir::ImageKind::store ? ir::Type::none : type, operands,
                         program_.imageOps.size() - 1);
}

/// The result of an image instruction from its four values.
void Lowering::setTexel(const Instruction& inst, ir::ValueId first) {
    const NewScalars leaves = newLeaves(leafTypes(inst[1]).size());
    if (leaves.empty() || leaves.size() > 4) refuse(inst, "the result is no scalar or vector");
    for (uint32_t i = 0; i < leaves.size(); ++i) leaves[i] = first + i;
    setValue(inst[2], inst[1], leaves);
}

/// Reads the image operands from the mask on and appends those that are there in the order of ir::ImageOp.
void Lowering::appendImageOperands(const Instruction& inst, uint32_t maskWord, ir::ImageOp& op,
                                   std::vector<ir::ValueId>& operands, uint32_t* constOffsets) {
    const uint32_t mask = inst[maskWord];
    uint32_t word = maskWord + 1;
    const auto append = [&](Leaves leaves) { operands.insert(operands.end(), leaves.begin(), leaves.end()); };
    if (mask & kBias) {
        op.hasBias = true;
        append(leavesOf(inst[word++]).first(1));
    }
    if (mask & kLod) {
        op.hasLod = true;
        append(leavesOf(inst[word++]).first(1));
    }
    if (mask & kGrad) {
        const Leaves dx = leavesOf(inst[word]), dy = leavesOf(inst[word + 1]);
        word += 2;
        op.gradients = static_cast<uint8_t>(dx.size() + dy.size());
        append(dx);
        append(dy);
    }
    if (mask & (kConstOffset | kOffset)) {
        const Leaves offset = leavesOf(inst[word++]);
        op.offsets = static_cast<uint8_t>(offset.size());
        append(offset);
    }
    if (mask & kConstOffsets) {
        if (constOffsets == nullptr) refuse(inst, "ConstOffsets are only for gathers");
        *constOffsets = inst[word++];
    }
    if (mask & kSample) {
        op.hasSample = true;
        append(leavesOf(inst[word++]).first(1));
    }
    if (mask & kMinLod) {
        op.hasMinLod = true;
        append(leavesOf(inst[word++]).first(1));
    }
    const uint32_t known =
        kBias | kLod | kGrad | kConstOffset | kOffset | kConstOffsets | kSample | kMinLod | kNoEffect;
    if ((mask & ~known) != 0) refuse(inst, "image operands " + std::to_string(mask & ~known) + " are not supported");
}

void Lowering::lowerSample(const Instruction& inst) {
    const Handle& handle = handleOf(inst[3]);
    const bool dref =
        inst.op == spv::Op::OpImageSampleDrefImplicitLod || inst.op == spv::Op::OpImageSampleDrefExplicitLod ||
        inst.op == spv::Op::OpImageSampleProjDrefImplicitLod || inst.op == spv::Op::OpImageSampleProjDrefExplicitLod;
    const bool projected = inst.op >= spv::Op::OpImageSampleProjImplicitLod;
    ir::ImageOp op = imageOpOf(handle, ir::ImageKind::sampleImplicit);
    op.depthCompare = dref;
    std::vector<ir::ValueId> operands = imageOperandsOf(handle);
    std::vector<ir::ValueId> coords(leavesOf(inst[4]).begin(), leavesOf(inst[4]).end());
    ir::ValueId reference = dref ? scalarOf(inst[5]) : ir::kNoValue;
    if (projected) {
        // (u, v, w, q): q follows the coordinates and divides them, and the reference too.
        if (coords.size() <= op.coords) refuse(inst, "the coordinate has no q");
        const ir::ValueId q = coords[op.coords];
        for (uint32_t i = 0; i < op.coords; ++i) coords[i] = binary(ir::Op::fdiv, coords[i], q);
        if (dref) reference = binary(ir::Op::fdiv, reference, q);
    }
    appendCoords(handle, coords, op, operands);
    if (dref) operands.push_back(reference);
    appendImageOperands(inst, dref ? 6 : 5, op, operands, nullptr);
    if (op.hasLod) op.kind = ir::ImageKind::sampleLod;
    if (op.gradients != 0) op.kind = ir::ImageKind::sampleGrad;
    if (op.kind == ir::ImageKind::sampleImplicit && program_.stage != ir::Stage::fragment) {
        refuse(inst, "implicit derivatives exist only in fragment shaders");
    }
    setTexel(inst, emitImage(op, scalarType(inst[1]), operands));
}

void Lowering::lowerGather(const Instruction& inst) {
    const Handle& handle = handleOf(inst[3]);
    const bool dref = inst.op == spv::Op::OpImageDrefGather;
    ir::ImageOp op = imageOpOf(handle, ir::ImageKind::gather);
    op.depthCompare = dref;
    std::vector<ir::ValueId> operands = imageOperandsOf(handle);
    appendCoords(handle, leavesOf(inst[4]), op, operands);
    if (dref) {
        operands.push_back(scalarOf(inst[5]));
    } else {
        const std::optional<uint32_t> component = constantOf(inst[5]);
        if (!component || *component > 3) refuse(inst, "the component is not a constant from 0 to 3");
        op.component = static_cast<uint8_t>(*component);
    }
    uint32_t offsets = 0;
    appendImageOperands(inst, 6, op, operands, &offsets);
    if (offsets == 0) return setTexel(inst, emitImage(op, scalarType(inst[1]), operands));
    // Four offsets: texel (i0, j0) of each of four gathers, which is the last of a gather's values.
    const Leaves each = leavesOf(offsets);
    const size_t parts = each.size() / 4;
    op.offsets = static_cast<uint8_t>(parts);
    const NewScalars leaves = newLeaves(4);
    for (size_t i = 0; i < 4; ++i) {
        std::vector<ir::ValueId> shifted = operands;
        shifted.insert(shifted.end(), each.begin() + static_cast<std::ptrdiff_t>(i * parts),
                       each.begin() + static_cast<std::ptrdiff_t>((i + 1) * parts));
        leaves[i] = emitImage(op, scalarType(inst[1]), shifted) + 3;
    }
    setValue(inst[2], inst[1], leaves);
}

}  // namespace vernier
