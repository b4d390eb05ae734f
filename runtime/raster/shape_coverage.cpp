#include "runtime/raster/shape_coverage.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "runtime/geometry/shapes.h"
#include "runtime/raster/bits.h"

namespace vernier {
namespace {

/// The pixels of a primitive's bounds inside a tile, inclusive, relative to the tile.
struct Window {
    int32_t x0, y0, x1, y1;
};

Window windowOf(const Primitive& p, int32_t tileX, int32_t tileY) {
    return {std::max(p.bounds[0] - tileX, 0), std::max(p.bounds[1] - tileY, 0),
            std::min(p.bounds[2] - tileX, kTileSize - 1), std::min(p.bounds[3] - tileY, kTileSize - 1)};
}

/// Calls function(block), which fills the masks of a block whose place is set and returns their union.
template <class Function>
uint32_t eachBlock(const Window& window, BlockCoverage* blocks, const Function& function) {
    uint32_t count = 0;
    for (int32_t y = window.y0 & ~(kBlockSize - 1); y <= window.y1; y += kBlockSize) {
        for (int32_t x = window.x0 & ~(kBlockSize - 1); x <= window.x1; x += kBlockSize) {
            blocks[count].x = x;
            blocks[count].y = y;
            if (function(blocks[count]) != 0) ++count;
        }
    }
    return count;
}

/// The pixels of a block inside the window.
uint64_t windowMask(const Window& window, const BlockCoverage& block) {
    return rectangleBits(window.x0 - block.x, window.y0 - block.y, window.x1 + 1 - block.x, window.y1 + 1 - block.y);
}

uint32_t coverSquare(const PreparedDraw& draw, const Window& window, const Shape& shape, int32_t tileX, int32_t tileY,
                     BlockCoverage* blocks) {
    // By sample: the pixels whose samples lie in [left, right) x [top, bottom).
    std::array<std::array<int32_t, 4>, kMaxSamples> pixels;
    const uint32_t bits = draw.subPixelBits;
    const auto first = [bits](int64_t side, uint32_t place16, int32_t origin) {
        const int64_t place = int64_t{place16} << (bits - 4), pixel = (side - place + (int64_t{1} << bits) - 1) >> bits;
        return static_cast<int32_t>(std::clamp<int64_t>(pixel - origin, -1, kTileSize + 1));
    };
    for (uint32_t s = 0; s < draw.plan->samples; ++s) {
        const uint32_t x = draw.positions[s].x16, y = draw.positions[s].y16;
        pixels[s] = {first(shape.sides[0], x, tileX), first(shape.sides[1], y, tileY), first(shape.sides[2], x, tileX),
                     first(shape.sides[3], y, tileY)};
    }
    return eachBlock(window, blocks, [&](BlockCoverage& block) {
        const uint64_t inside = windowMask(window, block);
        uint64_t any = 0;
        for (uint32_t s = 0; s < draw.plan->samples; ++s) {
            const auto& p = pixels[s];
            block.masks[s] = inside & rectangleBits(p[0] - block.x, p[1] - block.y, p[2] - block.x, p[3] - block.y);
            any |= block.masks[s];
        }
        return any;
    });
}

/// Whether the stipple pattern draws at a count of `s` ("Line Stipple": bit floor(s / r) mod 16).
bool stippleBit(const DynamicState& dynamic, uint64_t s) {
    const uint32_t factor = std::clamp(dynamic.lineStippleFactor, 1u, 256u);
    return (dynamic.lineStipplePattern >> (s / factor % 16) & 1) != 0;
}

/// Keeps the places of a rectangular line that its stipple pattern draws: unit-length pieces along the segment.
class RectangleStipple {
  public:
    RectangleStipple(const PreparedDraw& draw, const Shape& shape)
        : draw_(draw),
          shape_(shape),
          unit_(1 / static_cast<double>(1u << draw.subPixelBits)),
          length_(segmentLength(shape, draw.subPixelBits)),
          ux_((double(shape.bx) - shape.ax) * unit_ / length_),
          uy_((double(shape.by) - shape.ay) * unit_ / length_) {}

    bool draws(double x, double y) const {
        const double along = (x - shape_.ax * unit_) * ux_ + (y - shape_.ay * unit_) * uy_;
        const double counter = shape_.stippleStart + std::clamp(along, 0.0, length_);
        return stippleBit(*draw_.call.dynamic, static_cast<uint64_t>(counter));
    }
    /// Of the pixels `mask` of the block whose first pixel is (x, y), at a place inside them.
    uint64_t keep(uint64_t mask, int32_t x, int32_t y, float placeX, float placeY) const {
        uint64_t kept = 0;
        for (uint64_t rest = mask; rest != 0; rest &= rest - 1) {
            const int bit = std::countr_zero(rest);
            if (draws(double(x + (bit & 7)) + double{placeX}, double(y + (bit >> 3)) + double{placeY}))
                kept |= uint64_t{1} << bit;
        }
        return kept;
    }

  private:
    const PreparedDraw& draw_;
    const Shape& shape_;
    double unit_, length_, ux_, uy_;
};

/// The sides of a rectangle as the edges of a tile.
TileEdges edgesOf(const PreparedDraw& draw, const Window& window, const std::array<HalfPlane, 4>& sides, int32_t tileX,
                  int32_t tileY) {
    __extension__ using Wide = __int128;
    const uint32_t bits = draw.subPixelBits, samples = draw.plan->samples;
    TileEdges edges;
    edges.samples = samples;
    edges.x0 = window.x0;
    edges.y0 = window.y0;
    edges.x1 = window.x1;
    edges.y1 = window.y1;
    edges.fourEdges = true;
    edges.smallEdges = true;
    for (size_t e = 0; e < 4; ++e) {
        const HalfPlane& side = sides[e];
        edges.a[e] = side.a;
        edges.b[e] = side.b;
        edges.smallEdges &= std::max(std::abs(side.a), std::abs(side.b)) <= int64_t{1} << kSmallEdgeBits;
        for (uint32_t s = 0; s < samples; ++s) {
            const int64_t x = (int64_t{tileX} << bits) + (int64_t{draw.positions[s].x16} << (bits - 4)) - side.x0;
            const int64_t y = (int64_t{tileY} << bits) + (int64_t{draw.positions[s].y16} << (bits - 4)) - side.y0;
            edges.c[e][s] = static_cast<int64_t>((Wide{side.a} * x + Wide{side.b} * y + side.c) >> bits);
        }
    }
    return edges;
}

uint32_t coverRectangle(const PreparedDraw& draw, const Window& window, const Shape& shape, int32_t tileX,
                        int32_t tileY, BlockCoverage* blocks) {
    const CoverTileFn cover = coverTileFunction(draw.call.pipeline->isa());
    const uint32_t count = cover(edgesOf(draw, window, rectangleSides(shape), tileX, tileY), blocks);
    if (!draw.stipples) return count;
    const uint32_t samples = draw.plan->samples;
    const RectangleStipple stipple(draw, shape);
    uint32_t kept = 0;
    for (uint32_t n = 0; n < count; ++n) {
        uint64_t any = 0;
        for (uint32_t s = 0; s < samples; ++s) {
            uint64_t& mask = blocks[n].masks[s];
            mask = stipple.keep(mask, tileX + blocks[n].x, tileY + blocks[n].y, draw.positions[s].x(),
                                draw.positions[s].y());
            any |= mask;
        }
        if (any != 0) moveBlock(blocks, n, kept++, samples);
    }
    return kept;
}

/// Sets all samples of the pixels.
uint64_t coverPixels(BlockCoverage& block, uint32_t samples, uint64_t mask) {
    std::fill_n(block.masks.begin(), samples, mask);
    return mask;
}

uint32_t coverSmooth(const PreparedDraw& draw, const Window& window, const Shape& shape, int32_t tileX, int32_t tileY,
                     BlockCoverage* blocks) {
    const RectangleStipple stipple(draw, shape);
    return eachBlock(window, blocks, [&](BlockCoverage& block) {
        uint64_t mask = 0;
        for (uint64_t rest = windowMask(window, block); rest != 0; rest &= rest - 1) {
            const int bit = std::countr_zero(rest);
            const int32_t x = tileX + block.x + (bit & 7), y = tileY + block.y + (bit >> 3);
            if (coveredArea(shape, x, y, draw.subPixelBits) > 0 && (!draw.stipples || stipple.draws(x + 0.5, y + 0.5)))
                mask |= uint64_t{1} << bit;
        }
        return coverPixels(block, draw.plan->samples, mask);
    });
}

uint32_t coverBresenham(const PreparedDraw& draw, const Window& window, const Shape& shape, int32_t tileX,
                        int32_t tileY, BlockCoverage* blocks) {
    std::array<uint64_t, kBlocksPerTile> masks{};
    constexpr int32_t kColumns = kTileSize / kBlockSize;
    const int32_t majorOrigin = shape.yMajor ? tileY : tileX, minorOrigin = shape.yMajor ? tileX : tileY;
    const int32_t low = shape.yMajor ? window.y0 : window.x0, high = shape.yMajor ? window.y1 : window.x1;
    for (int32_t at = low; at <= high; ++at) {
        const int32_t number = (majorOrigin + at - shape.first) * shape.step;
        if (number < 0 || number >= shape.count) continue;
        if (draw.stipples &&
            !stippleBit(*draw.call.dynamic, static_cast<uint64_t>(shape.stippleStart) + static_cast<uint64_t>(number)))
            continue;
        const int32_t minor = bresenhamMinor(shape, majorOrigin + at, draw.subPixelBits) - minorOrigin;
        for (int32_t n = std::max(minor, 0); n < std::min(minor + shape.width, kTileSize); ++n) {
            const int32_t x = shape.yMajor ? n : at, y = shape.yMajor ? at : n;
            masks[static_cast<size_t>(y / kBlockSize * kColumns + x / kBlockSize)] |=
                uint64_t{1} << (y % kBlockSize * kBlockSize + x % kBlockSize);
        }
    }
    return eachBlock(window, blocks, [&](BlockCoverage& block) {
        const auto index = static_cast<size_t>(block.y / kBlockSize * kColumns + block.x / kBlockSize);
        return coverPixels(block, draw.plan->samples, masks[index] & windowMask(window, block));
    });
}

}  // namespace

uint32_t coverShape(const PreparedDraw& draw, const Primitive& primitive, const Shape& shape, int32_t tileX,
                    int32_t tileY, BlockCoverage* blocks) {
    const Window window = windowOf(primitive, tileX, tileY);
    switch (shape.kind) {
        case Shape::Kind::square:
            return coverSquare(draw, window, shape, tileX, tileY, blocks);
        case Shape::Kind::rectangle:
            return coverRectangle(draw, window, shape, tileX, tileY, blocks);
        case Shape::Kind::smooth:
            return coverSmooth(draw, window, shape, tileX, tileY, blocks);
        default:
            return coverBresenham(draw, window, shape, tileX, tileY, blocks);
    }
}

}  // namespace vernier
