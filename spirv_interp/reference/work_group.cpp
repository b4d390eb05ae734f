#include "spirv_interp/reference/work_group.h"

#include "spirv_interp/reference/drive.h"

namespace vernier::reference {
namespace {

constexpr uint64_t kMaxInvocations = 1024;

constexpr uint32_t kMaxPatchVertices = 32;

template <class Number>
using Machines = std::vector<std::optional<Machine<Number>>>;

template <class Number>
void set(InterfaceValues<Number>& values, spv::BuiltIn builtin, std::initializer_list<uint32_t> words) {
    auto& scalars = values.builtins[builtin];
    scalars.clear();
    for (const uint32_t word : words) scalars.push_back(Scalar<Number>::ofBits(word));
}

/// The built-in inputs that tell an invocation its place in a subgroup.
template <class Number>
void setSubgroup(InterfaceValues<Number>& values, uint32_t index, uint32_t invocations) {
    const uint32_t lane = index % kSubgroupSize;
    set(values, spv::BuiltInSubgroupSize, {kSubgroupSize});
    set(values, spv::BuiltInNumSubgroups, {(invocations + kSubgroupSize - 1) / kSubgroupSize});
    set(values, spv::BuiltInSubgroupId, {index / kSubgroupSize});
    set(values, spv::BuiltInSubgroupLocalInvocationId, {lane});
    const uint32_t equal = 1u << lane, less = equal - 1;
    // Bits beyond the subgroup's size are 0; it is a whole 32 even when not all of it is there.
    set(values, spv::BuiltInSubgroupEqMask, {equal, 0, 0, 0});
    set(values, spv::BuiltInSubgroupLtMask, {less, 0, 0, 0});
    set(values, spv::BuiltInSubgroupLeMask, {less | equal, 0, 0, 0});
    set(values, spv::BuiltInSubgroupGeMask, {~less, 0, 0, 0});
    set(values, spv::BuiltInSubgroupGtMask, {~(less | equal), 0, 0, 0});
}

/// The built-in inputs of one invocation (Vulkan specification, "Built-In Variables").
template <class Number>
InterfaceValues<Number> builtins(const WorkGroup& group, const std::array<uint32_t, 3>& size, uint32_t index,
                                 uint32_t invocations) {
    InterfaceValues<Number> values;
    const std::array<uint32_t, 3> local{index % size[0], index / size[0] % size[1], index / (size[0] * size[1])};
    set(values, spv::BuiltInWorkgroupId, {group.id[0], group.id[1], group.id[2]});
    set(values, spv::BuiltInNumWorkgroups, {group.count[0], group.count[1], group.count[2]});
    set(values, spv::BuiltInWorkgroupSize, {size[0], size[1], size[2]});
    set(values, spv::BuiltInLocalInvocationId, {local[0], local[1], local[2]});
    set(values, spv::BuiltInGlobalInvocationId,
        {group.id[0] * size[0] + local[0], group.id[1] * size[1] + local[1], group.id[2] * size[2] + local[2]});
    set(values, spv::BuiltInLocalInvocationIndex, {index});
    setSubgroup(values, index, invocations);
    return values;
}

/// Until all are done, from barrier to barrier.
template <class Number>
void driveSubgroups(std::vector<Machines<Number>>& subgroups) {
    while (true) {
        bool done = true;
        for (Machines<Number>& machines : subgroups) done = drive(machines) && done;
        if (done) return;
        std::optional<std::vector<uint64_t>> barrier;
        for (Machines<Number>& machines : subgroups) {
            for (auto& machine : machines) {
                if (!machine || machine->run() == Machine<Number>::Status::done) continue;
                if (barrier && *barrier != machine->position()) fail("a barrier in control flow that is not uniform");
                barrier = machine->position();
            }
        }
        for (Machines<Number>& machines : subgroups)
            for (auto& machine : machines)
                if (machine && machine->run() == Machine<Number>::Status::waiting) machine->resume({});
    }
}

}  // namespace

std::array<uint32_t, 3> workGroupSize(const ModuleData& module, size_t entryPoint) {
    for (const auto& [id, decorations] : module.decorations) {
        if (decorations.builtin != static_cast<uint32_t>(spv::BuiltInWorkgroupSize)) continue;
        if (id >= module.ids.size() || module.ids[id].kind != IdKind::constant) continue;
        const Constant& constant = module.constant(id);
        if (constant.scalars.size() != 3) fail("WorkgroupSize is no vector of three");
        std::array<uint32_t, 3> size{};
        for (size_t k = 0; k < 3; ++k) size[k] = static_cast<uint32_t>(constant.scalars[k].bits);
        return size;
    }
    return module.entryPoints[entryPoint].modes.localSize;
}

template <class Number>
void runWorkGroup(const Program<Number>& program, const WorkGroup& group, Resources<Number>& resources) {
    const std::array<uint32_t, 3> size = workGroupSize(*program.module, program.entryPoint);
    const uint64_t invocations = uint64_t{size[0]} * size[1] * size[2];
    if (invocations == 0 || size[0] > kMaxInvocations || size[1] > kMaxInvocations || invocations > kMaxInvocations)
        failUnsupported("a work-group of " + std::to_string(invocations) + " invocations");
    const auto count = static_cast<uint32_t>(invocations);
    SharedObjects<Number> shared;
    std::vector<Machines<Number>> subgroups((count + kSubgroupSize - 1) / kSubgroupSize);
    for (uint32_t k = 0; k < count; ++k) {
        Machines<Number>& machines = subgroups[k / kSubgroupSize];
        if (machines.empty()) machines.resize(kSubgroupSize);
        machines[k % kSubgroupSize].emplace(program, builtins<Number>(group, size, k, count), resources,
                                            k % kSubgroupSize, false, &shared);
    }
    driveSubgroups(subgroups);
}

template <class Number>
InterfaceValues<Number> runPatch(const Program<Number>& program, const InterfaceValues<Number>& inputs,
                                 Resources<Number>& resources) {
    const EntryPoint& entry = program.module->entryPoints[program.entryPoint];
    if (entry.model != spv::ExecutionModelTessellationControl) fail("a patch goes to a tessellation control shader");
    const uint32_t count = entry.modes.outputVertices;
    if (count == 0 || count > kMaxPatchVertices)
        failUnsupported("a patch of " + std::to_string(count) + " output vertices");
    SharedObjects<Number> shared;
    std::vector<Machines<Number>> subgroups(1);
    for (uint32_t k = 0; k < count; ++k) {
        InterfaceValues<Number> values = inputs;
        set(values, spv::BuiltInInvocationId, {k});
        setSubgroup(values, k, count);
        subgroups[0].emplace_back().emplace(program, values, resources, k, false, &shared);
    }
    subgroups[0].resize(kSubgroupSize);
    driveSubgroups(subgroups);
    return subgroups[0][0]->outcome().outputs;
}

template <class Number>
std::vector<Outcome<Number>> runSubgroup(const Program<Number>& program,
                                         std::span<const std::optional<InterfaceValues<Number>>> inputs,
                                         const std::vector<bool>& helper, Resources<Number>& resources) {
    if (inputs.size() > kSubgroupSize) fail("more invocations than a subgroup has");
    Machines<Number> machines(kSubgroupSize);
    for (uint32_t k = 0; k < inputs.size(); ++k) {
        if (!inputs[k]) continue;
        InterfaceValues<Number> values = *inputs[k];
        setSubgroup(values, k, kSubgroupSize);
        machines[k].emplace(program, values, resources, k, helper[k]);
    }
    driveAlone(machines);
    std::vector<Outcome<Number>> outcomes(inputs.size());
    for (size_t k = 0; k < inputs.size(); ++k)
        if (machines[k]) outcomes[k] = machines[k]->outcome();
    return outcomes;
}

#define VERNIER_INSTANTIATE(Number)                                                                            \
    template void runWorkGroup(const Program<Number>&, const WorkGroup&, Resources<Number>&);                  \
    template InterfaceValues<Number> runPatch(const Program<Number>&, const InterfaceValues<Number>&,          \
                                              Resources<Number>&);                                             \
    template std::vector<Outcome<Number>> runSubgroup(const Program<Number>&,                                  \
                                                      std::span<const std::optional<InterfaceValues<Number>>>, \
                                                      const std::vector<bool>&, Resources<Number>&);
VERNIER_INSTANTIATE(float)
VERNIER_INSTANTIATE(double)
VERNIER_INSTANTIATE(Real)

}  // namespace vernier::reference
