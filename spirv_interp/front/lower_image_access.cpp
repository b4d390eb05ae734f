// Images without filtering: fetches, reads, writes, queries, texel pointers.
#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {

/// A coordinate of the pixel that a fragment invocation stands for: the integer part of FragCoord.
ir::ValueId Lowering::fragmentPixel(uint8_t axis) {
    return convert(ir::Op::ftos, ir::Type::i32, inputSlot(ir::Builtin::fragCoord, axis, ir::Type::f32));
}

/// OpImageFetch from sampled images, OpImageRead from storage images, texel buffers and input attachments.
void Lowering::lowerFetch(const Instruction& inst) {
    const Handle& handle = handleOf(inst[3]);
    const bool storage = typeInfo(handle.imageType).image.storage;
    ir::ImageOp op = imageOpOf(handle, inst.op == spv::Op::OpImageFetch ? ir::ImageKind::fetch : ir::ImageKind::read);
    if (inst.op == spv::Op::OpImageRead && !storage) refuse(inst, "the image is no storage image or input attachment");
    op.samplerResource = ir::kNoIndex;
    Handle image = handle;
    image.samplerResource = ir::kNoIndex;
    std::vector<ir::ValueId> operands = imageOperandsOf(image);
    if (op.dim == ir::ImageDim::subpass) {
        // The coordinate counts from the fragment's own pixel ("Image Read" in the SPIR-V specification, Dim
        // SubpassData).
        if (program_.stage != ir::Stage::fragment) refuse(inst, "input attachments exist only in fragment shaders");
        const Leaves offset = leavesOf(inst[4]);
        std::vector<ir::ValueId> pixel;
        for (uint8_t axis = 0; axis < 2 && axis < offset.size(); ++axis)
            pixel.push_back(binary(ir::Op::iadd, fragmentPixel(axis), offset[axis]));
        // From the layer that is drawn to; with multiview that is the view.
        pixel.push_back(inputSlot(ir::Builtin::layer, 0, ir::Type::i32));
        op.arrayed = true;
        op.coords = 3;
        appendCoords(image, pixel, op, operands);
    } else {
        appendCoords(image, leavesOf(inst[4]), op, operands);
    }
    appendImageOperands(inst, 5, op, operands, nullptr);
    setTexel(inst, emitImage(op, scalarType(inst[1]), operands));
}

void Lowering::lowerImageWrite(const Instruction& inst) {
    const Handle& handle = handleOf(inst[1]);
    ir::ImageOp op = imageOpOf(handle, ir::ImageKind::store);
    std::vector<ir::ValueId> operands = imageOperandsOf(handle);
    appendCoords(handle, leavesOf(inst[2]), op, operands);
    appendImageOperands(inst, 4, op, operands, nullptr);
    const Leaves texel = leavesOf(inst[3]);
    const ir::Type type = emitter_.typeOf(texel[0]);
    if (ir::isWide(type)) refuse(inst, "the texel is of 64-bit components");
    for (size_t i = 0; i < 4; ++i) operands.push_back(i < texel.size() ? texel[i] : emitter_.constant(type, 0));
    emitImage(op, ir::Type::none, operands);
}

void Lowering::lowerImageQuery(const Instruction& inst) {
    Handle handle = handleOf(inst[3]);
    ir::ImageKind kind = ir::ImageKind::querySize;
    switch (inst.op) {
        case spv::Op::OpImageQueryLod:
            kind = ir::ImageKind::queryLod;
            break;
        case spv::Op::OpImageQueryLevels:
            kind = ir::ImageKind::queryLevels;
            break;
        case spv::Op::OpImageQuerySamples:
            kind = ir::ImageKind::querySamples;
            break;
        default:
            break;
    }
    if (kind != ir::ImageKind::queryLod) handle.samplerResource = ir::kNoIndex;
    ir::ImageOp op = imageOpOf(handle, kind);
    std::vector<ir::ValueId> operands = imageOperandsOf(handle);
    if (kind == ir::ImageKind::queryLod) {
        if (program_.stage != ir::Stage::fragment) refuse(inst, "implicit derivatives exist only in fragment shaders");
        // The layer does not take part.
        op.coords = static_cast<uint8_t>(op.coords - (op.arrayed ? 1 : 0));
        appendCoords(handle, leavesOf(inst[4]), op, operands);
    } else {
        op.coords = 0;
        if (inst.op == spv::Op::OpImageQuerySizeLod) {
            op.hasLod = true;
            operands.push_back(indexOf(inst[4]));
        }
    }
    setTexel(inst, emitImage(op, scalarType(inst[1]), operands));
}

void Lowering::lowerTexelPointer(const Instruction& inst) {
    const Pointer& image = pointerOf(inst[3]);
    if (image.base != Pointer::Base::handle || typeInfo(image.type).kind != SpirvType::Kind::image) {
        refuse(inst, "does not point to an image");
    }
    Texel texel;
    texel.image.imageType = image.type;
    texel.image.imageResource = resourceOf(image.root);
    texel.image.imageIndex = descriptorOf(image);
    const ir::ImageOp op = imageOpOf(texel.image, ir::ImageKind::atomic);
    const Leaves coords = leavesOf(inst[4]);
    if (coords.size() < op.coords) refuse(inst, "too few coordinates");
    texel.coords = coords.first(op.coords);
    if (op.multisampled) texel.sample = indexOf(inst[5]);
    Pointer pointer;
    pointer.base = Pointer::Base::texel;
    pointer.type = typeInfo(inst[1]).element;
    pointer.root = image.root;
    pointer.texel = arena_.create(texel);
    setPointer(inst[2], pointer);
}

}  // namespace vernier
