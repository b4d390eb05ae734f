#include "runtime/command/dispatcher.h"

#include <algorithm>

namespace vernier {
namespace {

constexpr size_t kMaxKeptContexts = 64;

/// Work-groups that a thread takes at a time: enough invocations that taking them costs nothing beside running them,
/// and enough chunks that the threads end together.
uint32_t chunkSize(uint64_t groups, uint32_t invocationsPerGroup, uint32_t threads) {
    constexpr uint64_t kFewestInvocations = 512, kChunksPerThread = 16, kMost = 1u << 20;
    if (threads == 1) return static_cast<uint32_t>(std::min(groups, kMost));
    const uint64_t fewest = (kFewestInvocations + invocationsPerGroup - 1) / invocationsPerGroup;
    const uint64_t fair = groups / (uint64_t{threads} * kChunksPerThread);
    return static_cast<uint32_t>(std::clamp(fair, std::min(fewest, kMost), kMost));
}

}  // namespace

WorkGroupContext& Dispatcher::Thread::begin(const ComputePipeline& pipeline, const ResourceBindings& bindings,
                                            const WorkGroupContext::Grid& grid, uint64_t dispatch) {
    const BatchProgram* key = pipeline.program().get();
    auto found = contexts.find(key);
    if (found == contexts.end()) {
        if (contexts.size() >= kMaxKeptContexts) contexts.clear();
        found = contexts.emplace(key, Entry{WorkGroupContext(pipeline.program())}).first;
    }
    Entry& entry = found->second;
    if (entry.begun != dispatch) {
        entry.context.beginDispatch(bindings, grid);
        entry.begun = dispatch;
    }
    return entry.context;
}

bool Dispatcher::run(const ComputePipeline& pipeline, const ResourceBindings& bindings,
                     const WorkGroupContext::Grid& grid) {
    const uint64_t groups = grid.size();
    if (groups == 0) return true;
    const uint64_t dispatch = ++dispatches_;
    const uint32_t chunk = chunkSize(groups, pipeline.invocations(), pool_.threadCount());
    // At most 65535^3 groups in chunks of a 2^20 at least when there are many: the count fits.
    const auto chunks = static_cast<uint32_t>((groups + chunk - 1) / chunk);
    std::atomic<bool> lost{false};
    pool_.parallelFor(chunks, [&](uint32_t index, uint32_t worker) {
        if (lost.load(std::memory_order_relaxed)) return;
        const uint64_t first = uint64_t{index} * chunk;
        const auto count = static_cast<uint32_t>(std::min<uint64_t>(chunk, groups - first));
        WorkGroupContext& context = threads_[worker].begin(pipeline, bindings, grid, dispatch);
        if (!context.run(first, count)) lost.store(true, std::memory_order_relaxed);
    });
    return !lost;
}

}  // namespace vernier
