// Query pools as objects, and reading their results on the host.
#include <chrono>
#include <thread>

#include "api/vulkan/allocation.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "runtime/command/query_pool.h"

namespace vernier::vulkan {
namespace {

/// How long a wait for results goes on when nothing is submitted that could bring them; after that the device
/// is called lost ("vkGetQueryPoolResults ... in finite time").
constexpr std::chrono::seconds kPatience{10};

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL CreateQueryPool(VkDevice device, const VkQueryPoolCreateInfo* pCreateInfo,
                                               const VkAllocationCallbacks* pAllocator, VkQueryPool* pQueryPool) {
    return guarded([&] {
        switch (pCreateInfo->queryType) {
            case VK_QUERY_TYPE_OCCLUSION:
            case VK_QUERY_TYPE_PIPELINE_STATISTICS:
            case VK_QUERY_TYPE_TIMESTAMP:
            case VK_QUERY_TYPE_TRANSFORM_FEEDBACK_STREAM_EXT:
            case VK_QUERY_TYPE_PRIMITIVES_GENERATED_EXT:
                break;
            default:
                return object(device)->report("vkCreateQueryPool", VK_ERROR_FEATURE_NOT_PRESENT,
                                              "queryType is not supported");
        }
        const bool statistics = pCreateInfo->queryType == VK_QUERY_TYPE_PIPELINE_STATISTICS;
        return createHandle(pAllocator, pQueryPool, pCreateInfo->queryType, pCreateInfo->queryCount,
                            statistics ? pCreateInfo->pipelineStatistics : 0);
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyQueryPool(VkDevice, VkQueryPool queryPool, const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, queryPool);
}

VKAPI_ATTR void VKAPI_CALL ResetQueryPool(VkDevice, VkQueryPool queryPool, uint32_t firstQuery, uint32_t queryCount) {
    object(queryPool)->reset(firstQuery, queryCount);
}

VKAPI_ATTR VkResult VKAPI_CALL GetQueryPoolResults(VkDevice device, VkQueryPool queryPool, uint32_t firstQuery,
                                                   uint32_t queryCount, size_t dataSize, void* pData,
                                                   VkDeviceSize stride, VkQueryResultFlags flags) {
    return guarded([&] {
        const Device& owner = *object(device);
        const QueryPool& pool = *object(queryPool);
        if (firstQuery > pool.count() || queryCount > pool.count() - firstQuery) {
            return owner.report("vkGetQueryPoolResults", VK_ERROR_UNKNOWN, "the queries are outside the pool");
        }
        auto* data = static_cast<std::byte*>(pData);
        const auto read = [&] { return pool.results(firstQuery, queryCount, data, dataSize, stride, flags); };
        VkResult result = read();
        if (result != VK_NOT_READY || (flags & VK_QUERY_RESULT_WAIT_BIT) == 0) return result;
        owner.runtime->queue().waitIdle();
        const auto deadline = std::chrono::steady_clock::now() + kPatience;
        while ((result = read()) == VK_NOT_READY) {
            if (owner.lost() || std::chrono::steady_clock::now() > deadline) return VK_ERROR_DEVICE_LOST;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return result;
    });
}

}  // namespace vernier::vulkan
