// Compute kernels that are measured: what they run on, and how far two drivers may differ.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace vernier::bench {

/// What the 32-bit elements of a buffer are and hold at first.
enum class BufferFill : uint8_t {
    zero,
    signedFloats,  // float in [-1, 1)
    smallIntegers  // uint in [0, 256)
};

struct KernelBuffer {
    uint32_t elements = 0;  // of 4 bytes each
    BufferFill fill = BufferFill::zero;
};

struct KernelPass {
    std::vector<std::string_view> files;  // GLSL in bench/compute/kernels, one after the other
    std::array<uint32_t, 3> groups{1, 1, 1};
};

struct Kernel {
    std::string_view name, description;
    std::vector<KernelBuffer> buffers;  // buffer i is set 0, binding i
    std::vector<KernelPass> passes;     // with a barrier between them
    std::vector<float> pushConstants;
    uint32_t output = 0;    // the buffer that is compared
    bool integers = false;  // of the output: equal on every driver; otherwise floats
    // Elements a and b agree if |a - b| <= tolerance * max(1, |a|, |b|).
    double tolerance = 0;
    double share =
        0;  // of the elements that may disagree: pixels at edges, where a last bit decides which way a loop goes
};

std::span<const Kernel> kernels();

/// nullptr: there is no kernel of that name.
const Kernel* findKernel(std::string_view name);

/// The texts of files in bench/compute/kernels, one after the other.
Result<std::string> readKernelSource(std::span<const std::string_view> files);

/// The push constants of uniform.glsl.
std::array<float, 8> uniformParameters();

}  // namespace vernier::bench
