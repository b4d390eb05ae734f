// A work-group, or the invocations of tessellation control for a patch: machines, in subgroups, that meet at barriers.
#pragma once

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
void runWorkGroup(const Program<Number>& program, const WorkGroup& group, Resources<Number>& resources);

}  // namespace vernier::reference
