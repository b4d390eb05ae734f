#include "bench/scenes/bench_scenes.h"
#include "bench/scenes/growth_scenes.h"

namespace vernier::bench {
namespace {

using namespace conformance;

constexpr SceneEntry kSpeedScenes[] = {
#define VERNIER_SCENE_ENTRY(name) {#name, &speed::name},
    VERNIER_SPEED_SCENES(VERNIER_SCENE_ENTRY)
#undef VERNIER_SCENE_ENTRY
};

constexpr SceneEntry kTransferScenes[] = {
#define VERNIER_SCENE_ENTRY(name) {#name, &transfer::name},
    VERNIER_TRANSFER_SCENES(VERNIER_SCENE_ENTRY)
#undef VERNIER_SCENE_ENTRY
};

}  // namespace

std::span<const SceneEntry> speedScenes() {
    return kSpeedScenes;
}

std::span<const SceneEntry> transferScenes() {
    return kTransferScenes;
}

Result<Scene> buildBenchScene(std::string_view name) {
    for (const std::span<const SceneEntry> list : {speedScenes(), transferScenes()})
        for (const SceneEntry& entry : list)
            if (entry.name == name) return entry.build();
    return growthScene(name);
}

}  // namespace vernier::bench
