// Atomics on buffers, on memory reached by its address and on texels.
#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {

ir::ValueId Lowering::atomic(const Pointer& pointer, ir::AtomicOp op, ir::Type type, Leaves values) {
    std::vector<ir::ValueId> operands;
    if (pointer.base == Pointer::Base::texel) {
        ir::ImageOp image = imageOpOf(pointer.texel->image, ir::ImageKind::atomic);
        image.atomicOp = op;
        image.hasSample = pointer.texel->sample != ir::kNoValue;
        operands = imageOperandsOf(pointer.texel->image);
        operands.insert(operands.end(), pointer.texel->coords.begin(), pointer.texel->coords.end());
        if (image.hasSample) operands.push_back(pointer.texel->sample);
        operands.insert(operands.end(), values.begin(), values.end());
        return emitImage(image, type, operands);
    }
    const uint64_t operation = static_cast<uint64_t>(op) << 32;
    if (pointer.base == Pointer::Base::address) {
        operands = {place(pointer, 0)};
        operands.insert(operands.end(), values.begin(), values.end());
        return emitter_.emit(ir::Op::atomicAddress, type, operands, operation);
    }
    if (pointer.base != Pointer::Base::buffer) refuseId(pointer.root, "is not memory that atomics work on");
    operands = {descriptorOf(pointer), place(pointer, 0)};
    operands.insert(operands.end(), values.begin(), values.end());
    return emitter_.emit(ir::Op::atomicBuffer, type, operands, resourceOrAny(pointer) | operation);
}

bool Lowering::lowerAtomic(const Instruction& inst) {
    struct Entry {
        spv::Op spirv;
        ir::AtomicOp op;
    };
    static constexpr Entry kBinary[] = {
        {spv::Op::OpAtomicExchange, ir::AtomicOp::exchange},
        {spv::Op::OpAtomicIAdd, ir::AtomicOp::add},
        {spv::Op::OpAtomicISub, ir::AtomicOp::sub},
        {spv::Op::OpAtomicSMin, ir::AtomicOp::smin},
        {spv::Op::OpAtomicUMin, ir::AtomicOp::umin},
        {spv::Op::OpAtomicSMax, ir::AtomicOp::smax},
        {spv::Op::OpAtomicUMax, ir::AtomicOp::umax},
        {spv::Op::OpAtomicAnd, ir::AtomicOp::iand},
        {spv::Op::OpAtomicOr, ir::AtomicOp::ior},
        {spv::Op::OpAtomicXor, ir::AtomicOp::ixor},
        {spv::Op::OpAtomicFAddEXT, ir::AtomicOp::fadd},
        {spv::Op::OpAtomicFMinEXT, ir::AtomicOp::fmin},
        {spv::Op::OpAtomicFMaxEXT, ir::AtomicOp::fmax},
    };
    const auto run = [&](uint32_t pointerId, ir::AtomicOp op, std::initializer_list<ir::ValueId> values) {
        const Pointer& pointer = pointerOf(pointerId);
        const LeafType type = scalarType(pointer.type);
        if (type.bits < 32 || typeInfo(pointer.type).leaves != 1)
            refuse(inst, "only atomics of 32 and 64 bits are supported");
        if (type.bits != 32 && pointer.base == Pointer::Base::texel)
            refuse(inst, "images have atomics of 32 bits only");
        // Exchanges, loads and stores of floats move bits, as integers of their width.
        const bool moves = ir::isFloat(type) && !ir::isFloatAtomic(op);
        const ir::Type word = !moves ? type.type : type.bits == 64 ? ir::Type::i64 : ir::Type::i32;
        std::vector<ir::ValueId> words;
        for (const ir::ValueId value : values) words.push_back(moves ? convert(ir::Op::bitcast, word, value) : value);
        const ir::ValueId result = atomic(pointer, op, word, words);
        return moves ? convert(ir::Op::bitcast, type, result) : result;
    };
    const auto one = [&](uint32_t pointerId) { return emitter_.constant(scalarType(pointerOf(pointerId).type), 1); };
    for (const Entry& entry : kBinary) {
        if (entry.spirv != inst.op) continue;
        setScalar(inst[2], inst[1], run(inst[3], entry.op, {scalarOf(inst[6])}));
        return true;
    }
    switch (inst.op) {
        case spv::Op::OpAtomicLoad:
            setScalar(inst[2], inst[1], run(inst[3], ir::AtomicOp::load, {}));
            return true;
        case spv::Op::OpAtomicStore:
            run(inst[1], ir::AtomicOp::store, {scalarOf(inst[4])});
            return true;
        case spv::Op::OpAtomicIIncrement:
            setScalar(inst[2], inst[1], run(inst[3], ir::AtomicOp::add, {one(inst[3])}));
            return true;
        case spv::Op::OpAtomicIDecrement:
            setScalar(inst[2], inst[1], run(inst[3], ir::AtomicOp::sub, {one(inst[3])}));
            return true;
        case spv::Op::OpAtomicCompareExchange:
            setScalar(inst[2], inst[1],
                      run(inst[3], ir::AtomicOp::compareExchange, {scalarOf(inst[7]), scalarOf(inst[8])}));
            return true;
        default:
            return false;
    }
}

}  // namespace vernier
