#include "runtime/geometry/assemble.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "runtime/geometry/project.h"

namespace vernier {
namespace {

/// The same operations in the same order as projectFunction(), for one vertex that clipping made.
bool projectVertex(const PreparedDraw& draw, const ViewportTransform& viewport, const std::array<double, 4>& clip,
                   WindowVertex& out) {
    const double w = clip[3];
    if (!(w > 0)) return false;
    double window[3];
    for (uint32_t c = 0; c < 3; ++c) window[c] = clip[c] / w * viewport.scale[c] + viewport.offset[c];
    const double subUnits = static_cast<double>(1u << draw.subPixelBits);
    for (uint32_t c = 0; c < 2; ++c) {
        if (!std::isfinite(window[c])) return false;
        window[c] = std::clamp(window[c], double{kGuardBandMin}, double{kGuardBandMax});
    }
    out.x = static_cast<int32_t>(std::nearbyint(window[0] * subUnits));
    out.y = static_cast<int32_t>(std::nearbyint(window[1] * subUnits));
    out.z = static_cast<float>(window[2]);
    out.inverseW = 1.0 / w;
    return std::isfinite(out.z);
}

}  // namespace

void Assembler::startReuse() {
    refs_.clear();
    if (++epoch_ == 0) {  // wrapped: old stamps would look new
        std::fill(reuse_.begin(), reuse_.end(), ReuseSlot{});
        epoch_ = 1;
    }
}

uint32_t Assembler::localVertex(const VertexRef& ref) {
    uint32_t slot = (ref.index * 0x9E3779B1u ^ ref.instance * 0x85EBCA6Bu) >> 19;  // 13 bits: kReuseSlots
    while (true) {
        ReuseSlot& entry = reuse_[slot];
        if (entry.epoch != epoch_) {
            entry = {ref, static_cast<uint32_t>(refs_.size()), epoch_};
            refs_.push_back(ref);
            return entry.local;
        }
        if (entry.ref.index == ref.index && entry.ref.instance == ref.instance) return entry.local;
        slot = (slot + 1) % kReuseSlots;
    }
}

/// Vertices of one instance whose indices lie close together: a slot for each index.
void Assembler::reuseByIndex(uint32_t least, uint32_t instance, uint32_t vertexCount) {
    for (LocalPrimitive& primitive : primitives_) {
        for (uint32_t v = 0; v < vertexCount; ++v) {
            const uint32_t index = primitive.vertex[v];
            ReuseSlot& entry = reuse_[index - least];
            if (entry.epoch != epoch_) {
                entry.local = static_cast<uint32_t>(refs_.size());
                entry.epoch = epoch_;
                refs_.push_back({index, instance});
            }
            primitive.vertex[v] = entry.local;
        }
    }
}

/// Primitives of a triangle list in one run, one instance and the index buffer: the vertices are the indices, one after
/// the other.
template <class T>
void Assembler::numberList(const PreparedDraw& draw, uint32_t first, uint32_t count, uint32_t& least,
                           uint32_t& greatest) {
    const std::byte* indices = draw.call.indices.data + (size_t{draw.call.first} + draw.runs[0].first) * sizeof(T) +
                               size_t{first} * 3 * sizeof(T);
    primitives_.resize(count);
    for (uint32_t n = 0; n < count; ++n) {
        LocalPrimitive& local = primitives_[n];
        for (uint32_t v = 0; v < 3; ++v) {
            T index;
            std::memcpy(&index, indices + (size_t{n} * 3 + v) * sizeof(T), sizeof(T));
            local.vertex[v] = index + static_cast<uint32_t>(draw.call.vertexOffset);
            least = std::min(least, local.vertex[v]);
            greatest = std::max(greatest, local.vertex[v]);
        }
        local.provoking = draw.state->provokingVertexLast ? 2 : 0;
        local.primitiveId = first + n;
        local.startsStrip = true;
    }
}

/// Whether numberList() is made for `count` primitives from `first` on, with indices of `bytes`.
bool Assembler::isPlainList(const PreparedDraw& draw, uint32_t first, uint32_t count, size_t bytes) {
    const DrawCall& call = draw.call;
    const uint64_t end = uint64_t{call.first} + draw.runs[0].first + (uint64_t{first} + count) * 3;
    return draw.state->topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST && draw.runs.size() == 1 &&
           call.indices.data != nullptr && end * bytes <= call.indices.size;
}

void Assembler::number(const PreparedDraw& draw, const PrimitiveRange& range) {
    primitives_.clear();
    startReuse();
    const VkPrimitiveTopology topology = draw.state->topology;
    const uint32_t vertexCount = verticesPerPrimitive(topology);
    const bool indexed = draw.call.indices.data != nullptr;
    const bool isLineStrip =
        topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP || topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY;
    const bool shared = indexed || topology != VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const auto firstInstance = static_cast<uint32_t>(range.first / draw.primitivesPerInstance);
    auto instance = firstInstance;
    auto primitive = static_cast<uint32_t>(range.first % draw.primitivesPerInstance);
    const bool oneInstance = primitive + uint64_t{range.count} <= draw.primitivesPerInstance;
    auto run = runAt(draw, primitive);
    uint32_t least = ~0u, greatest = 0;
    uint32_t left = range.count;
    const VkIndexType type = draw.call.indices.type;
    if (oneInstance && type == VK_INDEX_TYPE_UINT16 && isPlainList(draw, primitive, left, 2)) {
        numberList<uint16_t>(draw, primitive, left, least, greatest);
        left = 0;
    } else if (oneInstance && type == VK_INDEX_TYPE_UINT32 && isPlainList(draw, primitive, left, 4)) {
        numberList<uint32_t>(draw, primitive, left, least, greatest);
        left = 0;
    }
    for (; left != 0; --left) {
        const PrimitiveVertices numbers = primitiveVertices(topology, primitive - run->firstPrimitive);
        LocalPrimitive local{};
        local.primitiveId = primitive;
        local.startsStrip = !isLineStrip || primitive == run->firstPrimitive;
        local.provoking = draw.state->provokingVertexLast ? numbers.provokingLast : numbers.provokingFirst;
        for (uint32_t v = 0; v < vertexCount; ++v) {
            const uint32_t index = vertexIndex(draw.call, indexed, run->first + numbers.vertex[v]);
            if (!shared) {
                local.vertex[v] = static_cast<uint32_t>(refs_.size());
                refs_.push_back({index, instance});
            } else if (oneInstance) {
                local.vertex[v] = index;  // its place among the references comes below
                least = std::min(least, index);
                greatest = std::max(greatest, index);
            } else {
                local.vertex[v] = localVertex({index, instance});
            }
        }
        primitives_.push_back(local);
        if (++primitive == draw.primitivesPerInstance) {
            primitive = 0;
            ++instance;
            run = draw.runs.begin();
        } else if (primitive == run->firstPrimitive + run->primitives) {
            ++run;
        }
    }
    if (!shared || !oneInstance) return;
    if (greatest - least < kReuseSlots) return reuseByIndex(least, firstInstance, vertexCount);
    for (LocalPrimitive& local : primitives_)
        for (uint32_t v = 0; v < vertexCount; ++v) local.vertex[v] = localVertex({local.vertex[v], firstInstance});
}

WindowVertex Assembler::windowVertex(uint32_t v) const {
    return {vertices_.x[v], vertices_.y[v], vertices_.z[v], vertices_.inverseW[v], attributesOf(v), pointSizeOf(v)};
}

void Assembler::addPoint(const PreparedDraw& draw, const PrimitiveInfo& info, uint32_t v) {
    // A point is drawn or not by its vertex alone.
    if ((vertices_.flags[v] & (kOutsideVolume | kOutsideUserAll)) != 0) return;
    const ViewportTransform& viewport = draw.viewport(info.viewport).transform;
    WindowVertex vertex = windowVertex(v);
    if (info.viewport != 0) {  // windowVertex() is for the first
        const std::array<double, 4> clip{vertices_.clip[0][v], vertices_.clip[1][v], vertices_.clip[2][v],
                                         vertices_.clip[3][v]};
        if (!projectVertex(draw, viewport, clip, vertex)) return;
    } else if ((vertices_.flags[v] & kOutsideGuard) != 0) {
        return;
    }
    const double w = vertices_.clip[3][v];
    const double x = vertices_.clip[0][v] / w * viewport.scale[0] + viewport.offset[0];
    const double y = vertices_.clip[1][v] / w * viewport.scale[1] + viewport.offset[1];
    setup_.addPoint(draw, info, vertex, x, y);
}

void Assembler::clipAndAdd(const PreparedDraw& draw, const PrimitiveInfo& info, const LocalPrimitive& primitive,
                           uint32_t vertexCount, Chunk& chunk) {
    const auto clipCount = static_cast<uint32_t>(draw.plan->clipDistanceSlots.size());
    ClipPolygon polygon;
    polygon.count = vertexCount;
    for (uint32_t n = 0; n < vertexCount; ++n) {
        const uint32_t v = primitive.vertex[n];
        ClipVertex& vertex = polygon.vertices[n];
        for (uint32_t c = 0; c < 4; ++c) vertex.position[c] = double{vertices_.clip[c][v]};
        vertex.distances.fill(0);
        for (uint32_t k = 0; k < clipCount; ++k)
            vertex.distances[k] = double{vertices_.clipDistances[v * clipCount + k]};
        vertex.attributes = attributesOf(v);
        vertex.pointSize = pointSizeOf(v);
    }
    const ViewportTransform& viewport = draw.viewport(info.viewport).transform;
    if (clipPolygon(draw, viewport, polygon, chunk)) ++statistics_.clippedPrimitives;
    std::array<WindowVertex, kMaxPolygonVertices> window;
    uint32_t hiddenEdges = 0;
    // A polygon becomes triangles around its first vertex: the one with the least position, so that neither the order
    // of the primitive's vertices nor its winding changes what they are.
    uint32_t first = 0;
    for (uint32_t n = 1; vertexCount == 3 && n < polygon.count; ++n)
        if (polygon.vertices[n].position < polygon.vertices[first].position) first = n;
    // Of several at the same place the foremost: they follow each other, and the last may come before the first.
    if (first == 0 && vertexCount == 3)
        for (uint32_t n = polygon.count; n > 1 && polygon.vertices[n - 1].position == polygon.vertices[0].position; --n)
            first = n - 1;
    for (uint32_t n = 0; n < polygon.count; ++n) {
        const ClipVertex& vertex = polygon.vertices[(first + n) % polygon.count];
        if (!projectVertex(draw, viewport, vertex.position, window[n])) return;
        window[n].attributes = vertex.attributes;
        window[n].pointSize = vertex.pointSize;
        if (vertex.hiddenEdge) hiddenEdges |= 1u << n;
    }
    if (polygon.count == 2 && vertexCount == 2) setup_.addLine(draw, info, window[0], window[1]);
    if (polygon.count >= 3) setup_.addPolygon(draw, info, {window.data(), polygon.count}, hiddenEdges);
}

/// The layer and the viewport that the vertex program chose, of the provoking vertex. False: there is no such one.
bool Assembler::route(const PreparedDraw& draw, uint32_t provoking, PrimitiveInfo& info) const {
    if (!vertices_.layers.empty()) info.layer = vertices_.layers[provoking];
    if (!vertices_.viewports.empty()) info.viewport = vertices_.viewports[provoking];
    return grid_.draws(info.layer) && info.viewport < draw.viewportCount();
}

void Assembler::assemblePrimitive(const PreparedDraw& draw, uint32_t drawIndex, const LocalPrimitive& primitive,
                                  uint32_t vertexCount, Chunk& chunk) {
    uint32_t all = ~0u, any = 0, culled = vertices_.culled.empty() ? 0 : 0xFF;
    for (uint32_t n = 0; n < vertexCount; ++n) {
        const uint32_t v = primitive.vertex[n];
        all &= vertices_.flags[v];
        any |= vertices_.flags[v];
        if (!vertices_.culled.empty()) culled &= vertices_.culled[v];
    }
    if ((any & kNotFinite) != 0 || (all & (kOutsideVolume | kOutsideUserAll)) != 0 || culled != 0) return;
    // Primitives with a vertex inside must count; others may (specification, "Pipeline Statistics Queries").
    ++statistics_.clippingPrimitives;
    if (draw.state->rasterizerDiscard) return;
    const uint32_t provoking = primitive.vertex[primitive.provoking];
    PrimitiveInfo info{drawIndex, primitive.primitiveId, attributesOf(provoking), draw.viewIndex, 0};
    if (isRouted() && !route(draw, provoking, info)) return;
    if (vertexCount == 1) return addPoint(draw, info, primitive.vertex[0]);
    constexpr uint32_t kMustClip = kOutsideGuard | kOutsideNear | kOutsideFar | kOutsideUserAll;
    constexpr uint32_t kSides = kOutsideLeft | kOutsideRight | kOutsideTop | kOutsideBottom;
    if ((any & (vertexCount == 2 ? kMustClip | kSides : kMustClip)) != 0 || info.viewport != 0) {
        clipAndAdd(draw, info, primitive, vertexCount, chunk);
    } else if (vertexCount == 2) {
        setup_.addLine(draw, info, windowVertex(primitive.vertex[0]), windowVertex(primitive.vertex[1]));
    } else {
        setup_.addTriangle(draw, info, windowVertices(primitive));
    }
}

/// Triangles of a draw that packs small ones: a group at a time, those that are not small one by one.
void Assembler::assembleTriangles(const PreparedDraw& draw, uint32_t drawIndex, Chunk& chunk) {
    const SetUpTrianglesFn setUp = setUpTrianglesFunction(draw.call.pipeline->isa());
    const auto culls = [&](VkCullModeFlagBits face) {
        return (draw.state->cullMode & static_cast<uint32_t>(face)) != 0;
    };
    TriangleGroupInput in{};
    in.x = vertices_.x.data();
    in.y = vertices_.y.data();
    in.flags = vertices_.flags.data();
    in.subPixelBits = draw.subPixelBits;
    in.area = draw.firstViewport.triangleArea;
    in.clockwiseIsFront = draw.state->frontFace == VK_FRONT_FACE_CLOCKWISE;
    in.cullFront = culls(VK_CULL_MODE_FRONT_BIT);
    in.cullBack = culls(VK_CULL_MODE_BACK_BIT);
    in.gridX = grid_.x0;
    in.gridY = grid_.y0;
    in.columns = grid_.columns;
    for (size_t first = 0; first < primitives_.size(); first += kTriangleGroup) {
        in.count = static_cast<uint32_t>(std::min<size_t>(kTriangleGroup, primitives_.size() - first));
        for (uint32_t n = 0; n < in.count; ++n) in.triangles[n] = primitives_[first + n].vertex.data();
        setUp(in, group_);
        statistics_.clippingPrimitives += static_cast<uint32_t>(std::popcount(group_.counted & ~group_.ordinary));
        for (uint32_t rest = group_.ordinary | group_.small; rest != 0; rest &= rest - 1) {
            const auto n = static_cast<uint32_t>(std::countr_zero(rest));
            const LocalPrimitive& primitive = primitives_[first + n];
            if ((group_.ordinary >> n & 1) != 0) {
                assemblePrimitive(draw, drawIndex, primitive, 3, chunk);
                continue;
            }
            const PrimitiveInfo info{drawIndex, primitive.primitiveId,
                                     attributesOf(primitive.vertex[primitive.provoking]), draw.viewIndex, 0};
            setup_.addSmallTriangle(draw, info, group_, n, primitive.vertex.data(), vertices_);
        }
    }
}

void Assembler::assemble(const PreparedDraw& draw, uint32_t drawIndex, Chunk& chunk) {
    const uint32_t vertexCount = verticesPerPrimitive(draw.plan->rasterTopology);
    if (vertexCount == 3 && draw.packsSmall && draw.state->polygonMode == VK_POLYGON_MODE_FILL &&
        !draw.state->depthBiasEnable && !draw.state->rasterizerDiscard && !isRouted() && vertices_.culled.empty())
        return assembleTriangles(draw, drawIndex, chunk);
    const bool stippled = draw.stipples && vertexCount == 2;
    for (const LocalPrimitive& primitive : primitives_) {
        if (stippled && primitive.startsStrip) setup_.restartStipple();
        assemblePrimitive(draw, drawIndex, primitive, vertexCount, chunk);
    }
}

/// Gives every primitive copies of its vertices with what is of the primitive alone: weights, and values of its other
/// vertices. Vulkan, "Barycentric Interpolation", numbers vertices so that the provoking one comes first, or last where
/// it is the last of a primitive; the others follow in the order of the topology.
void Assembler::giveOwnVertices(const PreparedDraw& draw, uint32_t vertexCount, Chunk& chunk) {
    std::vector<uint32_t> chosen;
    chosen.reserve(primitives_.size() * vertexCount);
    for (LocalPrimitive& primitive : primitives_) {
        for (uint32_t n = 0; n < vertexCount; ++n) {
            chosen.push_back(primitive.vertex[n]);
            primitive.vertex[n] = static_cast<uint32_t>(chosen.size() - 1);
        }
    }
    vertices_.choose(chosen, *draw.plan, chunk);
    const std::vector<Varying>& varyings = draw.plan->varyings;
    for (const LocalPrimitive& primitive : primitives_) {
        const uint32_t first = primitive.provoking + (draw.state->provokingVertexLast ? 1 : 0);
        std::array<float*, 3> numbered{};
        for (uint32_t n = 0; n < vertexCount; ++n)
            numbered[n] = chunk.attributes.data() + attributesOf(primitive.vertex[(first + n) % vertexCount]);
        for (size_t k = 0; k < varyings.size(); ++k) {
            if (varyings[k].source == Varying::Source::vertex) continue;
            const bool weight = varyings[k].source == Varying::Source::weight;
            float value;  // whatever its type is
            std::memcpy(&value, numbered[std::min<uint32_t>(varyings[k].number, vertexCount - 1)] + k, sizeof value);
            for (uint32_t n = 0; n < vertexCount; ++n) {
                if (weight) value = n == varyings[k].number ? 1.0f : 0.0f;
                std::memcpy(numbered[n] + k, &value, sizeof value);
            }
        }
    }
}

bool Assembler::run(std::span<const PreparedDraw> draws, uint64_t token, std::span<const PrimitiveRange> ranges,
                    const TileGrid& grid, Chunk& chunk) {
    bool finished = true;
    chunk.clear();
    uint32_t primitives = 0;
    for (const PrimitiveRange& range : ranges) primitives += range.count;
    setup_.begin(chunk, grid, primitives);
    grid_ = grid;
    for (const PrimitiveRange& range : ranges) {
        const PreparedDraw& draw = draws[range.draw];
        if (draw.plan->stages) {
            finished &= runStages(draw, token + range.draw, range, chunk);
        } else {
            number(draw, range);
            finished &= shadeVertices(draw, token + range.draw, refs_, contexts_, vertices_, chunk);
            statistics_.vertexInvocations += refs_.size();
        }
        if (draw.plan->ownVertices) giveOwnVertices(draw, verticesPerPrimitive(draw.plan->rasterTopology), chunk);
        statistics_.inputPrimitives += range.count;
        statistics_.clippingInvocations += primitives_.size();
        if (!draw.plan->stages) {
            statistics_.generatedPrimitives[0] += range.count;
            if (draw.call.capture != nullptr) capture(draw, range.first);
        } else if (draw.call.capture != nullptr) {
            captureStages(draw, range.draw, chunk);
        }
        assemble(draw, range.draw, chunk);
    }
    setup_.finish();
    statistics_.rasterPrimitives += chunk.primitives.size();
    return finished;
}

}  // namespace vernier
