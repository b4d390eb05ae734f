// Runs the work-groups of a dispatch on the device's threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "base/thread_pool.h"
#include "runtime/plan/compute_pipeline.h"
#include "spirv_interp/program.h"

namespace vernier {

/// Keeps the registers of every thread from dispatch to dispatch. Dispatches may run side by side: each is begun by a
/// thread of the pool.
class Dispatcher {
  public:
    explicit Dispatcher(ThreadPool& pool) : pool_(pool), threads_(pool.threadCount()) {}

    /// Runs all work-groups and returns when they are done. False: a program ran out of its loop budget, and not all
    /// work was done.
    bool run(const ComputePipeline& pipeline, const ResourceBindings& bindings, const WorkGroupContext::Grid& grid);

  private:
    /// One thread's contexts, by program.
    struct Thread {
        struct Entry {
            WorkGroupContext context;
            uint64_t begun = 0;  // the dispatch that beginDispatch was last called for
        };
        std::unordered_map<const BatchProgram*, Entry> contexts;

        WorkGroupContext& begin(const ComputePipeline& pipeline, const ResourceBindings& bindings,
                                const WorkGroupContext::Grid& grid, uint64_t dispatch);
    };

    ThreadPool& pool_;
    std::vector<Thread> threads_;
    std::atomic<uint64_t> dispatches_{0};
};

}  // namespace vernier
