// Primitive assembly: from runs of draws to a chunk of primitives.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/geometry/clip.h"
#include "runtime/geometry/primitive_setup.h"
#include "runtime/geometry/tessellation_stage.h"
#include "runtime/geometry/vertex_stage.h"

namespace vernier {

/// Primitives [first, first + count) of a draw, numbered through its instances.
struct PrimitiveRange {
    uint32_t draw = 0;
    uint64_t first = 0;
    uint32_t count = 0;
};

struct GeometryStatistics {
    uint64_t inputPrimitives = 0, vertexInvocations = 0, clippingInvocations = 0, clippingPrimitives = 0;
    uint64_t clippedPrimitives = 0, rasterPrimitives = 0;
    uint64_t controlPatches = 0, evaluationInvocations = 0;
    uint64_t geometryInvocations = 0, geometryPrimitives = 0;
    std::array<uint64_t, ir::kVertexStreams> generatedPrimitives{};  // by vertex stream
};

/// One thread's geometry.
class Assembler {
  public:
    ContextCache& contexts() { return contexts_; }
    /// Processes the ranges into `chunk`. `draws` are those that PrimitiveRange::draw names; `token` numbers
    /// the bindings of the first of them, the next has token + 1, and so on. Returns false when a program ran
    /// out of its loop budget.
    bool run(std::span<const PreparedDraw> draws, uint64_t token, std::span<const PrimitiveRange> ranges,
             const TileGrid& grid, Chunk& chunk);
    GeometryStatistics& statistics() { return statistics_; }

  private:
    void number(const PreparedDraw& draw, const PrimitiveRange& range);
    template <class T>
    void numberList(const PreparedDraw& draw, uint32_t first, uint32_t count, uint32_t& least, uint32_t& greatest);
    static bool isPlainList(const PreparedDraw& draw, uint32_t first, uint32_t count, size_t bytes);
    void numberInputs(const PreparedDraw& draw, const PrimitiveRange& range);
    void takeTessellated(const PreparedDraw& draw);
    bool runStages(const PreparedDraw& draw, uint64_t token, const PrimitiveRange& range, Chunk& chunk);
    static std::vector<VertexRun>::const_iterator runAt(const PreparedDraw& draw, uint32_t primitive) {
        return std::upper_bound(draw.runs.begin(), draw.runs.end(), primitive,
                                [](uint32_t value, const VertexRun& run) { return value < run.firstPrimitive; }) -
               1;
    }
    /// gl_VertexIndex of a vertex or index of the draw.
    static uint32_t vertexIndex(const DrawCall& call, bool indexed, uint32_t number) {
        return indexed ? fetchIndex(call, number) + static_cast<uint32_t>(call.vertexOffset) : call.first + number;
    }
    void startReuse();
    uint32_t localVertex(const VertexRef& ref);
    void reuseByIndex(uint32_t least, uint32_t instance, uint32_t vertexCount);
    void capture(const PreparedDraw& draw, uint64_t first) const;
    void captureStages(const PreparedDraw& draw, uint32_t drawIndex, Chunk& chunk) const;
    void assemble(const PreparedDraw& draw, uint32_t drawIndex, Chunk& chunk);
    void assembleTriangles(const PreparedDraw& draw, uint32_t drawIndex, Chunk& chunk);
    void assemblePrimitive(const PreparedDraw& draw, uint32_t drawIndex, const LocalPrimitive& primitive,
                           uint32_t vertexCount, Chunk& chunk);
    void clipAndAdd(const PreparedDraw& draw, const PrimitiveInfo& info, const LocalPrimitive& primitive,
                    uint32_t vertexCount, Chunk& chunk);
    void addPoint(const PreparedDraw& draw, const PrimitiveInfo& info, uint32_t vertex);
    bool route(const PreparedDraw& draw, uint32_t provoking, PrimitiveInfo& info) const;
    WindowVertex windowVertex(uint32_t vertex) const;
    std::array<WindowVertex, 3> windowVertices(const LocalPrimitive& triangle) const {
        return {windowVertex(triangle.vertex[0]), windowVertex(triangle.vertex[1]), windowVertex(triangle.vertex[2])};
    }
    void giveOwnVertices(const PreparedDraw& draw, uint32_t vertexCount, Chunk& chunk);
    bool isRouted() const { return !vertices_.layers.empty() || !vertices_.viewports.empty(); }
    uint32_t attributesOf(uint32_t vertex) const { return vertices_.attributesOf(vertex); }
    float pointSizeOf(uint32_t vertex) const {
        return vertices_.pointSize.empty() ? 1.0f : vertices_.pointSize[vertex];
    }

    // Reuse of vertices inside a range: by index where these lie close together; else open addressing, twice as many
    // places as a range can have vertices.
    struct ReuseSlot {
        VertexRef ref{};
        uint32_t local = 0;
        uint32_t epoch = 0;
    };
    static constexpr uint32_t kReuseSlots = 8192;
    static_assert(kReuseSlots >= 2 * 3 * kChunkPrimitives);
    static constexpr uint32_t kMaxInputVertices = kMaxPatchVertices;  // of a primitive or patch

    ContextCache contexts_;
    PrimitiveSetup setup_;
    ShadedVertices vertices_;
    std::vector<VertexRef> refs_;
    std::vector<LocalPrimitive> primitives_;
    StagePrimitives inputs_;  // of the first stage behind the vertices
    TessellationStage tessellation_;
    StagePrimitives tessellated_;
    StageVertices outputs_;  // of the last stage before the rasteriser
    VertexStreams otherStreams_;
    std::vector<ReuseSlot> reuse_ = std::vector<ReuseSlot>(kReuseSlots);
    uint32_t epoch_ = 0;
    TileGrid grid_;
    TriangleGroup group_;
    GeometryStatistics statistics_;
};

}  // namespace vernier
