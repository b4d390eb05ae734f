// A case through the batch interpreter.
#include <algorithm>
#include <bit>
#include <cstring>

#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/place_vertices.h"
#include "spirv_interp/tessellation.h"
#include "tests/proof/proof.h"

namespace vernier::proof {
namespace {

/// What an ImageBinding's call finds behind its pointers.
struct BoundImage {
    TestImage* image = nullptr;
};

float floatAt(const uint32_t* lanes, uint32_t lane) {
    return lanes == nullptr ? 0.0f : std::bit_cast<float>(lanes[lane]);
}
int32_t intAt(const uint32_t* lanes, uint32_t lane) {
    return lanes == nullptr ? 0 : static_cast<int32_t>(lanes[lane]);
}

void callImage(const ImageBinding& binding, const ImageCall& call) {
    const ir::ImageOp& op = *call.op;
    auto& image = *static_cast<TestImage*>(const_cast<void*>(binding.image));
    const bool implicit = op.kind == ir::ImageKind::sampleImplicit || op.kind == ir::ImageKind::queryLod;
    for (uint32_t lane = 0; lane < call.lanes; ++lane) {
        if (call.mask != nullptr && call.mask[lane] == 0) continue;
        ImageAccess a;
        a.kind = op.kind;
        a.dim = op.dim;
        a.arrayed = op.arrayed;
        a.compare = op.depthCompare;
        a.component = op.component;
        a.atomic = op.atomicOp;
        for (uint32_t k = 0; k < op.coords; ++k) {
            a.coordinates[k] = floatAt(call.coord[k], lane);
            a.texel[k] = intAt(call.coord[k], lane);
        }
        const uint32_t spatial = op.coords - (op.arrayed && op.coords > 0 ? 1 : 0);
        for (uint32_t k = 0; k < 3; ++k) {
            if (implicit && k < spatial) {
                a.ddx[k] = floatAt(call.coord[k], lane | 1) - floatAt(call.coord[k], lane & ~1u);
                a.ddy[k] = floatAt(call.coord[k], lane | 2) - floatAt(call.coord[k], lane & ~2u);
            } else if (!implicit) {
                a.ddx[k] = floatAt(call.ddx[k], lane);
                a.ddy[k] = floatAt(call.ddy[k], lane);
            }
            a.offset[k] = intAt(call.offset[k], lane);
        }
        (op.hasBias ? a.bias : a.lod) = floatAt(call.lodOrBias, lane);
        if (op.hasMinLod) a.minLod = floatAt(call.minLod, lane);
        a.level = intAt(call.lodOrBias, lane);
        a.reference = floatAt(call.dref, lane);
        a.sample = intAt(call.sample, lane);
        for (uint32_t k = 0; k < 4; ++k) a.value[k] = static_cast<uint32_t>(intAt(call.texel[k], lane));
        if (op.kind == ir::ImageKind::atomic) a.comparator = a.value[1];
        const auto result = image.access(a);
        for (uint32_t k = 0; k < 4; ++k)
            if (call.result[k] != nullptr) call.result[k][lane] = result[k];
    }
}

/// The descriptors of a program over a Memory.
class Bindings {
  public:
    Bindings(const ir::Program& program, Memory& memory) {
        for (const ir::Resource& r : program.resources) {
            const uint32_t count = ir::isOfRunner(r.kind) ? 0
                                   : r.arraySize == 0     ? kRuntimeArray
                                                          : std::min(r.arraySize, kMaxArray);
            base_.push_back(static_cast<uint32_t>(ir::isBuffer(r.kind)                  ? buffers_.size()
                                                  : r.kind == ir::ResourceKind::sampler ? samplers_.size()
                                                                                        : images_.size()));
            count_.push_back(count);
            for (uint32_t element = 0; element < count; ++element) {
                const Slot slot{r.set, r.binding, element};
                if (ir::isBuffer(r.kind)) {
                    auto& bytes = memory.buffer(r.kind == ir::ResourceKind::pushConstants ? kPushConstants : slot);
                    buffers_.push_back({bytes.data(), static_cast<uint32_t>(bytes.size())});
                } else if (r.kind == ir::ResourceKind::sampler) {
                    samplers_.push_back(nullptr);
                } else {
                    images_.push_back({&memory.image(slot), nullptr, callImage});
                }
            }
        }
        bindings_ = {buffers_.data(), images_.data(), samplers_.data(),
                     base_.data(),    count_.data(),  [](const ImageBinding& image, const void*) { return image; }};
    }
    const ResourceBindings& get() const { return bindings_; }

    static constexpr uint32_t kRuntimeArray = 4, kMaxArray = 64;

  private:
    std::vector<BufferBinding> buffers_;
    std::vector<ImageBinding> images_;
    std::vector<const void*> samplers_;
    std::vector<uint32_t> base_, count_;
    ResourceBindings bindings_;
};

struct Interpolation {
    const World* world;
    const ir::Program* program;
    uint32_t first;

    static void at(void* self, uint32_t slot, uint32_t where, uint32_t lanes, const float* a, const float* b,
                   float* result) {
        const auto& me = *static_cast<const Interpolation*>(self);
        for (uint32_t lane = 0; lane < lanes; ++lane) {
            result[lane] = me.world->interpolated(me.first + lane, me.program->inputs[slot], where,
                                                  a == nullptr ? 0.0f : a[lane], b == nullptr ? 0.0f : b[lane]);
        }
    }
};

void takeVertices(const ir::Program& program, const BatchContext& context, uint32_t first, uint32_t lanes,
                  Ending& ending) {
    const uint32_t words = ir::wordsOfVertex(program);
    const auto* counts = reinterpret_cast<const uint32_t*>(context.output(words));
    for (uint32_t lane = 0; lane < lanes; ++lane) {
        if (!ending.live[first + lane]) continue;
        ending.outputs.back()[first + lane] = counts[lane];
        for (uint32_t v = 0; v < std::min(counts[lane], program.geometry.outputVertices); ++v)
            for (uint32_t k = 0; k < words; ++k)
                ending.outputs[size_t{v} * words + k][first + lane] =
                    context.stageMemory()[ir::placeOfVertex(program, v, k) + lane];
    }
}

/// A control program: whole patches in a batch.
void runPatches(const Case& subject, const Shape& shape, const BatchProgram& compiled, BatchContext& context,
                Ending& ending) {
    const ir::Program& program = compiled.source();
    const uint32_t each = program.localSize[0];
    // Subgroups see the invocations of one patch.
    const uint32_t most = std::min(patchesPerBatch(compiled.lanes(), each), program.usesSubgroups ? 1u : ~0u);
    const auto words = static_cast<uint32_t>(program.outputs.size());
    if (most == 0) return;  // the test asks for fewer lanes than a patch has
    for (uint32_t first = 0; first < subject.invocations; first += most) {
        const uint32_t patches = std::min(most, subject.invocations - first), lanes = patches * each;
        std::vector<uint32_t> exec(compiled.lanes()), store(compiled.lanes());
        for (uint32_t lane = 0; lane < lanes; ++lane) {
            exec[lane] = shape.exec[first + lane / each] ? ~0u : 0;
            store[lane] = shape.store[first + lane / each] ? ~0u : 0;
        }
        for (uint32_t slot = 0; slot < program.inputs.size(); ++slot) {
            auto* row = reinterpret_cast<uint32_t*>(context.input(slot));
            const ir::InterfaceSlot& input = program.inputs[slot];
            for (uint32_t lane = 0; row != nullptr && lane < lanes; ++lane) {
                const uint32_t patch = lane / each;
                row[lane] = input.builtin == ir::Builtin::stageOffset ? patch * words * 4
                            : input.builtin == ir::Builtin::invocationId
                                ? lane % each
                                : subject.world.input(invocationOfInput(program, input, first + patch), input);
            }
        }
        if (!context.run((lanes + 3) / 4 * 4, exec.data(), store.data())) {
            ending.error = "batch: the back-edge budget is used up";
            return;
        }
        for (uint32_t patch = 0; patch < patches; ++patch) {
            ending.live[first + patch] = shape.store[first + patch];
            for (uint32_t k = 0; k < words; ++k)
                ending.outputs[k][first + patch] = context.stageMemory()[patch * words + k];
        }
    }
}

}  // namespace

Ending runBatch(const Case& subject, const ir::Program& given, const Shape& shape, const BatchOptions& options) {
    Ending ending;
    ir::Program program = given;
    const bool vertices = program.stage == ir::Stage::geometry;
    if (vertices) ir::placeVertices(program);
    ending.memory = std::make_unique<Memory>(subject.world);
    const auto compiled = BatchProgram::compile(program, options);
    if (!compiled) {
        ending.error = "batch: " + compiled.error().message;
        return ending;
    }
    const Bindings bindings(program, *ending.memory);
    if (subject.stage == ir::Stage::compute) {
        WorkGroupContext context(*compiled);
        const WorkGroupContext::Grid grid{subject.groups, {0, 0, 0}};
        context.beginDispatch(bindings.get(), grid);
        // In two parts, as threads share a dispatch.
        const uint64_t half = grid.size() / 2;
        if (!context.run(0, static_cast<uint32_t>(half)) ||
            !context.run(half, static_cast<uint32_t>(grid.size() - half)))
            ending.error = "batch: the back-edge budget is used up";
        return ending;
    }
    BatchContext context(*compiled);
    Interpolation interpolation{&subject.world, &program, 0};
    context.setInterpolator({&interpolation, Interpolation::at});
    context.beginDraw(bindings.get());
    ending.outputs.assign(outputCount(program), std::vector<uint32_t>(subject.invocations));
    ending.written.assign(outputCount(program), std::vector<bool>(subject.invocations, true));
    ending.live.assign(subject.invocations, false);
    if (program.stage == ir::Stage::control) {
        runPatches(subject, shape, **compiled, context, ending);
        return ending;
    }
    const uint32_t capacity = std::min((*compiled)->lanes(), vertices ? ir::kVertexLanes : ~0u);
    for (uint32_t first = 0; first < subject.invocations; first += capacity) {
        const uint32_t lanes = std::min(capacity, subject.invocations - first);
        interpolation.first = first;
        std::vector<uint32_t> exec(capacity), store(capacity);
        for (uint32_t lane = 0; lane < lanes; ++lane) {
            bool runs = shape.exec[first + lane];
            // Derivatives need whole quads: the caller of a program that takes them adds the helpers.
            for (uint32_t k = 0; program.usesQuads && k < 4; ++k) runs = runs || shape.exec[((first + lane) & ~3u) + k];
            exec[lane] = runs ? ~0u : 0;
            store[lane] = shape.store[first + lane] ? ~0u : 0;
        }
        for (uint32_t slot = 0; slot < program.inputs.size(); ++slot) {
            auto* row = reinterpret_cast<uint32_t*>(context.input(slot));
            for (uint32_t lane = 0; row != nullptr && lane < lanes; ++lane) {
                const ir::InterfaceSlot& input = program.inputs[slot];
                const uint32_t word = input.builtin == ir::Builtin::stageOffset
                                          ? lane * 4
                                          : subject.world.input(invocationOfInput(program, input, first + lane), input);
                row[lane] = program.inputs[slot].type == ir::Type::b1 ? (word != 0 ? ~0u : 0) : word;
            }
        }
        if (!context.run(lanes, exec.data(), store.data())) {
            ending.error = "batch: the back-edge budget is used up";
            return ending;
        }
        for (uint32_t lane = 0; lane < lanes; ++lane) ending.live[first + lane] = context.liveMask()[lane] != 0;
        if (vertices) {
            takeVertices(program, context, first, lanes, ending);
            continue;
        }
        for (uint32_t slot = 0; slot < program.outputs.size(); ++slot) {
            const auto* row = reinterpret_cast<const uint32_t*>(context.output(slot));
            if (row != nullptr) std::copy_n(row, lanes, ending.outputs[slot].begin() + first);
        }
    }
    return ending;
}

}  // namespace vernier::proof
