#include "spirv_interp/ir/ops.h"

namespace vernier::ir {
namespace {

constexpr char P = 'P', S = 'S', R = 'R', X = 'X', T = 'T';

constexpr OpInfo kOps[] = {
#define VERNIER_IR_OP(name, operands, results, flags) {#name, operands, results, flags},
#include "spirv_interp/ir/ops.def"
#undef VERNIER_IR_OP
};

constexpr std::string_view kTypeNames[] = {"none", "b1", "i32", "f32", "i64", "f64"};

constexpr uint32_t bit(Type type) {
    return 1u << static_cast<uint32_t>(type);
}
constexpr uint32_t kInts = bit(Type::i32) | bit(Type::i64);
constexpr uint32_t kFloats = bit(Type::f32) | bit(Type::f64);
constexpr uint32_t kWords = bit(Type::i32) | bit(Type::f32);
constexpr uint32_t kWide = bit(Type::i64) | bit(Type::f64);
constexpr uint32_t kAll = bit(Type::b1) | kInts | kFloats;

constexpr bool between(Op op, Op first, Op last) {
    return op >= first && op <= last;
}

uint32_t immTypeBit(const Inst& inst) {
    return inst.imm >= 1 && inst.imm <= static_cast<uint64_t>(Type::f64) ? 1u << inst.imm : 0;
}

uint32_t imageOperandTypes(const ImageOp& op, uint32_t index) {
    const ImageOperands at = imageOperands(op);
    if (index >= at.count) return 0;
    const bool integerCoords = op.kind == ImageKind::fetch || op.kind == ImageKind::read ||
                               op.kind == ImageKind::store || op.kind == ImageKind::atomic;
    if (index == at.image || index == at.sampler || index == at.sample) return bit(Type::i32);
    if (at.coords != kNoIndex && index >= at.coords && index < at.coords + op.coords) {
        return integerCoords ? bit(Type::i32) : bit(Type::f32);
    }
    if (index == at.dref || index == at.minLod) return bit(Type::f32);
    if (index == at.lodOrBias) {
        return op.kind == ImageKind::fetch || op.kind == ImageKind::querySize ? bit(Type::i32) : bit(Type::f32);
    }
    if (at.gradients != kNoIndex && index >= at.gradients && index < at.gradients + op.gradients) return bit(Type::f32);
    if (at.offsets != kNoIndex && index >= at.offsets && index < at.offsets + op.offsets) return bit(Type::i32);
    return kWords;
}

}  // namespace

const OpInfo& opInfo(Op op) {
    return kOps[static_cast<size_t>(op)];
}

std::string_view typeName(Type type) {
    return kTypeNames[static_cast<size_t>(type)];
}

std::optional<Type> typeFromName(std::string_view name) {
    for (size_t i = 0; i < std::size(kTypeNames); ++i) {
        if (kTypeNames[i] == name) return static_cast<Type>(i);
    }
    return std::nullopt;
}

std::optional<Op> opFromName(std::string_view name) {
    for (size_t i = 0; i < std::size(kOps); ++i) {
        if (kOps[i].name == name) return static_cast<Op>(i);
    }
    return std::nullopt;
}

ImmKind immKind(Op op) {
    if (between(op, Op::foeq, Op::ule) || between(op, Op::ftos, Op::bitcast)) return ImmKind::type;
    switch (op) {
        case Op::constant:
            return ImmKind::bits;
        case Op::ffrexpExponent:
            return ImmKind::type;
        case Op::input:
        case Op::interpolateAtCentroid:
        case Op::interpolateAtSample:
        case Op::interpolateAtOffset:
            return ImmKind::input;
        case Op::storeOutput:
        case Op::storeVertex:
            return ImmKind::output;
        case Op::loadBuffer:
        case Op::storeBuffer:
        case Op::bufferSize:
            return ImmKind::resource;
        case Op::image:
        case Op::imageStore:
            return ImmKind::imageOp;
        case Op::inputIndexed:
        case Op::atomicBuffer:
        case Op::loadLocal:
        case Op::storeLocal:
        case Op::loadAddress:
        case Op::storeAddress:
        case Op::atomicAddress:
        case Op::subgroupReduce:
            return ImmKind::pair;
        default:
            return ImmKind::none;
    }
}

ImageOperands imageOperands(const ImageOp& op) {
    ImageOperands at;
    uint32_t next = 1;
    const auto take = [&next](uint32_t count) {
        const uint32_t first = count != 0 ? next : kNoIndex;
        next += count;
        return first;
    };
    at.sampler = take(op.samplerResource != kNoIndex && op.samplerResource != op.imageResource ? 1 : 0);
    at.coords = take(op.coords);
    at.dref = take(op.depthCompare ? 1 : 0);
    at.lodOrBias = take(op.hasBias || op.hasLod ? 1 : 0);
    at.gradients = take(op.gradients);
    at.offsets = take(op.offsets);
    at.sample = take(op.hasSample ? 1 : 0);
    at.minLod = take(op.hasMinLod ? 1 : 0);
    uint32_t values = 0;
    if (op.kind == ImageKind::store) values = 4;
    if (op.kind == ImageKind::atomic) {
        values = op.atomicOp == AtomicOp::compareExchange ? 2 : op.atomicOp == AtomicOp::load ? 0 : 1;
    }
    at.values = take(values);
    at.count = next;
    return at;
}

uint32_t operandCountOf(const Program& program, const Inst& inst) {
    switch (inst.op) {
        case Op::phi:
            return kNoIndex;
        case Op::image:
        case Op::imageStore:
            return inst.imm < program.imageOps.size() ? imageOperands(program.imageOps[inst.imm]).count : kNoIndex;
        case Op::atomicBuffer:
        case Op::atomicAddress: {
            const auto op = static_cast<AtomicOp>(immHigh(inst));
            const uint32_t place = inst.op == Op::atomicBuffer ? 2 : 1;
            return place + (op == AtomicOp::compareExchange ? 2 : op == AtomicOp::load ? 0 : 1);
        }
        default:
            return opInfo(inst.op).operands;
    }
}

uint32_t operandTypes(const Program& program, const Inst& inst, uint32_t index) {
    if (immKind(inst.op) == ImmKind::type) return immTypeBit(inst);
    switch (inst.op) {
        case Op::inputIndexed:
        case Op::loadBuffer:
        case Op::bufferSize:
        case Op::loadLocal:
        case Op::switchOn:
        case Op::makeWide:
        case Op::unpackHalfLow:
        case Op::unpackHalfHigh:
        case Op::interpolateAtSample:
            return bit(Type::i32);
        case Op::subgroupBallot:
            return bit(Type::b1);
        case Op::subgroupShuffle:
        case Op::quadShuffle:
            return index == 1 ? bit(Type::i32) : bit(inst.type);
        case Op::storeBuffer:
            return index < 2 ? bit(Type::i32) : immHigh(inst) != 0 ? bit(Type::i32) : kWords;
        case Op::loadAddress:
            return bit(Type::i64);
        case Op::storeAddress:
            if (index < 1) return bit(Type::i64);
            return immLow(inst) == 8 ? kWide : immLow(inst) == 4 ? kWords : bit(Type::i32);
        case Op::storeLocal:
            return index < 1 ? bit(Type::i32) : kWords;
        case Op::atomicBuffer:
            return index < 2 ? bit(Type::i32) : bit(inst.type);
        case Op::atomicAddress:
            return index < 1 ? bit(Type::i64) : bit(inst.type);
        case Op::packHalf:
        case Op::interpolateAtOffset:
            return bit(Type::f32);
        case Op::lowWord:
        case Op::highWord:
            return kWide;
        case Op::branch:
            return bit(Type::b1);
        case Op::select:
            return index == 0 ? bit(Type::b1) : bit(inst.type);
        case Op::fldexp:
            return index == 1 ? bit(Type::i32) : bit(inst.type);
        case Op::bitFieldInsert:
            return index >= 2 ? bit(Type::i32) : bit(inst.type);
        case Op::bitFieldSExtract:
        case Op::bitFieldUExtract:
            return index >= 1 ? bit(Type::i32) : bit(inst.type);
        case Op::storeVertex:
            if (index == 0) return bit(Type::i32);
            [[fallthrough]];
        case Op::storeOutput:
            return inst.imm < program.outputs.size() ? bit(program.outputs[inst.imm].type) : 0;
        case Op::image:
        case Op::imageStore:
            return inst.imm < program.imageOps.size() ? imageOperandTypes(program.imageOps[inst.imm], index) : 0;
        default:
            return bit(inst.type);
    }
}

uint32_t resultTypes(Op op) {
    if (opInfo(op).results == 0) return bit(Type::none);
    if (between(op, Op::fadd, Op::ffrexpMantissa)) return kFloats;
    if (between(op, Op::iadd, Op::subBorrow)) return kInts;
    if (between(op, Op::foeq, Op::bnot)) return bit(Type::b1);
    switch (op) {
        case Op::constant:
        case Op::undef:
        case Op::phi:
        case Op::copy:
        case Op::select:
            return kAll;
        case Op::input:
        case Op::inputIndexed:
            return kWords | bit(Type::b1);
        case Op::ffrexpExponent:
        case Op::lowWord:
        case Op::highWord:
        case Op::packHalf:
        case Op::bufferSize:
        case Op::itrunc:
        case Op::subgroupInvocation:
        case Op::subgroupBallot:
            return bit(Type::i32);
        case Op::ftos:
        case Op::ftou:
        case Op::zext:
        case Op::sext:
            return kInts;
        case Op::stof:
        case Op::utof:
        case Op::ftof:
        case Op::ddxFine:
        case Op::ddyFine:
        case Op::ddxCoarse:
        case Op::ddyCoarse:
            return kFloats;
        case Op::bitcast:
            return kInts | kFloats;
        case Op::makeWide:
            return kWide;
        case Op::readClock:
            return bit(Type::i64);
        case Op::ftoh:
        case Op::ftohZero:
        case Op::unpackHalfLow:
        case Op::unpackHalfHigh:
        case Op::quantizeF16:
        case Op::interpolateAtCentroid:
        case Op::interpolateAtSample:
        case Op::interpolateAtOffset:
            return bit(Type::f32);
        case Op::isHelper:
            return bit(Type::b1);
        case Op::atomicBuffer:
        case Op::atomicAddress:
            return kInts | kFloats;
        case Op::subgroupReduce:
            return kAll;
        case Op::loadAddress:
            return kWords | kWide;
        default:
            return kWords;
    }
}

bool hasSideEffect(const Program& program, const Inst& inst) {
    const char kind = opInfo(inst.op).kind;
    if (kind == 'S' || kind == 'T') return true;
    return inst.op == Op::image && program.imageOps[inst.imm].kind == ImageKind::atomic;
}

bool isMovable(const Program& program, const Inst& inst) {
    if (opInfo(inst.op).kind == 'P') return inst.op != Op::phi;
    if (inst.op == Op::bufferSize) return true;
    return inst.op == Op::loadBuffer && resourceOf(inst) != kNoIndex && program.resources[resourceOf(inst)].readOnly;
}

}  // namespace vernier::ir
