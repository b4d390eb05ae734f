// What the next draw runs and leaves out, and what was run: explain and statistics.
#include "api/mini/context_guard.h"
#include "runtime/plan/fact.h"
#include "runtime/raster/frame_facts.h"

using namespace vernier;
using namespace vernier::mini;

namespace {

VnResult give(VnContext context, const char* function, std::span<const Fact> facts, int64_t format, char* text,
              size_t capacity, size_t* length) {
    if (VnResult result = checkEnum(context->device, function, "format", format, VN_EXPLAIN_JSON)) return result;
    const size_t full = copyText(format == VN_EXPLAIN_JSON ? factsJson(facts) : factsText(facts), text, capacity);
    if (length) *length = full;
    return VN_SUCCESS;
}

}  // namespace

VnResult vnGetStatistics(VnContext context, VnStatistics* statistics) {
    return guardedContext(context, __func__, [&] {
        if (!statistics) return invalid(context->device, "vnGetStatistics", "statistics is NULL");
        if (VnResult result = finish(context, "vnGetStatistics")) return result;
        const PassStatistics& s = context->statistics;
        *statistics = {.draws = context->draws,
                       .inputVertices = s.inputVertices,
                       .inputPrimitives = s.inputPrimitives,
                       .vertexInvocations = s.vertexInvocations,
                       .controlPatches = s.controlPatches,
                       .evaluationInvocations = s.evaluationInvocations,
                       .geometryInvocations = s.geometryInvocations,
                       .clippedPrimitives = s.clippedPrimitives,
                       .rasterPrimitives = s.rasterPrimitives,
                       .fragmentInvocations = s.fragmentInvocations,
                       .helperInvocations = s.helperInvocations,
                       .samplesPassed = s.samplesPassed,
                       .perspectiveDivides = s.perspectiveDivides,
                       .destinationReads = s.destinationReads,
                       .depthReads = s.depthReads,
                       .plans = context->plans,
                       .dispatches = context->dispatches,
                       .computeInvocations = s.computeInvocations,
                       .fragmentBatches = s.batches,
                       .clearedPixels = s.clearedPixels};
        return VN_SUCCESS;
    });
}

VnResult vnResetStatistics(VnContext context) {
    return guardedContext(context, __func__, [&] {
        if (VnResult result = finish(context, "vnResetStatistics")) return result;
        context->statistics = {};
        context->draws = context->dispatches = context->plans = 0;
        return VN_SUCCESS;
    });
}

VnResult vnExplain(VnContext context, VnExplainFormat format, char* text, size_t capacity, size_t* length) {
    return guardedContext(context, __func__, [&] {
        std::vector<Fact> facts;
        if (!context->inPass && context->computeProgram) {
            facts = context->computeProgram->compute->explain();
        } else {
            if (VnResult result = preparePipeline(context, "vnExplain")) return result;
            facts = context->pipeline->explain(dynamicStateOf(*context));
        }
        return give(context, "vnExplain", facts, enumValue(format), text, capacity, length);
    });
}

VnResult vnExplainFrame(VnContext context, VnExplainFormat format, char* text, size_t capacity, size_t* length) {
    return guardedContext(context, __func__, [&] {
        if (VnResult result = finish(context, "vnExplainFrame")) return result;
        const std::vector<Fact> facts = frameFacts({context->draws, context->dispatches}, context->statistics);
        return give(context, "vnExplainFrame", facts, enumValue(format), text, capacity, length);
    });
}
