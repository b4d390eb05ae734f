#include "runtime/command/query_pool.h"

#include <bit>
#include <cstring>

namespace vernier {
namespace {

/// The value of one bit of VkQueryPipelineStatisticFlags.
uint64_t statisticOf(VkQueryPipelineStatisticFlags bit, const PassStatistics& s) {
    switch (bit) {
        case VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT:
            return s.inputVertices;
        case VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT:
            return s.inputPrimitives;
        case VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT:
            return s.vertexInvocations;
        case VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_CONTROL_SHADER_PATCHES_BIT:
            return s.controlPatches;
        case VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_EVALUATION_SHADER_INVOCATIONS_BIT:
            return s.evaluationInvocations;
        case VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_INVOCATIONS_BIT:
            return s.geometryInvocations;
        case VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_PRIMITIVES_BIT:
            return s.geometryPrimitives;
        case VK_QUERY_PIPELINE_STATISTIC_CLIPPING_INVOCATIONS_BIT:
            return s.clippingInvocations;
        case VK_QUERY_PIPELINE_STATISTIC_CLIPPING_PRIMITIVES_BIT:
            return s.clippingPrimitives;
        case VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT:
            return s.fragmentInvocations;
        case VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT:
            return s.computeInvocations;
        default:
            return 0;  // stages that do not exist run no invocations
    }
}

uint32_t valuesOf(VkQueryType type, VkQueryPipelineStatisticFlags statistics) {
    switch (type) {
        case VK_QUERY_TYPE_PIPELINE_STATISTICS:
            return static_cast<uint32_t>(std::popcount(statistics));
        case VK_QUERY_TYPE_TRANSFORM_FEEDBACK_STREAM_EXT:
            return 2;
        default:
            return 1;
    }
}

void put(std::byte* target, uint64_t value, bool wide) {
    if (wide) return static_cast<void>(std::memcpy(target, &value, sizeof value));
    const auto narrow = static_cast<uint32_t>(value);
    std::memcpy(target, &narrow, sizeof narrow);
}

}  // namespace

QueryPool::QueryPool(VkQueryType type, uint32_t count, VkQueryPipelineStatisticFlags statistics)
    : type_(type),
      statistics_(statistics & ((1u << kStatistics) - 1)),
      valuesPerQuery_(valuesOf(type, statistics_)),
      queries_(count) {}

void QueryPool::reset(uint32_t first, uint32_t count) {
    const std::lock_guard lock(mutex_);
    for (uint32_t i = first; i < first + count && i < queries_.size(); ++i) queries_[i] = {};
}

void QueryPool::write(uint32_t query, const PassStatistics& difference, uint32_t stream) {
    const std::lock_guard lock(mutex_);
    if (query >= queries_.size()) return;
    Query& target = queries_[query];
    target.available = true;
    switch (type_) {
        case VK_QUERY_TYPE_OCCLUSION:
            target.values[0] = difference.samplesPassed;
            return;
        case VK_QUERY_TYPE_PRIMITIVES_GENERATED_EXT:
            target.values[0] = difference.generatedPrimitives[stream];
            return;
        case VK_QUERY_TYPE_TRANSFORM_FEEDBACK_STREAM_EXT:
            target.values[0] = difference.capturedPrimitives[stream];
            target.values[1] = difference.capturablePrimitives[stream];
            return;
        default:
            break;
    }
    size_t next = 0;
    for (VkQueryPipelineStatisticFlags left = statistics_; left != 0; left &= left - 1)
        target.values[next++] = statisticOf(left & -left, difference);
}

void QueryPool::writeTimestamp(uint32_t query, uint64_t nanoseconds) {
    const std::lock_guard lock(mutex_);
    if (query >= queries_.size()) return;
    queries_[query].available = true;
    queries_[query].values[0] = nanoseconds;
}

VkResult QueryPool::results(uint32_t first, uint32_t count, std::byte* data, size_t size, VkDeviceSize stride,
                            VkQueryResultFlags flags) const {
    const std::lock_guard lock(mutex_);
    const bool wide = (flags & VK_QUERY_RESULT_64_BIT) != 0;
    const bool withAvailability = (flags & VK_QUERY_RESULT_WITH_AVAILABILITY_BIT) != 0;
    const size_t bytes = wide ? 8 : 4;
    const size_t row = (valuesPerQuery_ + (withAvailability ? 1 : 0)) * bytes;
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < count && first + i < queries_.size(); ++i) {
        const Query& query = queries_[first + i];
        if (i * stride + row > size) break;
        std::byte* target = data + i * stride;
        if (!query.available) result = VK_NOT_READY;
        if (query.available || (flags & VK_QUERY_RESULT_PARTIAL_BIT) != 0)
            for (uint32_t v = 0; v < valuesPerQuery_; ++v) put(target + v * bytes, query.values[v], wide);
        if (withAvailability) put(target + valuesPerQuery_ * bytes, query.available, wide);
    }
    return result;
}

}  // namespace vernier
