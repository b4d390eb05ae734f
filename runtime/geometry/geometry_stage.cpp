#include "runtime/geometry/geometry_stage.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "spirv_interp/ir/place_vertices.h"

namespace vernier {
namespace {

struct alignas(64) Lanes : std::array<uint32_t, ir::kVertexLanes> {};

/// One run of the program: consecutive invocations, one in each lane.
class GeometryBatch {
  public:
    GeometryBatch(const PreparedDraw& draw, const StagePrimitives& in, const BatchProgram& program,
                  BatchContext& context)
        : draw_(draw), in_(in), program_(program.source()), context_(context) {}

    /// Invocations [first, first + count), of primitive invocation / modes.invocations.
    bool run(uint64_t first, uint32_t count) {
        count_ = count;
        const uint32_t invocations = program_.geometry.invocations;
        for (uint32_t lane = 0; lane < count; ++lane) {
            primitive_[lane] = static_cast<uint32_t>((first + lane) / invocations);
            invocation_[lane] = static_cast<uint32_t>((first + lane) % invocations);
        }
        fill();
        Lanes mask{};
        std::fill_n(mask.begin(), count, ~0u);
        return context_.run((count + 3) / 4 * 4, mask.data(), mask.data());
    }

    /// Appends what the invocations put out.
    void take(StageVertices& vertices, std::vector<LocalPrimitive>& primitives, VertexStreams& otherStreams) {
        const uint32_t words = ir::wordsOfVertex(program_);
        Lanes counts;
        std::memcpy(counts.data(), context_.output(words), count_ * sizeof(uint32_t));
        uint32_t sum = 0;
        for (uint32_t lane = 0; lane < count_; ++lane) {
            counts[lane] = std::min(counts[lane], program_.geometry.outputVertices);
            sum += counts[lane];
        }
        const uint32_t first = vertices.add(sum);
        const uint32_t* memory = context_.stageMemory();
        for (uint32_t k = 0; k < words; ++k) {
            uint32_t* to = vertices.plane(k) + first;
            for (uint32_t lane = 0; lane < count_; ++lane)
                for (uint32_t v = 0; v < counts[lane]; ++v) *to++ = memory[ir::placeOfVertex(program_, v, k) + lane];
        }
        uint32_t vertex = first;
        for (uint32_t lane = 0; lane < count_; ++lane) {
            assemble(vertices, vertex, counts[lane], in_.ids[primitive_[lane]], primitives, otherStreams);
            vertex += counts[lane];
        }
    }

  private:
    uint32_t builtinValue(ir::Builtin builtin, uint32_t lane) const {
        switch (builtin) {
            case ir::Builtin::primitiveId:
                return in_.ids[primitive_[lane]];
            case ir::Builtin::invocationId:
                return invocation_[lane];
            case ir::Builtin::viewIndex:
                return draw_.viewIndex;
            case ir::Builtin::stageOffset:
                return lane * static_cast<uint32_t>(sizeof(uint32_t));
            default:
                return 0;
        }
    }

    void fill() {
        for (const BuiltinSlot& slot : draw_.plan->geometry.builtins) {
            float* plane = context_.input(slot.slot);
            if (plane == nullptr) continue;
            for (uint32_t lane = 0; lane < count_; ++lane) {
                const uint32_t value = builtinValue(slot.builtin, lane);
                std::memcpy(plane + lane, &value, sizeof value);
            }
        }
        for (const StageInput& input : draw_.plan->geometry.inputs) {
            float* plane = context_.input(input.slot);
            if (plane == nullptr) continue;
            if (input.from == kNoSlot) {
                std::fill_n(plane, count_, 0.0f);
                continue;
            }
            const uint32_t* from = in_.vertices.plane(input.from);
            const uint32_t* numbers = in_.numbers.data() + input.vertex;
            for (uint32_t lane = 0; lane < count_; ++lane)
                std::memcpy(plane + lane, from + numbers[size_t{primitive_[lane]} * in_.verticesPerPrimitive],
                            sizeof(uint32_t));
        }
    }

    /// The primitives that one invocation's vertices make up.
    void assemble(const StageVertices& vertices, uint32_t first, uint32_t count, uint32_t id,
                  std::vector<LocalPrimitive>& primitives, VertexStreams& otherStreams) const {
        const Plan& plan = *draw_.plan;
        const VkPrimitiveTopology topology = plan.rasterTopology;
        const uint32_t each = verticesPerPrimitive(topology);
        const uint32_t* flags = count == 0 ? nullptr : vertices.plane(plan.vertexFlagsSlot);
        uint32_t strip = first;
        for (uint32_t v = first; v < first + count; ++v) {
            if (const uint32_t stream = flags[v] >> ir::kStreamBit; stream != 0) {
                otherStreams[stream % ir::kVertexStreams].push_back(v);
                continue;
            }
            if (each == 1 || (flags[v] & ir::kStartsStrip) != 0) strip = v;
            if (v + 1 - strip < each) continue;
            const PrimitiveVertices numbers = primitiveVertices(topology, each == 1 ? 0 : v + 1 - strip - each);
            LocalPrimitive primitive{};
            for (uint32_t n = 0; n < 3; ++n) primitive.vertex[n] = strip + numbers.vertex[n];
            primitive.provoking = draw_.state->provokingVertexLast ? numbers.provokingLast : numbers.provokingFirst;
            primitive.primitiveId = plan.primitiveIdSlot == kNoSlot
                                        ? id
                                        : vertices.plane(plan.primitiveIdSlot)[primitive.vertex[primitive.provoking]];
            primitive.startsStrip = v + 1 - strip == each;
            primitives.push_back(primitive);
        }
    }

    const PreparedDraw& draw_;
    const StagePrimitives& in_;
    const ir::Program& program_;
    BatchContext& context_;
    uint32_t count_ = 0;
    Lanes primitive_{}, invocation_{};
};

}  // namespace

bool runGeometry(const PreparedDraw& draw, uint64_t token, const StagePrimitives& in, ContextCache& cache,
                 StageVertices& vertices, std::vector<LocalPrimitive>& primitives, VertexStreams& otherStreams) {
    const std::shared_ptr<const BatchProgram>& program = draw.call.pipeline->geometryProgram();
    vertices.reset(ir::wordsOfVertex(program->source()));
    primitives.clear();
    for (std::vector<uint32_t>& points : otherStreams) points.clear();
    const StageResources* resources = draw.call.stageResources;
    BatchContext& context =
        cache.begin(program, token, resources == nullptr ? ResourceBindings{} : resources->geometry);
    GeometryBatch batch(draw, in, *program, context);
    const uint64_t all = uint64_t{in.ids.size()} * program->source().geometry.invocations;
    const uint32_t lanes = std::min(program->lanes(), ir::kVertexLanes);
    bool finished = true;
    for (uint64_t first = 0; first < all; first += lanes) {
        finished &= batch.run(first, static_cast<uint32_t>(std::min<uint64_t>(lanes, all - first)));
        batch.take(vertices, primitives, otherStreams);
    }
    return finished;
}

}  // namespace vernier
