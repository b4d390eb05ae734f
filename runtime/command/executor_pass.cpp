// The commands that begin and end passes, move data, and ask questions.
#include <chrono>

#include "runtime/command/executor.h"
#include "runtime/command/query_pool.h"
#include "runtime/transfer/transfer.h"

namespace vernier {
namespace {

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
    target.loadOp = attachment.loadOp;
    target.storeOp = attachment.storeOp;
    target.stencilLoadOp = attachment.stencilLoadOp;
    target.stencilStoreOp = attachment.stencilStoreOp;
    target.clear = attachment.clear;
    target.loadViews = attachment.loadViews;
    return target;
}

/// Field by field: PassStatistics holds nothing but counters.
template <class Combine>
PassStatistics combineStatistics(const PassStatistics& a, const PassStatistics& b, Combine combine) {
    static_assert(sizeof(PassStatistics) % sizeof(uint64_t) == 0);
    PassStatistics result = a;
    auto* to = reinterpret_cast<uint64_t*>(&result);
    const auto* from = reinterpret_cast<const uint64_t*>(&b);
    for (size_t i = 0; i < sizeof(PassStatistics) / sizeof(uint64_t); ++i) to[i] = combine(to[i], from[i]);
    return result;
}

PassStatistics add(const PassStatistics& a, const PassStatistics& b) {
    return combineStatistics(a, b, [](uint64_t x, uint64_t y) { return x + y; });
}

PassStatistics subtract(const PassStatistics& a, const PassStatistics& b) {
    return combineStatistics(a, b, [](uint64_t x, uint64_t y) { return x - y; });
}

uint64_t nowNanoseconds() {
    using namespace std::chrono;
    return static_cast<uint64_t>(duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count());
}

}  // namespace

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
    passSink_ = command.statistics;
    inPass_ = true;
    pass_.begin(targets);
    views_ = command.viewMask;
}

void Executor::run(const command::EndRendering&) {
    if (!inPass_) return;
    if (!pass_.end()) lost_ = true;
    inPass_ = false;
    finished_ = add(finished_, pass_.statistics());
    if (passSink_) *passSink_ = add(*passSink_, pass_.statistics());
    arena_.reset();
    dynamicSnapshot_ = nullptr;
    drawBindings_.changed = true;
}

void Executor::run(const command::Flush&) {
    if (inPass_) pass_.flush();
}

void Executor::run(const command::ClearAttachments& command) {
    if (!inPass_) return;
    for (const VkClearAttachment& attachment : command.attachments)
        for (const VkClearRect& rect : command.rects)
            pass_.clear(attachment.aspectMask, attachment.colorAttachment, attachment.clearValue, rect);
}

/// The transfer commands: one call per region.
#define VERNIER_PER_REGION(Name, items, call)                         \
    void Executor::run(const command::Name& command) {                \
        const TransferContext context{device_.pool(), device_.isa()}; \
        for (const auto& item : command.items) call;                  \
    }
VERNIER_PER_REGION(CopyBuffer, regions, copyBuffer(context, *command.source, *command.destination, item))
VERNIER_PER_REGION(CopyImage, regions, copyImage(context, *command.source, *command.destination, item))
VERNIER_PER_REGION(CopyBufferToImage, regions, copyBufferToImage(context, *command.buffer, *command.image, item))
VERNIER_PER_REGION(CopyImageToBuffer, regions, copyImageToBuffer(context, *command.image, *command.buffer, item))
VERNIER_PER_REGION(BlitImage, regions, blitImage(context, *command.source, *command.destination, item, command.filter))
VERNIER_PER_REGION(ResolveImage, regions, resolveImage(context, *command.source, *command.destination, item))
VERNIER_PER_REGION(ClearColorImage, ranges, clearColorImage(context, *command.image, command.value, item))
VERNIER_PER_REGION(ClearDepthStencilImage, ranges, clearDepthStencilImage(context, *command.image, command.value, item))
#undef VERNIER_PER_REGION

void Executor::run(const command::FillBuffer& command) {
    fillBuffer({device_.pool(), device_.isa()}, *command.buffer, command.offset, command.size, command.value);
}

void Executor::run(const command::UpdateBuffer& command) {
    updateBuffer(*command.buffer, command.offset, command.bytes);
}

PassStatistics Executor::totals() const {
    return inPass_ ? add(finished_, pass_.statistics()) : finished_;
}

void Executor::run(const command::BeginQuery& command) {
    if (inPass_) pass_.flush();
    queries_.push_back({command.pool, command.query, viewCount(), totals()});
    pass_.setExactCounts(true);
}

void Executor::run(const command::EndQuery& command) {
    if (inPass_) pass_.flush();
    for (auto query = queries_.begin(); query != queries_.end(); ++query) {
        if (query->pool != command.pool || query->query != command.query) continue;
        command.pool->write(command.query, subtract(totals(), query->start));
        // With multiview a query takes as many as there are views: "the first contains the result, the others zero".
        for (uint32_t n = 1; n < query->views; ++n) command.pool->write(command.query + n, {});
        queries_.erase(query);
        pass_.setExactCounts(!queries_.empty());
        return;
    }
}

void Executor::run(const command::WriteTimestamp& command) {
    if (inPass_) pass_.flush();
    const uint64_t now = nowNanoseconds();
    for (uint32_t n = 0; n < viewCount(); ++n) command.pool->writeTimestamp(command.query + n, now);
}

void Executor::run(const command::ResetQueries& command) {
    command.pool->reset(command.first, command.count);
}

void Executor::run(const command::CopyQueryResults& command) {
    const Buffer& buffer = *command.buffer;
    if (command.offset >= buffer.size()) return;
    command.pool->results(command.first, command.count, buffer.data() + command.offset, buffer.size() - command.offset,
                          command.stride, command.flags);
}

}  // namespace vernier
