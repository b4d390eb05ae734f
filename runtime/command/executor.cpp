#include "runtime/command/executor.h"

#include <algorithm>

#include "runtime/command/buffer_range.h"
#include "runtime/command/misuse.h"
#include "runtime/command/query_pool.h"
#include "runtime/resource/texture_unit.h"

namespace vernier {
namespace {

/// Draws after which a pass renders what it has: each takes about a kilobyte until then.
constexpr size_t kDrawsPerFlush = 1 << 13;
/// Bytes of what dispatches point to after which they are waited for.
constexpr size_t kDispatchBytes = 16 << 20;

/// Applies what a pipeline fixes for every state the dynamic mask leaves out.
void applyFixedState(const DynamicState& fixed, uint32_t dynamicMask, DynamicState& state) {
    const auto isFixed = [&](VkDynamicState name) { return (dynamicMask & dynamicStateBit(name)) == 0; };
    state.viewportCount = fixed.viewportCount;
    if (isFixed(VK_DYNAMIC_STATE_VIEWPORT)) state.viewports = fixed.viewports;
    if (isFixed(VK_DYNAMIC_STATE_SCISSOR)) state.scissors = fixed.scissors;
    if (isFixed(VK_DYNAMIC_STATE_LINE_WIDTH)) state.lineWidth = fixed.lineWidth;
    if (isFixed(VK_DYNAMIC_STATE_LINE_STIPPLE_EXT)) {
        state.lineStippleFactor = fixed.lineStippleFactor;
        state.lineStipplePattern = fixed.lineStipplePattern;
    }
    if (isFixed(VK_DYNAMIC_STATE_DEPTH_BIAS)) {
        state.depthBiasConstant = fixed.depthBiasConstant;
        state.depthBiasClamp = fixed.depthBiasClamp;
        state.depthBiasSlope = fixed.depthBiasSlope;
    }
    if (isFixed(VK_DYNAMIC_STATE_BLEND_CONSTANTS)) state.blendConstants = fixed.blendConstants;
    if (isFixed(VK_DYNAMIC_STATE_COLOR_WRITE_ENABLE_EXT)) state.colorWrites = fixed.colorWrites;
    if (isFixed(VK_DYNAMIC_STATE_DEPTH_BOUNDS)) {
        state.minDepthBounds = fixed.minDepthBounds;
        state.maxDepthBounds = fixed.maxDepthBounds;
    }
    if (isFixed(VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_EXT)) state.sampleLocations = fixed.sampleLocations;
    const auto stencil = [&](VkDynamicState name, uint32_t DynamicState::StencilFace::*field) {
        if (!isFixed(name)) return;
        state.stencilFront.*field = fixed.stencilFront.*field;
        state.stencilBack.*field = fixed.stencilBack.*field;
    };
    stencil(VK_DYNAMIC_STATE_STENCIL_COMPARE_MASK, &DynamicState::StencilFace::compareMask);
    stencil(VK_DYNAMIC_STATE_STENCIL_WRITE_MASK, &DynamicState::StencilFace::writeMask);
    stencil(VK_DYNAMIC_STATE_STENCIL_REFERENCE, &DynamicState::StencilFace::reference);
}

}  // namespace

/// A dispatch with all it needs. Indirect counts are read when it runs.
struct Executor::DispatchWork {
    const ComputePipeline* pipeline;
    ResourceBindings resources;
    WorkGroupContext::Grid grid;
    command::BufferRange arguments;  // buffer not nullptr: VkDispatchIndirectCommand
    PassStatistics* statistics;
    std::span<RunningQuery* const> queries;  // that are open
};

Executor::Executor(Device& device)
    : device_(device), workers_(device.pool()), dispatcher_(device.pool()), scheduler_(device.pool()) {}
Executor::~Executor() = default;

void Executor::run(const CommandBuffer& commands) {
    pipeline_ = nullptr;
    dynamic_ = {};
    dynamicSnapshot_ = nullptr;
    drawBindings_ = {};
    computePipeline_ = nullptr;
    computeBindings_ = {};
    vertexStreams_ = {};
    indices_ = {};
    leavesOut_ = false;
    feedback_ = {};
    runAll(commands);
    if (pass_ != nullptr) run(command::EndRendering{});
    queries_.abandon();
}

bool Executor::finish() {
    scheduler_.finish();
    dispatchArena_.reset();
    return !lost_;
}

void Executor::runAll(const CommandBuffer& commands) {
    for (const CommandHeader* header = commands.first(); header; header = header->next) {
        switch (header->type) {
#define VERNIER_COMMAND(name)                                     \
    case CommandType::name:                                       \
        run(*static_cast<const command::name*>(header->payload)); \
        break;
#include "runtime/command/commands.def"
#undef VERNIER_COMMAND
        }
    }
}

void Executor::run(const command::BindPipeline& command) {
    pipeline_ = command.pipeline;
    vertexAddresses_ = command.vertexAddresses;
    fragmentAddresses_ = command.fragmentAddresses;
    if (command.fixed) applyFixedState(*command.fixed, command.dynamicMask, dynamic_);
    dynamicSnapshot_ = nullptr;
    drawBindings_.changed = true;
}

void Executor::run(const command::BindComputePipeline& command) {
    computePipeline_ = command.pipeline;
    computeAddresses_ = command.addresses;
    computeBindings_.changed = true;
}

void Executor::run(const command::BindDescriptorSets& command) {
    Bindings& to = bindings(command.bindPoint);
    for (size_t i = 0; i < command.sets.size() && command.firstSet + i < std::size(to.bound.sets); ++i) {
        to.bound.sets[command.firstSet + i] = command.sets[i];
        to.bound.dynamicOffsets[command.firstSet + i] =
            i < command.dynamicOffsets.size() ? command.dynamicOffsets[i] : std::span<const uint32_t>{};
    }
    to.changed = true;
}

void Executor::run(const command::PushConstants& command) {
    const auto write = [&](Bindings& to) {
        if (command.offset > to.pushConstants.size()) return;
        const size_t room = to.pushConstants.size() - command.offset;
        std::copy_n(command.bytes.data(), std::min(command.bytes.size(), room),
                    to.pushConstants.data() + command.offset);
        to.changed = true;
    };
    if (command.stages & ~VkShaderStageFlags{VK_SHADER_STAGE_COMPUTE_BIT}) write(drawBindings_);
    if (command.stages & VK_SHADER_STAGE_COMPUTE_BIT) write(computeBindings_);
}

void Executor::run(const command::BindVertexBuffers& command) {
    for (size_t i = 0; i < command.ranges.size() && command.first + i < vertexStreams_.size(); ++i)
        vertexStreams_[command.first + i] = streamOf(command.ranges[i]);
    streamsChanged_ = true;
}

void Executor::run(const command::BindIndexBuffer& command) {
    const VertexStream stream = streamOf(command.range);
    indices_ = {stream.data, stream.size, command.type};
    streamsChanged_ = true;
}

void Executor::run(const command::SetViewports& command) {
    for (size_t i = 0; i < command.viewports.size() && command.first + i < kMaxViewports; ++i)
        dynamic_.viewports[command.first + i] = command.viewports[i];
    dynamicSnapshot_ = nullptr;
}

void Executor::run(const command::SetScissors& command) {
    for (size_t i = 0; i < command.scissors.size() && command.first + i < kMaxViewports; ++i)
        dynamic_.scissors[command.first + i] = command.scissors[i];
    dynamicSnapshot_ = nullptr;
}

void Executor::run(const command::SetLineWidth& command) {
    dynamic_.lineWidth = command.width;
    dynamicSnapshot_ = nullptr;
}

void Executor::run(const command::SetLineStipple& command) {
    dynamic_.lineStippleFactor = command.factor;
    dynamic_.lineStipplePattern = command.pattern;
    dynamicSnapshot_ = nullptr;
}

void Executor::run(const command::SetDepthBias& command) {
    dynamic_.depthBiasConstant = command.constant;
    dynamic_.depthBiasClamp = command.clamp;
    dynamic_.depthBiasSlope = command.slope;
    dynamicSnapshot_ = nullptr;
}

void Executor::run(const command::SetBlendConstants& command) {
    dynamic_.blendConstants = command.constants;
    dynamicSnapshot_ = nullptr;
}

void Executor::run(const command::SetColorWrites& command) {
    dynamic_.colorWrites = command.mask;
    dynamicSnapshot_ = nullptr;
}

void Executor::run(const command::SetDepthBounds& command) {
    dynamic_.minDepthBounds = command.min;
    dynamic_.maxDepthBounds = command.max;
    dynamicSnapshot_ = nullptr;
}

void Executor::run(const command::SetSampleLocations& command) {
    dynamic_.sampleLocations = command.locations;
    dynamicSnapshot_ = nullptr;
}

void Executor::run(const command::SetStencil& command) {
    using Field = command::SetStencil::Field;
    uint32_t DynamicState::StencilFace::*field =
        command.field == Field::compareMask ? &DynamicState::StencilFace::compareMask
        : command.field == Field::writeMask ? &DynamicState::StencilFace::writeMask
                                            : &DynamicState::StencilFace::reference;
    if (command.faces & VK_STENCIL_FACE_FRONT_BIT) dynamic_.stencilFront.*field = command.value;
    if (command.faces & VK_STENCIL_FACE_BACK_BIT) dynamic_.stencilBack.*field = command.value;
    dynamicSnapshot_ = nullptr;
}

/// The same thing again and again is told once.
void Executor::checkBindings(const ir::Program& program, const BoundDescriptors& bound) {
    if (!device_.desc().misuse) return;
    std::string text = missingDescriptor(program, bound);
    if (text.empty() || text == misuseTold_) return;
    misuseTold_ = std::move(text);
    device_.desc().misuse(misuseTold_);
}

void Executor::refreshDrawBindings() {
    if (!drawBindings_.changed) return;
    drawBindings_.changed = false;
    BoundDescriptors& bound = drawBindings_.bound;
    Arena& arena = pass_->arena;
    bound.pushConstants = arena.copy(std::span<const std::byte>(drawBindings_.pushConstants));
    StageResources* others = nullptr;
    for (const StageProgram& stage : pipeline_->program().stages()) {
        const ir::Program& program = stage.program->source();
        checkBindings(program, bound);
        ResourceBindings resources = resolveBindings(program, bound, pipeline_->accuracy(), arena);
        addAccesses(program, bound, pass_->geometry);
        if (vertexAddresses_) {
            resources.addresses = device_.addresses().resolver();
            addAddressAccesses(program, device_.addresses(), pass_->geometry);
        }
        pass_->writesVertices |= program.hasSideEffects;
        if (stage.stage == ir::Stage::vertex) {
            vertexResources_ = resources;
        } else {
            if (others == nullptr) others = arena.create(StageResources());
            others->of(stage.stage) = resources;
        }
    }
    stageResources_ = others;
    fragmentResources_ = {};
    if (pipeline_->fragmentIr() == nullptr) return;
    checkBindings(*pipeline_->fragmentIr(), bound);
    fragmentResources_ = resolveBindings(*pipeline_->fragmentIr(), bound, pipeline_->accuracy(), arena);
    needsLevels_ =
        pipeline_->planWithoutQuads() == nullptr || needsLevels(*pipeline_->fragmentIr(), fragmentResources_);
    addAccesses(*pipeline_->fragmentIr(), bound, pass_->rest);
    if (fragmentAddresses_) {
        fragmentResources_.addresses = device_.addresses().resolver();
        addAddressAccesses(*pipeline_->fragmentIr(), device_.addresses(), pass_->rest);
    }
}

/// Vertex fetch may read to the end of every buffer that is bound.
void Executor::addStreams() {
    if (!streamsChanged_) return;
    streamsChanged_ = false;
    for (const VertexStream& stream : vertexStreams_) pass_->geometry.read(stream.data, stream.size);
    pass_->geometry.read(indices_.data, indices_.size);
    indicesReady_ = false;
}

/// Waits for what is still to write memory that the walk reads.
void Executor::awaitWrites(const VertexStream& stream) {
    AccessSet& reads = scheduler_.nextAccesses();
    reads.read(stream.data, stream.size);
    reads.finish();
    scheduler_.waitFor(scheduler_.conflicting(reads));
}

void Executor::draw(const command::Draw& command) {
    if (leavesOut_ || !pipeline_ || pass_ == nullptr || command.count == 0 || command.instances == 0) return;
    if (command.indexed && !indices_.data) return;
    refreshDrawBindings();
    addStreams();
    if (command.indexed && pipeline_->state().primitiveRestart && !indicesReady_) {
        // Where primitives are cut is found out now.
        awaitWrites({indices_.data, indices_.size});
        indicesReady_ = true;
    }
    if (!dynamicSnapshot_) dynamicSnapshot_ = pass_->arena.create(dynamic_);
    DrawCall call;
    call.pipeline = pipeline_;
    call.dynamic = dynamicSnapshot_;
    call.vertexStreams = vertexStreams_;
    if (command.indexed) call.indices = indices_;
    call.vertexResources = vertexResources_;
    call.fragmentResources = fragmentResources_;
    call.stageResources = stageResources_;
    call.needsLevels = needsLevels_;
    call.count = command.count;
    call.instances = command.instances;
    call.first = command.first;
    call.vertexOffset = command.vertexOffset;
    call.firstInstance = command.firstInstance;
    call.drawIndex = command.drawIndex;
    if (feedback_.active() && views_ == 0) call.capture = placeCapture(call);
    ++commandsRun_.draws;
    pass_->pass.draw(call);
    if (call.capture != nullptr && call.capture->running != nullptr) {
        catchUp();
        feedback_.goOn(*call.capture->running);
    }
    if (pass_->pass.recordedDraws() >= kDrawsPerFlush) catchUp();
}

void Executor::run(const command::Draw& command) {
    draw(command);
}

void Executor::run(const command::BeginConditionalRendering& command) {
    awaitWrites(argumentBytes<uint32_t>(command.predicate));
    const bool passes = argumentsAt<uint32_t>(command.predicate).value_or(0) != 0;
    leavesOut_ = passes == command.inverted;
}

void Executor::run(const command::EndConditionalRendering&) {
    leavesOut_ = false;
}

void Executor::run(const command::DrawIndirect& command) {
    if (leavesOut_) return;
    uint32_t count = command.drawCount;
    if (command.countBuffer.buffer) {
        awaitWrites(argumentBytes<uint32_t>(command.countBuffer));
        count = std::min(count, argumentsAt<uint32_t>(command.countBuffer).value_or(0));
    }
    awaitWrites(command.indexed ? argumentBytes<VkDrawIndexedIndirectCommand>(command.arguments, count, command.stride)
                                : argumentBytes<VkDrawIndirectCommand>(command.arguments, count, command.stride));
    for (uint32_t i = 0; i < count; ++i) {
        const VkDeviceSize offset = VkDeviceSize{i} * command.stride;
        if (command.indexed) {
            const auto a = argumentsAt<VkDrawIndexedIndirectCommand>(command.arguments, offset);
            if (!a) return;
            draw({true, a->indexCount, a->instanceCount, a->firstIndex, a->firstInstance, a->vertexOffset, i});
        } else {
            const auto a = argumentsAt<VkDrawIndirectCommand>(command.arguments, offset);
            if (!a) return;
            draw({false, a->vertexCount, a->instanceCount, a->firstVertex, a->firstInstance, 0, i});
        }
    }
}

void Executor::dispatch(const DispatchWork& work) {
    if (leavesOut_ || !computePipeline_ || pass_ != nullptr || lost_) return;
    ++commandsRun_.dispatches;
    if (dispatchArena_.used() > kDispatchBytes) {
        scheduler_.finish();
        dispatchArena_.reset();
        computeBindings_.changed = true;
    }
    AccessSet& accesses = scheduler_.nextAccesses();
    BoundDescriptors& bound = computeBindings_.bound;
    if (computeBindings_.changed) {
        computeBindings_.changed = false;
        bound.pushConstants = dispatchArena_.copy(std::span<const std::byte>(computeBindings_.pushConstants));
        checkBindings(computePipeline_->ir(), bound);
        computeResources_ =
            resolveBindings(computePipeline_->ir(), bound, computePipeline_->accuracy(), dispatchArena_);
        if (computeAddresses_) computeResources_.addresses = device_.addresses().resolver();
    }
    addAccesses(computePipeline_->ir(), bound, accesses);
    if (computeAddresses_) addAddressAccesses(computePipeline_->ir(), device_.addresses(), accesses);
    if (work.arguments.buffer != nullptr) {
        const VertexStream stream = argumentBytes<VkDispatchIndirectCommand>(work.arguments);
        accesses.read(stream.data, stream.size);
    }
    DispatchWork& kept = *dispatchArena_.create(work);
    kept.pipeline = computePipeline_;
    kept.resources = computeResources_;
    kept.queries = dispatchArena_.copy(std::span<RunningQuery* const>(queries_.open()));
    for (RunningQuery* query : kept.queries) queries_.addPart(*query);
    scheduler_.submit([this, &kept] {
        const PassStatistics counted = runDispatch(kept);
        count(counted, kept.statistics);
        for (RunningQuery* query : kept.queries) queries_.partEnded(*query, counted);
    });
}

PassStatistics Executor::runDispatch(const DispatchWork& work) {
    PassStatistics counted;
    WorkGroupContext::Grid grid = work.grid;
    if (work.arguments.buffer != nullptr) {
        const auto a = argumentsAt<VkDispatchIndirectCommand>(work.arguments);
        if (!a) return counted;
        grid.count = {a->x, a->y, a->z};
        if (!checkGroupCounts(grid.count)) return counted;
    }
    if (grid.size() == 0) return counted;
    if (!dispatcher_.run(*work.pipeline, work.resources, grid)) lost_ = true;
    counted.computeInvocations = grid.size() * work.pipeline->invocations();
    return counted;
}

void Executor::run(const command::Dispatch& command) {
    dispatch({nullptr, {}, {command.count, command.base}, {}, command.statistics, {}});
}

void Executor::run(const command::DispatchIndirect& command) {
    dispatch({nullptr, {}, {}, command.arguments, command.statistics, {}});
}

void Executor::run(const command::ExecuteCommands& command) {
    for (const CommandBuffer* buffer : command.buffers) runAll(*buffer);
}

void Executor::run(const command::SetEvent& command) {
    // Work before an event is done when the event is seen to be set.
    catchUp();
    command.event->store(command.value, std::memory_order_release);
    command.event->notify_all();
}

void Executor::run(const command::WaitEvent& command) {
    catchUp();
    command.event->wait(false, std::memory_order_acquire);
}

}  // namespace vernier
