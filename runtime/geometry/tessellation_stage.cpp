#include "runtime/geometry/tessellation_stage.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace vernier {
namespace {

constexpr uint32_t kMaxLanes = 128;

struct alignas(64) Mask : std::array<uint32_t, kMaxLanes> {
    explicit Mask(uint32_t count) : array{} { std::fill_n(begin(), count, ~0u); }
};

const ResourceBindings& resourcesOf(const PreparedDraw& draw, ir::Stage stage) {
    static const StageResources kNone{};
    const StageResources& resources = draw.call.stageResources == nullptr ? kNone : *draw.call.stageResources;
    return stage == ir::Stage::control ? resources.control : resources.evaluation;
}

/// valueOf(lane) for `count` lanes of an input; nothing where the program does not read it.
template <class ValueOf>
void fillLanes(BatchContext& context, uint32_t slot, uint32_t count, const ValueOf& valueOf) {
    float* plane = context.input(slot);
    if (plane == nullptr) return;
    for (uint32_t lane = 0; lane < count; ++lane) {
        const uint32_t value = valueOf(lane);
        std::memcpy(plane + lane, &value, sizeof value);
    }
}

/// Runs the control program for whole patches, `first` and those behind it, in the lanes of one batch.
bool runControl(const PreparedDraw& draw, const StagePrimitives& in, BatchContext& context, uint32_t first,
                uint32_t patches, uint32_t rowWords) {
    const uint32_t each = draw.plan->tessellation.outputVertices, count = patches * each;
    for (const BuiltinSlot& slot : draw.plan->control.builtins) {
        fillLanes(context, slot.slot, count, [&](uint32_t lane) -> uint32_t {
            switch (slot.builtin) {
                case ir::Builtin::primitiveId:
                    return in.ids[first + lane / each];
                case ir::Builtin::invocationId:
                    return lane % each;
                case ir::Builtin::patchVertices:
                    return in.verticesPerPrimitive;
                case ir::Builtin::viewIndex:
                    return draw.viewIndex;
                case ir::Builtin::stageOffset:
                    return lane / each * rowWords * static_cast<uint32_t>(sizeof(uint32_t));
                default:
                    return 0;
            }
        });
    }
    for (const StageInput& input : draw.plan->control.inputs) {
        const bool missing = input.from == kNoSlot || input.vertex >= in.verticesPerPrimitive;
        fillLanes(context, input.slot, count, [&](uint32_t lane) {
            const size_t patch = first + lane / each;
            return missing ? 0u
                           : in.vertices.plane(input.from)[in.numbers[patch * in.verticesPerPrimitive + input.vertex]];
        });
    }
    // What is read before it is written does not tell of other patches.
    std::fill_n(context.stageMemory(), size_t{patches} * rowWords, 0u);
    const Mask mask(count);
    return context.run((count + 3) / 4 * 4, mask.data(), mask.data());
}

}  // namespace

bool TessellationStage::control(const PreparedDraw& draw, uint64_t token, const StagePrimitives& in,
                                ContextCache& cache) {
    const std::shared_ptr<const BatchProgram>& program = draw.call.pipeline->controlProgram();
    const ir::Program& source = program->source();
    const auto rowWords = static_cast<uint32_t>(source.outputs.size());
    const auto patches = static_cast<uint32_t>(in.ids.size());
    rows_.resize(size_t{patches} * rowWords);
    BatchContext& context = cache.begin(program, token, resourcesOf(draw, ir::Stage::control));
    // Subgroups see the invocations of one patch.
    const uint32_t most =
        source.usesSubgroups ? 1 : patchesPerBatch(program->lanes(), draw.plan->tessellation.outputVertices);
    bool finished = true;
    for (uint32_t first = 0; first < patches; first += most) {
        const uint32_t count = std::min(most, patches - first);
        finished &= runControl(draw, in, context, first, count, rowWords);
        std::copy_n(context.stageMemory(), size_t{count} * rowWords, rows_.data() + size_t{first} * rowWords);
    }
    return finished;
}

void TessellationStage::subdivide(const PreparedDraw& draw, const StagePrimitives& in, StagePrimitives& out) {
    const Plan& plan = *draw.plan;
    if (!tessellator_ || modes_ != plan.tessellation) {
        tessellator_.emplace(plan.tessellation);
        modes_ = plan.tessellation;
    }
    const size_t rowWords = draw.call.pipeline->controlProgram()->source().outputs.size();
    points_.clear();
    out.numbers.clear();
    out.ids.clear();
    for (uint32_t patch = 0; patch < in.ids.size(); ++patch) {
        const uint32_t* row = rows_.data() + patch * rowWords;
        const auto level = [row](uint32_t word) { return word == kNoSlot ? 0.0f : std::bit_cast<float>(row[word]); };
        TessellationLevels levels;
        for (uint32_t n = 0; n < levels.outer.size(); ++n) levels.outer[n] = level(plan.outerLevelWords[n]);
        for (uint32_t n = 0; n < levels.inner.size(); ++n) levels.inner[n] = level(plan.innerLevelWords[n]);
        const SubdividedPatch& made = tessellator_->subdivide(levels);
        const auto first = static_cast<uint32_t>(points_.size());
        for (const TessellationPoint& place : made.points) points_.push_back({place, patch});
        for (const uint32_t point : made.indices) out.numbers.push_back(first + point);
        out.verticesPerPrimitive = made.verticesPerPrimitive;
        out.ids.insert(out.ids.end(), made.indices.size() / made.verticesPerPrimitive, in.ids[patch]);
    }
}

bool TessellationStage::evaluate(const PreparedDraw& draw, uint64_t token, const StagePrimitives& in,
                                 ContextCache& cache, StagePrimitives& out) {
    const std::shared_ptr<const BatchProgram>& program = draw.call.pipeline->evaluationProgram();
    const size_t rowWords = draw.call.pipeline->controlProgram()->source().outputs.size();
    const size_t outputs = program->source().outputs.size();
    const auto all = static_cast<uint32_t>(points_.size());
    out.vertices.reset(outputs);
    out.vertices.add(all);
    BatchContext& context = cache.begin(program, token, resourcesOf(draw, ir::Stage::evaluation));
    const uint32_t lanes = std::min(program->lanes(), kMaxLanes);
    bool finished = true;
    for (uint32_t first = 0; first < all; first += lanes) {
        const uint32_t count = std::min(lanes, all - first);
        const Point* points = points_.data() + first;
        for (const BuiltinSlot& slot : draw.plan->evaluation.builtins) {
            fillLanes(context, slot.slot, count, [&](uint32_t lane) -> uint32_t {
                const TessellationPoint& place = points[lane].place;
                switch (slot.builtin) {
                    case ir::Builtin::tessCoord:
                        return std::bit_cast<uint32_t>(slot.component == 0   ? place.u
                                                       : slot.component == 1 ? place.v
                                                                             : place.w);
                    case ir::Builtin::primitiveId:
                        return in.ids[points[lane].patch];
                    case ir::Builtin::patchVertices:
                        return draw.plan->tessellation.outputVertices;
                    case ir::Builtin::viewIndex:
                        return draw.viewIndex;
                    default:
                        return 0;
                }
            });
        }
        for (const StageInput& input : draw.plan->evaluation.inputs) {
            fillLanes(context, input.slot, count, [&](uint32_t lane) {
                return input.from == kNoSlot ? 0u : rows_[points[lane].patch * rowWords + input.from];
            });
        }
        const Mask mask(count);
        finished &= context.run((count + 3) / 4 * 4, mask.data(), mask.data());
        for (uint32_t k = 0; k < outputs; ++k)
            std::memcpy(out.vertices.plane(k) + first, context.output(k), count * sizeof(uint32_t));
    }
    return finished;
}

bool TessellationStage::run(const PreparedDraw& draw, uint64_t token, const StagePrimitives& in, ContextCache& cache,
                            StagePrimitives& out) {
    bool finished = control(draw, token, in, cache);
    subdivide(draw, in, out);
    finished &= evaluate(draw, token, in, cache, out);
    return finished;
}

}  // namespace vernier
