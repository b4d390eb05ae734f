#include "bench/compute/kernel.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace vernier::bench {
namespace {

constexpr uint32_t kBodies = 2048, kSignals = 512, kPoints = 512, kMatrix = 256, kBlocks = 1024, kBlock = 1024;
// image.comp writes one pixel per invocation in groups of 16 x 8.
// blur.comp handles rows of 256 pixels; a second pass of the same over the transposed image handles the columns.
constexpr uint32_t kBlurSide = 768;
constexpr uint32_t kWidth = 512, kHeight = 384;

Kernel imageKernel(std::string_view name, std::string_view description, std::string_view file, double share) {
    Kernel kernel;
    kernel.name = name;
    kernel.description = description;
    kernel.buffers = {{kWidth * kHeight * 4, BufferFill::zero}};
    kernel.passes = {{{file, "image.comp"}, {kWidth / 16, kHeight / 8, 1}}};
    kernel.tolerance = 0.01;
    kernel.share = share;
    return kernel;
}

std::vector<Kernel> makeKernels() {
    std::vector<Kernel> list;

    Kernel nbody;
    nbody.name = "nbody";
    nbody.description = "2048 bodies attract each other; tiles of 128 in shared memory.";
    nbody.buffers = {{kBodies * 4, BufferFill::signedFloats}, {kBodies * 4, BufferFill::zero}};
    nbody.passes = {{{"nbody.comp"}, {kBodies / 128, 1, 1}}};
    nbody.output = 1;
    nbody.tolerance = 1e-3;
    list.push_back(nbody);

    // Vulkan allows sines and cosines an error of 2^-11, and an output is a sum of 512 numbers times such factors.
    Kernel fft;
    fft.name = "fft";
    fft.description = "512 signals of 512 complex points in shared memory.";
    fft.buffers = {{kSignals * kPoints * 2, BufferFill::signedFloats}, {kSignals * kPoints * 2, BufferFill::zero}};
    fft.passes = {{{"fft.comp"}, {kSignals, 1, 1}}};
    fft.output = 1;
    fft.tolerance = 0.02;
    list.push_back(fft);

    Kernel blur;
    blur.name = "blur";
    blur.description = "A 33-tap Gaussian blur of 768 x 768 floats, rows then columns, through shared memory.";
    blur.buffers = {{kBlurSide * kBlurSide, BufferFill::signedFloats},
                    {kBlurSide * kBlurSide, BufferFill::zero},
                    {kBlurSide * kBlurSide, BufferFill::zero}};
    blur.passes = {{{"blur_rows.glsl", "blur.comp"}, {kBlurSide / 256, kBlurSide, 1}},
                   {{"blur_columns.glsl", "blur.comp"}, {kBlurSide / 256, kBlurSide, 1}}};
    blur.output = 2;
    blur.tolerance = 1e-5;
    list.push_back(blur);

    Kernel matrix;
    matrix.name = "matrix";
    matrix.description = "A product of 256 x 256 matrices by tiles of 16 x 16 in shared memory.";
    matrix.buffers = {{kMatrix * kMatrix, BufferFill::signedFloats},
                      {kMatrix * kMatrix, BufferFill::signedFloats},
                      {kMatrix * kMatrix, BufferFill::zero}};
    matrix.passes = {{{"matrix.comp"}, {kMatrix / 16, kMatrix / 16, 1}}};
    matrix.output = 2;
    matrix.tolerance = 1e-4;
    list.push_back(matrix);

    Kernel scan;
    scan.name = "prefix_sum";
    scan.description = "Prefix sums of a million integers: blocks, block sums, and adding them.";
    scan.buffers = {{kBlocks * kBlock, BufferFill::smallIntegers},
                    {kBlocks * kBlock, BufferFill::zero},
                    {kBlocks, BufferFill::zero}};
    scan.passes = {
        {{"scan_blocks.comp"}, {kBlocks, 1, 1}}, {{"scan_sums.comp"}, {1, 1, 1}}, {{"scan_add.comp"}, {kBlocks, 1, 1}}};
    scan.output = 1;
    scan.integers = true;
    list.push_back(scan);

    list.push_back(imageKernel("raymarch", "512 x 384 pixels sphere-traced, with divergent loops and soft shadows.",
                               "raymarch.glsl", 0.02));
    list.push_back(imageKernel("noise", "512 x 384 pixels of six octaves of gradient noise.", "noise.glsl", 0));
    Kernel uniform =
        imageKernel("uniform", "512 x 384 pixels of which nearly all arithmetic is the same.", "uniform.glsl", 0);
    const std::array<float, 8> parameters = uniformParameters();
    uniform.pushConstants.assign(parameters.begin(), parameters.end());
    list.push_back(uniform);
    return list;
}

}  // namespace

std::span<const Kernel> kernels() {
    static const std::vector<Kernel> list = makeKernels();
    return list;
}

const Kernel* findKernel(std::string_view name) {
    for (const Kernel& kernel : kernels())
        if (kernel.name == name) return &kernel;
    return nullptr;
}

Result<std::string> readKernelSource(std::span<const std::string_view> files) {
    std::string source;
    for (const std::string_view file : files) {
        const std::string path = std::string(VERNIER_BENCH_KERNELS "/") + std::string(file);
        std::ifstream stream(path);
        if (!stream) return invalidArgument(path + ": cannot be read");
        source.append(std::istreambuf_iterator<char>(stream), {});
    }
    return source;
}

std::array<float, 8> uniformParameters() {
    return {0.4f, 1.1f, -0.7f, 0.9f, 5200, 0.35f, 0.6f, 0};
}

}  // namespace vernier::bench
