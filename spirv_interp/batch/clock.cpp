// The clock that programs read: the steady one, in nanoseconds, which is also that of time stamps. The lanes of a batch
// run in step and so read it together.
#include <algorithm>
#include <chrono>

#include "spirv_interp/batch/handlers.h"

namespace vernier::batch {

const Inst* readClock(Frame& frame, const Inst* inst) {
    using namespace std::chrono;
    const auto now = static_cast<uint64_t>(duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count());
    std::fill_n(frame.row<uint32_t>(inst->operand[0]), frame.lanes, static_cast<uint32_t>(now));
    std::fill_n(frame.row<uint32_t>(inst->operand[0] + frame.rowBytes), frame.lanes, static_cast<uint32_t>(now >> 32));
    return inst + 1;
}

}  // namespace vernier::batch
