// vernier-soak [--seconds N | --frames N] [--seed N] [--workers N]: uses the driver from many threads at random for so
// long, or until so many frames are presented, compares what comes out with a model, and watches its memory.
// VK_DRIVER_FILES chooses another driver.
#include <vernier/vernier_glsl.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

#include <unistd.h>

#include "tests/vulkan/soak/context.h"

namespace {

using namespace vernier::soak;
using Clock = std::chrono::steady_clock;

/// Memory of the process that is present, in bytes.
uint64_t residentBytes() {
    std::ifstream file("/proc/self/statm");
    uint64_t pages = 0, resident = 0;
    file >> pages >> resident;
    return resident * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

/// How much may come after the first quarter: what the threads use goes up and down by a few megabytes. Sanitizers keep
/// what is freed for a while.
#ifdef VERNIER_SANITIZED
constexpr uint64_t kMostGrowth = uint64_t{1} << 30;
#else
constexpr uint64_t kMostGrowth = uint64_t{48} << 20;
#endif

struct Options {
    uint32_t seconds = 10, frames = 0, workers = 3;  // frames: presentations; 0 for as long as the seconds last
    uint32_t seed = static_cast<uint32_t>(Clock::now().time_since_epoch().count());
};

/// False for what it does not know.
bool read(int argc, char** argv, Options& options) {
    for (int i = 1; i < argc; i += 2) {
        const struct {
            const char* name;
            uint32_t& value;
        } known[] = {{"--seconds", options.seconds},
                     {"--frames", options.frames},
                     {"--workers", options.workers},
                     {"--seed", options.seed}};
        const auto* found = std::find_if(std::begin(known), std::end(known),
                                         [&](const auto& one) { return std::strcmp(one.name, argv[i]) == 0; });
        if (found == std::end(known) || i + 1 == argc) return false;
        char* rest = nullptr;
        found->value = static_cast<uint32_t>(std::strtoul(argv[i + 1], &rest, 10));
        if (*rest != '\0') return false;
    }
    return options.workers > 0;
}

struct Memory {
    uint64_t first = 0, most = 0;  // in the first quarter of the run, and ever; bytes
};

/// Looks at the memory until the run is over: so many seconds, or so many frames.
Memory watch(const Options& options, Context& context) {
    Memory memory;
    const Clock::time_point start = Clock::now();
    double done = 0;
    while (!context.verdict.failed() && done < 1) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        const uint64_t resident = residentBytes();
        done = options.frames != 0 ? static_cast<double>(context.presentations) / options.frames
                                   : std::chrono::duration<double>(Clock::now() - start).count() / options.seconds;
        if (done < 0.25 || memory.first == 0) memory.first = std::max(memory.first, resident);
        memory.most = std::max(memory.most, resident);
        if (memory.most > memory.first + kMostGrowth && done > 0.25) {
            context.verdict.fail("memory grew from " + std::to_string(memory.first >> 20) + " to " +
                                 std::to_string(memory.most >> 20) + " MiB");
        }
    }
    return memory;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    if (!read(argc, argv, options)) {
        std::fprintf(stderr, "usage: vernier-soak [--seconds N | --frames N] [--seed N] [--workers N]\n");
        return 64;
    }
    const uint32_t workers = options.workers, seed = options.seed;
    setenv("VK_DRIVER_FILES", VERNIER_ICD_JSON, 0);
    setenv("VK_ICD_FILENAMES", VERNIER_ICD_JSON, 0);
    setenv("VERNIER_REFRESH", "0", 0);
    std::printf("soak: --seed %u --workers %u %s %u\n", seed, workers, options.frames != 0 ? "--frames" : "--seconds",
                options.frames != 0 ? options.frames : options.seconds);
    std::fflush(stdout);
    vnRetainGlslCompiler();
    Verdict verdict;
    Memory memory;
    uint64_t submissions = 0, presentations = 0, devices = 0;
    {
        Context context(verdict);
        std::vector<uint64_t> counts(workers);
        std::vector<std::thread> threads;
        for (uint32_t i = 0; i < workers && !verdict.failed(); ++i)
            threads.emplace_back([&, i] { counts[i] = work(context, seed + i); });
        if (!verdict.failed()) {
            threads.emplace_back([&] { present(context, seed + 1000); });
            threads.emplace_back([&] { devices = makeDevices(verdict, seed + 2000); });
        }
        memory = watch(options, context);
        verdict.stop();
        for (std::thread& thread : threads) thread.join();
        for (const uint64_t count : counts) submissions += count;
        presentations = context.presentations;
    }
    vnReleaseGlslCompiler();
    std::printf("soak: %llu submissions, %llu presentations, %llu devices; %llu MiB after a quarter, %llu at most\n",
                static_cast<unsigned long long>(submissions), static_cast<unsigned long long>(presentations),
                static_cast<unsigned long long>(devices), static_cast<unsigned long long>(memory.first >> 20),
                static_cast<unsigned long long>(memory.most >> 20));
    return verdict.failed() || submissions == 0 ? 1 : 0;
}
