// What geometry hands to the rasteriser: primitives on the sub-pixel grid with their attributes, sorted by
// tile. A chunk is the work of one thread on a run of primitives; chunks are numbered in submission order.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/raw_vector.h"
#include "runtime/limits.h"

namespace vernier {

/// Pixels on a side. 64 rows of 64 RGBA8 and D32 texels fill a 32 KiB first-level cache. Builds with smaller tiles
/// (scripts/same-bits) show that no pixel depends on it.
#ifdef VERNIER_TILE_SIZE
inline constexpr int32_t kTileSize = VERNIER_TILE_SIZE;
#else
inline constexpr int32_t kTileSize = 64;
#endif
inline constexpr int kTileBits = std::countr_zero(static_cast<uint32_t>(kTileSize));
static_assert(kTileSize == 1 << kTileBits && kTileSize >= 16 && kTileSize <= 64);
inline constexpr int32_t kBlockSize = 8;
inline constexpr uint32_t kChunkPrimitives = 1024;

// Bit budget. Window coordinates span kGuardBandMax + 1 - kGuardBandMin = 2^15 pixels, so at b sub-pixel bits
// the components of an edge have 15 + b bits and an edge function, twice the area of a triangle inside that
// square, at most 2 * (15 + b) bits: 62 at the finest grid.
static_assert(kGuardBandMax + 1 - kGuardBandMin == 1 << 15);
inline constexpr int kMaxSubPixelBits = 16;
static_assert(2 * (15 + kMaxSubPixelBits) < 63);

/// What a point or a line covers. Lengths are in sub-units where nothing else is said.
struct Shape {
    enum class Kind : uint8_t {
        square,     // a point
        rectangle,  // a line with square ends
        smooth,     // the same, and whatever it touches, with the area as alpha
        bresenham,  // a row of pixels (diamond exit)
    };
    Kind kind = Kind::square;
    std::array<int64_t, 4> sides{};          // square: left, top, right, bottom
    int32_t ax = 0, ay = 0, bx = 0, by = 0;  // the segment
    // rectangle, smooth: |2 cross(p - a, b - a)| <= reach, the greatest integer not above width * length. `sharp`: it
    // is exactly that, and points on the long sides are ties.
    int64_t reach = 0;
    bool sharp = false;
    // bresenham: pixels along the major axis, in the order in which they are drawn, and how many across.
    bool yMajor = false;
    int32_t first = 0, count = 0, step = 1, width = 1;
    double stippleStart = 0;  // the counter at the segment's start
};
inline constexpr uint32_t kNoShape = ~0u;

/// A triangle with vertices in canonical order: the one with the least (y, x) first, then clockwise on the
/// screen (y down). The order of submission cannot be told from it, so neither can it change a pixel. Or a point or a
/// line: then `shape` says what it covers, x and y have its ends in the order of submission, and the third vertex is
/// the first again.
struct Primitive {
    std::array<int32_t, 3> x, y;  // sub-units of 2^-b pixel
    std::array<float, 3> z;       // window depth
    std::array<float, 3> w;       // 1 / w_clip, times 2^-wExponent
    float depthBias;
    std::array<uint32_t, 3> attributes;  // first float of each vertex in Chunk::attributes
    uint32_t flat;                       // the same of the provoking vertex
    std::array<int16_t, 4> bounds;       // pixels that may be covered: x0, y0, x1, y1, inclusive, scissored
    uint32_t draw;                       // index among the prepared draws
    uint32_t primitiveId;
    uint32_t shape;              // index in Chunk::shapes; kNoShape: a triangle
    std::array<float, 3> point;  // of a point: centre x, y and 1 / size, in pixels
    int16_t wExponent;
    uint16_t layer;    // of the attachments; with multiview, the view
    uint8_t viewport;  // index
    bool front;
    bool affine;      // all w equal
    bool smallEdges;  // edge components below 2^kSmallEdgeBits: 32-bit edge functions
    bool tiny;        // edge components up to 2^kTinyEdgeBits
    bool small;  // tiny or a point, bounds of at most kSmallExtent pixels on a side, wExponent 0; and the draw packs
                 // such primitives. A point has no shape then: it covers its bounds
    bool isPoint;
};

/// Edge components up to 2^23 keep the edge function, divided by the sub-pixel scale, in 32 bits all over a
/// tile: within a tile it changes by less than 2 * 64 * 2^23 = 2^30, and an edge that crosses the tile is
/// zero somewhere in it.
inline constexpr int kSmallEdgeBits = 23;
static_assert((int64_t{2} * kTileSize << kSmallEdgeBits) <= (int64_t{1} << 30));

/// Edge components up to 2^12 (16 pixels at 8 sub-pixel bits) keep products with distances inside a tile (up to 2^6
/// pixels, the primitive's own extent, and one pixel more), and their sums, in 32 bits as they are.
inline constexpr int kTinyEdgeBits = 12, kTinySubPixelBits = 8;
static_assert(int64_t{4} * (kTileSize + 17) << (kTinySubPixelBits + kTinyEdgeBits) < int64_t{1} << 31);

/// Pixels on a side that a small primitive's bounds have at most.
inline constexpr int32_t kSmallExtent = 8;

/// A run of Chunk::entries that lie in one tile. `large`: some of them may cover a large part of it.
struct TileRange {
    uint32_t tile = 0, first = 0, count = 0;
    bool large = false;
};

/// Whether the bounds inside a tile, in pixels, are a large part of it.
constexpr bool isLargePart(int32_t width, int32_t height) {
    return width * height >= kTileSize * kTileSize / 8;
}

/// An entry is the index of a primitive; this bit says that it covers the tile completely.
inline constexpr uint32_t kCoversTile = 1u << 31;

/// What transform feedback takes of primitives that stages have made, in their order.
struct CapturedPrimitives {
    uint32_t draw = 0;  // index among the prepared draws
    uint32_t stream = 0;
    uint32_t verticesPerPrimitive = 1;
    uint32_t primitives = 0;
    std::vector<uint32_t> words;  // by vertex: the outputs of the stream, as CapturePlan has them
};

struct Chunk {
    RawVector<Primitive> primitives;
    std::vector<CapturedPrimitives> captured;
    std::vector<Shape> shapes;
    // Line stipple goes on through a strip, and a strip through chunks. The first `continuingShapes` count from where
    // the chunk before ended (all of them unless `restartsStipple`); stippleEnd is the counter at the end of this one.
    uint32_t continuingShapes = 0;
    bool restartsStipple = false;
    double stippleEnd = 0;
    RawVector<float> attributes;
    RawVector<uint32_t> entries;
    std::vector<TileRange> ranges;

    void clear() {
        primitives.clear();
        captured.clear();
        shapes.clear();
        continuingShapes = 0;
        restartsStipple = false;
        stippleEnd = 0;
        attributes.clear();
        entries.clear();
        ranges.clear();
    }
    size_t bytes() const {
        return primitives.size() * sizeof(Primitive) + shapes.size() * sizeof(Shape) +
               attributes.size() * sizeof(float) + entries.size() * sizeof(uint32_t);
    }
};

}  // namespace vernier
