#include "bench/effects/count_effects.h"

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#define VERNIER_HAS_CALLGRIND 1
#else
#define VERNIER_HAS_CALLGRIND 0
#endif

#include <algorithm>
#include <charconv>
#include <fstream>

#include "conformance/drivers/try.h"
#include "conformance/drivers/vulkan_driver.h"

namespace vernier::bench {
namespace {

using namespace conformance;

void startCounting() {
#if VERNIER_HAS_CALLGRIND
    CALLGRIND_START_INSTRUMENTATION;
    CALLGRIND_ZERO_STATS;
#endif
}

void stopCounting([[maybe_unused]] const std::string& name) {
#if VERNIER_HAS_CALLGRIND
    CALLGRIND_STOP_INSTRUMENTATION;
    CALLGRIND_DUMP_STATS_AT(name.c_str());
#endif
}

}  // namespace

bool underValgrind() {
#if VERNIER_HAS_CALLGRIND
    return RUNNING_ON_VALGRIND != 0;
#else
    return false;
#endif
}

Result<std::vector<SceneCost>> drawEffect(const DriverPaths& paths, const Effect& effect) {
    const std::vector<DriverChoice> choices = driverChoices(paths);
    const auto icd = std::find_if(choices.begin(), choices.end(), [](const auto& each) { return each.name == "icd"; });
    if (icd == choices.end() || !icd->present()) return unsupported("Vernier's Vulkan driver is not there");
    VERNIER_TRY(selectVulkanDriver(*icd));
    const Result<std::unique_ptr<VulkanDriver>> driver = VulkanDriver::create({});
    if (!driver) return driver.error();
    std::vector<SceneCost> costs;
    constexpr SceneQueries kQueries[] = {SceneQueries::none, SceneQueries::aroundNothing, SceneQueries::aroundPasses};
    for (const Scene& scene : effect.scenes) {
        (*driver)->setQueries(effect.queries ? kQueries[costs.size()] : SceneQueries::none);
        if (underValgrind())
            (*driver)->setFrameMeter([&](const std::function<Status()>& runFrame) -> Result<FrameTimes> {
                // What is allocated and planned once is so after a second frame.
                VERNIER_TRY(runFrame());
                startCounting();
                const Status status = runFrame();
                stopCounting(scene.name);
                VERNIER_TRY(status);
                return FrameTimes{0, 1};
            });
        Timing timing;
        Result<std::vector<RenderedImage>> images = (*driver)->render(scene, &timing);
        if (!images) return images.error();
        costs.push_back({timing.frame, 0, std::move(images->front().texels)});
    }
    return costs;
}

uint64_t dumpedInstructions(const std::filesystem::path& folder, const std::string& name) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (!entry.path().filename().string().starts_with("callgrind.out")) continue;
        std::ifstream file(entry.path());
        bool ours = false;
        for (std::string line; std::getline(file, line);) {
            ours |= line == "desc: Trigger: Client Request: " + name;
            for (const std::string_view key : {"summary: ", "totals: "}) {
                if (!ours || !line.starts_with(key)) continue;
                uint64_t count = 0;
                std::from_chars(line.data() + key.size(), line.data() + line.size(), count);
                if (count > 0) return count;
            }
        }
    }
    return 0;
}

}  // namespace vernier::bench
