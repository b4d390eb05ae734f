// Instructions to machine code.
#include <algorithm>
#include <optional>

#include "spirv_interp/batch/lowerer.h"
#include "spirv_interp/batch/select.h"

namespace vernier::batch {
namespace {

bool isConversion(ir::Op op) {
    return op == ir::Op::ftof || op == ir::Op::zext || op == ir::Op::sext || op == ir::Op::itrunc;
}

}  // namespace

void Lowerer::lowerElement(const ir::Inst& inst, Op op) {
    const auto operands = program_.operandsOf(inst);
    std::vector<Operand> from;
    if (isVectorOp(op)) {
        for (const ir::ValueId value : operands) from.push_back(operandOf(value));
        emitVector(op, target(inst), std::move(from));
        return;
    }
    for (const ir::ValueId value : operands) from.push_back(rowOf(value));
    from.insert(from.begin(), target(inst));
    // A 64-bit row pair may overlap another one shifted by a row: such operations never work in place.
    emit(op, std::move(from)).inPlace = !isWideOp(op);
}

/// From scalars to a scalar.
void Lowerer::lowerScalar(const ir::Inst& inst) {
    const auto operands = program_.operandsOf(inst);
    if (inst.op == ir::Op::phi) return;
    if (inst.op == ir::Op::copy || inst.op == ir::Op::bitcast) {
        uint32_t& index = scalarIndex_[inst.result];
        const uint32_t from = scalarOf(operands[0]);
        if (index == kNone) {
            index = from;
        } else {
            emit(Op::moveScalar, {Operand::writeScalar(index), Operand::scalar(from)});
        }
        return;
    }
    std::vector<Operand> all{Operand::writeScalar(scalarOf(inst.result))};
    for (const ir::ValueId value : operands) all.push_back(operandOf(value));
    if (inst.op == ir::Op::loadBuffer) {
        all.push_back(Operand::number(ir::resourceOf(inst)));
        emit(Op::loadBuffer, std::move(all)).form = 4;
        return;
    }
    const Op op = inst.op == ir::Op::select ? Op::select : *elementOp(program_, inst);
    emit(op, std::move(all)).form = isVectorOp(op) ? 0 : 1;
}

/// Operations that only move words: copies, halves of wide values, and select and b1 logic on them.
void Lowerer::lowerWords(const ir::Inst& inst) {
    const auto operands = program_.operandsOf(inst);
    const bool wide = ir::isWide(inst.type);
    const bool renames = inst.op != ir::Op::select && isWide(operands[0]) == wide && inst.op != ir::Op::makeWide &&
                         inst.op != ir::Op::lowWord && inst.op != ir::Op::highWord;
    if (renames && !isScalar(operands[0])) {
        registers_[inst.result] = registerOf(operands[0]);
        return;
    }
    const uint32_t to = registerOf(inst.result);
    switch (inst.op) {
        case ir::Op::makeWide:
            emitMove(Operand::write(to, 0), operandOf(operands[0]));
            emitMove(Operand::write(to, 1), operandOf(operands[1]));
            return;
        case ir::Op::lowWord:
            return emitMove(Operand::write(to), wordOf(operands[0], 0));
        case ir::Op::highWord:
            return emitMove(Operand::write(to), wordOf(operands[0], 1));
        case ir::Op::select:
            for (uint8_t word = 0; word <= (wide ? 1 : 0); ++word) {
                emitVector(Op::select, Operand::write(to, word),
                           {operandOf(operands[0]), wordOf(operands[1], word), wordOf(operands[2], word)});
            }
            return;
        default:  // renaming a scalar, itrunc
            for (uint8_t word = 0; word <= (wide ? 1 : 0); ++word) {
                emitMove(Operand::write(to, word), wordOf(operands[0], word));
            }
            return;
    }
}

void Lowerer::lowerStore(const ir::Inst& inst) {
    const auto operands = program_.operandsOf(inst);
    if (const JoinedStores::Group* group = stores_.of(inst)) {
        if (&inst != group->last) return;
        const auto& stores = group->stores;
        std::vector<Operand> all{operandOf(operands[0]), rowOf(program_.operandsOf(*stores[0])[1])};
        for (size_t k = 0; k < JoinedStores::kMost; ++k) {
            all.push_back(rowOf(program_.operandsOf(*stores[std::min(k, stores.size() - 1)])[2]));
        }
        all.push_back(Operand::number(ir::resourceOf(inst)));
        all.push_back(Operand::number(static_cast<uint32_t>(stores.size())));
        emit(Op::storeWords, std::move(all));
        return;
    }
    const Operand descriptor = operandOf(operands[0]), offset = operandOf(operands[1]);
    const Operand value = rowOf(operands[2]);
    const uint32_t bytes = ir::immHigh(inst);
    emit(bytes == 1   ? Op::storeByte
         : bytes == 2 ? Op::storeHalfword
                      : Op::storeBuffer,
         {descriptor, offset, value, Operand::number(ir::resourceOf(inst))})
        .form = static_cast<uint8_t>(descriptor.isScalar() | offset.isScalar() << 1);
}

bool Lowerer::lowerFused(const ir::Inst& inst) {
    const Fusion* fusion = inst.result == ir::kNoValue ? nullptr : fusions_.of(inst.result);
    if (fusion == nullptr) return false;
    std::vector<Operand> operands;
    for (size_t k = 0; k < fusion->operands.size(); ++k) {
        const ir::ValueId value = fusion->operands[k];
        operands.push_back(k > 0 && k <= fusion->rows ? rowOf(value) : operandOf(value));
    }
    if (isVectorOp(fusion->op)) {
        emitVector(fusion->op, target(inst), std::move(operands));
    } else {
        operands.insert(operands.begin(), target(inst));
        emit(fusion->op, std::move(operands));
    }
    return true;
}

void Lowerer::lowerInst(const ir::Inst& inst) {
    line_ = inst.line;
    const auto operands = program_.operandsOf(inst);
    if (inst.result != ir::kNoValue) {
        if (isGiven(inst.result)) return;
        if (isScalar(inst.result) && takesScalars(program_, inst)) return lowerScalar(inst);
        if (fusions_.isInner(inst.result) || stores_.isInner(inst.result)) return;
    }
    if (lowerFused(inst)) return;
    switch (inst.op) {
        case ir::Op::phi:
            return;
        case ir::Op::input: {
            uint32_t& reg = code_.inputs[inst.imm];
            if (reg == kNone) {
                reg = newRegister(false);
                code_.registers[reg].loop = kNone;
            }
            registers_[inst.result] = reg;
            return;
        }
        case ir::Op::inputIndexed:
            return lowerInputIndexed(inst);
        case ir::Op::copy:
        case ir::Op::bitcast:
        case ir::Op::makeWide:
        case ir::Op::lowWord:
        case ir::Op::highWord:
        case ir::Op::itrunc:
        case ir::Op::select:
            return lowerWords(inst);
        case ir::Op::loadBuffer: {
            const Operand descriptor = operandOf(operands[0]), offset = operandOf(operands[1]);
            const uint32_t bytes = ir::immHigh(inst);
            emit(bytes == 1   ? Op::loadByte
                 : bytes == 2 ? Op::loadHalfword
                              : Op::loadBuffer,
                 {target(inst), descriptor, offset, Operand::number(ir::resourceOf(inst))})
                .form = static_cast<uint8_t>(descriptor.isScalar() | offset.isScalar() << 1);
            return;
        }
        case ir::Op::storeBuffer:
            return lowerStore(inst);
        case ir::Op::loadAddress:
            emit(Op::loadAddress, {target(inst), rowOf(operands[0]), Operand::number(ir::immLow(inst))}).inPlace =
                false;
            return;
        case ir::Op::storeAddress: {
            const Operand address = rowOf(operands[0]);
            emit(Op::storeAddress, {address, rowOf(operands[1]), Operand::number(ir::immLow(inst))});
            return;
        }
        case ir::Op::bufferSize: {
            const Operand descriptor = operandOf(operands[0]);
            emit(Op::bufferSize, {target(inst), descriptor, Operand::number(static_cast<uint32_t>(inst.imm))}).form =
                descriptor.isScalar();
            return;
        }
        case ir::Op::atomicBuffer:
        case ir::Op::atomicAddress:
            return lowerAtomic(inst);
        case ir::Op::loadLocal:
        case ir::Op::storeLocal:
            return lowerLocal(inst);
        case ir::Op::image:
        case ir::Op::imageStore:
            return lowerImage(inst);
        case ir::Op::ddxFine:
            emit(Op::ddxFine, {target(inst), rowOf(operands[0])});
            return;
        case ir::Op::ddyFine:
            emit(Op::ddyFine, {target(inst), rowOf(operands[0])});
            return;
        case ir::Op::ddxCoarse:
            emit(Op::ddxCoarse, {target(inst), rowOf(operands[0])});
            return;
        case ir::Op::ddyCoarse:
            emit(Op::ddyCoarse, {target(inst), rowOf(operands[0])});
            return;
        case ir::Op::interpolateAtCentroid:
        case ir::Op::interpolateAtSample:
        case ir::Op::interpolateAtOffset:
            return lowerInterpolation(inst);
        case ir::Op::storeOutput:
            return lowerOutput(inst);
        case ir::Op::demote:
            emit(Op::discard, {});
            return;
        case ir::Op::subgroupInvocation:
        case ir::Op::subgroupBallot:
        case ir::Op::subgroupShuffle:
        case ir::Op::quadShuffle:
        case ir::Op::subgroupReduce:
            return lowerSubgroup(inst);
        case ir::Op::controlBarrier:
            emit(Op::controlBarrier, {});
            return;
        case ir::Op::memoryBarrier:
            emit(Op::memoryBarrier, {});
            return;
        case ir::Op::readClock:
            emit(Op::readClock, {target(inst)});
            return;
        case ir::Op::isHelper:
            emit(Op::helperLanes, {target(inst)});
            return;
        case ir::Op::jump:
        case ir::Op::branch:
        case ir::Op::switchOn:
        case ir::Op::ret:
        case ir::Op::kill:
            return;  // lowerTerminator
        default:
            break;
    }
    if (isConversion(inst.op) && program_.valueTypes[operands[0]] == inst.type) return lowerWords(inst);
    if (const std::optional<Op> op = elementOp(program_, inst)) return lowerElement(inst, *op);
    if (unsupported_.empty()) unsupported_ = ir::opInfo(inst.op).name;
}

void Lowerer::lowerAtomic(const ir::Inst& inst) {
    const auto operands = program_.operandsOf(inst);
    const Operand operation = Operand::number(ir::immHigh(inst));
    const bool wide = ir::isWide(inst.type), buffer = inst.op == ir::Op::atomicBuffer;
    const size_t first = buffer ? 2 : 1;  // of the values
    const Operand place = rowOf(operands[0]), offset = buffer ? rowOf(operands[1]) : place;
    // Operands that the operation does not read name some row, of the right width.
    Operand value = place;
    if (operands.size() > first) {
        value = rowOf(operands[first]);
    } else if (wide) {
        const uint32_t zero = newRegister(true);
        for (uint8_t word = 0; word < 2; ++word) {
            emit(Op::broadcast, {Operand::write(zero, word), Operand::scalar(scalars_.constant(0, false))});
        }
        value = Operand::read(zero);
    }
    const Operand comparator = operands.size() > first + 1 ? rowOf(operands[first + 1]) : value;
    if (buffer) {
        const uint32_t resource = ir::resourceOf(inst);
        const bool shared =
            resource != ir::kNoIndex && program_.resources[resource].kind == ir::ResourceKind::workgroupMemory;
        emit(!wide    ? Op::atomicBuffer
             : shared ? Op::atomicShared64
                      : Op::atomicBuffer64,
             {target(inst), place, offset, Operand::number(resource), operation, value, comparator})
            .inPlace = false;
    } else {
        emit(wide ? Op::atomicAddress64 : Op::atomicAddress, {target(inst), place, operation, value, comparator})
            .inPlace = false;
    }
}

void Lowerer::lowerLocal(const ir::Inst& inst) {
    const auto operands = program_.operandsOf(inst);
    const Operand first = Operand::number(ir::immLow(inst)), words = Operand::number(ir::immHigh(inst));
    const Operand index = operandOf(operands[0]);
    if (inst.op == ir::Op::loadLocal) {
        emit(index.isScalar() ? Op::loadLocalScalar : Op::loadLocal, {target(inst), index, first, words});
    } else {
        const Operand value = rowOf(operands[1]);
        emit(index.isScalar() ? Op::storeLocalScalar : Op::storeLocal, {index, value, first, words});
    }
}

void Lowerer::lowerInputIndexed(const ir::Inst& inst) {
    const uint32_t first = ir::immLow(inst), count = ir::immHigh(inst);
    std::vector<Operand> rows;
    for (uint32_t k = 0; k < count; ++k) {
        uint32_t& reg = code_.inputs[first + k];
        if (reg == kNone) {
            reg = newRegister(false);
            code_.registers[reg].loop = kNone;
        }
        rows.push_back(Operand::read(reg));
    }
    const Operand index = rowOf(program_.operandsOf(inst)[0]);
    MachineInst& out =
        emit(Op::inputIndexed, {target(inst), index, Operand::number(code_.indexedRows), Operand::number(count)});
    out.inPlace = false;
    out.hidden = std::move(rows);
    code_.indexedRows += count;
}

void Lowerer::lowerInterpolation(const ir::Inst& inst) {
    const auto operands = program_.operandsOf(inst);
    const Operand a = operands.empty() ? Operand{} : rowOf(operands[0]);
    const Operand b = operands.size() < 2 ? Operand{} : rowOf(operands[1]);
    const uint32_t where = inst.op == ir::Op::interpolateAtCentroid ? 0
                           : inst.op == ir::Op::interpolateAtSample ? 1
                                                                    : 2;
    emit(Op::interpolate,
         {target(inst), a, b, Operand::number(static_cast<uint32_t>(inst.imm)), Operand::number(where)})
        .inPlace = false;
}

void Lowerer::lowerImage(const ir::Inst& inst) {
    const ir::ImageOp& op = program_.imageOps[inst.imm];
    const ir::ImageOperands places = ir::imageOperands(op);
    const auto operands = program_.operandsOf(inst);
    const auto row = [&](uint32_t place) { return place == ir::kNoIndex ? Operand{} : rowOf(operands[place]); };
    const auto rows = [&](uint32_t place, uint32_t count, uint32_t room, std::vector<Operand>& to) {
        for (uint32_t k = 0; k < room; ++k) {
            to.push_back(place != ir::kNoIndex && k < count ? rowOf(operands[place + k]) : Operand{});
        }
    };
    // The first descriptor needs no row.
    const auto index = [&](uint32_t place) {
        const ir::Inst* constant = place == ir::kNoIndex ? nullptr : facts_.definition[operands[place]];
        return constant != nullptr && constant->op == ir::Op::constant && constant->imm == 0 ? Operand{} : row(place);
    };
    std::vector<Operand> hidden{index(places.image), index(places.sampler)};
    rows(places.coords, op.coords, 4, hidden);
    hidden.push_back(row(places.dref));
    hidden.push_back(row(places.lodOrBias));
    const uint32_t directions = op.gradients / 2u;  // along x, then along y
    rows(places.gradients, directions, 3, hidden);
    const uint32_t ddy = places.gradients == ir::kNoIndex ? ir::kNoIndex : places.gradients + directions;
    rows(ddy, directions, 3, hidden);
    rows(places.offsets, op.offsets, 3, hidden);
    hidden.push_back(row(places.sample));
    hidden.push_back(row(places.minLod));
    const uint32_t values = places.values == ir::kNoIndex ? 0 : static_cast<uint32_t>(operands.size()) - places.values;
    rows(places.values, values, 4, hidden);
    for (uint32_t k = 0; k < 4; ++k) {
        const bool wanted = inst.result != ir::kNoValue && facts_.uses[inst.result + k] != 0;
        hidden.push_back(wanted ? Operand::write(registerOf(inst.result + k)) : Operand{});
    }
    MachineInst& out = emit(Op::image, {Operand::number(static_cast<uint32_t>(code_.imageSites.size()))});
    out.inPlace = false;
    out.hidden = std::move(hidden);
    ImageSite site;
    site.op = static_cast<uint32_t>(inst.imm);
    site.effects = op.kind == ir::ImageKind::store || op.kind == ir::ImageKind::atomic;
    code_.imageSites.push_back(site);
}

void Lowerer::lowerOutput(const ir::Inst& inst) {
    const ir::ValueId value = program_.operandsOf(inst)[0];
    uint32_t& reg = code_.outputs[inst.imm];
    if (outputPlans_[inst.imm].alias && !isScalar(value)) {
        reg = registerOf(value);
        return;
    }
    const Operand to = Operand::write(reg), from = operandOf(value);
    if (full_[block_]) return emitMove(to, from);
    emit(from.isScalar() ? Op::broadcastMasked : Op::copyMasked, {to, from, Operand::mask(kCurrentMask)});
}

}  // namespace vernier::batch
