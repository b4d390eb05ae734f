#include "runtime/geometry/primitive_setup.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "runtime/geometry/depth_bias.h"
#include "runtime/geometry/shapes.h"

namespace vernier {
namespace {

/// The power of two to divide 1/w by so that float can hold it: 0 in all ordinary cases.
int16_t exponentOf(double largest) {
    constexpr int kOrdinary = 60;
    const int exponent = static_cast<int>(std::bit_cast<uint64_t>(largest) >> 52 & 0x7FF) - 1023;
    return std::abs(exponent) > kOrdinary ? static_cast<int16_t>(exponent) : int16_t{0};
}

double powerOfTwo(int exponent) {
    return std::bit_cast<double>(static_cast<uint64_t>(exponent + 1023) << 52);
}

/// Pixels whose centres, or any part of which (`anywhere`), lie between two coordinates in sub-units.
void pixelBounds(int32_t low, int32_t high, uint32_t bits, bool anywhere, int32_t& first, int32_t& last) {
    const int32_t half = anywhere ? 0 : 1 << (bits - 1);
    first = anywhere ? low >> bits : (low - half + (1 << bits) - 1) >> bits;
    last = (high - half) >> bits;
}

bool culled(VkCullModeFlags mode, bool front) {
    return (mode & static_cast<VkCullModeFlags>(front ? VK_CULL_MODE_FRONT_BIT : VK_CULL_MODE_BACK_BIT)) != 0;
}

bool isSmall(const std::array<int16_t, 4>& bounds) {
    return bounds[2] - bounds[0] < kSmallExtent && bounds[3] - bounds[1] < kSmallExtent;
}

bool before(const WindowVertex& a, const WindowVertex& b) {
    return a.y != b.y ? a.y < b.y : a.x < b.x;
}

}  // namespace

TileGrid tileGridOf(const VkRect2D& area) {
    const auto tile = [](uint32_t pixel) { return pixel / kTileSize; };
    const auto x = static_cast<uint32_t>(area.offset.x), y = static_cast<uint32_t>(area.offset.y);
    TileGrid grid;
    grid.x0 = static_cast<int32_t>(tile(x) * kTileSize);
    grid.y0 = static_cast<int32_t>(tile(y) * kTileSize);
    grid.columns = tile(x + area.extent.width + kTileSize - 1) - tile(x);
    grid.rows = tile(y + area.extent.height + kTileSize - 1) - tile(y);
    return grid;
}

void PrimitiveSetup::begin(Chunk& chunk, const TileGrid& grid, uint32_t primitives) {
    chunk_ = &chunk;
    grid_ = grid;
    entries_.clear();
    touched_.clear();
    stipple_ = 0;
    if (perTile_.size() < grid.count()) perTile_.resize(grid.count());
    // Most draws add a primitive for each of the chunk's; growing step by step would copy them several times.
    if (primitives > chunk.primitives.capacity()) chunk.primitives.reserve(primitives);
}

void PrimitiveSetup::addPolygon(const PreparedDraw& draw, const PrimitiveInfo& info,
                                std::span<const WindowVertex> polygon, uint32_t hiddenEdges) {
    // A fan over a clipped polygon has one facing: that of the whole. Snapping can turn a sliver of the fan
    // over; it is dropped rather than drawn twice.
    int64_t area = 0;
    for (size_t n = 2; n < polygon.size(); ++n) area += doubleArea(polygon[0], polygon[n - 1], polygon[n]);
    if (area == 0) return;
    Style style;
    style.front = (area > 0) == (draw.state->frontFace == VK_FRONT_FACE_CLOCKWISE);
    if (culled(draw.state->cullMode, style.front)) return;
    style.area = &draw.viewport(info.viewport).triangleArea;
    if (draw.state->depthBiasEnable) {
        size_t largest = 2;
        for (size_t n = 3; n < polygon.size(); ++n)
            if (std::abs(doubleArea(polygon[0], polygon[n - 1], polygon[n])) >
                std::abs(doubleArea(polygon[0], polygon[largest - 1], polygon[largest])))
                largest = n;
        style.depthBias = depthBias(draw, polygon, polygon[0], polygon[largest - 1], polygon[largest]);
    }
    switch (draw.state->polygonMode) {
        case VK_POLYGON_MODE_LINE:
            if (draw.stipples) restartStipple();
            for (size_t n = 0; n < polygon.size(); ++n)
                if ((hiddenEdges >> n & 1) == 0)
                    addSegment(draw, info, style, polygon[n], polygon[(n + 1) % polygon.size()]);
            return;
        case VK_POLYGON_MODE_POINT: {
            const double subUnits = static_cast<double>(1u << draw.subPixelBits);
            for (const WindowVertex& v : polygon) addSquare(draw, info, style, v, v.x / subUnits, v.y / subUnits);
            return;
        }
        default:
            break;
    }
    for (size_t n = 2; n < polygon.size(); ++n) {
        const int64_t part = doubleArea(polygon[0], polygon[n - 1], polygon[n]);
        if (part != 0 && (part > 0) == (area > 0))
            addFilled(draw, info, style, polygon[0], polygon[n - 1], polygon[n], part);
    }
}

void PrimitiveSetup::addTriangle(const PreparedDraw& draw, const PrimitiveInfo& info,
                                 const std::array<WindowVertex, 3>& vertices) {
    if (draw.state->polygonMode != VK_POLYGON_MODE_FILL || draw.state->depthBiasEnable)
        return addPolygon(draw, info, vertices);
    const int64_t area = doubleArea(vertices[0], vertices[1], vertices[2]);
    if (area == 0) return;
    Style style;
    style.front = (area > 0) == (draw.state->frontFace == VK_FRONT_FACE_CLOCKWISE);
    if (culled(draw.state->cullMode, style.front)) return;
    style.area = &draw.viewport(info.viewport).triangleArea;
    addFilled(draw, info, style, vertices[0], vertices[1], vertices[2], area);
}

void PrimitiveSetup::addSmallTriangle(const PreparedDraw& draw, const PrimitiveInfo& info, const TriangleGroup& group,
                                      uint32_t n, const uint32_t* numbers, const ShadedVertices& vertices) {
    const auto index = static_cast<uint32_t>(chunk_->primitives.size());
    Primitive& p = chunk_->primitives.emplace_back();
    for (size_t corner = 0; corner < 3; ++corner) {
        const uint32_t vertex = numbers[group.corner[corner][n]];
        p.x[corner] = group.x[corner][n];
        p.y[corner] = group.y[corner][n];
        p.z[corner] = vertices.z[vertex];
        p.w[corner] = static_cast<float>(vertices.inverseW[vertex]);
        p.attributes[corner] = vertices.attributesOf(vertex);
    }
    p.affine = p.w[0] == p.w[1] && p.w[1] == p.w[2];
    p.depthBias = 0;
    p.flat = info.flat;
    std::memcpy(p.bounds.data(), &group.low[n], 4);
    std::memcpy(p.bounds.data() + 2, &group.high[n], 4);
    p.draw = info.draw;
    p.primitiveId = info.primitiveId;
    p.shape = kNoShape;
    p.wExponent = 0;
    p.layer = static_cast<uint16_t>(info.layer);
    p.viewport = static_cast<uint8_t>(info.viewport);
    p.front = (group.front >> n & 1) != 0;
    p.smallEdges = p.tiny = p.small = true;
    p.isPoint = false;
    if ((group.spread >> n & 1) != 0) return bin(p, index, draw);
    addEntry(grid_.firstTile(p.layer) + static_cast<uint32_t>(group.tile[n]), index, false);
}

void PrimitiveSetup::addLine(const PreparedDraw& draw, const PrimitiveInfo& info, const WindowVertex& a,
                             const WindowVertex& b) {
    Style style;
    style.area = &draw.viewport(info.viewport).area;
    addSegment(draw, info, style, a, b);
}

void PrimitiveSetup::addPoint(const PreparedDraw& draw, const PrimitiveInfo& info, const WindowVertex& vertex, double x,
                              double y) {
    Style style;
    style.area = &draw.viewport(info.viewport).area;
    addSquare(draw, info, style, vertex, x, y);
}

void PrimitiveSetup::restartStipple() {
    if (!chunk_->restartsStipple) chunk_->continuingShapes = static_cast<uint32_t>(chunk_->shapes.size());
    chunk_->restartsStipple = true;
    stipple_ = 0;
}

void PrimitiveSetup::addSegment(const PreparedDraw& draw, const PrimitiveInfo& info, const Style& style,
                                const WindowVertex& a, const WindowVertex& b) {
    const uint32_t bits = draw.subPixelBits;
    const std::array<int32_t, 2> from{a.x, a.y}, to{b.x, b.y};
    const double width = std::clamp(double{draw.call.dynamic->lineWidth}, double{kMinLineWidth}, double{kMaxLineWidth});
    const VkLineRasterizationModeEXT mode = draw.state->lineMode;
    const bool pixels = mode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    Shape shape =
        pixels ? bresenhamShape(from, to, width, bits)
               : rectangleShape(from, to, width, bits, mode == VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT);
    shape.stippleStart = stipple_;
    if (draw.stipples) stipple_ += pixels ? shape.count : segmentLength(shape, bits);
    if ((pixels && shape.count == 0) || from == to) return;
    addShape(draw, info, style, shape, a, b, nullptr);
}

void PrimitiveSetup::addSquare(const PreparedDraw& draw, const PrimitiveInfo& info, const Style& style,
                               const WindowVertex& vertex, double x, double y) {
    const float size = vertex.pointSize;
    const double clamped = size >= kMinPointSize ? std::min(size, kMaxPointSize) : kMinPointSize;  // NaN: the least
    const std::array<float, 3> point{static_cast<float>(x), static_cast<float>(y), static_cast<float>(1 / clamped)};
    if (draw.packsSmall && addSmallSquare(draw, info, style, vertex, x, y, clamped)) return;
    addShape(draw, info, style, squareShape(x, y, clamped, draw.subPixelBits), vertex, vertex, &point);
}

/// A point of a few pixels, as its bounds alone: with one sample in the middle, the pixels that it covers are a
/// rectangle. Returns false when it has to be added otherwise.
bool PrimitiveSetup::addSmallSquare(const PreparedDraw& draw, const PrimitiveInfo& info, const Style& style,
                                    const WindowVertex& vertex, double x, double y, double size) {
    if (size > kSmallExtent || exponentOf(vertex.inverseW) != 0) return false;
    const Shape shape = squareShape(x, y, size, draw.subPixelBits);
    const uint32_t bits = draw.subPixelBits;
    // The first pixel whose centre is not before a side.
    const auto pixelAt = [bits](int64_t side) {
        const int64_t half = int64_t{1} << (bits - 1);
        return static_cast<int32_t>(std::clamp<int64_t>((side + half - 1) >> bits, kGuardBandMin, kGuardBandMax));
    };
    const std::array<int32_t, 4> bounds{
        std::max(pixelAt(shape.sides[0]), style.area->x0), std::max(pixelAt(shape.sides[1]), style.area->y0),
        std::min(pixelAt(shape.sides[2]), style.area->x1) - 1, std::min(pixelAt(shape.sides[3]), style.area->y1) - 1};
    if (bounds[0] > bounds[2] || bounds[1] > bounds[3]) return true;
    if (bounds[2] - bounds[0] >= kSmallExtent || bounds[3] - bounds[1] >= kSmallExtent) return false;
    const auto index = static_cast<uint32_t>(chunk_->primitives.size());
    Primitive& p = addPrimitive(info, style, {&vertex, &vertex, &vertex}, bounds);
    p.shape = kNoShape;
    p.isPoint = p.small = true;
    const uint32_t tx0 = column(bounds[0]), tx1 = column(bounds[2]), ty0 = row(bounds[1]), ty1 = row(bounds[3]);
    for (uint32_t ty = ty0; ty <= ty1; ++ty)
        for (uint32_t tx = tx0; tx <= tx1; ++tx)
            addEntry(grid_.firstTile(p.layer) + ty * grid_.columns + tx, index, false);
    return true;
}

void PrimitiveSetup::addShape(const PreparedDraw& draw, const PrimitiveInfo& info, const Style& style,
                              const Shape& shape, const WindowVertex& a, const WindowVertex& b,
                              const std::array<float, 3>* point) {
    std::array<int32_t, 4> bounds = shapeBounds(shape, draw.subPixelBits);
    bounds = {std::max(bounds[0], style.area->x0), std::max(bounds[1], style.area->y0),
              std::min(bounds[2], style.area->x1 - 1), std::min(bounds[3], style.area->y1 - 1)};
    if (bounds[0] > bounds[2] || bounds[1] > bounds[3]) return;
    const auto index = static_cast<uint32_t>(chunk_->primitives.size());
    const auto shapeIndex = static_cast<uint32_t>(chunk_->shapes.size());
    chunk_->shapes.push_back(shape);
    Primitive& p = addPrimitive(info, style, {&a, &b, &a}, bounds);
    p.shape = shapeIndex;
    p.isPoint = point != nullptr;
    p.point = p.isPoint ? *point : std::array<float, 3>{};
    binShape(p, shape, index, draw.subPixelBits);
}

/// What triangles, points and lines have in common; the caller sets the rest.
Primitive& PrimitiveSetup::addPrimitive(const PrimitiveInfo& info, const Style& style,
                                        const std::array<const WindowVertex*, 3>& vertices,
                                        const std::array<int32_t, 4>& bounds) {
    Primitive& p = chunk_->primitives.emplace_back();
    double inverseW[3];
    for (size_t n = 0; n < 3; ++n) {
        const WindowVertex& vertex = *vertices[n];
        p.x[n] = vertex.x;
        p.y[n] = vertex.y;
        p.z[n] = vertex.z;
        p.attributes[n] = vertex.attributes;
        inverseW[n] = vertex.inverseW;
    }
    p.wExponent = exponentOf(std::max(std::max(inverseW[0], inverseW[1]), inverseW[2]));
    const double scale = powerOfTwo(-p.wExponent);
    for (size_t n = 0; n < 3; ++n) p.w[n] = static_cast<float>(inverseW[n] * scale);
    p.affine = p.w[0] == p.w[1] && p.w[1] == p.w[2];
    p.depthBias = style.depthBias;
    p.flat = info.flat;
    for (size_t n = 0; n < 4; ++n) p.bounds[n] = static_cast<int16_t>(bounds[n]);
    p.draw = info.draw;
    p.primitiveId = info.primitiveId;
    p.layer = static_cast<uint16_t>(info.layer);
    p.viewport = static_cast<uint8_t>(info.viewport);
    p.front = style.front;
    p.smallEdges = p.tiny = p.small = p.isPoint = false;
    return p;
}

/// `area`: twice the signed area, not 0.
void PrimitiveSetup::addFilled(const PreparedDraw& draw, const PrimitiveInfo& info, const Style& style,
                               const WindowVertex& a, const WindowVertex& b, const WindowVertex& c, int64_t area) {
    const uint32_t bits = draw.subPixelBits;
    int32_t x0, x1, y0, y1;
    pixelBounds(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), bits, !draw.samplesAtCentre, x0, x1);
    pixelBounds(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), bits, !draw.samplesAtCentre, y0, y1);
    x0 = std::max(x0, style.area->x0);
    y0 = std::max(y0, style.area->y0);
    x1 = std::min(x1, style.area->x1 - 1);
    y1 = std::min(y1, style.area->y1 - 1);
    if (x0 > x1 || y0 > y1) return;

    const WindowVertex* v[3] = {&a, area > 0 ? &b : &c, area > 0 ? &c : &b};
    const int least = before(*v[1], *v[0]) ? (before(*v[2], *v[1]) ? 2 : 1) : (before(*v[2], *v[0]) ? 2 : 0);

    const auto index = static_cast<uint32_t>(chunk_->primitives.size());
    Primitive& p = addPrimitive(info, style, {v[least], v[(least + 1) % 3], v[(least + 2) % 3]}, {x0, y0, x1, y1});
    p.shape = kNoShape;
    const auto span = [](const std::array<int32_t, 3>& values) {
        return int64_t{std::max({values[0], values[1], values[2]})} - std::min({values[0], values[1], values[2]});
    };
    const int64_t extent = std::max(span(p.x), span(p.y));
    p.smallEdges = extent <= int64_t{1} << kSmallEdgeBits;
    p.tiny = bits <= kTinySubPixelBits && extent <= int64_t{1} << kTinyEdgeBits;
    p.small = p.tiny && draw.packsSmall && p.wExponent == 0 && isSmall(p.bounds);
    bin(p, index, draw);
}

void PrimitiveSetup::bin(const Primitive& p, uint32_t index, const PreparedDraw& draw) {
    const uint32_t subPixelBits = draw.subPixelBits;
    const bool mayCoverTiles = draw.viewport(p.viewport).sampleAreas.empty();
    const uint32_t firstTile = grid_.firstTile(p.layer);
    const uint32_t tx0 = column(p.bounds[0]), tx1 = column(p.bounds[2]);
    const uint32_t ty0 = row(p.bounds[1]), ty1 = row(p.bounds[3]);
    const bool spansTile = p.bounds[2] - p.bounds[0] == kTileSize - 1 && p.bounds[3] - p.bounds[1] == kTileSize - 1;
    if (tx0 == tx1 && ty0 == ty1 && !spansTile) {
        const bool large = isLargePart(p.bounds[2] - p.bounds[0] + 1, p.bounds[3] - p.bounds[1] + 1);
        addEntry(firstTile + ty0 * grid_.columns + tx0, index, large);
        return;
    }
    // Edge functions at the corner of the first tile, and how far they change over one tile.
    int64_t corner[3], stepX[3], stepY[3];
    const int64_t tileUnits = int64_t{kTileSize} << subPixelBits;
    const int64_t cx = (grid_.x0 + static_cast<int64_t>(tx0) * kTileSize) * (int64_t{1} << subPixelBits);
    const int64_t cy = (grid_.y0 + static_cast<int64_t>(ty0) * kTileSize) * (int64_t{1} << subPixelBits);
    for (int e = 0; e < 3; ++e) {
        const int next = (e + 1) % 3;
        const int64_t a = int64_t{p.y[e]} - p.y[next], b = int64_t{p.x[next]} - p.x[e];
        corner[e] = a * (cx - p.x[e]) + b * (cy - p.y[e]);
        stepX[e] = a * tileUnits;
        stepY[e] = b * tileUnits;
    }
    for (uint32_t ty = ty0; ty <= ty1; ++ty) {
        for (uint32_t tx = tx0; tx <= tx1; ++tx) {
            bool outside = false, inside = true;
            for (int e = 0; e < 3; ++e) {
                const int64_t value = corner[e] + stepX[e] * (tx - tx0) + stepY[e] * (ty - ty0);
                outside |= value + std::max<int64_t>(stepX[e], 0) + std::max<int64_t>(stepY[e], 0) < 0;
                // An edge through a corner of the tile still has every sample, which lie inside the tile, on one side.
                inside &= value + std::min<int64_t>(stepX[e], 0) + std::min<int64_t>(stepY[e], 0) >= 0;
            }
            if (outside) continue;
            const int32_t x = grid_.x0 + static_cast<int32_t>(tx) * kTileSize;
            const int32_t y = grid_.y0 + static_cast<int32_t>(ty) * kTileSize;
            inside &= p.bounds[0] <= x && p.bounds[1] <= y && p.bounds[2] >= x + kTileSize - 1 &&
                      p.bounds[3] >= y + kTileSize - 1;
            const int32_t width = std::min(p.bounds[2] - x, kTileSize - 1) - std::max(p.bounds[0] - x, 0) + 1;
            const int32_t height = std::min(p.bounds[3] - y, kTileSize - 1) - std::max(p.bounds[1] - y, 0) + 1;
            addEntry(firstTile + ty * grid_.columns + tx, index | (inside && mayCoverTiles ? kCoversTile : 0),
                     isLargePart(width, height));
        }
    }
}

/// A line is handed to the tiles near it, a point to all that its bounds touch.
void PrimitiveSetup::binShape(const Primitive& p, const Shape& shape, uint32_t index, uint32_t subPixelBits) {
    const uint32_t firstTile = grid_.firstTile(p.layer);
    const double unit = static_cast<double>(1u << subPixelBits), half = 0.5 * kTileSize * unit;
    const double dx = double(shape.bx) - shape.ax, dy = double(shape.by) - shape.ay;
    // The farthest that a covered place can be from the segment's line, times the segment's length.
    const double length = segmentLength(shape, subPixelBits) * unit;
    const double band = (std::abs(dx) + std::abs(dy)) * half + (kMaxLineWidth + 2) * unit * length;
    for (uint32_t ty = row(p.bounds[1]); ty <= row(p.bounds[3]); ++ty) {
        for (uint32_t tx = column(p.bounds[0]); tx <= column(p.bounds[2]); ++tx) {
            const double cx = (grid_.x0 + static_cast<double>(tx) * kTileSize) * unit + half;
            const double cy = (grid_.y0 + static_cast<double>(ty) * kTileSize) * unit + half;
            const bool near = std::abs((cx - shape.ax) * dy - (cy - shape.ay) * dx) <= band;
            if (shape.kind == Shape::Kind::square || near) addEntry(firstTile + ty * grid_.columns + tx, index, false);
        }
    }
}

void PrimitiveSetup::addEntry(uint32_t tile, uint32_t entry, bool large) {
    TileCount& count = perTile_[tile];
    if (count.entries++ == 0) touched_.push_back(tile);
    count.large |= large;
    entries_.push_back({tile, entry});
}

void PrimitiveSetup::finish() {
    chunk_->stippleEnd = stipple_;
    uint32_t first = 0;
    for (const uint32_t tile : touched_) {
        TileCount& tileCount = perTile_[tile];
        chunk_->ranges.push_back({tile, first, tileCount.entries, tileCount.large});
        const uint32_t count = tileCount.entries;
        tileCount.entries = first;  // from here on: where the tile's next entry goes
        first += count;
    }
    chunk_->entries.resize(entries_.size());
    for (const Entry& entry : entries_) chunk_->entries[perTile_[entry.tile].entries++] = entry.primitive;
    for (const uint32_t tile : touched_) perTile_[tile] = {};
}

}  // namespace vernier
