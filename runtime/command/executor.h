// Walks through the commands of command buffers on the queue's thread and makes passes, dispatches and transfers pieces
// of work for all threads, with the memory that each reads and writes. Work that does not touch the same memory runs
// side by side, whatever barriers were recorded; all other work in the order of the commands. What the walk itself
// needs to know (indirect arguments, events) waits.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/arena.h"
#include "runtime/command/command_buffer.h"
#include "runtime/command/device.h"
#include "runtime/command/dispatcher.h"
#include "runtime/command/running_queries.h"
#include "runtime/command/scheduler.h"
#include "runtime/command/transform_feedback.h"
#include "runtime/raster/render_pass.h"
#include "runtime/raster/render_workers.h"

namespace vernier {

class Executor {
  public:
    explicit Executor(Device& device);
    ~Executor();

    /// State set by commands (pipeline, descriptors, dynamic state) starts anew. Work may still be running afterwards.
    void run(const CommandBuffer& commands);
    /// Waits for all work. False: a shader ran out of its loop budget. Throws what a piece of work threw.
    bool finish();
    /// All that was run since the executor was made; after finish().
    SubmissionReport ran() const { return {commandsRun_, finished_}; }

  private:
    void runAll(const CommandBuffer& commands);
#define VERNIER_COMMAND(name) void run(const command::name& command);
#include "runtime/command/commands.def"
#undef VERNIER_COMMAND

    /// The segments of a pass that count for a query.
    struct QueryPart {
        RunningQuery* query;
        uint32_t first, end;
    };
    static constexpr uint32_t kToTheEnd = ~0u;

    /// A pass that is recorded, waits, or runs, with all that its draws point to.
    struct PassWork {
        explicit PassWork(RenderWorkers& workers) : pass(workers) {}
        RenderPass pass;
        Arena arena;
        PassStatistics* sink = nullptr;
        bool begun = false;           // some of its draws have run
        bool writesVertices = false;  // vertex programs of it write memory
        AccessSet geometry;           // what its vertex stage reads
        AccessSet rest;               // attachments, and what fragment programs reach
        AccessSet captured;           // what transform feedback has written since the pass last caught up
        std::vector<QueryPart> queries;
    };
    /// One dispatch that waits or runs; lies in dispatchArena_.
    struct DispatchWork;

    PassWork& takePass();
    void submitPass(PassWork& work);
    void endPass(PassWork& work);
    void catchUp();
    void addStreams();

    void draw(const command::Draw& command);
    void awaitWrites(const VertexStream& stream);
    const CaptureTarget* placeCapture(const DrawCall& call);
    const CaptureTarget* placeRunning(const CapturePlan& plan);
    void checkBindings(const ir::Program& program, const BoundDescriptors& bound);
    void refreshDrawBindings();
    void dispatch(const DispatchWork& work);
    PassStatistics runDispatch(const DispatchWork& work);
    void count(const PassStatistics& difference, PassStatistics* sink);
    void addQueryPart(PassWork& work, RunningQuery& query, uint32_t first);
    void writeTimestamps(QueryPool& pool, uint32_t query, uint32_t views);
    uint32_t viewCount() const {
        return pass_ != nullptr && views_ != 0 ? static_cast<uint32_t>(std::popcount(views_)) : 1;
    }

    Device& device_;
    RenderWorkers workers_;
    Dispatcher dispatcher_;
    std::vector<std::unique_ptr<PassWork>> passes_;
    PassWork* pass_ = nullptr;  // that is being recorded
    uint32_t views_ = 0;        // of it
    std::atomic<bool> lost_{false};
    FrameCommands commandsRun_;

    std::mutex endedMutex_;              // of what follows, and of sinks of statistics
    std::vector<PassWork*> idlePasses_;  // the one that ended last is taken first: its memory is in the caches
    PassStatistics finished_;            // of the passes and dispatches that have ended
    std::atomic<uint32_t> idleCount_{0};

    /// What descriptors and push constants draws, or dispatches, find.
    struct Bindings {
        BoundDescriptors bound;
        std::array<std::byte, kMaxPushConstantBytes> pushConstants{};
        bool changed = true;
    };
    Bindings& bindings(command::BindPoint point) {
        return point == command::BindPoint::compute ? computeBindings_ : drawBindings_;
    }
    Bindings drawBindings_, computeBindings_;

    bool leavesOut_ = false;  // by conditional rendering

    const GraphicsPipeline* pipeline_ = nullptr;
    // Of it: memory is reached by address, before the rasteriser and behind it.
    bool vertexAddresses_ = false, fragmentAddresses_ = false;
    DynamicState dynamic_;
    const DynamicState* dynamicSnapshot_ = nullptr;  // in the pass's arena; nullptr after a change
    ResourceBindings vertexResources_, fragmentResources_;
    const StageResources* stageResources_ = nullptr;
    bool needsLevels_ = true;
    std::string misuseTold_;
    std::array<VertexStream, kMaxVertexBindings> vertexStreams_{};
    IndexStream indices_;
    bool streamsChanged_ = true;  // since they were last added to the accesses of the pass
    bool indicesReady_ = false;   // nothing that was submitted before the pass is still to write them
    TransformFeedback feedback_;

    /// What dispatches point to until they have run.
    Arena dispatchArena_;
    const ComputePipeline* computePipeline_ = nullptr;
    bool computeAddresses_ = false;
    ResourceBindings computeResources_;

    RunningQueries queries_;

    Scheduler scheduler_;  // last: its work uses everything above
};

}  // namespace vernier
