#include "conformance/scenes/scenes.h"

#include <algorithm>
#include <array>

namespace vernier::conformance {
namespace {

constexpr auto kScenes = std::to_array<SceneEntry>({
#define VERNIER_SCENE_ENTRY(name) {#name, &scenes::name},
    VERNIER_SCENES(VERNIER_SCENE_ENTRY)
#undef VERNIER_SCENE_ENTRY
});

}  // namespace

std::span<const SceneEntry> allScenes() {
    return kScenes;
}

const SceneEntry* findScene(std::string_view name) {
    const auto found =
        std::find_if(kScenes.begin(), kScenes.end(), [name](const SceneEntry& entry) { return entry.name == name; });
    return found == kScenes.end() ? nullptr : &*found;
}

}  // namespace vernier::conformance
