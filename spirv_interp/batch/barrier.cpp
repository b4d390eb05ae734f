// Barriers. A batch runs its lanes in step, so a control barrier only has to wait for the other batches of the
// work-group: the run ends there, and whoever runs the work-group (work_group.cpp) takes it up again.
#include <atomic>

#include "spirv_interp/batch/handlers.h"

namespace vernier::batch {

/// Between threads only storage buffers and images are shared; their stores are relaxed atomics.
const Inst* memoryBarrier(Frame&, const Inst* inst) {
    std::atomic_thread_fence(std::memory_order_acq_rel);
    return inst + 1;
}

const Inst* controlBarrier(Frame& frame, const Inst* inst) {
    const Inst* next = memoryBarrier(frame, inst);
    if (!frame.suspends) return next;
    frame.resume = next;
    return nullptr;
}

}  // namespace vernier::batch
