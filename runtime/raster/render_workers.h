// What render passes share: every thread's geometry and tile renderer, kept from pass to pass.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/thread_pool.h"
#include "runtime/geometry/assemble.h"
#include "runtime/raster/tile_renderer.h"

namespace vernier {

/// Several passes may run at a time, step by step: a thread's step belongs to one of them.
class RenderWorkers {
  public:
    struct Worker {
        Assembler assembler;
        TileRenderer renderer;
        uint64_t pass = 0;  // that it is set up for
    };

    explicit RenderWorkers(ThreadPool& pool) : pool_(pool) {
        for (uint32_t n = 0; n < pool.threadCount(); ++n) workers_.push_back(std::make_unique<Worker>());
    }

    ThreadPool& pool() { return pool_; }
    /// The thread's own, set up for pass `pass` (a number of takeNumbers).
    Worker& enter(uint32_t thread, uint64_t pass, const PassTargets& targets) {
        Worker& worker = *workers_[thread];
        if (worker.pass != pass) {
            worker.pass = pass;
            worker.assembler.contexts().trim();
            worker.renderer.startPass(targets);
        }
        return worker;
    }
    /// The first of `count` numbers that nobody else gets. They name passes and the bindings of draws.
    uint64_t takeNumbers(uint64_t count) { return next_.fetch_add(count, std::memory_order_relaxed); }

  private:
    ThreadPool& pool_;
    std::vector<std::unique_ptr<Worker>> workers_;
    std::atomic<uint64_t> next_{1};
};

}  // namespace vernier
