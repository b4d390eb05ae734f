#include "runtime/plan/capture_plan.h"

#include <algorithm>
#include <tuple>

namespace vernier {

CapturePlan planCapture(const CaptureLayout& layout, const ir::Program& last) {
    CapturePlan plan;
    plan.strides = layout.strides;
    for (const CapturedWord& word : layout.words) {
        CapturedOutput output{ir::kNoIndex, word.buffer, word.offset, word.output.index};
        for (uint32_t slot = 0; slot < last.outputs.size(); ++slot) {
            const ir::InterfaceSlot& found = last.outputs[slot];
            if (found.builtin == word.output.builtin && found.location == word.output.location &&
                found.component == word.output.component)
                output.slot = slot;
        }
        uint32_t& extent = plan.extents[word.buffer];
        extent = std::max(extent, word.offset + 4);
        plan.outputs.push_back(output);
    }
    std::sort(plan.outputs.begin(), plan.outputs.end(), [](const CapturedOutput& a, const CapturedOutput& b) {
        return std::tie(a.buffer, a.offset) < std::tie(b.buffer, b.offset);
    });
    return plan;
}

}  // namespace vernier
