// Nanoseconds per sample: filters, formats and instruction sets, on a 256x256 texture that stays in cache,
// walked the way a fragment batch does (128 lanes of 2x2 quads, about one texel per pixel).
#include <benchmark/benchmark.h>

#include <random>
#include <string>
#include <vector>

#include "runtime/texture/texture.h"

namespace vernier {
namespace {

constexpr uint32_t kSize = 256, kLevels = 9, kLanes = 128, kBatches = 64;

struct Texture {
    std::vector<std::vector<std::byte>> data;
    TextureView view;

    Texture(VkFormat format, VkImageAspectFlags aspect, Isa isa) {
        const uint32_t bytes = findFormat(format)->bytesPerTexel;
        std::mt19937 random(1);
        view.format = format;
        view.aspect = aspect;
        view.levelCount = kLevels;
        view.texelPitch = bytes;
        view.ops = formatOps(format, aspect, isa);
        for (uint32_t l = 0; l < kLevels; ++l) {
            const uint32_t size = kSize >> l;
            data.emplace_back(size_t{size} * size * bytes);
            for (std::byte& b : data.back()) b = static_cast<std::byte>(random() & 0x3f);  // no NaNs
            view.levels[l] = {data.back().data(), size, size, 1, size * bytes, uint64_t{size} * size * bytes};
        }
    }
};

enum class Filter { nearest, bilinear, trilinear };

SamplerState samplerFor(Filter filter, VkSamplerAddressMode mode) {
    SamplerState sampler;
    sampler.magFilter = sampler.minFilter = filter == Filter::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    sampler.mipmapMode = filter == Filter::trilinear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    for (VkSamplerAddressMode& m : sampler.addressMode) m = mode;
    return sampler;
}

void sample(benchmark::State& state, VkFormat format, VkImageAspectFlags aspect, Filter filter,
            VkSamplerAddressMode mode, bool compare, Isa isa) {
    Texture texture(format, aspect, isa);
    if (filter != Filter::trilinear) texture.view.levelCount = 1;
    SamplerState sampler = samplerFor(filter, mode);
    sampler.compareEnable = compare;
    sampler.compareOp = VK_COMPARE_OP_LESS;
    if (!checkSampling(texture.view, sampler).ok()) {
        state.SkipWithError("refused");
        return;
    }
    const float step =
        filter == Filter::trilinear ? 1.4f / kSize : 0.7f / kSize;  // lambda about 0.5 when there are levels
    std::vector<float> s(kLanes * kBatches), t(s.size()), dref(s.size(), 0.5f), out(kLanes * 4);
    for (uint32_t i = 0; i < s.size(); ++i) {
        const uint32_t quad = i / 4, x = quad % 64 * 2 + i % 2, y = quad / 64 * 2 + i / 2 % 2;
        s[i] = static_cast<float>(x) * step + 0.1234f;
        t[i] = static_cast<float>(y) * step + 0.2345f;
    }
    const SampleFn fn = selectSampler(texture.view, sampler, isa);
    SampleRequest request;
    request.lanes = kLanes;
    for (int c = 0; c < 4; ++c) request.out[c] = &out[static_cast<size_t>(c) * kLanes];
    for (auto _ : state) {
        for (uint32_t b = 0; b < kBatches; ++b) {
            request.coord[0] = &s[b * kLanes];
            request.coord[1] = &t[b * kLanes];
            request.dref = &dref[b * kLanes];
            fn(texture.view, sampler, request);
        }
        benchmark::ClobberMemory();
    }
    state.counters["ns/sample"] = benchmark::Counter(static_cast<double>(state.iterations()) * kBatches * kLanes * 1e-9,
                                                     benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void registerAll() {
    struct Kind {
        const char* name;
        VkFormat format;
        VkImageAspectFlags aspect;
        bool compare;
    };
    constexpr Kind kKinds[] = {
        {"rgba8", VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_ASPECT_COLOR_BIT, false},
        {"srgb8", VK_FORMAT_R8G8B8A8_SRGB, VK_IMAGE_ASPECT_COLOR_BIT, false},
        {"r8", VK_FORMAT_R8_UNORM, VK_IMAGE_ASPECT_COLOR_BIT, false},
        {"rgba16f", VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_ASPECT_COLOR_BIT, false},
        {"shadow_d32", VK_FORMAT_D32_SFLOAT, VK_IMAGE_ASPECT_DEPTH_BIT, true},
    };
    constexpr std::pair<const char*, Filter> kFilters[] = {
        {"nearest", Filter::nearest}, {"bilinear", Filter::bilinear}, {"trilinear", Filter::trilinear}};
    constexpr std::pair<const char*, VkSamplerAddressMode> kModes[] = {
        {"repeat", VK_SAMPLER_ADDRESS_MODE_REPEAT},
        {"clamp", VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
        {"mirror", VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT}};
    for (const Isa isa : availableIsas()) {
        for (const Kind& kind : kKinds) {
            for (const auto& [filterName, filter] : kFilters) {
                for (const auto& [modeName, mode] : kModes) {
                    if (mode != VK_SAMPLER_ADDRESS_MODE_REPEAT && kind.format != VK_FORMAT_R8G8B8A8_UNORM) continue;
                    const std::string name =
                        std::string(isaName(isa)) + "/" + kind.name + "/" + filterName + "/" + modeName;
                    benchmark::RegisterBenchmark(name.c_str(), sample, kind.format, kind.aspect, filter, mode,
                                                 kind.compare, isa);
                }
            }
        }
    }
}

}  // namespace
}  // namespace vernier

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    vernier::registerAll();
    benchmark::RunSpecifiedBenchmarks();
}
