// Built-in inputs that are made of others, the size of a work-group, and barriers.
#include <algorithm>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {
namespace {

constexpr uint32_t kFragment = 1u << static_cast<uint32_t>(ir::Stage::fragment);
constexpr uint32_t kCompute = 1u << static_cast<uint32_t>(ir::Stage::compute);
constexpr uint32_t kAllStages = ~0u;

struct ComputedBuiltin {
    spv::BuiltIn builtin;
    uint32_t stages;
};

constexpr ComputedBuiltin kComputed[] = {
    {spv::BuiltIn::HelperInvocation, kFragment},    {spv::BuiltIn::NumWorkgroups, kCompute},
    {spv::BuiltIn::WorkgroupId, kCompute},          {spv::BuiltIn::LocalInvocationId, kCompute},
    {spv::BuiltIn::LocalInvocationIndex, kCompute}, {spv::BuiltIn::GlobalInvocationId, kCompute},
    {spv::BuiltIn::NumSubgroups, kCompute},         {spv::BuiltIn::SubgroupId, kCompute},
    {spv::BuiltIn::SubgroupSize, kAllStages},       {spv::BuiltIn::SubgroupLocalInvocationId, kAllStages},
    {spv::BuiltIn::SubgroupEqMask, kAllStages},     {spv::BuiltIn::SubgroupGeMask, kAllStages},
    {spv::BuiltIn::SubgroupGtMask, kAllStages},     {spv::BuiltIn::SubgroupLeMask, kAllStages},
    {spv::BuiltIn::SubgroupLtMask, kAllStages},     {spv::BuiltIn::DeviceIndex, kAllStages},
};

/// Memory semantics that ask for nothing: no bit of an order and none of a storage class.
bool isRelaxed(uint32_t semantics) {
    const auto order = spv::MemorySemanticsMask::Acquire | spv::MemorySemanticsMask::Release |
                       spv::MemorySemanticsMask::AcquireRelease | spv::MemorySemanticsMask::SequentiallyConsistent;
    return (semantics & static_cast<uint32_t>(order)) == 0;
}

}  // namespace

bool Lowering::isComputedBuiltin(uint32_t variable) const {
    const Decoration* decoration = module_.findDecoration(variable, spv::Decoration::BuiltIn);
    if (decoration == nullptr) return false;
    return std::any_of(std::begin(kComputed), std::end(kComputed), [&](const ComputedBuiltin& entry) {
        return static_cast<uint32_t>(entry.builtin) == decoration->value &&
               (entry.stages >> static_cast<uint32_t>(program_.stage) & 1) != 0;
    });
}

/// Reads one component of an input that the runner of the program gives.
ir::ValueId Lowering::inputSlot(ir::Builtin builtin, uint8_t component, ir::Type type) {
    auto& slots = program_.inputs;
    const auto found = std::find_if(slots.begin(), slots.end(), [&](const ir::InterfaceSlot& slot) {
        return slot.builtin == builtin && slot.component == component;
    });
    const auto index = static_cast<uint64_t>(found - slots.begin());
    if (found == slots.end()) {
        ir::InterfaceSlot& slot = slots.emplace_back();
        slot.builtin = builtin;
        slot.component = component;
        slot.type = type;
    }
    return emitter_.emit(ir::Op::input, type, {}, index);
}

/// In a work-group that is a line, the only coordinate that varies is the index.
ir::ValueId Lowering::localInvocationId(uint8_t component) {
    const auto& size = program_.localSize;
    if (size[component] == 1) return emitter_.constantI32(0);
    const bool line = size[0] * size[1] * size[2] == size[component];
    return line ? inputSlot(ir::Builtin::localInvocationIndex, 0, ir::Type::i32)
                : inputSlot(ir::Builtin::localInvocationId, component, ir::Type::i32);
}

ir::ValueId Lowering::localInvocationIndex() {
    const auto& size = program_.localSize;
    return size[0] * size[1] * size[2] == 1 ? emitter_.constantI32(0)
                                            : inputSlot(ir::Builtin::localInvocationIndex, 0, ir::Type::i32);
}

/// The lanes of a subgroup that stand in some relation to a lane: a word, and three that are 0.
ir::ValueId Lowering::subgroupMask(spv::BuiltIn builtin) {
    switch (builtin) {
        case spv::BuiltIn::SubgroupLtMask:
            return lanesBefore(false);
        case spv::BuiltIn::SubgroupLeMask:
            return lanesBefore(true);
        case spv::BuiltIn::SubgroupGeMask:
            return unary(ir::Op::inot, lanesBefore(false));
        case spv::BuiltIn::SubgroupGtMask:
            return unary(ir::Op::inot, lanesBefore(true));
        default:
            return binary(ir::Op::shl, emitter_.constantI32(1), subgroupInvocation());
    }
}

Lowering::Leaves Lowering::builtinLeaves(spv::BuiltIn builtin) {
    const auto each = [this](uint8_t count, auto&& component) -> Leaves {
        const NewScalars leaves = newLeaves(count);
        for (uint8_t c = 0; c < count; ++c) leaves[c] = component(c);
        return leaves;
    };
    switch (builtin) {
        case spv::BuiltIn::DeviceIndex:  // a device group is one device
            return each(1, [this](uint8_t) { return emitter_.constantI32(0); });
        case spv::BuiltIn::NumWorkgroups:
            return each(3, [this](uint8_t c) { return inputSlot(ir::Builtin::numWorkgroups, c, ir::Type::i32); });
        case spv::BuiltIn::WorkgroupId:
            return each(3, [this](uint8_t c) { return inputSlot(ir::Builtin::workgroupId, c, ir::Type::i32); });
        case spv::BuiltIn::LocalInvocationId:
            return each(3, [this](uint8_t c) { return localInvocationId(c); });
        case spv::BuiltIn::LocalInvocationIndex:
            return each(1, [this](uint8_t) { return localInvocationIndex(); });
        case spv::BuiltIn::GlobalInvocationId:
            // WorkgroupId * WorkgroupSize + LocalInvocationId ("Built-In Variables" in the Vulkan specification).
            return each(3, [this](uint8_t c) {
                const ir::ValueId first = binary(ir::Op::imul, inputSlot(ir::Builtin::workgroupId, c, ir::Type::i32),
                                                 emitter_.constantI32(program_.localSize[c]));
                return binary(ir::Op::iadd, first, localInvocationId(c));
            });
        case spv::BuiltIn::NumSubgroups:
            return each(1, [this](uint8_t) {
                const auto& size = program_.localSize;
                return emitter_.constantI32((size[0] * size[1] * size[2] + ir::kSubgroupSize - 1) / ir::kSubgroupSize);
            });
        case spv::BuiltIn::SubgroupId:
            return each(1, [this](uint8_t) {
                return binary(ir::Op::udiv, localInvocationIndex(), emitter_.constantI32(ir::kSubgroupSize));
            });
        case spv::BuiltIn::SubgroupSize:
            return each(1, [this](uint8_t) { return emitter_.constantI32(ir::kSubgroupSize); });
        case spv::BuiltIn::SubgroupLocalInvocationId:
            return each(1, [this](uint8_t) { return subgroupInvocation(); });
        case spv::BuiltIn::SubgroupEqMask:
        case spv::BuiltIn::SubgroupGeMask:
        case spv::BuiltIn::SubgroupGtMask:
        case spv::BuiltIn::SubgroupLeMask:
        case spv::BuiltIn::SubgroupLtMask:
            return each(
                4, [this, builtin](uint8_t c) { return c == 0 ? subgroupMask(builtin) : emitter_.constantI32(0); });
        default:
            return each(1, [this](uint8_t) { return emitter_.emit(ir::Op::isHelper, ir::Type::b1, {}); });
    }
}

void Lowering::setLocalSize(const Instruction& mode) {
    for (uint32_t c = 0; c < 3; ++c) {
        program_.localSize[c] = mode.op == spv::Op::OpExecutionModeId ? constantIndex(mode[3 + c]) : mode[3 + c];
    }
}

/// The built-in WorkgroupSize goes before the execution modes ("WorkgroupSize" in the Vulkan specification).
void Lowering::checkLocalSize(const EntryPoint& entry) {
    auto& size = program_.localSize;
    if (program_.stage != ir::Stage::compute) {
        size = {1, 1, 1};
        return;
    }
    if (workgroupSizeId_ != 0) {
        const Leaves leaves = leavesOf(workgroupSizeId_);
        for (size_t c = 0; c < 3 && c < leaves.size(); ++c) {
            size[c] = static_cast<uint32_t>(emitter_.constantBits(leaves[c]).value_or(0));
        }
    }
    uint64_t invocations = 1;
    for (const uint32_t count : size) invocations *= std::min(count, ir::kMaxWorkgroupInvocations + 1);
    if (invocations == 0 || invocations > ir::kMaxWorkgroupInvocations) {
        throw LoweringError{unsupported("SPIR-V: entry point '" + entry.name + "': work-groups of " +
                                        std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
                                        std::to_string(size[2]) + " invocations; from 1 to " +
                                        std::to_string(ir::kMaxWorkgroupInvocations) + " are supported")};
    }
}

bool Lowering::lowerBarrier(const Instruction& inst) {
    if (inst.op == spv::Op::OpMemoryBarrier) {
        emitter_.emit(ir::Op::memoryBarrier, ir::Type::none, {});
        return true;
    }
    if (inst.op != spv::Op::OpControlBarrier) return false;
    const auto scope = static_cast<spv::Scope>(constantIndex(inst[1]));
    // The invocations of a patch run in step, too.
    const bool ofPatch = scope == spv::Scope::Workgroup && program_.stage == ir::Stage::control;
    if (scope == spv::Scope::Workgroup && program_.stage == ir::Stage::compute) {
        emitter_.emit(ir::Op::controlBarrier, ir::Type::none, {});
        return true;
    }
    if (!ofPatch && scope != spv::Scope::Subgroup && scope != spv::Scope::Invocation) {
        refuse(inst, "execution scope " + std::to_string(static_cast<uint32_t>(scope)) + " is not supported here");
    }
    // The invocations of a subgroup run in step: only the order of memory is left to ask for.
    if (ofPatch || !isRelaxed(constantIndex(inst[3]))) emitter_.emit(ir::Op::memoryBarrier, ir::Type::none, {});
    return true;
}

/// As one number or as two words (SPV_KHR_shader_clock); all scopes have one clock.
void Lowering::lowerClock(const Instruction& inst) {
    const ir::ValueId now = emitter_.emit(ir::Op::readClock, ir::Type::i64, {});
    if (leafTypes(inst[1]).size() == 1) {
        setScalar(inst[2], inst[1], now);
        return;
    }
    const NewScalars words = newLeaves(2);
    words[0] = emitter_.emit(ir::Op::lowWord, ir::Type::i32, {now});
    words[1] = emitter_.emit(ir::Op::highWord, ir::Type::i32, {now});
    setValue(inst[2], inst[1], words);
}

}  // namespace vernier
