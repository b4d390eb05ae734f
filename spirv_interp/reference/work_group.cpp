#include "spirv_interp/reference/work_group.h"

#include "spirv_interp/reference/drive.h"

namespace vernier::reference {
namespace {

constexpr uint64_t kMaxInvocations = 1024;

/// The built-in inputs of one invocation (Vulkan specification, "Built-In Variables").
template <class Number>
InterfaceValues<Number> builtins(const WorkGroup& group, const std::array<uint32_t, 3>& size, uint32_t index,
                                 uint32_t invocations) {
    InterfaceValues<Number> values;
    const auto set = [&](spv::BuiltIn builtin, std::initializer_list<uint32_t> words) {
        for (const uint32_t word : words) values.builtins[builtin].push_back(Scalar<Number>::ofBits(word));
    };
    const std::array<uint32_t, 3> local{index % size[0], index / size[0] % size[1], index / (size[0] * size[1])};
    set(spv::BuiltInWorkgroupId, {group.id[0], group.id[1], group.id[2]});
    set(spv::BuiltInNumWorkgroups, {group.count[0], group.count[1], group.count[2]});
    set(spv::BuiltInWorkgroupSize, {size[0], size[1], size[2]});
    set(spv::BuiltInLocalInvocationId, {local[0], local[1], local[2]});
    set(spv::BuiltInGlobalInvocationId,
        {group.id[0] * size[0] + local[0], group.id[1] * size[1] + local[1], group.id[2] * size[2] + local[2]});
    set(spv::BuiltInLocalInvocationIndex, {index});
    const uint32_t lane = index % kSubgroupSize;
    set(spv::BuiltInSubgroupSize, {kSubgroupSize});
    set(spv::BuiltInNumSubgroups, {(invocations + kSubgroupSize - 1) / kSubgroupSize});
    set(spv::BuiltInSubgroupId, {index / kSubgroupSize});
    set(spv::BuiltInSubgroupLocalInvocationId, {lane});
    const uint32_t equal = 1u << lane, less = equal - 1;
    // Bits beyond the subgroup's size are 0; it is a whole 32 even when not all of it is there.
    set(spv::BuiltInSubgroupEqMask, {equal, 0, 0, 0});
    set(spv::BuiltInSubgroupLtMask, {less, 0, 0, 0});
    set(spv::BuiltInSubgroupLeMask, {less | equal, 0, 0, 0});
    set(spv::BuiltInSubgroupGeMask, {~less, 0, 0, 0});
    set(spv::BuiltInSubgroupGtMask, {~(less | equal), 0, 0, 0});
    return values;
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
    using Machines = std::vector<std::optional<Machine<Number>>>;
    const std::array<uint32_t, 3> size = workGroupSize(*program.module, program.entryPoint);
    const uint64_t invocations = uint64_t{size[0]} * size[1] * size[2];
    if (invocations == 0 || size[0] > kMaxInvocations || size[1] > kMaxInvocations || invocations > kMaxInvocations)
        failUnsupported("a work-group of " + std::to_string(invocations) + " invocations");
    const auto count = static_cast<uint32_t>(invocations);
    SharedObjects<Number> shared;
    std::vector<Machines> subgroups((count + kSubgroupSize - 1) / kSubgroupSize);
    for (uint32_t k = 0; k < count; ++k) {
        Machines& machines = subgroups[k / kSubgroupSize];
        if (machines.empty()) machines.resize(kSubgroupSize);
        machines[k % kSubgroupSize].emplace(program, builtins<Number>(group, size, k, count), resources,
                                            k % kSubgroupSize, false, &shared);
    }
    while (true) {
        bool done = true;
        for (Machines& machines : subgroups) done = drive(machines) && done;
        if (done) return;
        std::optional<std::vector<uint64_t>> barrier;
        for (Machines& machines : subgroups) {
            for (auto& machine : machines) {
                if (!machine || machine->run() == Machine<Number>::Status::done) continue;
                if (barrier && *barrier != machine->position()) fail("a barrier in control flow that is not uniform");
                barrier = machine->position();
            }
        }
        for (Machines& machines : subgroups)
            for (auto& machine : machines)
                if (machine && machine->run() == Machine<Number>::Status::waiting) machine->resume({});
    }
}

template void runWorkGroup(const Program<float>&, const WorkGroup&, Resources<float>&);
template void runWorkGroup(const Program<double>&, const WorkGroup&, Resources<double>&);
template void runWorkGroup(const Program<Real>&, const WorkGroup&, Resources<Real>&);

}  // namespace vernier::reference
