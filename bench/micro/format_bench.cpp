// Nanoseconds per texel of row conversions, 128 texels at a time.
#include <benchmark/benchmark.h>

#include <random>
#include <string>
#include <vector>

#include "runtime/format/format.h"

namespace vernier {
namespace {

constexpr size_t kTexels = 128;

void convert(benchmark::State& state, VkFormat format, bool pack, Isa isa) {
    const FormatOps ops = formatOps(format, isa);
    std::vector<std::byte> texels(kTexels * ops.layout.bytes);
    std::vector<uint32_t> values(kTexels * 4);
    std::mt19937 random(1);
    for (std::byte& b : texels) b = static_cast<std::byte>(random() & 0x3f);
    void* planes[4];
    for (size_t c = 0; c < 4; ++c) planes[c] = &values[c * kTexels];
    ops.unpack(texels.data(), kTexels, planes);
    for (auto _ : state) {
        if (pack) {
            ops.pack(planes, kTexels, texels.data());
        } else {
            ops.unpack(texels.data(), kTexels, planes);
        }
        benchmark::ClobberMemory();
    }
    state.counters["ns/texel"] = benchmark::Counter(static_cast<double>(state.iterations()) * kTexels * 1e-9,
                                                    benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace
}  // namespace vernier

int main(int argc, char** argv) {
    using namespace vernier;
    benchmark::Initialize(&argc, argv);
    for (const Isa isa : availableIsas()) {
        for (const VkFormat format :
             {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R5G6B5_UNORM_PACK16,
              VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT,
              VK_FORMAT_R32_SFLOAT, VK_FORMAT_D16_UNORM, VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT}) {
            for (const bool pack : {false, true}) {
                const std::string name =
                    std::string(isaName(isa)) + (pack ? "/pack/" : "/unpack/") + findFormat(format)->name;
                benchmark::RegisterBenchmark(name.c_str(), convert, format, pack, isa);
            }
        }
    }
    benchmark::RunSpecifiedBenchmarks();
}
