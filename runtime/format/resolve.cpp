#include "runtime/format/resolve.h"

#include <algorithm>
#include <cstring>

namespace vernier {

void resolveTexels(const FormatOps& ops, const std::byte* texels, uint64_t samplePitch, uint32_t samples, size_t n,
                   std::byte* result) {
    const size_t bytes = ops.layout.bytes;
    if (ops.layout.type != ValueType::floating) {
        std::memcpy(result, texels, n * bytes);
        return;
    }
    constexpr size_t kRun = 64;
    // A power of two: scaling first is exact and cannot overflow.
    const float scale = 1.0f / static_cast<float>(samples);
    alignas(64) float sum[4][kRun];
    alignas(64) float sample[4][kRun];
    void* planes[4] = {sample[0], sample[1], sample[2], sample[3]};
    const void* sums[4] = {sum[0], sum[1], sum[2], sum[3]};
    for (size_t done = 0; done < n; done += kRun) {
        const size_t count = std::min(kRun, n - done);
        std::memset(sum, 0, sizeof(sum));
        for (uint32_t s = 0; s < samples; ++s) {
            ops.unpack(texels + done * bytes + s * samplePitch, count, planes);
            for (int c = 0; c < 4; ++c)
                for (size_t k = 0; k < count; ++k) sum[c][k] += sample[c][k] * scale;
        }
        ops.pack(sums, count, result + done * bytes);
    }
}

}  // namespace vernier
