// Runs work-groups: whole ones one after the other, batch by batch up to the next barrier, or several small ones in one
// batch.
#include <algorithm>

#include "spirv_interp/batch/own_memory.h"
#include "spirv_interp/program.h"

namespace vernier {

using batch::kNone;
using batch::LaneMask;

struct WorkGroupContext::Impl {
    using GroupId = std::array<uint32_t, 3>;

    explicit Impl(std::shared_ptr<const BatchProgram> p)
        : shared(std::move(p)),
          lanes(shared.compiled.batch().lanes),
          size(sizeOf(shared.compiled.source())),
          groupsPerBatch(shared.compiled.packed() ? std::max(lanes / size, 1u) : 1),
          batchesPerGroup((size + lanes - 1) / lanes),
          draw(shared, shared.compiled.draw()),
          workGroup(shared, shared.compiled.workGroup()),
          memory(shared.compiled.source()) {
        const ir::Program& source = shared.compiled.source();
        // Only batches that wait for each other need registers of their own.
        const bool waits = source.hasBarriers && batchesPerGroup > 1;
        batches.reserve(waits ? batchesPerGroup : 1);
        for (uint32_t k = 0; k < (waits ? batchesPerGroup : 1); ++k) {
            batches.emplace_back(shared, shared.compiled.batch()).frame.suspends = waits;
        }
        for (uint32_t slot = 0; slot < source.inputs.size(); ++slot) addInput(slot);
    }

    static uint32_t sizeOf(const ir::Program& program) {
        return program.localSize[0] * program.localSize[1] * program.localSize[2];
    }

    /// An input with a row of its own; for those that depend on the invocation, what to put there for every batch of a
    /// work-group.
    struct RowInput {
        uint32_t row = 0;
        ir::Builtin builtin{};
        uint8_t component = 0;
        std::vector<uint32_t> pattern;
    };
    struct ScalarInput {
        uint32_t scalar = 0;
        ir::Builtin builtin{};
        uint8_t component = 0;
    };

    void addInput(uint32_t slot) {
        const ir::InterfaceSlot& input = shared.compiled.source().inputs[slot];
        const uint8_t component = std::min<uint8_t>(input.component, 2);
        const uint32_t scalar = shared.compiled.inputScalars()[slot], row = shared.compiled.batch().inputs[slot];
        if (scalar != kNone) scalarInputs.push_back({scalar, input.builtin, component});
        if (row == kNone) return;
        RowInput& made = rowInputs.emplace_back(RowInput{row, input.builtin, component, {}});
        const auto& localSize = shared.compiled.source().localSize;
        for (uint32_t lane = 0; lane < batchesPerGroup * lanes; ++lane) {
            const uint32_t index = groupsPerBatch > 1 ? lane % size : lane;
            if (input.builtin == ir::Builtin::localInvocationIndex) {
                made.pattern.push_back(index);
            } else if (input.builtin == ir::Builtin::localInvocationId) {
                const uint32_t id[3] = {index % localSize[0], index / localSize[0] % localSize[1],
                                        index / localSize[0] / localSize[1]};
                made.pattern.push_back(id[component]);
            }
        }
    }

    void begin(const ResourceBindings& bindings, const Grid& newGrid) {
        grid = newGrid;
        shared.bindings = memory.bind(bindings);
        for (const ScalarInput& input : scalarInputs) {
            if (input.builtin == ir::Builtin::numWorkgroups) shared.scalars[input.scalar] = grid.count[input.component];
        }
        draw.runStraight();
    }

    GroupId groupAt(uint64_t linear) const {
        const uint64_t row = linear / grid.count[0];
        return {static_cast<uint32_t>(linear % grid.count[0]), static_cast<uint32_t>(row % grid.count[1]),
                static_cast<uint32_t>(row / grid.count[1])};
    }
    void step(GroupId& id) const {
        if (++id[0] < grid.count[0]) return;
        id[0] = 0;
        if (++id[1] < grid.count[1]) return;
        id[1] = 0;
        ++id[2];
    }

    /// Starts batch k of a work-group, or a batch of `groups` work-groups, the first of which is `id`.
    void start(batch::RunState& state, uint32_t k, const GroupId& id, uint32_t groups) {
        const uint32_t active = groupsPerBatch > 1 ? groups * size : std::min(size - k * lanes, lanes);
        for (const RowInput& input : rowInputs) {
            uint32_t* row = state.row(input.row);
            const uint8_t c = input.component;
            if (!input.pattern.empty()) {
                std::copy_n(input.pattern.data() + size_t{k} * lanes, lanes, row);
            } else if (input.builtin == ir::Builtin::numWorkgroups) {
                std::fill_n(row, lanes, grid.count[c]);
            } else if (groupsPerBatch == 1) {
                std::fill_n(row, lanes, grid.base[c] + id[c]);
            } else {
                GroupId at = id;
                for (uint32_t g = 0; g < groups; ++g, step(at)) std::fill_n(row + g * size, size, grid.base[c] + at[c]);
            }
        }
        const LaneMask all = LaneMask::first(active);
        state.begin(active, all, all);
    }

    bool runPacked(const GroupId& id, uint32_t groups) {
        start(batches[0], 0, id, groups);
        return batches[0].run();
    }

    bool runGroup(const GroupId& id) {
        for (const ScalarInput& input : scalarInputs) {
            if (input.builtin != ir::Builtin::workgroupId) continue;
            shared.scalars[input.scalar] = grid.base[input.component] + id[input.component];
        }
        workGroup.runStraight();
        // What is read before it is written does not tell of other work-groups.
        std::fill_n(memory.words(), memory.wordCount(), 0u);
        if (batches.size() == 1) {
            for (uint32_t k = 0; k < batchesPerGroup; ++k) {
                start(batches[0], k, id, 1);
                if (!batches[0].run()) return false;
            }
            return true;
        }
        for (uint32_t k = 0; k < batchesPerGroup; ++k) start(batches[k], k, id, 1);
        // Round by round from barrier to barrier. A batch that ends earlier than others no longer takes part, so that
        // barriers in control flow that is not uniform (undefined in Vulkan) end all the same.
        for (bool waiting = true; waiting;) {
            waiting = false;
            for (batch::RunState& state : batches) {
                if (state.ended()) continue;
                if (!state.run()) {
                    for (batch::RunState& other : batches) other.abandon();
                    return false;
                }
                waiting |= !state.ended();
            }
        }
        return true;
    }

    bool run(uint64_t first, uint32_t count) {
        if (count == 0) return true;  // a grid without work-groups has no first
        GroupId id = groupAt(first);
        while (count != 0) {
            const uint32_t groups = std::min(count, groupsPerBatch);
            if (!(shared.compiled.packed() ? runPacked(id, groups) : runGroup(id))) return false;
            for (uint32_t g = 0; g < groups; ++g) step(id);
            count -= groups;
        }
        return true;
    }

    batch::SharedState shared;
    const uint32_t lanes, size, groupsPerBatch, batchesPerGroup;
    batch::RunState draw, workGroup;
    std::vector<batch::RunState> batches;
    batch::OwnMemory memory;
    std::vector<RowInput> rowInputs;
    std::vector<ScalarInput> scalarInputs;
    Grid grid;
};

WorkGroupContext::WorkGroupContext(std::shared_ptr<const BatchProgram> program)
    : impl_(std::make_unique<Impl>(std::move(program))) {}
WorkGroupContext::~WorkGroupContext() = default;
WorkGroupContext::WorkGroupContext(WorkGroupContext&&) noexcept = default;
WorkGroupContext& WorkGroupContext::operator=(WorkGroupContext&&) noexcept = default;

void WorkGroupContext::beginDispatch(const ResourceBindings& bindings, const Grid& grid) {
    impl_->begin(bindings, grid);
}

bool WorkGroupContext::run(uint64_t first, uint32_t count) {
    return impl_->run(first, count);
}

}  // namespace vernier
