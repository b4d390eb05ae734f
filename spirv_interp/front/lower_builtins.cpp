// Built-in inputs that are made of others, the size of a work-group, and barriers.
#include <algorithm>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {
namespace {

struct ComputedBuiltin {
    spv::BuiltIn builtin;
    ir::Stage stage;
};

constexpr ComputedBuiltin kComputed[] = {
    {spv::BuiltIn::HelperInvocation, ir::Stage::fragment},    {spv::BuiltIn::NumWorkgroups, ir::Stage::compute},
    {spv::BuiltIn::WorkgroupId, ir::Stage::compute},          {spv::BuiltIn::LocalInvocationId, ir::Stage::compute},
    {spv::BuiltIn::LocalInvocationIndex, ir::Stage::compute}, {spv::BuiltIn::GlobalInvocationId, ir::Stage::compute},
    {spv::BuiltIn::DeviceIndex, ir::Stage::vertex},           {spv::BuiltIn::DeviceIndex, ir::Stage::fragment},
    {spv::BuiltIn::DeviceIndex, ir::Stage::compute},
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
        return static_cast<uint32_t>(entry.builtin) == decoration->value && entry.stage == program_.stage;
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

Lowering::Leaves Lowering::builtinLeaves(spv::BuiltIn builtin) {
    const auto each = [this](uint8_t count, auto&& component) -> Leaves {
        const std::span<ir::ValueId> leaves = newLeaves(count);
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
            return each(1, [this](uint8_t) {
                const auto& size = program_.localSize;
                return size[0] * size[1] * size[2] == 1
                           ? emitter_.constantI32(0)
                           : inputSlot(ir::Builtin::localInvocationIndex, 0, ir::Type::i32);
            });
        case spv::BuiltIn::GlobalInvocationId:
            // WorkgroupId * WorkgroupSize + LocalInvocationId ("Built-In Variables" in the Vulkan specification).
            return each(3, [this](uint8_t c) {
                const ir::ValueId first = binary(ir::Op::imul, inputSlot(ir::Builtin::workgroupId, c, ir::Type::i32),
                                                 emitter_.constantI32(program_.localSize[c]));
                return binary(ir::Op::iadd, first, localInvocationId(c));
            });
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
    if (scope == spv::Scope::Workgroup && program_.stage == ir::Stage::compute) {
        emitter_.emit(ir::Op::controlBarrier, ir::Type::none, {});
        return true;
    }
    if (scope != spv::Scope::Subgroup && scope != spv::Scope::Invocation) {
        refuse(inst, "execution scope " + std::to_string(static_cast<uint32_t>(scope)) + " is not supported here");
    }
    // The invocations of a subgroup run in step: only the order of memory is left to ask for.
    if (!isRelaxed(constantIndex(inst[3]))) emitter_.emit(ir::Op::memoryBarrier, ir::Type::none, {});
    return true;
}

}  // namespace vernier
