// Lets a group of invocations run together: a quad or a subgroup.
#pragma once

#include <vector>

#include "spirv_interp/reference/machine.h"

namespace vernier::reference {

/// Lets the invocations of a group run until all are done or wait at a barrier; empty places take no part. Each runs
/// until it waits; then those go on that wait at the earliest place, with each other's values: all that can come to a
/// place have come when it is the earliest, so that invocations reconverge as soon as structured control flow lets
/// them. Throws Failure. True when all are done.
template <class Number>
bool drive(std::vector<std::optional<Machine<Number>>>& machines) {
    using Status = typename Machine<Number>::Status;
    while (true) {
        std::optional<std::vector<uint64_t>> earliest;
        std::vector<bool> waiting(machines.size());
        bool done = true;
        for (size_t k = 0; k < machines.size(); ++k) {
            if (!machines[k] || machines[k]->run() != Status::waiting) continue;
            done = false;
            if (machines[k]->meeting() == Meeting::barrier) continue;
            waiting[k] = true;
            if (!earliest || machines[k]->position() < *earliest) earliest = machines[k]->position();
        }
        if (!earliest) return done;
        typename Machine<Number>::GroupValues values(machines.size());
        for (size_t k = 0; k < machines.size(); ++k) {
            waiting[k] = waiting[k] && machines[k]->position() == *earliest;
            if (waiting[k]) values[k] = machines[k]->offer();
        }
        for (size_t k = 0; k < machines.size(); ++k)
            if (waiting[k]) machines[k]->resume(values);
    }
}

/// Of invocations outside of a work-group, which have no barrier to wait at. Throws Failure.
template <class Number>
void driveAlone(std::vector<std::optional<Machine<Number>>>& machines) {
    if (!drive(machines)) fail("OpControlBarrier outside a compute or tessellation control shader");
}

}  // namespace vernier::reference
