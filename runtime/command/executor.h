// Runs the commands of command buffers, one after the other, on the queue's thread. The work inside a command is shared
// out over the device's threads.
#pragma once

#include <array>
#include <bit>
#include <memory>
#include <vector>

#include "base/arena.h"
#include "runtime/command/command_buffer.h"
#include "runtime/command/device.h"
#include "runtime/command/dispatcher.h"
#include "runtime/raster/render_pass.h"

namespace vernier {

class Executor {
  public:
    explicit Executor(Device& device);
    ~Executor();

    /// State set by commands (pipeline, descriptors, dynamic state) starts anew. False: a shader ran out of its loop
    /// budget.
    bool run(const CommandBuffer& commands);

  private:
    void runAll(const CommandBuffer& commands);
#define VERNIER_COMMAND(name) void run(const command::name& command);
#include "runtime/command/commands.def"
#undef VERNIER_COMMAND

    void beginTargets(const command::BeginRendering& command);
    void draw(const command::Draw& command, uint32_t drawIndex);
    void refreshDrawBindings();
    void dispatch(const WorkGroupContext::Grid& grid, PassStatistics* statistics);
    PassStatistics totals() const;
    uint32_t viewCount() const {
        return inPass_ && views_ != 0 ? static_cast<uint32_t>(std::popcount(views_)) : 1;
    }

    Device& device_;
    RenderPass pass_;
    Dispatcher dispatcher_;
    bool inPass_ = false;
    uint32_t views_ = 0;  // of the pass
    bool lost_ = false;
    PassStatistics* passSink_ = nullptr;
    PassStatistics finished_;  // of the passes and dispatches that have ended

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

    /// What draws point to until their pass ends.
    Arena arena_;
    const GraphicsPipeline* pipeline_ = nullptr;
    DynamicState dynamic_;
    const DynamicState* dynamicSnapshot_ = nullptr;  // in the arena; nullptr after a change
    ResourceBindings vertexResources_, fragmentResources_;
    std::array<VertexStream, kMaxVertexBindings> vertexStreams_{};
    IndexStream indices_;

    /// What the next dispatch points to.
    Arena computeArena_;
    const ComputePipeline* computePipeline_ = nullptr;
    ResourceBindings computeResources_;

    struct ActiveQuery {
        QueryPool* pool;
        uint32_t query;
        uint32_t views;
        PassStatistics start;
    };
    std::vector<ActiveQuery> queries_;
};

}  // namespace vernier
