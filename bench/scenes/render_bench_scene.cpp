#include "bench/scenes/render_bench_scene.h"

#include <cstdio>

#include "bench/scenes/bench_scenes.h"
#include "conformance/tool/render_scene.h"

namespace vernier::bench {

using namespace conformance;

int renderBenchScene(const DriverPaths& paths, const std::string& driver, const std::string& scene,
                     const std::filesystem::path& out) {
    const Result<Scene> built = buildBenchScene(scene);
    const Result<Rendering> rendering =
        built ? renderScene(paths, driver, *built, false) : Result<Rendering>(built.error());
    const Status status = rendering ? saveRendering(*rendering, out) : Status(rendering.error());
    if (!status) std::fprintf(stderr, "%s\n", status.error().message.c_str());
    return status ? 0 : 2;
}

}  // namespace vernier::bench
