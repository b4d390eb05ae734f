#include "runtime/plan/facts.h"

#include <string>

#include "runtime/plan/program_facts.h"
#include "spirv_interp/ir/names.h"

namespace vernier {
namespace {

class FactWriter {
  public:
    explicit FactWriter(Plan& plan) : plan_(plan) {}
    void runs(std::string what, std::string why) { add(true, std::move(what), std::move(why)); }
    void leftOut(std::string what, std::string why) { add(false, std::move(what), std::move(why)); }
    void add(Fact fact) { plan_.facts.push_back(std::move(fact)); }

  private:
    void add(bool runs, std::string what, std::string why) {
        add({.runs = runs, .what = std::move(what), .why = std::move(why), .rates = {}});
    }
    Plan& plan_;
};

std::string count(size_t n, const std::string& thing) {
    return std::to_string(n) + " " + thing + (n == 1 ? "" : "s");
}

const char* domainName(const TessellationModes& modes) {
    if (modes.pointMode) return "points";
    return modes.domain == TessellationDomain::triangles ? "triangles"
           : modes.domain == TessellationDomain::quads   ? "quads"
                                                         : "isolines";
}

const char* spacingName(TessellationSpacing spacing) {
    return spacing == TessellationSpacing::fractionalEven  ? "fractional even spacing"
           : spacing == TessellationSpacing::fractionalOdd ? "fractional odd spacing"
                                                           : "equal spacing";
}

/// Whose vertices the rasteriser gets.
std::string lastProgram(const ShaderProgram& program) {
    return std::string(ir::nameOf(program.lastIr().stage));
}

void geometryFacts(const GraphicsState& state, const ShaderProgram& program, const Plan& plan, FactWriter& facts) {
    const Accuracy& accuracy = program.accuracy();
    facts.runs("vertex program, once per vertex in each chunk of primitives",
               count(plan.attributes.size(), "attribute") + " fetched; " + tierName(accuracy.math) + " maths");
    if (program.stage(ir::Stage::control) != nullptr) {
        facts.runs("control program, " + std::to_string(plan.tessellation.outputVertices) + " times per patch",
                   "patches of " + std::to_string(plan.inputVertices) + " vertices go in");
        facts.runs("tessellator, once per patch, and evaluation program, once per point of it",
                   std::string(domainName(plan.tessellation)) + ", " + spacingName(plan.tessellation.spacing));
    }
    if (const auto geometry = program.stage(ir::Stage::geometry)) {
        const ir::GeometryModes& modes = geometry->source().geometry;
        facts.runs("geometry program, " +
                       (modes.invocations == 1 ? std::string("once") : std::to_string(modes.invocations) + " times") +
                       " per primitive",
                   std::string(ir::nameOf(modes.input)) + " in, " + std::string(ir::nameOf(modes.output)) +
                       " out, at most " + std::to_string(modes.outputVertices) + " vertices each time");
    }
    if (state.rasterizerDiscard) {
        facts.leftOut("everything after the " + lastProgram(program) + " program", "rasterizer discard is on");
        return;
    }
    facts.runs(
        "coverage, exact on a grid of 1/" + std::to_string(1u << accuracy.subPixelBits) + " pixel",
        std::to_string(accuracy.subPixelBits) + " sub-pixel bits; " + count(plan.samples, "sample") + " per pixel");
    if (plan.clipDistanceSlots.empty())
        facts.leftOut("user clip planes", "no clip distance is written");
    else
        facts.runs("clipping to user planes", count(plan.clipDistanceSlots.size(), "clip distance") + " written");
    if (plan.layerSlot != kNoSlot)
        facts.runs("a layer for each primitive", "the " + lastProgram(program) + " program chooses it");
    if (plan.viewportIndexSlot != kNoSlot)
        facts.runs("a viewport for each primitive", "the " + lastProgram(program) + " program chooses it");
    if (plan.smoothLines) facts.runs("the area that a line covers of each pixel, into alpha", "lines are smooth");
    if (!state.depthClipEnable) facts.leftOut("clipping to near and far", "depth clipping is off");
    if (state.cullMode == VK_CULL_MODE_NONE)
        facts.leftOut("culling", "cull mode is none");
    else
        facts.runs("culling", "the cull mode asks for it");
    if (state.depthBiasEnable)
        facts.runs("depth bias", "it is on");
    else
        facts.leftOut("depth bias", "it is off");
}

void depthFacts(const GraphicsState& state, const Plan& plan, FactWriter& facts) {
    const DepthPlan& depth = plan.depth;
    if (!depth.any()) {
        facts.leftOut("depth and stencil tests",
                      state.depthStencilFormat == VK_FORMAT_UNDEFINED ? "there is no depth/stencil attachment"
                      : state.depthTest || state.stencilTest          ? "the tests pass always and write nothing"
                                                                      : "both tests are off");
        return;
    }
    std::string tests;
    for (const auto& [on, name] :
         {std::pair{depth.test, "depth"}, {depth.bounds, "depth bounds"}, {depth.stencil, "stencil"}})
        if (on) tests += (tests.empty() ? "" : ", ") + std::string(name);
    const bool runs = plan.runsFragments;
    facts.runs(tests + " test, once per sample" +
                   (!runs         ? ""
                    : depth.early ? ", before the fragment program"
                                  : ", after the fragment program"),
               !runs         ? "no fragment program runs"
               : depth.early ? "nothing the program does can change the outcome"
                             : "the program may drop fragments, change their depth, or have side effects");
    if (depth.test && !depth.write) facts.leftOut("depth writes", "they are off");
}

/// How often the fragment program runs, and why.
void fragmentRateFacts(const Plan& plan, const Accuracy& accuracy, FactWriter& facts) {
    const bool askedCoarse = accuracy.shading == ShadingRate::twoByTwo;
    facts.runs(std::string("fragment program, once per ") + (plan.coarse      ? "2x2 pixels"
                                                             : plan.perSample ? "sample"
                                                                              : "pixel"),
               plan.coarse        ? "the accuracy asks for it"
               : plan.allAtSample ? "sample shading is on"
               : plan.perSample   ? "it asks for samples"
               : askedCoarse      ? "2x2 is asked for, but it depends on single pixels, or they have several samples"
                                  : "nothing in it varies between samples");
}

/// Why a fragment program runs for whole quads of 2x2 pixels.
const char* quadsReason(const ir::Program& fragment, const Plan& plan) {
    if (!fragment.usesQuads) return "rule helper_invocations is off";
    if (plan.quadsForLevels)
        return "an image's level of detail comes from neighbouring pixels; draws whose images and samplers leave no "
               "choice of levels run none";
    return fragment.usesSubgroups ? "the program looks at neighbouring pixels" : "the program takes derivatives";
}

void fragmentFacts(const ir::Program* fragment, const Plan& plan, const Accuracy& accuracy, FactWriter& facts) {
    if (!plan.runsFragments) {
        facts.leftOut("fragment program", fragment == nullptr ? "there is none" : "it writes nothing that is kept");
        return;
    }
    fragmentRateFacts(plan, accuracy, facts);
    if (accuracy.anisotropy < Accuracy().anisotropy && !fragment->imageOps.empty())
        facts.runs("anisotropic filters with " + count(accuracy.anisotropy, "sample") + " at most",
                   "the accuracy asks for no more");
    if (plan.splitSamples)
        facts.runs("a part of it once per pixel, " + count(plan.carried.size(), "value") + " handed on",
                   "it is the same for all samples");
    if (plan.usesQuads) {
        facts.runs("helper invocations, where 2x2 pixels are covered in part", quadsReason(*fragment, plan));
    } else {
        facts.leftOut("helper invocations", "nothing in the program depends on neighbouring pixels");
    }
    const std::string arithmetic = plan.preciseInterpolation ? "double" : "float";
    if (plan.smoothCount > 0)
        facts.runs("perspective interpolation of " + count(plan.smoothCount, "scalar") + ", in " + arithmetic,
                   "one division per pixel, none where the vertices have equal w");
    if (plan.smoothCount == 0) facts.leftOut("perspective division", "no input is interpolated with perspective");
    if (plan.linearCount > 0)
        facts.runs("linear interpolation of " + count(plan.linearCount, "scalar") + ", in " + arithmetic,
                   "noperspective");
    if (!plan.needsBarycentrics) facts.leftOut("interpolation", "all inputs are flat or built in");
}

/// How often what is computed, in a program of `stage`.
void rateFacts(const std::string& stage, const std::string& item, const BatchProgram& program, FactWriter& facts) {
    const BatchStatistics& statistics = program.statistics();
    if (std::optional<Fact> rates = rateFact(stage, program)) facts.add(*std::move(rates));
    if (statistics.drawRateInstructions > 0)
        facts.runs(
            count(statistics.drawRateInstructions, "instruction") + " of the " + stage + ", once per draw and thread",
            "their values are the same for every " + item);
}

const char* unwrittenReason(const GraphicsState& state, uint32_t attachment) {
    if (state.colorFormats[attachment] == VK_FORMAT_UNDEFINED) return "there is no attachment";
    if (state.blend[attachment].colorWriteMask == 0) return "its write mask is empty";
    return state.logicOpEnable ? "the program does not write it, or the logic operation keeps it"
                               : "the program does not write it";
}

void colorFacts(const GraphicsState& state, const Plan& plan, FactWriter& facts) {
    uint32_t next = 0;
    for (uint32_t n = 0; n < state.colorCount; ++n) {
        const std::string name = "colour " + std::to_string(n);
        if (next == plan.colors.size() || plan.colors[next].attachment != n) {
            facts.leftOut("writes to " + name, unwrittenReason(state, n));
            continue;
        }
        const ColorPlan& color = plan.colors[next++];
        if (color.path == ColorPath::blend)
            facts.runs("blending into " + name + ", in float, rounded once", "blending is on");
        if (color.path == ColorPath::logic) facts.runs("logic operation on " + name, "logic operations are on");
        if (!color.readsDestination)
            facts.leftOut("reading " + name, "no blending, no logic operation, all components written");
        if (color.readsDestination && color.path == ColorPath::store)
            facts.runs("reading " + name, "the write mask keeps some components");
    }
}

}  // namespace

const char* tierName(MathTier tier) {
    switch (tier) {
        case MathTier::fast:
            return "fast";
        case MathTier::standard:
            return "standard";
        case MathTier::fine:
            return "fine";
        default:
            return "reference";
    }
}

void collectFacts(const GraphicsState& state, const ShaderProgram& program, Plan& plan) {
    FactWriter facts(plan);
    for (size_t rule = 0; rule < skipRules().size(); ++rule)
        if (!plan.skips.has(static_cast<Skip>(rule)))
            facts.runs(skipRules()[rule].meaning, std::string("rule ") + skipRules()[rule].name + " is off");
    geometryFacts(state, program, plan, facts);
    for (const StageProgram& stage : program.stages())
        rateFacts(std::string(ir::nameOf(stage.stage)) + " program",
                  stage.stage == ir::Stage::vertex ? "vertex" : "invocation", *stage.program, facts);
    if (program.lifted().flat > 0)
        facts.runs(count(program.lifted().flat, "operation") + " of the fragment program, once per vertex",
                   "they depend on flat inputs alone");
    if (program.lifted().linear > 0)
        facts.runs(count(program.lifted().linear, "operation") + " of the fragment program, once per vertex",
                   "they are linear across a primitive; fast maths allows what interpolation then rounds otherwise");
    if (!program.capture().empty())
        facts.runs("transform feedback of " + count(program.capture().outputs.size(), "word") +
                       " per vertex, in draws between its begin and its end",
                   "the " + lastProgram(program) + " program declares it");
    if (program.removedVaryings() > 0)
        facts.leftOut(count(program.removedVaryings(), "vertex output"), "nobody reads them");
    if (state.rasterizerDiscard) return;
    depthFacts(state, plan, facts);
    fragmentFacts(program.fragmentIr(), plan, program.accuracy(), facts);
    if (plan.splitSamples) rateFacts("pixels' part of the fragment program", "pixel", *program.pixelPart(), facts);
    if (plan.runsFragments)
        rateFacts("fragment program", "fragment", plan.splitSamples ? *program.samplePart() : *program.fragment(),
                  facts);
    colorFacts(state, plan, facts);
}

}  // namespace vernier
