#include "runtime/raster/coverage.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/raster/coverage.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The edges that still matter over a rectangle of pixels, in one integer width.
template <class T, int kEdges>
struct Edges {
    T a[kEdges], b[kEdges];
    T c[kEdges][kMaxSamples];
};

/// Drops edges that have all of the rectangle inside; returns false when one has all of it outside.
template <class T, int kEdges>
bool selectEdges(const TileEdges& in, Edges<T, kEdges>& out) {
    for (size_t e = 0; e < kEdges; ++e) {
        int64_t low = in.c[e][0], high = low;
        for (uint32_t s = 1; s < in.samples; ++s) {
            low = std::min(low, in.c[e][s]);
            high = std::max(high, in.c[e][s]);
        }
        const int64_t ax0 = in.a[e] * in.x0, ax1 = in.a[e] * in.x1, by0 = in.b[e] * in.y0, by1 = in.b[e] * in.y1;
        if (high + std::max(ax0, ax1) + std::max(by0, by1) < 0) return false;
        const bool inside = low + std::min(ax0, ax1) + std::min(by0, by1) >= 0;
        out.a[e] = inside ? T{0} : static_cast<T>(in.a[e]);
        out.b[e] = inside ? T{0} : static_cast<T>(in.b[e]);
        for (uint32_t s = 0; s < in.samples; ++s) out.c[e][s] = inside ? T{0} : static_cast<T>(in.c[e][s]);
    }
    return true;
}

uint64_t rectangleMask(int32_t x0, int32_t y0, int32_t x1, int32_t y1) {
    const uint64_t row = (0xFFu >> (7 - x1)) & (0xFFu << x0);
    const uint64_t rows = (~uint64_t{0} >> (8 * (7 - y1))) & (~uint64_t{0} << (8 * y0));
    return rows & (row * 0x0101010101010101u);
}

/// first, first + step, first + 2 * step, ...
template <class D>
HWY_INLINE hn::Vec<D> rowOfEdge(D d, int32_t first, int32_t step) {
    return hn::Add(hn::Set(d, first), hn::Mul(hn::Iota(d, 0), hn::Set(d, step)));
}
template <class D>
HWY_INLINE hn::Vec<D> rowOfEdge(D d, int64_t first,
                                int64_t step) {  // not every target multiplies 64-bit lanes
    alignas(64) int64_t row[hn::MaxLanes(D())];
    for (size_t n = 0; n < hn::MaxLanes(D()); ++n) row[n] = first + step * static_cast<int64_t>(n);
    return hn::Load(d, row);
}

/// Pixels [.., y0..y1] of a block whose first pixel has the edge values `c`.
template <class T, int kEdges>
uint64_t blockMask(const T* c, const T* a, const T* b, int32_t y0, int32_t y1) {
    const hn::CappedTag<T, 8> d;
    using V = hn::Vec<decltype(d)>;
    constexpr uint32_t kLanes = hn::MaxLanes(hn::CappedTag<T, 8>());
    uint64_t outside = 0;  // the sign bit of any edge
    for (uint32_t x = 0; x < 8; x += kLanes) {
        V edge[kEdges], step[kEdges];
        for (int e = 0; e < kEdges; ++e) {
            edge[e] = rowOfEdge(d, static_cast<T>(c[e] + b[e] * y0 + a[e] * static_cast<T>(x)), a[e]);
            step[e] = hn::Set(d, b[e]);
        }
        for (int32_t y = y0; y <= y1; ++y) {
            V sign = hn::Or(hn::Or(edge[0], edge[1]), edge[2]);
            if constexpr (kEdges == 4) sign = hn::Or(sign, edge[3]);
            uint8_t bits[8] = {};
            hn::StoreMaskBits(d, hn::Lt(sign, hn::Zero(d)), bits);
            outside |= static_cast<uint64_t>(bits[0]) << (8 * y + x);
            for (int e = 0; e < kEdges; ++e) edge[e] = hn::Add(edge[e], step[e]);
        }
    }
    return ~outside;
}

template <class T, int kEdges>
uint32_t cover(const TileEdges& in, BlockCoverage* blocks) {
    static_assert(kEdges == 3 || kEdges == 4);
    Edges<T, kEdges> edges;
    if (!selectEdges(in, edges)) return 0;
    const int32_t bx0 = in.x0 & ~7, bx1 = in.x1 & ~7, by0 = in.y0 & ~7, by1 = in.y1 & ~7;
    // Whole-block tests pay when there are many blocks.
    const bool classify = (bx1 - bx0) + (by1 - by0) > 2 * kBlockSize;
    uint32_t count = 0;
    for (int32_t by = by0; by <= by1; by += kBlockSize) {
        for (int32_t bx = bx0; bx <= bx1; bx += kBlockSize) {
            const int32_t x0 = std::max(in.x0 - bx, 0), x1 = std::min(in.x1 - bx, 7);
            const int32_t y0 = std::max(in.y0 - by, 0), y1 = std::min(in.y1 - by, 7);
            const uint64_t rectangle = rectangleMask(x0, y0, x1, y1);
            BlockCoverage& block = blocks[count];
            uint64_t any = 0;
            for (uint32_t s = 0; s < in.samples; ++s) {
                T c[kEdges];
                bool outside = false, inside = true;
                for (int e = 0; e < kEdges; ++e) {
                    c[e] = static_cast<T>(edges.c[e][s] + edges.a[e] * bx + edges.b[e] * by);
                    if (!classify) continue;
                    const T a7 = edges.a[e] * 7, b7 = edges.b[e] * 7;
                    outside |= c[e] + std::max<T>(a7, 0) + std::max<T>(b7, 0) < 0;
                    inside &= c[e] + std::min<T>(a7, 0) + std::min<T>(b7, 0) >= 0;
                }
                uint64_t mask = 0;
                if (classify && inside) {
                    mask = rectangle;
                } else if (!outside) {
                    mask = blockMask<T, kEdges>(c, edges.a, edges.b, y0, y1) & rectangle;
                }
                block.masks[s] = mask;
                any |= mask;
            }
            if (any == 0) continue;
            block.x = bx;
            block.y = by;
            ++count;
        }
    }
    return count;
}

uint32_t coverTile(const TileEdges& edges, BlockCoverage* blocks) {
    if (edges.fourEdges) return edges.smallEdges ? cover<int32_t, 4>(edges, blocks) : cover<int64_t, 4>(edges, blocks);
    return edges.smallEdges ? cover<int32_t, 3>(edges, blocks) : cover<int64_t, 3>(edges, blocks);
}

// --- Tiny primitives: few blocks, all in 32 bits

using Tiny = hn::CappedTag<int32_t, 16>;
constexpr uint32_t kTinyLanes = hn::MaxLanes(Tiny());
/// A vector is part of a row of a block, or as many rows as it has room for.
constexpr int32_t kTinyColumns = kTinyLanes < 8 ? kTinyLanes : 8, kTinyRows = kTinyLanes < 8 ? 1 : kTinyLanes / 8;

struct TinyTable {
    alignas(64) int32_t column[kTinyLanes], row[kTinyLanes];
};

constexpr TinyTable tinyTable() {
    TinyTable table{};
    for (uint32_t lane = 0; lane < kTinyLanes; ++lane) {
        table.column[lane] = static_cast<int32_t>(lane % kTinyColumns);
        table.row[lane] = static_cast<int32_t>(lane / kTinyColumns);
    }
    return table;
}

uint32_t coverTiny(const TinyInput& in, BlockCoverage* blocks) {
    static constexpr TinyTable kTable = tinyTable();
    const Tiny d;
    using V = hn::Vec<Tiny>;
    const Primitive& p = *in.primitive;
    const int32_t left = std::max(p.bounds[0] - in.tileX, 0), right = std::min(p.bounds[2] - in.tileX, kTileSize - 1);
    const int32_t top = std::max(p.bounds[1] - in.tileY, 0), bottom = std::min(p.bounds[3] - in.tileY, kTileSize - 1);
    // The place of the sample of pixel (0, 0) of the tile.
    const uint32_t sixteenth = in.subPixelBits - 4;
    const int32_t originX = (in.tileX << in.subPixelBits) + (int32_t{in.position.x16} << sixteenth);
    const int32_t originY = (in.tileY << in.subPixelBits) + (int32_t{in.position.y16} << sixteenth);
    int32_t a[3], b[3], c[3];  // as in TileEdges
    V slope[3], step[3];
    for (int e = 0; e < 3; ++e) {
        const int next = e == 2 ? 0 : e + 1;
        const int32_t dx = p.x[next] - p.x[e], dy = p.y[next] - p.y[e];
        a[e] = -dy;
        b[e] = dx;
        const int32_t value = dx * (originY - p.y[e]) - dy * (originX - p.x[e]) - (isTopLeft(dx, dy) ? 0 : 1);
        c[e] = value >> in.subPixelBits;
        slope[e] = hn::Add(hn::Mul(hn::Load(d, kTable.column), hn::Set(d, a[e])),
                           hn::Mul(hn::Load(d, kTable.row), hn::Set(d, b[e])));
        step[e] = hn::Set(d, b[e] * kTinyRows);
    }
    uint32_t count = 0;
    for (int32_t by = top & ~7; by <= bottom; by += kBlockSize) {
        const int32_t y0 = std::max(top - by, 0), y1 = std::min(bottom - by, 7), first = y0 & ~(kTinyRows - 1);
        for (int32_t bx = left & ~7; bx <= right; bx += kBlockSize) {
            uint64_t outside = 0;  // the sign bit of any edge
            for (int32_t x = 0; x < kBlockSize; x += kTinyColumns) {
                V edge[3];
                for (int e = 0; e < 3; ++e)
                    edge[e] = hn::Add(slope[e], hn::Set(d, c[e] + a[e] * (bx + x) + b[e] * (by + first)));
                for (int32_t y = first; y <= y1; y += kTinyRows) {
                    const V sign = hn::Or(hn::Or(edge[0], edge[1]), edge[2]);
                    uint8_t bytes[8] = {};
                    hn::StoreMaskBits(d, hn::Lt(sign, hn::Zero(d)), bytes);
                    outside |= (bytes[0] | uint64_t{bytes[1]} << 8) << (8 * y + x);
                    for (int e = 0; e < 3; ++e) edge[e] = hn::Add(edge[e], step[e]);
                }
            }
            const uint64_t mask = ~outside & rectangleMask(std::max(left - bx, 0), y0, std::min(right - bx, 7), y1);
            if (mask == 0) continue;
            blocks[count].x = bx;
            blocks[count].y = by;
            blocks[count++].masks[0] = mask;
        }
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {

CoverTileFn coverTileFunction(Isa isa){VERNIER_SELECT_ISA(isa, coverTile)}

CoverTinyFn coverTinyFunction(Isa isa){VERNIER_SELECT_ISA(isa, coverTiny)}

uint32_t coverWholeTile(uint32_t samples, BlockCoverage* blocks) {
    uint32_t count = 0;
    for (int32_t y = 0; y < kTileSize; y += kBlockSize) {
        for (int32_t x = 0; x < kTileSize; x += kBlockSize) {
            BlockCoverage& block = blocks[count++];
            block.x = x;
            block.y = y;
            for (uint32_t s = 0; s < samples; ++s) block.masks[s] = ~uint64_t{0};
        }
    }
    return count;
}

}  // namespace vernier
#endif
