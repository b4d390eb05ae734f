// The commands that begin and end passes, and ask questions.
#include <chrono>

#include "runtime/command/executor.h"
#include "runtime/command/query_pool.h"

namespace vernier {
namespace {

/// Passes that wait or run at a time.
constexpr size_t kMostPasses = 8;
/// A pass with more primitives than this keeps all threads busy by itself; its vertices would be long out of the caches
/// when they are wanted.
constexpr uint64_t kPrimitivesAhead = 1 << 15;

RenderTarget targetOf(const ImageView* view) {
    RenderTarget target;
    if (!view) return target;
    const VkImageSubresourceRange& range = view->info().range;
    const Image& image = view->image();
    const LevelLayout& level = image.level(range.baseMipLevel);
    target.format = view->info().format;
    const bool slices = seesSlices(image, view->info().type);
    target.data = slices ? image.address(range.baseMipLevel, 0, range.baseArrayLayer)
                         : image.address(range.baseMipLevel, range.baseArrayLayer);
    target.rowPitch = level.rowPitch;
    target.samplePitch = level.samplePitch;
    target.layerPitch = slices ? level.slicePitch : image.layerPitch();
    target.extent = view->extent();
    target.samples = image.info().samples;
    return target;
}

RenderTarget targetOf(const RenderingAttachment& attachment) {
    RenderTarget target = targetOf(attachment.view);
    static_cast<AttachmentOps&>(target) = attachment;
    return target;
}

/// The bytes that drawing to a target may change, and what lies between its layers.
void addTarget(const RenderTarget& target, uint32_t layers, AccessSet& accesses) {
    if (target.data == nullptr || layers == 0) return;
    accesses.write(target.data, (layers - 1) * target.layerPitch + target.samples * target.samplePitch);
}

uint64_t nowNanoseconds() {
    using namespace std::chrono;
    return static_cast<uint64_t>(duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count());
}

}  // namespace

/// One that nothing is left to do for. There are few: those that wait hold memory.
Executor::PassWork& Executor::takePass() {
    if (idleCount_ == 0 && passes_.size() < kMostPasses) {
        passes_.push_back(std::make_unique<PassWork>(workers_));
        const std::lock_guard lock(endedMutex_);  // passes end meanwhile, and must find room
        idlePasses_.reserve(passes_.size());
        return *passes_.back();
    }
    scheduler_.waitUntil([this] { return idleCount_ != 0; });
    if (idleCount_ == 0) scheduler_.finish();  // throws: a pass failed, and is not used again
    const std::lock_guard lock(endedMutex_);
    PassWork& work = *idlePasses_.back();
    idlePasses_.pop_back();
    --idleCount_;
    return work;
}

void Executor::run(const command::BeginRendering& command) {
    device_.pool().expectLoop();
    PassTargets targets;
    targets.colorCount = command.colorCount;
    for (uint32_t i = 0; i < command.colorCount; ++i) {
        targets.colors[i] = targetOf(command.colors[i]);
        targets.resolves[i] = targetOf(command.colors[i].resolve);
    }
    targets.depthStencil = targetOf(command.depthStencil);
    targets.depthStencilResolve = targetOf(command.depthStencil.resolve);
    targets.depthResolveMode = command.depthStencil.depthResolveMode;
    targets.stencilResolveMode = command.depthStencil.stencilResolveMode;
    targets.renderArea = command.renderArea;
    targets.layers = command.layers;
    targets.viewMask = command.viewMask;
    targets.samples = command.samples;
    targets.isa = device_.isa();

    PassWork& work = takePass();
    work.sink = command.statistics;
    work.begun = work.writesVertices = false;
    work.geometry.clear();
    work.rest.clear();
    work.captured.clear();
    const uint32_t layers =
        command.viewMask != 0 ? static_cast<uint32_t>(std::bit_width(command.viewMask)) : command.layers;
    for (uint32_t i = 0; i < command.colorCount; ++i) {
        addTarget(targets.colors[i], layers, work.rest);
        addTarget(targets.resolves[i], layers, work.rest);
    }
    addTarget(targets.depthStencil, layers, work.rest);
    addTarget(targets.depthStencilResolve, layers, work.rest);
    for (const SampledInput& input : command.sampledInputs) addTarget(targetOf(input.samples), layers, work.rest);
    work.pass.begin(targets);
    for (RunningQuery* query : queries_.open()) addQueryPart(work, *query, 0);
    pass_ = &work;
    views_ = command.viewMask;
    drawBindings_.bound.sampledInputs = command.sampledInputs;
    streamsChanged_ = drawBindings_.changed = true;
}

void Executor::run(const command::EndRendering&) {
    if (pass_ == nullptr) return;
    submitPass(*pass_);
    pass_ = nullptr;
    dynamicSnapshot_ = nullptr;
    drawBindings_.changed = true;
}

/// Where only the attachments have to be waited for, the vertex stage runs ahead.
void Executor::submitPass(PassWork& work) {
    AccessSet& geometry = scheduler_.nextAccesses();
    geometry.add(work.geometry);
    geometry.finish();
    const Scheduler::Mask before = scheduler_.conflicting(geometry);
    work.rest.add(work.geometry);
    work.rest.finish();
    Scheduler::Mask ahead = 0;
    const uint64_t primitives = work.pass.recordedPrimitives();
    if (!work.begun && !work.writesVertices && primitives != 0 && primitives <= kPrimitivesAhead &&
        (scheduler_.conflicting(work.rest) & ~before) != 0)
        ahead = scheduler_.submit([&work] { work.pass.prepare(); });
    scheduler_.nextAccesses().add(work.rest);
    scheduler_.submit([this, &work] { endPass(work); }, ahead);
}

void Executor::endPass(PassWork& work) {
    if (!work.pass.end()) lost_ = true;
    count(work.pass.statistics(), work.sink);
    for (const QueryPart& part : work.queries)
        queries_.partEnded(*part.query, work.pass.statistics(part.first, part.end));
    work.queries.clear();
    work.arena.reset();
    const std::lock_guard lock(endedMutex_);
    idlePasses_.push_back(&work);
    ++idleCount_;
}

/// Everything recorded so far is done afterwards.
void Executor::catchUp() {
    scheduler_.finish();
    if (pass_ == nullptr) return;
    pass_->begun = true;
    pass_->pass.flush();
    pass_->captured.clear();
}

void Executor::run(const command::Flush&) {
    if (pass_ != nullptr) catchUp();
}

void Executor::run(const command::ClearAttachments& command) {
    if (leavesOut_ || pass_ == nullptr) return;
    for (const VkClearAttachment& attachment : command.attachments)
        for (const VkClearRect& rect : command.rects)
            pass_->pass.clear(attachment.aspectMask, attachment.colorAttachment, attachment.clearValue, rect);
}

void Executor::count(const PassStatistics& difference, PassStatistics* sink) {
    const std::lock_guard lock(endedMutex_);
    finished_ = combine(finished_, difference, std::plus<>{});
    if (sink != nullptr) *sink = combine(*sink, difference, std::plus<>{});
}

/// What the pass counts from the segment on is the query's.
void Executor::addQueryPart(PassWork& work, RunningQuery& query, uint32_t first) {
    work.pass.countExactly();
    work.queries.push_back({&query, first, kToTheEnd});
    queries_.addPart(query);
}

void Executor::run(const command::BeginQuery& command) {
    queries_.begin(*command.pool, command.query, viewCount(), command.stream);
    if (pass_ != nullptr) addQueryPart(*pass_, *queries_.open().back(), pass_->pass.nextSegment());
}

void Executor::run(const command::EndQuery& command) {
    RunningQuery* query = queries_.find(*command.pool, command.query);
    if (query == nullptr) return;
    if (pass_ != nullptr) {
        const uint32_t end = pass_->pass.nextSegment();
        for (QueryPart& part : pass_->queries)
            if (part.query == query && part.end == kToTheEnd) part.end = end;
    }
    queries_.close(*query);
}

void Executor::writeTimestamps(QueryPool& pool, uint32_t query, uint32_t views) {
    const uint64_t now = nowNanoseconds();
    for (uint32_t n = 0; n < views; ++n) pool.writeTimestamp(query + n, now);
}

/// Everything before it is done when a time stamp is taken, and nothing behind it waits; inside a pass, whose draws are
/// not done one by one, what is recorded is done first.
void Executor::run(const command::WriteTimestamp& command) {
    if (pass_ != nullptr) {
        catchUp();
        return writeTimestamps(*command.pool, command.query, viewCount());
    }
    scheduler_.nextAccesses();
    command.pool->hold();
    scheduler_.submit(
        [this, pool = command.pool, query = command.query] {
            writeTimestamps(*pool, query, 1);
            pool->release();
        },
        ~Scheduler::Mask{0});
}

void Executor::run(const command::ResetQueries& command) {
    scheduler_.waitUntil([&] { return !command.pool->held(); });
    command.pool->reset(command.first, command.count);
}

void Executor::run(const command::CopyQueryResults& command) {
    const Buffer& buffer = *command.buffer;
    if (command.offset >= buffer.size()) return;
    std::byte* to = buffer.data() + command.offset;
    const VkDeviceSize size = buffer.size() - command.offset;
    scheduler_.nextAccesses().write(to, size);
    command.pool->hold();
    scheduler_.submit(
        [command, to, size] {
            command.pool->results(command.first, command.count, to, size, command.stride, command.flags);
            command.pool->release();
        },
        ~Scheduler::Mask{0});
}

}  // namespace vernier
