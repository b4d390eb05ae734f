#include "runtime/geometry/vertex_stage.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "runtime/geometry/project.h"

namespace vernier {
namespace {

constexpr uint32_t kMaxBatchLanes = 128;
constexpr size_t kMaxKeptContexts = 64;
alignas(16) constexpr std::byte kZeroTexel[32]{};

/// Where the texel of a vertex lies, or zeros for one outside its buffer.
const std::byte* locate(const VertexStream& stream, const AttributeFetch& fetch, uint64_t element) {
    const uint64_t offset = element * fetch.stride + fetch.offset;
    return offset + fetch.texelBytes <= stream.size ? stream.data + offset : kZeroTexel;
}

void fetchAttribute(const PreparedDraw& draw, const AttributeFetch& fetch, const VertexRef* refs, uint32_t count,
                    BatchContext& context) {
    const VertexStream& stream = draw.call.vertexStreams[fetch.binding];
    const std::byte* texels[kMaxBatchLanes];
    for (uint32_t n = 0; n < count; ++n)
        texels[n] = locate(stream, fetch,
                           fetch.perInstance ? uint64_t{draw.call.firstInstance} +
                                                   (fetch.divisor == 0 ? 0 : refs[n].instance / fetch.divisor)
                                             : refs[n].index);
    void* planes[4];
    for (uint32_t c = 0; c < 4; ++c) planes[c] = fetch.slots[c] == kNoSlot ? nullptr : context.input(fetch.slots[c]);
    if (!fetch.words) {
        fetch.ops.unpackEach(texels, count, planes);
        return;
    }
    for (uint32_t c = 0; c < 4; ++c) {
        if (planes[c] == nullptr) continue;
        auto* plane = static_cast<uint32_t*>(planes[c]);
        if (c < fetch.components) {
            for (uint32_t n = 0; n < count; ++n) std::memcpy(plane + n, texels[n] + 4 * c, 4);
        } else {
            std::fill_n(plane, count, c == 3 ? fetch.alphaBits : 0u);
        }
    }
}

uint32_t builtinValue(const PreparedDraw& draw, ir::Builtin builtin, const VertexRef& ref) {
    const DrawCall& call = draw.call;
    switch (builtin) {
        case ir::Builtin::vertexIndex:
            return ref.index;
        case ir::Builtin::instanceIndex:
            return call.firstInstance + ref.instance;
        case ir::Builtin::baseVertex:
            return call.indices.data != nullptr ? static_cast<uint32_t>(call.vertexOffset) : call.first;
        case ir::Builtin::baseInstance:
            return call.firstInstance;
        case ir::Builtin::drawIndex:
            return call.drawIndex;
        case ir::Builtin::viewIndex:
            return draw.viewIndex;
        default:
            return 0;
    }
}

void fetchInputs(const PreparedDraw& draw, const VertexRef* refs, uint32_t count, BatchContext& context) {
    for (const AttributeFetch& fetch : draw.plan->attributes) fetchAttribute(draw, fetch, refs, count, context);
    for (const BuiltinSlot& builtin : draw.plan->vertexBuiltins) {
        float* plane = context.input(builtin.slot);
        if (plane == nullptr) continue;
        for (uint32_t n = 0; n < count; ++n) {
            const uint32_t value = builtinValue(draw, builtin.builtin, refs[n]);
            std::memcpy(plane + n, &value, 4);
        }
    }
}

// Where outputs come from, `context` below: a batch, or what a stage has kept.

template <class Context>
void copyPlane(const Context& context, uint32_t slot, uint32_t count, float missing, float* target) {
    if (slot == kNoSlot) {
        std::fill_n(target, count, missing);
    } else {
        std::memcpy(target, context.output(slot), count * sizeof(float));
    }
}

/// Outputs to the arrays, from vertex `first` on.
template <class Context>
void storeOutputs(const Plan& plan, const Context& context, uint32_t first, uint32_t count, ShadedVertices& vertices,
                  Chunk& chunk) {
    for (uint32_t c = 0; c < 4; ++c)
        copyPlane(context, plan.positionSlots[c], count, c == 3 ? 1.0f : 0.0f, vertices.clip[c].data() + first);
    if (!vertices.layers.empty())
        std::memcpy(vertices.layers.data() + first, context.output(plan.layerSlot), count * sizeof(uint32_t));
    if (!vertices.viewports.empty())
        std::memcpy(vertices.viewports.data() + first, context.output(plan.viewportIndexSlot),
                    count * sizeof(uint32_t));
    if (!vertices.pointSize.empty())
        copyPlane(context, plan.pointSizeSlot, count, 1.0f, vertices.pointSize.data() + first);

    const auto clipCount = static_cast<uint32_t>(plan.clipDistanceSlots.size());
    for (uint32_t k = 0; k < clipCount; ++k) {
        const float* plane = context.output(plan.clipDistanceSlots[k]);
        for (uint32_t n = 0; n < count; ++n) vertices.clipDistances[(first + n) * clipCount + k] = plane[n];
    }
    const uint32_t stride = vertices.attributeStride;
    float* attributes = chunk.attributes.data() + vertices.firstAttribute + size_t{first} * stride;
    for (uint32_t k = 0; k < stride; ++k) {
        const uint32_t slot = plan.varyings[k].vertexSlot;
        if (slot == kNoSlot) {
            for (uint32_t n = 0; n < count; ++n) attributes[n * stride + k] = 0;
            continue;
        }
        // Bits, not values: a copy must not touch the payload of a NaN.
        const float* plane = context.output(slot);
        for (uint32_t n = 0; n < count; ++n) std::memcpy(attributes + n * stride + k, plane + n, sizeof(float));
    }
}

template <class Context>
void storeCullDistances(const Plan& plan, const Context& context, uint32_t first, uint32_t count,
                        ShadedVertices& vertices) {
    for (uint32_t k = 0; k < plan.cullDistanceSlots.size(); ++k) {
        const float* plane = context.output(plan.cullDistanceSlots[k]);
        for (uint32_t n = 0; n < count; ++n)
            vertices.culled[first + n] |= static_cast<uint8_t>((plane[n] < 0 ? 1u : 0u) << k);
    }
}

/// The words of captured outputs.
void storeCaptured(const CapturePlan& plan, const BatchContext& context, uint32_t first, uint32_t count,
                   ShadedVertices& vertices) {
    const size_t stride = plan.outputs.size();
    uint32_t* words = vertices.captured.data() + first * stride;
    for (size_t k = 0; k < stride; ++k) {
        const uint32_t slot = plan.outputs[k].slot;
        const float* plane = slot == ir::kNoIndex ? nullptr : context.output(slot);
        for (uint32_t n = 0; n < count; ++n) {
            uint32_t& word = words[n * stride + k];
            word = 0;
            if (plane != nullptr) std::memcpy(&word, plane + n, sizeof word);
        }
    }
}

/// Clip distances: negative is outside. NaN counts as outside of everything it is compared with: as not
/// finite.
void flagClipDistances(uint32_t count, uint32_t clipCount, ShadedVertices& vertices) {
    for (uint32_t n = 0; n < count; ++n) {
        for (uint32_t k = 0; k < clipCount; ++k) {
            const float distance = vertices.clipDistances[n * clipCount + k];
            if (distance < 0) vertices.flags[n] |= kOutsideUser << k;
            if (distance != distance) vertices.flags[n] |= kNotFinite;
        }
    }
}

}  // namespace

ContextCache::Entry& ContextCache::get(const std::shared_ptr<const BatchProgram>& program) {
    const auto found = entries_.find(program.get());
    if (found != entries_.end()) return found->second;
    return entries_.emplace(program.get(), Entry{BatchContext(program), 0}).first->second;
}

BatchContext& ContextCache::begin(const std::shared_ptr<const BatchProgram>& program, uint64_t token,
                                  const ResourceBindings& bindings) {
    Entry& entry = get(program);
    if (entry.begun != token) {
        entry.context.beginDraw(bindings);
        entry.begun = token;
    }
    return entry.context;
}

void ContextCache::trim() {
    if (entries_.size() > kMaxKeptContexts) entries_.clear();
}

void ShadedVertices::choose(const std::vector<uint32_t>& chosen, const Plan& plan, Chunk& chunk) {
    const auto take = [&chosen](auto& values, size_t each) {
        if (values.empty()) return;
        auto taken = values;
        taken.clear();
        for (const uint32_t n : chosen) {
            const auto first = values.begin() + static_cast<ptrdiff_t>(n * each);
            taken.insert(taken.end(), first, first + static_cast<ptrdiff_t>(each));
        }
        values.swap(taken);
    };
    for (std::vector<float>& component : clip) take(component, 1);
    take(x, 1);
    take(y, 1);
    take(z, 1);
    take(inverseW, 1);
    take(flags, 1);
    take(culled, 1);
    take(clipDistances, plan.clipDistanceSlots.size());
    take(pointSize, 1);
    take(layers, 1);
    take(viewports, 1);
    const auto first = static_cast<uint32_t>(chunk.attributes.size());
    chunk.attributes.resize(first + chosen.size() * attributeStride);
    for (size_t n = 0; n < chosen.size(); ++n) {
        std::memcpy(chunk.attributes.data() + first + n * attributeStride,
                    chunk.attributes.data() + attributesOf(chosen[n]), attributeStride * sizeof(float));
    }
    firstAttribute = first;
}

void ShadedVertices::resize(uint32_t count, const Plan& plan) {
    const uint32_t padded = (count + 15) / 16 * 16;
    for (auto& plane : clip) plane.resize(padded);
    x.resize(padded);
    y.resize(padded);
    z.resize(padded);
    inverseW.resize(padded);
    flags.resize(padded);
    culled.assign(plan.cullDistanceSlots.empty() ? 0 : count, 0);
    clipDistances.resize(count * plan.clipDistanceSlots.size());
    pointSize.resize(plan.pointSizeSlot == kNoSlot ? 0 : count);
    layers.resize(plan.layerSlot == kNoSlot ? 0 : count);
    viewports.resize(plan.viewportIndexSlot == kNoSlot ? 0 : count);
}

namespace {

/// Runs the vertex program, and hands `take` each batch: its registers, the number of its first vertex and how many.
template <class Take>
bool runVertices(const PreparedDraw& draw, uint64_t token, const std::vector<VertexRef>& refs, ContextCache& cache,
                 const Take& take) {
    const auto count = static_cast<uint32_t>(refs.size());
    const std::shared_ptr<const BatchProgram>& program = draw.call.pipeline->vertexProgram();
    BatchContext& context = cache.begin(program, token, draw.call.vertexResources);
    const uint32_t lanes = std::min(program->lanes(), kMaxBatchLanes);
    alignas(64) uint32_t mask[kMaxBatchLanes];
    bool finished = true;
    for (uint32_t first = 0; first < count; first += lanes) {
        const uint32_t n = std::min(lanes, count - first), padded = (n + 3) / 4 * 4;
        fetchInputs(draw, refs.data() + first, n, context);
        std::fill_n(mask, n, ~0u);
        std::fill_n(mask + n, lanes - n, 0u);
        finished &= context.run(padded, mask, mask);
        take(context, first, n);
    }
    return finished;
}

void makeRoom(const Plan& plan, uint32_t count, ShadedVertices& vertices, Chunk& chunk) {
    vertices.resize(count, plan);
    vertices.attributeStride = static_cast<uint32_t>(plan.varyings.size());
    vertices.firstAttribute = static_cast<uint32_t>(chunk.attributes.size());
    chunk.attributes.resize(chunk.attributes.size() + size_t{count} * vertices.attributeStride);
}

void project(const PreparedDraw& draw, uint32_t count, ShadedVertices& vertices) {
    const ProjectionInput in{
        {vertices.clip[0].data(), vertices.clip[1].data(), vertices.clip[2].data(), vertices.clip[3].data()},
        count,
        draw.firstViewport.transform,
        draw.subPixelBits,
        draw.state->depthClipEnable,
        draw.state->negativeOneToOne};
    const ProjectionOutput out{vertices.x.data(), vertices.y.data(), vertices.z.data(), vertices.inverseW.data(),
                               vertices.flags.data()};
    projectFunction(draw.call.pipeline->isa())(in, out);
    flagClipDistances(count, static_cast<uint32_t>(draw.plan->clipDistanceSlots.size()), vertices);
}

}  // namespace

bool shadeVertices(const PreparedDraw& draw, uint64_t token, const std::vector<VertexRef>& refs, ContextCache& cache,
                   ShadedVertices& vertices, Chunk& chunk) {
    const Plan& plan = *draw.plan;
    const auto count = static_cast<uint32_t>(refs.size());
    makeRoom(plan, count, vertices, chunk);
    const bool captures = draw.call.capture != nullptr;
    const CapturePlan& capture = draw.call.pipeline->program().capture();
    vertices.captured.resize(captures ? count * capture.outputs.size() : 0);
    const bool finished =
        runVertices(draw, token, refs, cache, [&](const BatchContext& context, uint32_t first, uint32_t n) {
            storeOutputs(plan, context, first, n, vertices, chunk);
            storeCullDistances(plan, context, first, n, vertices);
            if (captures) storeCaptured(capture, context, first, n, vertices);
        });
    project(draw, count, vertices);
    return finished;
}

bool shadeForStages(const PreparedDraw& draw, uint64_t token, const std::vector<VertexRef>& refs, ContextCache& cache,
                    StageVertices& vertices) {
    const size_t outputs = draw.call.pipeline->vertexIr().outputs.size();
    vertices.reset(outputs);
    vertices.add(static_cast<uint32_t>(refs.size()));
    return runVertices(draw, token, refs, cache, [&](const BatchContext& context, uint32_t first, uint32_t n) {
        for (uint32_t k = 0; k < outputs; ++k)
            std::memcpy(vertices.plane(k) + first, context.output(k), n * sizeof(uint32_t));
    });
}

void finishVertices(const PreparedDraw& draw, const StageVertices& from, ShadedVertices& vertices, Chunk& chunk) {
    makeRoom(*draw.plan, from.count(), vertices, chunk);
    if (from.count() == 0) return;  // stages may put out nothing
    storeOutputs(*draw.plan, from, 0, from.count(), vertices, chunk);
    storeCullDistances(*draw.plan, from, 0, from.count(), vertices);
    project(draw, from.count(), vertices);
}

}  // namespace vernier
