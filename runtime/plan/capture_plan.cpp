#include "runtime/plan/capture_plan.h"

#include <algorithm>
#include <tuple>

namespace vernier {

CapturePlan planCapture(const CaptureLayout& layout, const ir::Program& vertex) {
    CapturePlan plan;
    plan.strides = layout.strides;
    for (const CapturedWord& word : layout.words) {
        CapturedOutput output{ir::kNoIndex, word.buffer, word.offset};
        for (uint32_t slot = 0; slot < vertex.outputs.size(); ++slot) {
            const ir::InterfaceSlot& found = vertex.outputs[slot];
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
