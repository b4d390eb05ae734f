// Machines in subgroups: those of a work-group, or of tessellation control for a patch, which meet at barriers, and
// those of other stages.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "spirv_interp/reference/machine.h"

namespace vernier::reference {

/// The constant decorated WorkgroupSize, or else the entry point's LocalSize.
std::array<uint32_t, 3> workGroupSize(const ModuleData& module, size_t entryPoint);

/// Throws Failure.
template <class Number>
InterfaceValues<Number> runPatch(const Program<Number>& program, const InterfaceValues<Number>& inputs,
                                 Resources<Number>& resources);

/// Throws Failure.
template <class Number>
std::vector<Outcome<Number>> runSubgroup(const Program<Number>& program,
                                         std::span<const std::optional<InterfaceValues<Number>>> inputs,
                                         const std::vector<bool>& helper, Resources<Number>& resources);

/// Throws Failure.
template <class Number>
void runWorkGroup(const Program<Number>& program, const WorkGroup& group, Resources<Number>& resources);

}  // namespace vernier::reference
