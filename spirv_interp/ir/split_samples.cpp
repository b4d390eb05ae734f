#include "spirv_interp/ir/split_samples.h"

#include <algorithm>

#include "spirv_interp/ir/cost.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/ir/rates.h"

namespace vernier::ir {
namespace {

constexpr size_t kMostCarried = 64;
// The usual number of samples, and what a carried value costs: stored once, filled in for every sample.
constexpr uint32_t kSamples = 4, kCarryCost = 1 + kSamples;

class Splitter {
  public:
    explicit Splitter(const Program& program) : program_(program), kinds_(program.valueTypes.size(), Kind::sample) {}

    std::optional<SplitProgram> run() {
        classify();
        findCarried();
        if (carried_.empty() || carried_.size() > kMostCarried) return std::nullopt;
        if (saved_ * (kSamples - 1) < kLeastSplit + carried_.size() * kCarryCost) return std::nullopt;
        SplitProgram split{pixelProgram(), sampleProgram(), operations_};
        optimise(split.pixel);
        optimise(split.sample);
        return split;
    }

  private:
    enum class Kind : uint8_t {
        draw,   // of constants and the like: in both programs, where they are wanted
        pixel,  // the same for all samples
        sample,
    };

    static bool isPixelInput(const InterfaceSlot& slot) {
        switch (slot.builtin) {
            case Builtin::user:
            case Builtin::baryCoord:
            case Builtin::baryCoordNoPersp:
                return slot.interpolation == Interpolation::flat || slot.sampling == Sampling::center;
            case Builtin::frontFacing:
            case Builtin::primitiveId:
            case Builtin::layer:
            case Builtin::viewportIndex:
            case Builtin::viewIndex:
                return true;
            default:
                return false;
        }
    }

    /// A read of an image that gives the same whenever it is done, if all lanes of a quad do it.
    bool readsSampledImage(const Inst& inst) const {
        if (inst.op != Op::image) return false;
        const ImageKind kind = program_.imageOps[inst.imm].kind;
        return kind != ImageKind::read && kind != ImageKind::store && kind != ImageKind::atomic;
    }

    Kind kindOf(const Inst& inst, bool allRun) const {
        switch (inst.op) {
            case Op::input:
                return isPixelInput(program_.inputs[inst.imm]) ? Kind::pixel : Kind::sample;
            case Op::interpolateAtCentroid:
            case Op::interpolateAtSample:
            case Op::interpolateAtOffset:
            case Op::inputIndexed:
            case Op::subgroupInvocation:
                return Kind::sample;
            default:
                break;
        }
        const bool derivative = inst.op >= Op::ddxFine && inst.op <= Op::ddyCoarse;
        const bool moves = isMovable(program_, inst) || (allRun && (derivative || readsSampledImage(inst)));
        if (!moves || isWide(inst.type)) return Kind::sample;
        Kind kind = derivative || inst.op == Op::image ? Kind::pixel : Kind::draw;
        for (const ValueId operand : program_.operandsOf(inst)) kind = std::max(kind, kinds_[operand]);
        return kind;
    }

    void classify() {
        bool allRun = true;
        for (size_t b = 0; b < program_.blocks.size(); ++b) {
            for (const Inst& inst : program_.blocks[b].insts) {
                allRun = allRun && b == 0 && inst.op != Op::demote;
                if (inst.result == kNoValue) continue;
                const Kind kind = kindOf(inst, allRun);
                for (uint32_t r = 0; r < opInfo(inst.op).results; ++r) kinds_[inst.result + r] = kind;
                if (kind != Kind::pixel || inst.op == Op::input) continue;
                const uint32_t cost = costOf(program_, inst);
                saved_ += cost < kTooDear ? cost : inst.op == Op::image ? kImageCost : kAccessCost;
                ++operations_;
            }
        }
    }

    bool isPixel(const Inst& inst) const { return inst.result != kNoValue && kinds_[inst.result] == Kind::pixel; }

    /// Values of the pixel that something of the sample uses.
    void findCarried() {
        place_.assign(kinds_.size(), kNoIndex);
        for (const Block& block : program_.blocks) {
            for (const Inst& inst : block.insts) {
                if (isPixel(inst)) continue;
                for (const ValueId operand : program_.operandsOf(inst)) {
                    if (kinds_[operand] != Kind::pixel || place_[operand] != kNoIndex) continue;
                    place_[operand] = static_cast<uint32_t>(carried_.size());
                    carried_.push_back(operand);
                }
            }
        }
    }

    InterfaceSlot slotOf(ValueId value) const {
        InterfaceSlot slot;
        slot.location = static_cast<uint16_t>(kFirstCarried + place_[value] / 4);
        slot.component = static_cast<uint8_t>(place_[value] % 4);
        // Between the programs there are numbers only.
        slot.type = program_.valueTypes[value] == Type::b1 ? Type::i32 : program_.valueTypes[value];
        return slot;
    }

    static Inst withOperands(Program& program, Op op, Type type, std::initializer_list<ValueId> operands,
                             uint64_t imm = 0) {
        Inst inst;
        inst.op = op;
        inst.type = type;
        inst.imm = imm;
        inst.firstOperand = static_cast<uint32_t>(program.operands.size());
        inst.operandCount = static_cast<uint16_t>(operands.size());
        program.operands.insert(program.operands.end(), operands);
        return inst;
    }

    /// Straight through all that moves: it may be done whatever way the lanes would have gone.
    Program pixelProgram() const {
        Program pixel = program_;
        Block straight;
        for (const Block& block : program_.blocks) {
            for (const Inst& inst : block.insts) {
                if (inst.result != kNoValue && kinds_[inst.result] != Kind::sample) straight.insts.push_back(inst);
            }
        }
        pixel.outputs.clear();
        for (const ValueId value : carried_) {
            ValueId stored = value;
            if (program_.valueTypes[value] == Type::b1) {
                Inst widen = withOperands(pixel, Op::zext, Type::i32, {value}, static_cast<uint64_t>(Type::b1));
                stored = widen.result = pixel.newValue(Type::i32);
                straight.insts.push_back(widen);
            }
            straight.insts.push_back(withOperands(pixel, Op::storeOutput, Type::none, {stored}, pixel.outputs.size()));
            pixel.outputs.push_back(slotOf(value));
        }
        straight.insts.emplace_back().op = Op::ret;
        pixel.blocks = {std::move(straight)};
        pixel.earlyFragmentTests = pixel.postDepthCoverage = false;
        return pixel;
    }

    Program sampleProgram() const {
        Program sample = program_;
        const auto firstInput = sample.inputs.size();
        for (const ValueId value : carried_) {
            InterfaceSlot slot = slotOf(value);
            slot.interpolation = Interpolation::flat;
            sample.inputs.push_back(slot);
        }
        for (Block& block : sample.blocks) {
            std::vector<Inst> insts;
            for (const Inst& inst : block.insts) {
                if (!isPixel(inst)) {
                    insts.push_back(inst);
                    continue;
                }
                for (uint32_t r = 0; r < opInfo(inst.op).results; ++r)
                    if (place_[inst.result + r] != kNoIndex) read(sample, insts, inst.result + r, firstInput);
            }
            block.insts = std::move(insts);
        }
        return sample;
    }

    void read(Program& sample, std::vector<Inst>& insts, ValueId value, size_t firstInput) const {
        const uint64_t slot = firstInput + place_[value];
        Inst input = withOperands(sample, Op::input, sample.inputs[slot].type, {}, slot);
        if (program_.valueTypes[value] != Type::b1) {
            input.result = value;
            insts.push_back(input);
            return;
        }
        Inst zero = withOperands(sample, Op::constant, Type::i32, {});
        input.result = sample.newValue(Type::i32);
        zero.result = sample.newValue(Type::i32);
        Inst test =
            withOperands(sample, Op::ine, Type::b1, {input.result, zero.result}, static_cast<uint64_t>(Type::i32));
        test.result = value;
        insts.insert(insts.end(), {input, zero, test});
    }

    const Program& program_;
    std::vector<Kind> kinds_;       // by value
    std::vector<ValueId> carried_;  // in the order of their slots
    std::vector<uint32_t> place_;   // by value: in carried_, or kNoIndex
    uint32_t saved_ = 0, operations_ = 0;
};

}  // namespace

std::optional<SplitProgram> splitSamples(const Program& fragment) {
    if (fragment.stage != Stage::fragment || !fragment.perSample || fragment.usesSubgroups) return std::nullopt;
    return Splitter(fragment).run();
}

}  // namespace vernier::ir
