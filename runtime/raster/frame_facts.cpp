#include "runtime/raster/frame_facts.h"

namespace vernier {
namespace {

/// A counter, and what to say when it is 0 and when it is not.
struct Counter {
    uint64_t count;
    const char *what, *unit, *whenRun, *whenLeftOut;
};

Fact factOf(const Counter& counter) {
    Fact fact;
    fact.runs = counter.count != 0;
    fact.what = counter.what;
    if (fact.runs) fact.what += ", " + std::to_string(counter.count) + " " + counter.unit;
    fact.why = fact.runs ? counter.whenRun : counter.whenLeftOut;
    fact.count = counter.count;
    return fact;
}

}  // namespace

std::vector<Fact> frameFacts(const FrameCommands& commands, const PassStatistics& s) {
    std::vector<Fact> facts;
    const auto add = [&](const Counter& counter) { facts.push_back(factOf(counter)); };
    add({commands.draws, "draws", "of them", "they were recorded", "none was recorded"});
    add({commands.dispatches, "dispatches", "of them", "they were recorded", "none was recorded"});
    if (commands.dispatches != 0)
        add({s.computeInvocations, "compute programs", "invocations", "of the dispatches", "they have no work-group"});
    if (commands.draws == 0) return facts;
    add({s.vertexInvocations, "vertex programs", "vertices", "once per vertex in each chunk of primitives",
         "no vertex was drawn"});
    // Of stages that few draws have, nothing is said where they are not there.
    if (s.controlPatches != 0) add({s.controlPatches, "control programs", "patches", "draws have tessellation", ""});
    if (s.evaluationInvocations != 0)
        add({s.evaluationInvocations, "evaluation programs", "invocations", "at points that the tessellator makes",
             ""});
    if (s.geometryInvocations != 0)
        add({s.geometryInvocations, "geometry programs", "invocations", "once per primitive and invocation", ""});
    add({s.clippedPrimitives, "clipping primitives", "of them", "they cross a clip plane",
         "none crosses a clip plane"});
    add({s.rasterPrimitives, "rasterising primitives", "of them", "they are neither culled nor outside",
         "all are culled or outside"});
    add({s.clearedPixels, "clearing attachments", "pixels", "load operations ask for it",
         "no load operation asks for it, or all is drawn over"});
    add({s.coarseDepthRejects, "rejecting whole blocks of 8 x 8 pixels", "blocks",
         "all in them is behind what is there", "no block is known to be hidden"});
    add({s.depthReads, "reading depth and stencil", "samples", "tests need them",
         "no test is on, or bounds of whole blocks decide it"});
    add({s.fragmentInvocations, "fragment programs", "pixels or samples", "what they write is kept",
         "nothing they write is kept, or nothing is covered"});
    add({s.batches, "batches of fragments", "of them", "each has pixels of any primitives and draws of one state",
         "no fragment program runs"});
    add({s.helperInvocations, "helper invocations", "lanes", "neighbours matter where 2x2 pixels are covered in part",
         "no program looks at neighbours, or 2x2 pixels are always covered together"});
    add({s.perspectiveDivides, "perspective division", "pixels", "vertices of a primitive differ in w",
         "no input needs it, or the vertices have equal w"});
    add({s.destinationReads, "reading colours back", "pixels", "blending, logic operations or partial write masks",
         "all colours are replaced"});
    add({s.samplesPassed, "samples that passed all tests", "of them", "they are covered, and no test fails",
         "none is covered, or a test fails for each"});
    return facts;
}

}  // namespace vernier
