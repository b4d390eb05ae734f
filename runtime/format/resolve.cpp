#include "runtime/format/resolve.h"

#include <algorithm>
#include <cstring>

namespace vernier {
namespace {

constexpr size_t kRun = 64, kGroup = 16;  // texels that are averaged, and compared, together

/// Whether samples that are equal have themselves as their average: the codes of fixed-point components of up to 16
/// bits lie much farther apart than what averaging rounds by. Of floats, it could make another zero or another NaN.
bool averagesToItself(const TexelLayout& layout) {
    uint32_t bits = 0;
    for (const Component& part : layout.rgba) {
        const bool fixed = part.kind == ComponentKind::unorm || part.kind == ComponentKind::srgb;
        if (part.kind != ComponentKind::none && (!fixed || part.bits > 16)) return false;
        if (part.kind != ComponentKind::none) bits += part.bits;
    }
    return bits == 8u * layout.bytes && !layout.keepOtherBits && !layout.sharedExponent;
}

bool samplesEqual(const std::byte* texels, uint64_t samplePitch, uint32_t samples, size_t bytes) {
    for (uint32_t s = 1; s < samples; ++s)
        if (std::memcmp(texels, texels + s * samplePitch, bytes) != 0) return false;
    return true;
}

/// Up to kRun texels.
void average(const FormatOps& ops, const std::byte* texels, uint64_t samplePitch, uint32_t samples, size_t count,
             std::byte* result) {
    // A power of two: scaling first is exact and cannot overflow.
    const float scale = 1.0f / static_cast<float>(samples);
    alignas(64) float sum[4][kRun];
    alignas(64) float sample[4][kRun];
    void* planes[4] = {sample[0], sample[1], sample[2], sample[3]};
    const void* sums[4] = {sum[0], sum[1], sum[2], sum[3]};
    std::memset(sum, 0, sizeof(sum));
    for (uint32_t s = 0; s < samples; ++s) {
        ops.unpack(texels + s * samplePitch, count, planes);
        for (int c = 0; c < 4; ++c)
            for (size_t k = 0; k < count; ++k) sum[c][k] += sample[c][k] * scale;
    }
    ops.pack(sums, count, result);
}

}  // namespace

void resolveTexels(const FormatOps& ops, const std::byte* texels, uint64_t samplePitch, uint32_t samples, size_t n,
                   std::byte* result) {
    const size_t bytes = ops.layout.bytes;
    if (ops.layout.type != ValueType::floating) {
        std::memcpy(result, texels, n * bytes);
        return;
    }
    const bool mayCopy = averagesToItself(ops.layout);
    // Texels [begin, end) are to be averaged.
    size_t begin = 0, end = 0;
    const auto flush = [&] {
        if (begin < end)
            average(ops, texels + begin * bytes, samplePitch, samples, end - begin, result + begin * bytes);
        begin = end;
    };
    while (end < n) {
        const size_t count = std::min(kGroup, n - end);
        const std::byte* group = texels + end * bytes;
        if (mayCopy && samplesEqual(group, samplePitch, samples, count * bytes)) {
            flush();
            std::memcpy(result + end * bytes, group, count * bytes);
            begin = end += count;
        } else {
            end += count;
            if (end - begin == kRun) flush();
        }
    }
    flush();
}

}  // namespace vernier
