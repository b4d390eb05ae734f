// From window vertices to primitives in a chunk, and from primitives to tiles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/geometry/chunk.h"
#include "runtime/geometry/prepared_draw.h"
#include "runtime/geometry/small_triangles.h"
#include "runtime/geometry/vertex_stage.h"

namespace vernier {

inline constexpr float kMinPointSize = 1.0f, kMaxPointSize = 256.0f;
inline constexpr float kMinLineWidth = 1.0f, kMaxLineWidth = 64.0f;

/// The tiles of a render area: tile (0, 0) of the grid has its first pixel at (x0, y0), a multiple of
/// kTileSize.
struct TileGrid {
    int32_t x0 = 0, y0 = 0;
    uint32_t columns = 0, rows = 0;
    uint32_t layers = 1;
    bool anyLayer = false;  // primitives of all layers go to the same tiles, of the one layer there is
    uint32_t perLayer() const { return columns * rows; }
    /// Tiles are numbered row by row, and layer by layer.
    uint32_t count() const { return perLayer() * layers; }
    uint32_t firstTile(uint32_t layer) const { return anyLayer ? 0 : layer * perLayer(); }
    /// Whether primitives of the layer are drawn.
    bool draws(uint32_t layer) const { return anyLayer ? layer <= UINT16_MAX : layer < layers; }
};

/// The least grid of whole tiles around an area that lies at or below coordinate 0.
TileGrid tileGridOf(const VkRect2D& area);

struct WindowVertex {
    int32_t x = 0, y = 0;  // sub-units
    float z = 0;
    double inverseW = 1;
    uint32_t attributes = 0;
    float pointSize = 1;  // as the vertex program gives it
};

/// What all triangles of one primitive of a draw have in common.
struct PrimitiveInfo {
    uint32_t draw = 0;
    uint32_t primitiveId = 0;
    uint32_t flat = 0;  // attributes of the provoking vertex
    uint32_t layer = 0, viewport = 0;
};

/// Fills one chunk. One per thread; keeps its scratch memory.
class PrimitiveSetup {
  public:
    /// `primitives`: how many are expected.
    void begin(Chunk& chunk, const TileGrid& grid, uint32_t primitives);
    /// A convex polygon of at least three vertices, in order: culled, then drawn as the polygon mode says. Bit n of
    /// `hiddenEdges`: the edge from vertex n to the next is no edge of the primitive.
    void addPolygon(const PreparedDraw& draw, const PrimitiveInfo& info, std::span<const WindowVertex> polygon,
                    uint32_t hiddenEdges = 0);
    /// addPolygon() of a triangle that was not clipped.
    void addTriangle(const PreparedDraw& draw, const PrimitiveInfo& info, const std::array<WindowVertex, 3>& vertices);
    /// Triangle n of a group, one of TriangleGroup::small. `numbers`: of its vertices.
    void addSmallTriangle(const PreparedDraw& draw, const PrimitiveInfo& info, const TriangleGroup& group, uint32_t n,
                          const uint32_t* numbers, const ShadedVertices& vertices);
    /// A segment of a line list or strip.
    void addLine(const PreparedDraw& draw, const PrimitiveInfo& info, const WindowVertex& a, const WindowVertex& b);
    /// Line stipple starts anew: before every segment of a list, and before a strip.
    void restartStipple();
    /// A square around a centre in pixels, not snapped.
    void addPoint(const PreparedDraw& draw, const PrimitiveInfo& info, const WindowVertex& vertex, double x, double y);
    /// Sorts what was added by tile.
    void finish();

  private:
    struct Entry {
        uint32_t tile, primitive;
    };
    struct Style {  // of the triangles of one primitive
        bool front = true;
        float depthBias = 0;
        const PixelRect* area = nullptr;
    };
    void addFilled(const PreparedDraw& draw, const PrimitiveInfo& info, const Style& style, const WindowVertex& a,
                   const WindowVertex& b, const WindowVertex& c, int64_t area);
    void addSegment(const PreparedDraw& draw, const PrimitiveInfo& info, const Style& style, const WindowVertex& a,
                    const WindowVertex& b);
    void addSquare(const PreparedDraw& draw, const PrimitiveInfo& info, const Style& style, const WindowVertex& vertex,
                   double x, double y);
    bool addSmallSquare(const PreparedDraw& draw, const PrimitiveInfo& info, const Style& style,
                        const WindowVertex& vertex, double x, double y, double size);
    Primitive& addPrimitive(const PrimitiveInfo& info, const Style& style,
                            const std::array<const WindowVertex*, 3>& vertices, const std::array<int32_t, 4>& bounds);
    void addShape(const PreparedDraw& draw, const PrimitiveInfo& info, const Style& style, const Shape& shape,
                  const WindowVertex& a, const WindowVertex& b, const std::array<float, 3>* point);
    void bin(const Primitive& primitive, uint32_t index, const PreparedDraw& draw);
    void binShape(const Primitive& primitive, const Shape& shape, uint32_t index, uint32_t subPixelBits);
    uint32_t column(int32_t x) const { return static_cast<uint32_t>((x - grid_.x0) / kTileSize); }
    uint32_t row(int32_t y) const { return static_cast<uint32_t>((y - grid_.y0) / kTileSize); }
    void addEntry(uint32_t tile, uint32_t entry, bool large);

    Chunk* chunk_ = nullptr;
    TileGrid grid_;
    std::vector<Entry> entries_;
    struct TileCount {
        uint32_t entries = 0;
        bool large = false;
    };
    std::vector<TileCount> perTile_;  // zero between chunks
    std::vector<uint32_t> touched_;
    double stipple_ = 0;  // the counter of line stipple, in pixels
};

/// Twice the signed area; positive when clockwise on the screen (y down).
inline int64_t doubleArea(const WindowVertex& a, const WindowVertex& b, const WindowVertex& c) {
    const int64_t abx = int64_t{b.x} - a.x, aby = int64_t{b.y} - a.y;
    const int64_t acx = int64_t{c.x} - a.x, acy = int64_t{c.y} - a.y;
    return abx * acy - aby * acx;
}

}  // namespace vernier
