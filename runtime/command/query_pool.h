// Query pools: occlusion, pipeline statistics, transform feedback, timestamps.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <vector>

#include "runtime/raster/render_pass.h"

namespace vernier {

/// Thread-safe: the host may read results while a queue writes them.
class QueryPool {
  public:
    QueryPool(VkQueryType type, uint32_t count, VkQueryPipelineStatisticFlags statistics);

    VkQueryType type() const { return type_; }
    uint32_t count() const { return static_cast<uint32_t>(queries_.size()); }

    void reset(uint32_t first, uint32_t count);
    /// `stream` < ir::kVertexStreams: whose primitives a query counts that is of one.
    void write(uint32_t query, const PassStatistics& difference, uint32_t stream = 0);
    void writeTimestamp(uint32_t query, uint64_t nanoseconds);

    /// While somebody holds the pool, results are still to be written: a reset has to wait.
    void hold() { ++holders_; }
    void release() { --holders_; }
    bool held() const { return holders_ != 0; }

    /// vkGetQueryPoolResults into `data`. VK_NOT_READY when something is missing and no wait was asked for; a wait is
    /// for the caller to do.
    VkResult results(uint32_t first, uint32_t count, std::byte* data, size_t size, VkDeviceSize stride,
                     VkQueryResultFlags flags) const;

  private:
    /// Of Vulkan 1.0; other bits of a pool's statistics do not count.
    static constexpr uint32_t kStatistics = 11;
    struct Query {
        bool available = false;
        std::array<uint64_t, kStatistics> values{};
    };
    VkQueryType type_;
    VkQueryPipelineStatisticFlags statistics_;
    uint32_t valuesPerQuery_;
    std::atomic<uint32_t> holders_{0};
    mutable std::mutex mutex_;
    std::vector<Query> queries_;
};

}  // namespace vernier
