#include "runtime/raster/render_pass.h"

#include <x86intrin.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <deque>
#include <variant>
#include <vector>

#include "runtime/geometry/assemble.h"
#include "runtime/raster/attachment_ops.h"
#include "runtime/raster/depth_resolve.h"
#include "runtime/raster/hidden_work.h"
#include "runtime/raster/tile_renderer.h"

namespace vernier {
namespace {

/// Chunks processed before tiles are rendered: bounds the memory of binned primitives, so that it stays in the caches
/// between geometry and tiles, but leaves each tile enough primitives for its own colours and depths to stay there.
constexpr uint32_t kChunksPerWave = 64;
/// Recorded primitives after which the pass renders what it has, so that a long pass does not hold all its
/// draws.
constexpr uint64_t kPrimitivesPerFlush = uint64_t{kChunksPerWave} * kChunkPrimitives;
constexpr size_t kDrawsPerFlush = 1 << 16;

/// One step of a wave: a chunk's worth of primitives, or a clear.
struct Step {
    std::vector<PrimitiveRange> ranges;
    const ClearCommand* clear = nullptr;
    uint32_t primitives = 0;
};

bool sameBindings(const ResourceBindings& a, const ResourceBindings& b) {
    return a.buffers == b.buffers && a.images == b.images && a.samplers == b.samplers && a.base == b.base &&
           a.count == b.count && a.combine == b.combine;
}

/// One thread's part of the backend.
struct Worker {
    Assembler assembler;
    TileRenderer renderer;
    uint64_t vertexCycles = 0, rasterCycles = 0;
};

/// Hands a range of cycles to a counter.
class CycleCount {
  public:
    explicit CycleCount(uint64_t& counter) : counter_(counter), start_(__rdtsc()) {}
    ~CycleCount() { counter_ += __rdtsc() - start_; }
    CycleCount(const CycleCount&) = delete;
    CycleCount& operator=(const CycleCount&) = delete;

  private:
    uint64_t& counter_;
    uint64_t start_;
};

}  // namespace

struct RenderPass::Impl {
    explicit Impl(ThreadPool& threadPool) : pool(threadPool) {
        for (uint32_t n = 0; n < pool.threadCount(); ++n) workers.push_back(std::make_unique<Worker>());
    }

    void add(PreparedDraw draw);
    void renderRecorded();
    void cutIntoSteps(uint64_t& primitive, size_t& command);
    void runGeometry();
    void continueStipple();
    void collectTileWork();
    void runTiles();
    void loadTile(const PixelRect& rect, uint32_t layer, bool colorsReplaced) const;
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
    void sumStatistics();

    ThreadPool& pool;
    std::vector<std::unique_ptr<Worker>> workers;
    PassTargets targets;
    TileGrid grid;
    PassStatistics statistics;
    uint64_t inputVertices = 0;

    // Recorded and not yet rendered. A command is the index of a draw, or a clear.
    std::vector<PreparedDraw> draws;
    std::deque<ClearCommand> clears;
    std::vector<std::variant<uint32_t, const ClearCommand*>> commands;
    uint64_t recordedPrimitives = 0;
    uint64_t nextToken = 1;  // of draws[0]; tokens are never used twice

    // Of the wave being rendered.
    std::vector<Step> steps;
    uint32_t stepCount = 0;
    std::vector<Chunk> chunks;
    std::vector<std::vector<TileWork>> tileWork;
    std::vector<uint32_t> activeTiles;
    bool loaded = false;  // load operations are done
    bool exactCounts = false;
    bool stippled = false;  // some draw of the pass has stippled lines
    double stipple = 0;     // the counter at the end of the last chunk
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

/// Cuts recorded commands into at most kChunksPerWave steps, from (command, primitive) on.
void RenderPass::Impl::cutIntoSteps(uint64_t& primitive, size_t& command) {
    stepCount = 0;
    const auto newStep = [&]() -> Step& {
        if (stepCount == steps.size()) steps.emplace_back();
        Step& step = steps[stepCount++];
        step.ranges.clear();
        step.clear = nullptr;
        step.primitives = 0;
        return step;
    };
    while (command < commands.size()) {
        if (const auto* clear = std::get_if<const ClearCommand*>(&commands[command])) {
            if (stepCount == kChunksPerWave) return;
            newStep().clear = *clear;
            ++command;
            continue;
        }
        const uint32_t index = std::get<uint32_t>(commands[command]);
        const uint64_t total = draws[index].primitives();
        while (primitive < total) {
            const bool open = stepCount > 0 && steps[stepCount - 1].clear == nullptr &&
                              steps[stepCount - 1].primitives < kChunkPrimitives;
            if (!open && stepCount == kChunksPerWave) return;
            Step& step = open ? steps[stepCount - 1] : newStep();
            const auto count =
                static_cast<uint32_t>(std::min<uint64_t>(kChunkPrimitives - step.primitives, total - primitive));
            step.ranges.push_back({index, primitive, count});
            step.primitives += count;
            primitive += count;
        }
        primitive = 0;
        ++command;
    }
}

void RenderPass::Impl::runGeometry() {
    if (chunks.size() < stepCount) chunks.resize(stepCount);
    pool.parallelFor(stepCount, [&](uint32_t index, uint32_t worker) {
        Worker& self = *workers[worker];
        const CycleCount cycles(self.vertexCycles);
        chunks[index].clear();
        if (steps[index].clear != nullptr) return;
        if (!self.assembler.run(draws, nextToken, steps[index].ranges, grid, chunks[index]))
            outOfBudget.store(true, std::memory_order_relaxed);
    });
}

/// Stipple counters of strips that chunks cut: each chunk goes on from where the one before ended.
void RenderPass::Impl::continueStipple() {
    for (uint32_t n = 0; n < stepCount; ++n) {
        Chunk& chunk = chunks[n];
        const size_t count = chunk.restartsStipple ? chunk.continuingShapes : chunk.shapes.size();
        for (size_t k = 0; k < count; ++k) chunk.shapes[k].stippleStart += stipple;
        stipple = chunk.restartsStipple ? chunk.stippleEnd : stipple + chunk.stippleEnd;
    }
}

void RenderPass::Impl::collectTileWork() {
    tileWork.resize(grid.count());
    for (const uint32_t tile : activeTiles) tileWork[tile].clear();
    activeTiles.clear();
    const auto add = [&](uint32_t tile, const TileWork& work) {
        if (tileWork[tile].empty()) activeTiles.push_back(tile);
        tileWork[tile].push_back(work);
    };
    for (uint32_t n = 0; n < stepCount; ++n) {
        if (const ClearCommand* clear = steps[n].clear; clear != nullptr) {
            for (uint32_t tile = 0; tile < grid.count(); ++tile)
                if (isDrawn(layerOf(tile)) && clear->clears(layerOf(tile))) add(tile, {nullptr, clear, 0, 0, false});
            continue;
        }
        for (const TileRange& range : chunks[n].ranges)
            add(range.tile, {&chunks[n], nullptr, range.first, range.count, range.large});
    }
    if (loaded) return;
    // The first wave touches every tile: load operations clear where nothing is drawn, too.
    activeTiles.clear();
    for (uint32_t tile = 0; tile < grid.count(); ++tile)
        if (isDrawn(layerOf(tile))) activeTiles.push_back(tile);
}

/// `colorsReplaced`: nothing would be seen of the cleared colours.
void RenderPass::Impl::loadTile(const PixelRect& rect, uint32_t layer, bool colorsReplaced) const {
    for (uint32_t c = 0; c < targets.colorCount && !colorsReplaced; ++c)
        if (targets.colors[c].loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR && loads(targets.colors[c], layer))
            clearPixels(targets.colors[c], VK_IMAGE_ASPECT_COLOR_BIT, targets.colors[c].clear, rect, layer);
    const RenderTarget& depth = targets.depthStencil;
    VkImageAspectFlags aspects = 0;
    if (depth.loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR) aspects |= VK_IMAGE_ASPECT_DEPTH_BIT;
    if (depth.stencilLoadOp == VK_ATTACHMENT_LOAD_OP_CLEAR) aspects |= VK_IMAGE_ASPECT_STENCIL_BIT;
    if (aspects != 0 && loads(depth, layer)) clearPixels(depth, aspects, depth.clear, rect, layer);
}

void RenderPass::Impl::runTiles() {
    const auto count = static_cast<uint32_t>(activeTiles.size());
    const bool mayHide = !exactCounts && mayHideWork(targets, draws);
    pool.parallelFor(count, [&](uint32_t index, uint32_t worker) {
        Worker& self = *workers[worker];
        const CycleCount cycles(self.rasterCycles);
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
        if (!loaded) loadTile(rect, layerOf(tile), start.replacesColors);
        if (tileWork[tile].empty()) return;
        self.renderer.render(rect, layerOf(tile), input.tileX, input.tileY, cleared, draws, nextToken, tileWork[tile],
                             start.item, start.entry);
    });
    loaded = true;
    for (const auto& worker : workers) worker->renderer.fragments().unbind();
}

void RenderPass::Impl::renderRecorded() {
    uint64_t primitive = 0;
    size_t command = 0;
    while (command < commands.size() || !loaded) {
        cutIntoSteps(primitive, command);
        runGeometry();
        if (stippled) continueStipple();
        collectTileWork();
        runTiles();
    }
    nextToken += draws.size();
    draws.clear();
    clears.clear();
    commands.clear();
    recordedPrimitives = 0;
    sumStatistics();
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

void RenderPass::Impl::sumStatistics() {
    statistics = {};
    statistics.inputVertices = inputVertices;
    for (const auto& worker : workers) {
        const GeometryStatistics& geometry = worker->assembler.statistics();
        statistics.inputPrimitives += geometry.inputPrimitives;
        statistics.vertexInvocations += geometry.vertexInvocations;
        statistics.clippingInvocations += geometry.clippingInvocations;
        statistics.clippingPrimitives += geometry.clippingPrimitives;
        statistics.clippedPrimitives += geometry.clippedPrimitives;
        statistics.rasterPrimitives += geometry.rasterPrimitives;
        const PassStatistics& fragments = worker->renderer.fragments().statistics();
        statistics.fragmentInvocations += fragments.fragmentInvocations;
        statistics.helperInvocations += fragments.helperInvocations;
        statistics.batches += fragments.batches;
        statistics.samplesPassed += fragments.samplesPassed;
        statistics.perspectiveDivides += fragments.perspectiveDivides;
        statistics.destinationReads += fragments.destinationReads;
        statistics.depthReads += fragments.depthReads;
        statistics.coarseDepthRejects += fragments.coarseDepthRejects;
        statistics.vertexCycles += worker->vertexCycles;
        statistics.rasterCycles += worker->rasterCycles;
    }
}

RenderPass::RenderPass(ThreadPool& pool) : impl_(std::make_unique<Impl>(pool)) {}
RenderPass::~RenderPass() = default;

void RenderPass::begin(const PassTargets& targets) {
    Impl& self = *impl_;
    self.targets = targets;
    self.grid = tileGridOf(targets.renderArea);
    self.grid.layers = targets.viewMask != 0 ? static_cast<uint32_t>(std::bit_width(targets.viewMask)) : targets.layers;
    self.loaded = false;
    self.stippled = false;
    self.stipple = 0;
    self.outOfBudget = false;
    self.inputVertices = 0;
    self.statistics = {};
    self.activeTiles.clear();
    self.tileWork.assign(self.grid.count(), {});
    for (const auto& worker : self.workers) {
        worker->assembler.contexts().startPass();
        worker->assembler.statistics() = {};
        worker->renderer.startPass(self.targets);
        worker->vertexCycles = worker->rasterCycles = 0;
    }
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
    for (const VertexRun& run : draw.runs) self.inputVertices += uint64_t{run.vertices} * call.instances;
    const auto index = static_cast<uint32_t>(self.draws.size());
    // Neighbours that differ in geometry only fill the same fragment batches.
    const bool same = index > 0 && self.draws.back().call.pipeline == call.pipeline &&
                      self.draws.back().call.dynamic == call.dynamic &&
                      sameBindings(self.draws.back().call.fragmentResources, call.fragmentResources);
    draw.fragmentState = same ? self.draws.back().fragmentState : index;
    self.recordedPrimitives += draw.primitives();
    self.stippled |= draw.state->stippledLine;
    self.draws.push_back(std::move(draw));
    self.commands.emplace_back(index);
    if (self.recordedPrimitives >= kPrimitivesPerFlush || self.draws.size() >= kDrawsPerFlush) self.renderRecorded();
}

void RenderPass::setExactCounts(bool exact) {
    impl_->exactCounts = exact;
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
    self.commands.emplace_back(&self.clears.back());
}

void RenderPass::flush() {
    impl_->renderRecorded();
}

bool RenderPass::end() {
    Impl& self = *impl_;
    self.renderRecorded();
    self.resolve();
    for (const auto& worker : self.workers)
        if (worker->renderer.fragments().outOfBudget()) self.outOfBudget = true;
    return !self.outOfBudget;
}

const PassStatistics& RenderPass::statistics() const {
    return impl_->statistics;
}

}  // namespace vernier
