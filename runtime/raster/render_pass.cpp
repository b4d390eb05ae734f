#include "runtime/raster/render_pass.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <deque>
#include <span>
#include <vector>

#include "base/processor.h"
#include "runtime/geometry/capture.h"
#include "runtime/raster/attachment_ops.h"
#include "runtime/raster/depth_resolve.h"
#include "runtime/raster/hidden_work.h"
#include "runtime/raster/render_workers.h"

namespace vernier {
namespace {

/// Chunks processed before tiles are rendered: bounds the memory of binned primitives, so that it stays in the caches
/// between geometry and tiles, but leaves each tile enough primitives for its own colours and depths to stay there.
constexpr uint32_t kChunksPerWave = 64;

/// A draw, or a clear.
struct Command {
    uint32_t draw = 0;  // index; does not count for a clear
    const ClearCommand* clear = nullptr;
    uint32_t segment = 0;
};

/// One step of a wave: a chunk's worth of primitives of one segment, or a clear.
struct Step {
    std::vector<PrimitiveRange> ranges;
    const ClearCommand* clear = nullptr;
    uint32_t segment = 0;
    uint32_t primitives = 0;
};

bool sameBindings(const ResourceBindings& a, const ResourceBindings& b) {
    return a.buffers == b.buffers && a.images == b.images && a.samplers == b.samplers && a.base == b.base &&
           a.count == b.count && a.combine == b.combine;
}

/// A run of the commands: geometry first, then tiles.
struct Wave {
    std::vector<Step> steps;
    uint32_t stepCount = 0;
    std::vector<Chunk> chunks;
};

/// What a thread counts for one pass, by segment. Cycles, and what is cleared, are the first segment's.
struct ThreadCounts {
    std::vector<PassStatistics> segments;

    void add(uint32_t segment, GeometryStatistics& geometry) {
        PassStatistics& sums = segments[segment];
        sums.inputPrimitives += geometry.inputPrimitives;
        sums.vertexInvocations += geometry.vertexInvocations;
        sums.clippingInvocations += geometry.clippingInvocations;
        sums.clippingPrimitives += geometry.clippingPrimitives;
        sums.clippedPrimitives += geometry.clippedPrimitives;
        sums.rasterPrimitives += geometry.rasterPrimitives;
        sums.controlPatches += geometry.controlPatches;
        sums.evaluationInvocations += geometry.evaluationInvocations;
        sums.geometryInvocations += geometry.geometryInvocations;
        sums.geometryPrimitives += geometry.geometryPrimitives;
        for (uint32_t stream = 0; stream < ir::kVertexStreams; ++stream)
            sums.generatedPrimitives[stream] += geometry.generatedPrimitives[stream];
        geometry = {};
    }
};

/// What the draws of a segment ask for: known when they are recorded.
struct SegmentInput {
    uint64_t vertices = 0, capturable = 0, captured = 0;
};

/// Adds the ticks of its life to a counter.
class CycleCount {
  public:
    explicit CycleCount(uint64_t& counter) : counter_(counter), start_(ticks()) {}
    ~CycleCount() { counter_ += ticks() - start_; }
    CycleCount(const CycleCount&) = delete;
    CycleCount& operator=(const CycleCount&) = delete;

  private:
    uint64_t& counter_;
    uint64_t start_;
};

}  // namespace

struct RenderPass::Impl {
    explicit Impl(RenderWorkers& shared) : workers(shared), pool(shared.pool()), counts(pool.threadCount()) {}

    void add(PreparedDraw draw);
    void prepare();
    void renderRecorded();
    void cutIntoSteps(Wave& wave);
    void runChunk(Wave& wave, uint32_t index, uint32_t thread);
    void continueStipple(Wave& wave);
    void writeCaptured(const Wave& wave);
    void collectTileWork(const Wave& wave);
    void runTile(uint32_t index, uint32_t thread, bool mayHide);
    void runTiles(Wave& ahead);
    uint64_t loadTile(const PixelRect& rect, uint32_t layer, bool colorsReplaced) const;
    bool loads(const RenderTarget& target, uint32_t layer) const {
        return targets.viewMask == 0 || (target.loadViews >> layer & 1) != 0;
    }
    bool isDrawn(uint32_t layer) const { return targets.viewMask == 0 || (targets.viewMask >> layer & 1) != 0; }
    uint32_t layerOf(uint32_t tile) const { return tile / grid.perLayer(); }
    PixelRect tileRect(uint32_t tile) const;
    PixelRect areaRect() const {
        const VkRect2D& area = targets.renderArea;
        return {area.offset.x, area.offset.y, area.offset.x + static_cast<int32_t>(area.extent.width),
                area.offset.y + static_cast<int32_t>(area.extent.height)};
    }
    void resolve();

    RenderWorkers& workers;
    ThreadPool& pool;
    uint64_t number = 0;  // for RenderWorkers::enter
    PassTargets targets;
    TileGrid grid;
    std::vector<ThreadCounts> counts;
    std::vector<SegmentInput> segmentInputs;
    uint32_t segment = 0;  // of what is recorded next

    // Recorded and not yet rendered.
    std::vector<PreparedDraw> draws;
    std::deque<ClearCommand> clears;
    std::vector<Command> commands;
    uint64_t recordedPrimitives = 0;

    // Being rendered: tiles of one wave beside the geometry of the other.
    bool prepared = false;
    uint64_t token = 0;  // names the bindings of draws[0], token + 1 those of draws[1]
    uint64_t nextPrimitive = 0;
    size_t nextCommand = 0;
    std::array<Wave, 2> waves;
    std::vector<std::vector<TileWork>> tileWork;
    std::vector<uint32_t> activeTiles;
    bool loaded = false;  // load operations are done
    bool exactCounts = false;
    bool capturesStages = false;  // some draw's transform feedback has to wait for its stages
    bool stippled = false;        // some draw of the pass has stippled lines
    double stipple = 0;           // the counter at the end of the last chunk
    std::atomic<bool> outOfBudget{false};
};

PixelRect RenderPass::Impl::tileRect(uint32_t tile) const {
    tile %= grid.perLayer();
    const PixelRect area = areaRect();
    const int32_t x = grid.x0 + static_cast<int32_t>(tile % grid.columns) * kTileSize;
    const int32_t y = grid.y0 + static_cast<int32_t>(tile / grid.columns) * kTileSize;
    return {std::max(x, area.x0), std::max(y, area.y0), std::min(x + kTileSize, area.x1),
            std::min(y + kTileSize, area.y1)};
}

/// Cuts recorded commands into at most kChunksPerWave steps, from (nextCommand, nextPrimitive) on.
void RenderPass::Impl::cutIntoSteps(Wave& wave) {
    wave.stepCount = 0;
    const auto newStep = [&](const Command& command) -> Step& {
        if (wave.stepCount == wave.steps.size()) wave.steps.emplace_back();
        Step& step = wave.steps[wave.stepCount++];
        step.ranges.clear();
        step.clear = command.clear;
        step.segment = command.segment;
        step.primitives = 0;
        return step;
    };
    for (; nextCommand < commands.size(); ++nextCommand) {
        const Command& command = commands[nextCommand];
        if (command.clear != nullptr) {
            if (wave.stepCount == kChunksPerWave) break;
            newStep(command);
            continue;
        }
        const uint64_t total = draws[command.draw].primitives();
        while (nextPrimitive < total) {
            const Step* last = wave.stepCount > 0 ? &wave.steps[wave.stepCount - 1] : nullptr;
            const bool open = last != nullptr && last->clear == nullptr && last->segment == command.segment &&
                              last->primitives < kChunkPrimitives;
            if (!open && wave.stepCount == kChunksPerWave) break;
            Step& step = open ? wave.steps[wave.stepCount - 1] : newStep(command);
            const uint32_t weight = draws[command.draw].primitiveWeight;
            const uint32_t room = std::max((kChunkPrimitives - step.primitives) / weight, 1u);
            const auto count = static_cast<uint32_t>(std::min<uint64_t>(room, total - nextPrimitive));
            step.ranges.push_back({command.draw, nextPrimitive, count});
            step.primitives += count * weight;
            nextPrimitive += count;
        }
        if (nextPrimitive < total) break;
        nextPrimitive = 0;
    }
    if (wave.chunks.size() < wave.stepCount) wave.chunks.resize(wave.stepCount);
}

void RenderPass::Impl::runChunk(Wave& wave, uint32_t index, uint32_t thread) {
    const CycleCount cycles(counts[thread].segments[0].vertexCycles);
    wave.chunks[index].clear();
    if (wave.steps[index].clear != nullptr) return;
    Assembler& assembler = workers.enter(thread, number, targets).assembler;
    if (!assembler.run(draws, token, wave.steps[index].ranges, grid, wave.chunks[index]))
        outOfBudget.store(true, std::memory_order_relaxed);
    counts[thread].add(wave.steps[index].segment, assembler.statistics());
}

void RenderPass::Impl::prepare() {
    prepared = true;
    token = workers.takeNumbers(draws.size());
    nextPrimitive = nextCommand = 0;
    for (ThreadCounts& thread : counts) thread.segments.resize(segment + 1);
    cutIntoSteps(waves[0]);
    pool.parallelFor(waves[0].stepCount, [&](uint32_t index, uint32_t thread) { runChunk(waves[0], index, thread); });
}

/// Stipple counters of strips that chunks cut: each chunk goes on from where the one before ended.
void RenderPass::Impl::continueStipple(Wave& wave) {
    for (uint32_t n = 0; n < wave.stepCount; ++n) {
        Chunk& chunk = wave.chunks[n];
        const size_t count = chunk.restartsStipple ? chunk.continuingShapes : chunk.shapes.size();
        for (size_t k = 0; k < count; ++k) chunk.shapes[k].stippleStart += stipple;
        stipple = chunk.restartsStipple ? chunk.stippleEnd : stipple + chunk.stippleEnd;
    }
}

/// Where what stages have made goes is known when all before it is.
void RenderPass::Impl::writeCaptured(const Wave& wave) {
    for (uint32_t n = 0; n < wave.stepCount; ++n) {
        PassStatistics& sums = counts[0].segments[wave.steps[n].segment];
        for (const CapturedPrimitives& captured : wave.chunks[n].captured) {
            sums.capturablePrimitives[captured.stream] += captured.primitives;
            sums.capturedPrimitives[captured.stream] += vernier::writeCaptured(draws[captured.draw], captured);
        }
    }
}

void RenderPass::Impl::collectTileWork(const Wave& wave) {
    tileWork.resize(grid.count());
    for (const uint32_t tile : activeTiles) tileWork[tile].clear();
    activeTiles.clear();
    const auto add = [&](uint32_t tile, const TileWork& work) {
        if (tileWork[tile].empty()) activeTiles.push_back(tile);
        tileWork[tile].push_back(work);
    };
    for (uint32_t n = 0; n < wave.stepCount; ++n) {
        if (const ClearCommand* clear = wave.steps[n].clear; clear != nullptr) {
            for (uint32_t tile = 0; tile < grid.count(); ++tile)
                if (isDrawn(layerOf(tile)) && clear->clears(layerOf(tile)))
                    add(tile, {nullptr, clear, 0, 0, wave.steps[n].segment, false});
            continue;
        }
        for (const TileRange& range : wave.chunks[n].ranges)
            add(range.tile, {&wave.chunks[n], nullptr, range.first, range.count, wave.steps[n].segment, range.large});
    }
    if (loaded) return;
    // The first wave touches every tile: load operations clear where nothing is drawn, too.
    activeTiles.clear();
    for (uint32_t tile = 0; tile < grid.count(); ++tile)
        if (isDrawn(layerOf(tile))) activeTiles.push_back(tile);
}

/// `colorsReplaced`: nothing would be seen of the cleared colours. Returns how many pixels of attachments are cleared.
uint64_t RenderPass::Impl::loadTile(const PixelRect& rect, uint32_t layer, bool colorsReplaced) const {
    uint64_t cleared = 0;
    for (uint32_t c = 0; c < targets.colorCount && !colorsReplaced; ++c) {
        if (targets.colors[c].loadOp != VK_ATTACHMENT_LOAD_OP_CLEAR || !loads(targets.colors[c], layer)) continue;
        clearPixels(targets.colors[c], VK_IMAGE_ASPECT_COLOR_BIT, targets.colors[c].clear, rect, layer);
        ++cleared;
    }
    const RenderTarget& depth = targets.depthStencil;
    VkImageAspectFlags aspects = 0;
    if (depth.loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR) aspects |= VK_IMAGE_ASPECT_DEPTH_BIT;
    if (depth.stencilLoadOp == VK_ATTACHMENT_LOAD_OP_CLEAR) aspects |= VK_IMAGE_ASPECT_STENCIL_BIT;
    if (aspects != 0 && loads(depth, layer)) {
        clearPixels(depth, aspects, depth.clear, rect, layer);
        ++cleared;
    }
    return cleared * static_cast<uint64_t>(rect.x1 - rect.x0) * static_cast<uint64_t>(rect.y1 - rect.y0);
}

void RenderPass::Impl::runTile(uint32_t index, uint32_t thread, bool mayHide) {
    std::vector<PassStatistics>& segments = counts[thread].segments;
    const CycleCount cycles(segments[0].rasterCycles);
    const uint32_t tile = activeTiles[index];
    const PixelRect rect = tileRect(tile);
    const uint32_t inLayer = tile % grid.perLayer();
    const bool cleared = !loaded && targets.depthStencil.loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR &&
                         loads(targets.depthStencil, layerOf(tile));
    const TileInput input{rect,
                          grid.x0 + static_cast<int32_t>(inLayer % grid.columns) * kTileSize,
                          grid.y0 + static_cast<int32_t>(inLayer / grid.columns) * kTileSize,
                          draws,
                          tileWork[tile],
                          cleared};
    const VisibleStart start = mayHide ? visibleStart(targets, input) : VisibleStart{};
    if (!loaded) segments[0].clearedPixels += loadTile(rect, layerOf(tile), start.replacesColors);
    if (tileWork[tile].empty()) return;
    TileRenderer& renderer = workers.enter(thread, number, targets).renderer;
    renderer.render(rect, layerOf(tile), input.tileX, input.tileY, cleared, draws, token, tileWork[tile], start.item,
                    start.entry, segments);
    if (renderer.fragments().outOfBudget()) outOfBudget.store(true, std::memory_order_relaxed);
}

/// The tiles that have work, and beside them the geometry of `ahead`.
void RenderPass::Impl::runTiles(Wave& ahead) {
    const auto tiles = static_cast<uint32_t>(activeTiles.size());
    const bool mayHide = !exactCounts && mayHideWork(targets, draws);
    pool.parallelFor({tiles, ahead.stepCount}, [&](uint32_t index, uint32_t thread) {
        if (index < tiles) {
            runTile(index, thread, mayHide);
        } else {
            runChunk(ahead, index - tiles, thread);
        }
    });
    loaded = true;
}

void RenderPass::Impl::renderRecorded() {
    if (commands.empty() && loaded) return;
    if (!prepared) prepare();
    for (uint32_t n = 0, left = 1; left != 0; n ^= 1) {
        Wave &wave = waves[n], &ahead = waves[n ^ 1];
        if (stippled) continueStipple(wave);
        if (capturesStages) writeCaptured(wave);
        collectTileWork(wave);
        cutIntoSteps(ahead);
        left = ahead.stepCount;
        runTiles(ahead);
    }
    prepared = false;
    draws.clear();
    clears.clear();
    commands.clear();
    recordedPrimitives = 0;
}

void RenderPass::Impl::resolve() {
    const bool any = std::any_of(targets.resolves.begin(), targets.resolves.end(),
                                 [](const RenderTarget& target) { return target.data != nullptr; });
    const bool depth = targets.depthStencilResolve.data != nullptr;
    if (!any && !depth) return;
    pool.parallelFor(grid.count(), [&](uint32_t tile, uint32_t) {
        for (uint32_t c = 0; c < targets.colorCount; ++c)
            if (targets.resolves[c].data != nullptr && isDrawn(layerOf(tile)))
                resolvePixels(targets.colors[c], targets.resolves[c], tileRect(tile), layerOf(tile), targets.isa);
        if (depth && isDrawn(layerOf(tile)))
            resolveDepthStencil(targets.depthStencil, targets.depthStencilResolve, targets.depthResolveMode,
                                targets.stencilResolveMode, tileRect(tile), layerOf(tile));
    });
}

RenderPass::RenderPass(RenderWorkers& workers) : impl_(std::make_unique<Impl>(workers)) {}
RenderPass::~RenderPass() = default;

void RenderPass::begin(const PassTargets& targets) {
    Impl& self = *impl_;
    self.targets = targets;
    self.grid = tileGridOf(targets.renderArea);
    self.grid.layers = targets.viewMask != 0 ? static_cast<uint32_t>(std::bit_width(targets.viewMask)) : targets.layers;
    // Primitives of a layer that the framebuffer does not have "may still be rasterized" (specification, Layer). They
    // are where that can do no harm: OpenGL's framebuffers of one layer take all, and Mesa's Zink says nothing of
    // layers when it has no attachments.
    const bool attached = targets.depthStencil.format != VK_FORMAT_UNDEFINED ||
                          std::ranges::any_of(std::span(targets.colors).first(targets.colorCount),
                                              [](const auto& color) { return color.format != VK_FORMAT_UNDEFINED; });
    self.grid.anyLayer = targets.viewMask == 0 && (targets.layers == 1 || !attached);
    if (self.grid.anyLayer) self.grid.layers = 1;
    self.loaded = false;
    self.stippled = self.capturesStages = false;
    self.stipple = 0;
    self.outOfBudget = false;
    self.exactCounts = false;
    self.segmentInputs.assign(1, {});
    self.segment = 0;
    self.activeTiles.clear();
    self.tileWork.assign(self.grid.count(), {});
    self.number = self.workers.takeNumbers(1);
    for (ThreadCounts& thread : self.counts) thread.segments.assign(1, {});
}

void RenderPass::draw(const DrawCall& call) {
    Impl& self = *impl_;
    PreparedDraw draw = prepareDraw(call, self.targets.renderArea);
    if (draw.primitives() == 0) return;
    if (self.targets.viewMask == 0) return self.add(std::move(draw));
    for (uint32_t views = self.targets.viewMask; views != 0; views &= views - 1) {
        draw.viewIndex = static_cast<uint32_t>(std::countr_zero(views));
        self.add(PreparedDraw(draw));
    }
}

void RenderPass::Impl::add(PreparedDraw draw) {
    Impl& self = *this;
    const DrawCall& call = draw.call;
    SegmentInput& input = self.segmentInputs[self.segment];
    for (const VertexRun& run : draw.runs) input.vertices += uint64_t{run.vertices} * call.instances;
    if (call.capture != nullptr && call.capture->running == nullptr) {
        input.capturable += draw.primitives();
        input.captured += call.capture->primitives;
    }
    const auto index = static_cast<uint32_t>(self.draws.size());
    // Neighbours that differ in geometry only fill the same fragment batches.
    const bool same = index > 0 && self.draws.back().call.pipeline == call.pipeline &&
                      self.draws.back().call.dynamic == call.dynamic &&
                      sameBindings(self.draws.back().call.fragmentResources, call.fragmentResources);
    draw.fragmentState = same ? self.draws.back().fragmentState : index;
    self.recordedPrimitives += draw.primitives();
    self.stippled |= draw.stipples;
    self.capturesStages |= call.capture != nullptr && call.capture->running != nullptr;
    self.draws.push_back(std::move(draw));
    self.commands.push_back({index, nullptr, self.segment});
}

void RenderPass::countExactly() {
    impl_->exactCounts = true;
}

uint32_t RenderPass::nextSegment() {
    impl_->segmentInputs.emplace_back();
    return ++impl_->segment;
}

void RenderPass::clear(VkImageAspectFlags aspect, uint32_t color, const VkClearValue& value, const VkClearRect& rect) {
    Impl& self = *impl_;
    const auto end = [](int32_t offset, uint32_t extent) {
        return static_cast<int32_t>(std::min<int64_t>(int64_t{offset} + extent, kGuardBandMax));
    };
    const PixelRect pixels{rect.rect.offset.x, rect.rect.offset.y, end(rect.rect.offset.x, rect.rect.extent.width),
                           end(rect.rect.offset.y, rect.rect.extent.height)};
    // With multiview every view is cleared (VUID-vkCmdClearAttachments-baseArrayLayer-00018).
    const bool allViews = self.targets.viewMask != 0;
    self.clears.push_back({aspect, color, value, pixels, allViews ? 0 : rect.baseArrayLayer,
                           allViews ? self.grid.layers : rect.layerCount});
    self.commands.push_back({0, &self.clears.back(), self.segment});
}

size_t RenderPass::recordedDraws() const {
    return impl_->draws.size();
}

uint64_t RenderPass::recordedPrimitives() const {
    return impl_->recordedPrimitives;
}

void RenderPass::prepare() {
    impl_->prepare();
}

void RenderPass::flush() {
    impl_->renderRecorded();
}

bool RenderPass::end() {
    Impl& self = *impl_;
    self.renderRecorded();
    self.resolve();
    return !self.outOfBudget;
}

PassStatistics RenderPass::statistics(uint32_t first, uint32_t end) const {
    PassStatistics sum;
    for (size_t s = first; s < std::min<size_t>(end, impl_->segmentInputs.size()); ++s) {
        const SegmentInput& input = impl_->segmentInputs[s];
        sum.inputVertices += input.vertices;
        sum.capturablePrimitives[0] += input.capturable;
        sum.capturedPrimitives[0] += input.captured;
        for (const ThreadCounts& thread : impl_->counts)
            if (s < thread.segments.size()) sum = combine(sum, thread.segments[s], std::plus<>{});
    }
    return sum;
}

}  // namespace vernier
