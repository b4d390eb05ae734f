#include "runtime/raster/tile_renderer.h"

#include <algorithm>
#include <bit>

#include "runtime/raster/attachment_ops.h"
#include "runtime/raster/bits.h"
#include "runtime/raster/depth_test.h"
#include "runtime/raster/shape_coverage.h"

namespace vernier {
namespace {

/// Early tests one sample at a time, where depth bounds take part.
uint32_t testSamples(const DepthStencilState& state, const TrianglePlanes& planes, int32_t tileX, int32_t tileY,
                     uint32_t samples, const SamplePosition* positions, BlockCoverage* blocks, uint32_t count) {
    uint32_t kept = 0;
    for (uint32_t b = 0; b < count; ++b) {
        BlockCoverage& block = blocks[b];
        uint64_t any = 0;
        for (uint32_t s = 0; s < samples; ++s) {
            uint64_t passed = 0;
            for (uint64_t rest = block.masks[s]; rest != 0; rest &= rest - 1) {
                const int bit = std::countr_zero(rest);
                const int32_t x = tileX + block.x + (bit & 7), y = tileY + block.y + (bit >> 3);
                const float z = depthAt(planes, x, y, positions[s].x(), positions[s].y());
                if (testSample(state, state.target.texel(x, y, s), z, planes.primitive->front))
                    passed |= uint64_t{1} << bit;
            }
            block.masks[s] = passed;
            any |= passed;
        }
        if (any != 0) moveBlock(blocks, b, kept++, samples);
    }
    return kept;
}

/// The sample mask of the pipeline; drops blocks that have nothing left.
uint32_t maskSamples(uint32_t mask, uint32_t samples, BlockCoverage* blocks, uint32_t count) {
    uint32_t kept = 0;
    for (uint32_t b = 0; b < count; ++b) {
        uint64_t any = 0;
        for (uint32_t s = 0; s < samples; ++s) {
            if ((mask >> s & 1) == 0) blocks[b].masks[s] = 0;
            any |= blocks[b].masks[s];
        }
        if (any != 0) moveBlock(blocks, b, kept++, samples);
    }
    return kept;
}

/// Keeps of each sample the pixels inside its rectangle; drops blocks that have nothing left.
uint32_t cutSamples(const std::vector<PixelRect>& areas, int32_t tileX, int32_t tileY, BlockCoverage* blocks,
                    uint32_t count) {
    const auto samples = static_cast<uint32_t>(areas.size());
    uint32_t kept = 0;
    for (uint32_t b = 0; b < count; ++b) {
        uint64_t any = 0;
        for (uint32_t s = 0; s < samples; ++s) {
            const PixelRect& area = areas[s];
            const int32_t x = tileX + blocks[b].x, y = tileY + blocks[b].y;
            any |= blocks[b].masks[s] &= rectangleBits(area.x0 - x, area.y0 - y, area.x1 - x, area.y1 - y);
        }
        if (any != 0) moveBlock(blocks, b, kept++, samples);
    }
    return kept;
}

/// So many small primitives are drawn together, at least; what fewer would gain is less than what it costs.
constexpr uint32_t kFewestSmall = 4;

/// Entries of a tile whose primitives are asked for ahead; and whose shapes, which the primitives tell.
constexpr uint32_t kAhead = 16, kShapesAhead = 6;

const Primitive& primitiveOf(const TileWork& item, uint32_t n) {
    return item.chunk->primitives[item.chunk->entries[n] & ~kCoversTile];
}

/// All the lines of an object.
template <class T>
void prefetch(const T& object) {
    constexpr size_t kLine = 64;
    const auto* bytes = reinterpret_cast<const std::byte*>(&object);
    for (size_t at = 0; at < sizeof(T); at += kLine) __builtin_prefetch(bytes + at);
    __builtin_prefetch(bytes + sizeof(T) - 1);
}

/// Goes through the entries of a tile in front of whoever draws them.
class Ahead {
  public:
    Ahead(std::span<const TileWork> work, size_t item, uint32_t entry) : work_(work), item_(item), entry_(entry) {}

    /// Calls visit(item, n) for the next entry, if there is one.
    template <class Visit>
    void next(const Visit& visit) {
        for (; item_ < work_.size(); ++item_, entry_ = 0) {
            const TileWork& item = work_[item_];
            if (item.chunk == nullptr) continue;
            entry_ = std::max(entry_, item.first);
            if (entry_ < item.first + item.count) return visit(item, entry_++);
        }
    }

  private:
    std::span<const TileWork> work_;
    size_t item_;
    uint32_t entry_;
};

void prefetchPrimitive(const TileWork& item, uint32_t n) {
    prefetch(primitiveOf(item, n));
}

/// What a primitive covers that is no triangle.
void prefetchShape(const TileWork& item, uint32_t n) {
    const Primitive& primitive = primitiveOf(item, n);
    if (primitive.shape != kNoShape) prefetch(item.chunk->shapes[primitive.shape]);
}

/// Where the primitives are told of the items behind those that are looked at already.
void prefetchEntries(std::span<const TileWork> work, size_t index) {
    constexpr size_t kItems = 8;
    if (index + kItems < work.size() && work[index + kItems].chunk != nullptr)
        __builtin_prefetch(work[index + kItems].chunk->entries.data() + work[index + kItems].first);
}

/// Where the pixel of a bit lies, as part of a SmallFragment.
constexpr std::array<SmallFragment, 64> placesOfBits() {
    std::array<SmallFragment, 64> places{};
    for (uint32_t bit = 0; bit < 64; ++bit) places[bit] = smallFragment(bit % 8, bit / 8, 0);
    return places;
}
constexpr std::array<SmallFragment, 64> kPlaceOfBit = placesOfBits();

/// Pixels of a tile by block: at most four blocks have some of an area of 8x8.
struct BlockParts {
    /// Bit 8 y + x of `area`: pixel (left + x, top + y) of the tile.
    BlockParts(uint32_t left, uint32_t top, uint64_t area) {
        constexpr uint32_t kColumns = kTileSize / kBlockSize;
        const uint32_t first = top / 8 * kColumns + left / 8, x = left % 8, y = top % 8;
        const uint64_t leftColumns = (0xFFull >> x) * 0x0101010101010101u;
        const uint64_t upper = area << (8 * y), lower = y == 0 ? 0 : area >> (64 - 8 * y);
        if (((upper & ~leftColumns) | lower) == 0) {
            add(first, upper << x);
            return;
        }
        add(first, (upper & leftColumns) << x);
        add(first + 1, (upper & ~leftColumns) >> (8 - x));
        add(first + kColumns, (lower & leftColumns) << x);
        add(first + kColumns + 1, (lower & ~leftColumns) >> (8 - x));
    }
    void add(uint32_t block, uint64_t part) {
        if (part == 0) return;
        blocks[count] = block;
        pixels[count++] = part;
    }

    uint32_t count = 0;
    uint32_t blocks[4];
    uint64_t pixels[4];
};

uint64_t countSamples(const BlockCoverage* blocks, uint32_t count, uint32_t samples) {
    uint64_t total = 0;
    for (uint32_t b = 0; b < count; ++b)
        for (uint32_t s = 0; s < samples; ++s) total += countBits(blocks[b].masks[s]);
    return total;
}

}  // namespace

void applyClear(const PassTargets& targets, const ClearCommand& clear, const PixelRect& area) {
    const PixelRect rect{std::max(clear.rect.x0, area.x0), std::max(clear.rect.y0, area.y0),
                         std::min(clear.rect.x1, area.x1), std::min(clear.rect.y1, area.y1)};
    if (rect.empty()) return;
    if ((clear.aspects & VK_IMAGE_ASPECT_COLOR_BIT) != 0) {
        if (clear.color < targets.colorCount)
            clearPixels(targets.colors[clear.color], VK_IMAGE_ASPECT_COLOR_BIT, clear.value, rect, 0);
    } else {
        clearPixels(targets.depthStencil, clear.aspects, clear.value, rect, 0);
    }
}

void TileRenderer::startPass(const PassTargets& targets) {
    pass_ = targets_ = &targets;
    layer_ = 0;
    fragments_.startPass(targets);
}

/// Makes `layer` the one that is drawn to.
void TileRenderer::selectLayer(uint32_t layer) {
    layer_ = layer;
    targets_ = pass_;
    if (layer != 0) {
        layerTargets_ = *pass_;
        const auto shift = [&](RenderTarget& target) {
            if (target.data != nullptr) target.data += layer * target.layerPitch;
        };
        for (uint32_t c = 0; c < layerTargets_.colorCount; ++c) shift(layerTargets_.colors[c]);
        shift(layerTargets_.depthStencil);
        targets_ = &layerTargets_;
    }
    fragments_.setTargets(*targets_);
}

uint32_t TileRenderer::testEarly(const PreparedDraw& draw, const TrianglePlanes& planes, uint32_t count) {
    const Plan& plan = *draw.plan;
    const DepthStencilState& state = fragments_.depthState();
    PassStatistics& statistics = fragments_.statistics();
    // Stencil operations happen for hidden samples, too.
    const bool coarse = plan.depth.test && !plan.depth.stencil && plan.skips.has(Skip::coarseDepth);
    uint64_t certain = 0;
    if (coarse) {
        const uint32_t left =
            coarse_.reject(plan.depth, planes, tileX_, tileY_, plan.samples, blocks_.data(), count, certain);
        statistics.coarseDepthRejects += count - left;
        count = left;
    }
    if (plan.depth.bounds) certain = 0;
    for (uint32_t b = 0; b < count; ++b)
        if ((certain >> blockIndex(blocks_[b]) & 1) == 0)
            statistics.depthReads += countSamples(&blocks_[b], 1, plan.samples);
    if (plan.depth.bounds) {
        count = testSamples(state, planes, tileX_, tileY_, plan.samples, draw.positions, blocks_.data(), count);
    } else {
        const DepthTestInput input{
            &plan.depth, state.target, &planes,        tileX_,
            tileY_,      plan.samples, draw.positions, planes.primitive->front ? &state.front : &state.back,
            certain};
        const Isa isa = draw.call.pipeline->isa();
        const DepthTestFn test = plan.depth.stencil ? stencilTestFunction(isa) : depthTestFunction(isa);
        count = test(input, blocks_.data(), count);
    }
    if (plan.depth.write) coarse_.update(plan.depth, planes, tileX_, tileY_, plan.samples, blocks_.data(), count);
    return count;
}

/// Where the test comes late: drops what cannot pass it.
uint32_t TileRenderer::rejectEarly(const PreparedDraw& draw, const TrianglePlanes& planes, uint32_t count) {
    const Plan& plan = *draw.plan;
    DepthPlan reading = plan.depth;
    reading.write = false;
    uint64_t certain = 0;
    const uint32_t left = coarse_.reject(reading, planes, tileX_, tileY_, plan.samples, blocks_.data(), count, certain);
    fragments_.statistics().coarseDepthRejects += count - left;
    const DepthTestInput input{
        &reading, fragments_.depthState().target, &planes, tileX_, tileY_, plan.samples, draw.positions, nullptr,
        certain};
    return depthTestFunction(draw.call.pipeline->isa())(input, blocks_.data(), left);
}

void TileRenderer::draw(const Primitive& primitive, const Chunk& chunk, const PreparedDraw& draw, bool coversTile) {
    const Plan& plan = *draw.plan;
    // What interpolation reads comes while coverage and depth are worked out.
    if (!plan.varyings.empty())
        for (const uint32_t vertex : primitive.attributes) __builtin_prefetch(chunk.attributes.data() + vertex);
    uint32_t count = 0;
    const Shape* shape = primitive.shape == kNoShape ? nullptr : &chunk.shapes[primitive.shape];
    if (shape != nullptr) {
        count = coverShape(draw, primitive, *shape, tileX_, tileY_, blocks_.data());
    } else if (coversTile) {
        count = coverWholeTile(plan.samples, blocks_.data());
    } else if (primitive.tiny && plan.samples == 1) {
        const TinyInput input{&primitive, tileX_, tileY_, draw.subPixelBits, draw.positions[0]};
        count = coverTinyFunction(draw.call.pipeline->isa())(input, blocks_.data());
    } else {
        const TileEdges edges = tileEdges(primitive, tileX_, tileY_, draw.subPixelBits, plan.samples, draw.positions);
        count = coverTileFunction(draw.call.pipeline->isa())(edges, blocks_.data());
    }
    const uint32_t allSamples = (1u << plan.samples) - 1;
    if ((plan.sampleMask & allSamples) != allSamples)
        count = maskSamples(plan.sampleMask, plan.samples, blocks_.data(), count);
    const ViewportSetup& viewport = draw.viewport(primitive.viewport);
    if (!viewport.sampleAreas.empty() && shape == nullptr)
        count = cutSamples(viewport.sampleAreas, tileX_, tileY_, blocks_.data(), count);
    if (count == 0) return;

    TrianglePlanes& planes = fragments_.startPrimitive();
    if (shape != nullptr) {
        makeShapePlanes(primitive, *shape, chunk.attributes.data(), draw.subPixelBits, plan.preciseInterpolation,
                        viewport.depthLow, viewport.depthHigh, planes);
    } else {
        makePlanes(primitive, chunk.attributes.data(), draw.subPixelBits, plan.preciseInterpolation, viewport.depthLow,
                   viewport.depthHigh, planes);
    }
    if (plan.maskBeforeTests) fragments_.keepCoverage(blocks_.data(), count);
    if (fragments_.testsDepth() && plan.depth.early) count = testEarly(draw, planes, count);
    if (fragments_.testsDepth() && plan.depth.rejects) count = rejectEarly(draw, planes, count);
    if (plan.depth.write && !plan.depth.early) {
        uint64_t touched = 0;
        for (uint32_t b = 0; b < count; ++b) touched |= uint64_t{1} << blockIndex(blocks_[b]);
        coarse_.updateParts(plan.depth, touched);
    }
    if (!plan.runsFragments) {
        fragments_.statistics().samplesPassed += countSamples(blocks_.data(), count, plan.samples);
        return;
    }
    for (uint32_t b = 0; b < count; ++b) fragments_.add(blocks_[b]);
}

/// Draws the small primitives that wait.
void TileRenderer::flushSmall() {
    const uint32_t count = waiting_.count;
    if (count == 0) return;
    waiting_.count = 0;
    if (count >= kFewestSmall || waiting_.primitives[0]->isPoint) return drawSmall(*waitingDraw_, count);
    for (uint32_t n = 0; n < count; ++n) draw(*waiting_.primitives[n], *waitingChunks_[n], *waitingDraw_, false);
}

/// `count` of those that wait.
void TileRenderer::drawSmall(const PreparedDraw& draw, uint32_t count) {
    const Plan& plan = *draw.plan;
    const Isa isa = draw.call.pipeline->isa();
    const bool tests = fragments_.testsDepth(), writes = tests && plan.depth.write;
    SmallInput& input = waiting_;
    input.count = count;
    input.tileX = tileX_;
    input.tileY = tileY_;
    input.subPixelBits = draw.subPixelBits;
    input.zLow = draw.firstViewport.depthLow;
    input.zHigh = draw.firstViewport.depthHigh;
    setUpSmallFunction(isa)(input, group_);
    input.count = 0;
    uint32_t fragments = 0;
    const auto finish = [&] {
        PassStatistics& statistics = fragments_.statistics();
        if (tests && fragments != 0) {
            const DepthTarget& target = fragments_.depthState().target;
            statistics.depthReads += fragments;
            fragments = testSmallFunction(isa)({&plan.depth, &group_, target.texel(tileX_, tileY_, 0),
                                                static_cast<uint32_t>(target.rowPitch), target.texelBytes},
                                               smallFragments_.data(), fragments);
            if (writes) coarse_.updateParts(plan.depth, blocksCollected_);
        }
        if (plan.runsFragments) {
            fragments_.addSmall(group_, smallFragments_.data(), fragments);
        } else {
            statistics.samplesPassed += fragments;
        }
        fragments = 0;
        for (; blocksCollected_ != 0; blocksCollected_ &= blocksCollected_ - 1)
            collected_[static_cast<uint32_t>(std::countr_zero(blocksCollected_))] = 0;
    };
    for (uint32_t lane = 0; lane < count; ++lane) {
        uint64_t pixels = group_.pixels[lane];
        if (pixels == 0) continue;
        if ((group_.precise >> lane & 1) != 0) {
            finish();
            this->draw(*waiting_.primitives[lane], *waitingChunks_[lane], draw, false);
            continue;
        }
        const uint32_t left = group_.left[lane], top = group_.top[lane];
        const BlockParts parts(left, top, pixels);
        // Neither depths nor colours of one pixel may be asked for twice at a time.
        bool twice = false, waits = false;
        for (uint32_t n = 0; n < parts.count; ++n) {
            twice |= (collected_[parts.blocks[n]] & parts.pixels[n]) != 0;
            waits |= plan.runsFragments && fragments_.waitsFor(parts.blocks[n], parts.pixels[n]);
        }
        if (twice || waits) finish();
        if (waits) fragments_.flush();
        for (uint32_t n = 0; n < parts.count; ++n) {
            if (plan.runsFragments) fragments_.expect(parts.blocks[n], parts.pixels[n]);
            if (!writes) continue;
            collected_[parts.blocks[n]] |= parts.pixels[n];
            blocksCollected_ |= uint64_t{1} << parts.blocks[n];
        }
        const SmallFragment origin = smallFragment(left, top, lane);
        for (; pixels != 0; pixels &= pixels - 1)
            smallFragments_[fragments++] =
                static_cast<SmallFragment>(origin + kPlaceOfBit[static_cast<uint32_t>(std::countr_zero(pixels))]);
    }
    finish();
}

/// Draws all that waits; what has been counted is the segment's.
void TileRenderer::finishSegment(PassStatistics& counts) {
    flushSmall();
    fragments_.flush();
    counts = combine(counts, fragments_.statistics(), std::plus<>{});
    fragments_.statistics() = {};
}

void TileRenderer::render(const PixelRect& rect, uint32_t layer, int32_t tileX, int32_t tileY, bool cleared,
                          std::span<const PreparedDraw> draws, uint64_t token, std::span<const TileWork> work,
                          size_t firstItem, uint32_t firstEntry, std::span<PassStatistics> counts) {
    if (layer != layer_) selectLayer(layer);
    if (cleared) {
        coarse_.setCleared(depthStorage(targets_->depthStencil.format),
                           targets_->depthStencil.clear.depthStencil.depth);
    } else {
        coarse_.forget();
    }
    tileX_ = tileX;
    tileY_ = tileY;
    fragments_.startTile(tileX, tileY);
    uint32_t segment = work[firstItem].segment;
    Ahead primitives(work, firstItem, firstEntry), shapes(work, firstItem, firstEntry);
    for (uint32_t n = 0; n < kAhead; ++n) primitives.next(prefetchPrimitive);
    for (uint32_t n = 0; n < kShapesAhead; ++n) shapes.next(prefetchShape);
    for (size_t index = firstItem; index < work.size(); ++index) {
        const TileWork& item = work[index];
        if (item.segment != segment) {
            finishSegment(counts[segment]);
            segment = item.segment;
        }
        if (item.clear != nullptr) {
            flushSmall();
            fragments_.flush();
            applyClear(*targets_, *item.clear, rect);
            coarse_.forget();
            continue;
        }
        prefetchEntries(work, index);
        const uint32_t end = item.first + item.count;
        for (uint32_t n = std::max(item.first, index == firstItem ? firstEntry : 0); n < end; ++n) {
            primitives.next(prefetchPrimitive);
            shapes.next(prefetchShape);
            const Primitive& primitive = primitiveOf(item, n);
            const PreparedDraw& prepared = draws[primitive.draw];
            if (waiting_.count != 0 && (!primitive.small || &prepared != waitingDraw_)) flushSmall();
            if (waiting_.count == 0) fragments_.bind(prepared, token + prepared.fragmentState);
            if (!primitive.small) {
                draw(primitive, *item.chunk, prepared, (item.chunk->entries[n] & kCoversTile) != 0);
                continue;
            }
            waitingDraw_ = &prepared;
            waitingChunks_[waiting_.count] = item.chunk;
            waiting_.attributes[waiting_.count] = item.chunk->attributes.data();
            waiting_.primitives[waiting_.count++] = &primitive;
            if (waiting_.count == kSmallGroup) flushSmall();
        }
    }
    finishSegment(counts[segment]);
}

}  // namespace vernier
