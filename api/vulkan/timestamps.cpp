// Calibrated time stamps (VK_EXT_calibrated_timestamps). The device counts nanoseconds of the steady clock, which is
// CLOCK_MONOTONIC.
#include <time.h>

#include <algorithm>
#include <chrono>

#include "api/vulkan/entry_points.h"
#include "api/vulkan/enumerate.h"

namespace vernier::vulkan {
namespace {

uint64_t deviceTime() {
    using namespace std::chrono;
    return static_cast<uint64_t>(duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count());
}

uint64_t hostTime(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<uint64_t>(now.tv_sec) * 1'000'000'000 + static_cast<uint64_t>(now.tv_nsec);
}

uint64_t timeOf(VkTimeDomainEXT domain) {
    switch (domain) {
        case VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT:
            return hostTime(CLOCK_MONOTONIC);
        case VK_TIME_DOMAIN_CLOCK_MONOTONIC_RAW_EXT:
            return hostTime(CLOCK_MONOTONIC_RAW);
        default:
            return deviceTime();
    }
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceCalibrateableTimeDomainsEXT(VkPhysicalDevice,
                                                                            uint32_t* pTimeDomainCount,
                                                                            VkTimeDomainEXT* pTimeDomains) {
    OutputArray<VkTimeDomainEXT> output(pTimeDomainCount, pTimeDomains);
    for (const VkTimeDomainEXT domain :
         {VK_TIME_DOMAIN_DEVICE_EXT, VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT, VK_TIME_DOMAIN_CLOCK_MONOTONIC_RAW_EXT}) {
        output.add(domain);
    }
    return output.result();
}

VKAPI_ATTR VkResult VKAPI_CALL GetCalibratedTimestampsEXT(VkDevice, uint32_t timestampCount,
                                                          const VkCalibratedTimestampInfoEXT* pTimestampInfos,
                                                          uint64_t* pTimestamps, uint64_t* pMaxDeviation) {
    const uint64_t before = deviceTime();
    std::transform(pTimestampInfos, pTimestampInfos + timestampCount, pTimestamps,
                   [](const VkCalibratedTimestampInfoEXT& info) { return timeOf(info.timeDomain); });
    // All were taken between two looks at the clock, whose ticks are nanoseconds.
    *pMaxDeviation = deviceTime() - before + 1;
    return VK_SUCCESS;
}

}  // namespace vernier::vulkan
