#include "bench/compute/run_kernel.h"

#include <vernier/vernier_glsl.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "conformance/drivers/stopwatch.h"
#include "conformance/drivers/vulkan_compute.h"
#include "conformance/tool/render_scene.h"

namespace vernier::bench {
namespace {

using namespace conformance;

Result<std::vector<uint32_t>> compileKernel(const KernelPass& pass) {
    const Result<std::string> source = readKernelSource(pass.files);
    if (!source) return source.error();
    const std::string name(pass.files.back());
    VnGlslDesc desc{};
    desc.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    desc.source = source->c_str();
    desc.sourceName = name.c_str();
    VnGlslOutput* raw = nullptr;
    const VnGlslResult result = vnCompileGlsl(&desc, &raw);
    const std::unique_ptr<VnGlslOutput, decltype(&vnFreeGlslOutput)> output(raw, &vnFreeGlslOutput);
    if (result != VN_GLSL_SUCCESS) return invalidArgument(name + ":\n" + (output ? output->log : "out of memory"));
    return std::vector<uint32_t>(output->words, output->words + output->wordCount);
}

/// The same numbers on every driver: a hash of the index.
std::vector<uint32_t> initialContents(const KernelBuffer& buffer, uint32_t seed) {
    std::vector<uint32_t> words(buffer.elements, 0);
    if (buffer.fill == BufferFill::zero) return words;
    for (uint32_t i = 0; i < buffer.elements; ++i) {
        uint32_t hash = (i + seed * 0x9E3779B9u) * 0x85EBCA6Bu;
        hash = (hash ^ hash >> 15) * 0xC2B2AE35u;
        hash ^= hash >> 13;
        const float value = static_cast<float>(hash >> 8) * 0x1p-23f - 1.0f;
        if (buffer.fill == BufferFill::smallIntegers)
            words[i] = hash >> 24;
        else
            std::memcpy(&words[i], &value, sizeof value);
    }
    return words;
}

/// A kernel on a device, from its buffers to its output.
class KernelRun {
  public:
    KernelRun(VulkanContext& context, const Kernel& kernel)
        : kernel_(kernel), resources_(context), device_(context.device()) {}

    Status prepare() {
        VERNIER_TRY(resources_.create(Scene{}));
        VERNIER_TRY(createBuffers());
        const Result<StorageBuffers> bound =
            bindStorageBuffers(device_, resources_.cleanup(), buffers_,
                               static_cast<uint32_t>(kernel_.pushConstants.size() * sizeof(float)));
        if (!bound) return bound.error();
        bound_ = *bound;
        for (const KernelPass& pass : kernel_.passes) {
            Result<std::vector<uint32_t>> words = compileKernel(pass);
            if (!words) return words.error();
            VERNIER_TRY(createPipeline(*words));
        }
        VERNIER_TRY(record(true, oneGroup_));
        return record(false, all_);
    }

    Status runOnce() { return resources_.run(all_); }
    /// One work-group of every pass: what compiles lazily does so now, and little else is done.
    Status runOneGroup() { return resources_.run(oneGroup_); }
    double moduleTime() const { return moduleTime_; }
    double pipelineTime() const { return pipelineTime_; }
    RenderedImage output() const {
        const uint32_t elements = kernel_.buffers[kernel_.output].elements;
        RenderedImage image{kernel_.integers ? VK_FORMAT_R32_UINT : VK_FORMAT_R32_SFLOAT, {elements, 1}, {}};
        image.texels.resize(size_t{elements} * 4);
        std::memcpy(image.texels.data(), buffers_[kernel_.output].mapped, image.texels.size());
        return image;
    }

  private:
    Status createBuffers();
    Status createPipeline(const std::vector<uint32_t>& words);
    Status record(bool oneGroup, VkCommandBuffer& commands);

    const Kernel& kernel_;
    VulkanResources resources_;
    VkDevice device_;
    std::vector<VulkanBuffer> buffers_;
    StorageBuffers bound_;
    std::vector<VkPipeline> pipelines_;
    VkCommandBuffer oneGroup_ = VK_NULL_HANDLE, all_ = VK_NULL_HANDLE;
    double moduleTime_ = 0, pipelineTime_ = 0;
};

Status KernelRun::createBuffers() {
    for (const KernelBuffer& each : kernel_.buffers) {
        const std::vector<uint32_t> words = initialContents(each, static_cast<uint32_t>(buffers_.size()));
        const Result<VulkanBuffer> buffer =
            resources_.createHostBuffer(words.size() * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        if (!buffer) return buffer.error();
        std::memcpy(buffer->mapped, words.data(), words.size() * 4);
        buffers_.push_back(*buffer);
    }
    return {};
}

Status KernelRun::createPipeline(const std::vector<uint32_t>& words) {
    const Stopwatch moduleWatch;
    const Result<VkShaderModule> shader = createShaderModule(device_, resources_.cleanup(), words);
    if (!shader) return shader.error();
    moduleTime_ += moduleWatch.milliseconds();
    const Stopwatch watch;
    const Result<VkPipeline> pipeline = createComputePipeline(device_, resources_.cleanup(), bound_.layout, *shader);
    if (!pipeline) return pipeline.error();
    pipelineTime_ += watch.milliseconds();
    pipelines_.push_back(*pipeline);
    return {};
}

Status KernelRun::record(bool oneGroup, VkCommandBuffer& commands) {
    const Result<VkCommandBuffer> begun = resources_.beginCommands();
    if (!begun) return begun.error();
    commands = *begun;
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, bound_.layout, 0, 1, &bound_.set, 0, nullptr);
    if (!kernel_.pushConstants.empty())
        vkCmdPushConstants(commands, bound_.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           static_cast<uint32_t>(kernel_.pushConstants.size() * sizeof(float)),
                           kernel_.pushConstants.data());
    for (size_t i = 0; i < kernel_.passes.size(); ++i) {
        if (i > 0)
            computeBarrier(commands, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT,
                           VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT);
        const std::array<uint32_t, 3> groups = oneGroup ? std::array<uint32_t, 3>{1, 1, 1} : kernel_.passes[i].groups;
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_[i]);
        vkCmdDispatch(commands, groups[0], groups[1], groups[2]);
    }
    computeBarrier(commands, VK_ACCESS_HOST_READ_BIT, VK_PIPELINE_STAGE_HOST_BIT);
    VERNIER_TRY_VK(vkEndCommandBuffer(commands));
    return {};
}

}  // namespace

Result<Rendering> runKernel(const DriverPaths& paths, const std::string& driver, const Kernel& kernel) {
    const std::vector<DriverChoice> choices = driverChoices(paths);
    const auto choice =
        std::find_if(choices.begin(), choices.end(), [&](const DriverChoice& each) { return each.name == driver; });
    if (choice == choices.end()) return invalidArgument("--driver: no driver is called '" + driver + "'");
    VERNIER_TRY(selectVulkanDriver(*choice));
    VERNIER_TRY(limitCpus(paths.cpus));
    const uint64_t librariesBefore = loadedLibraryBytes();
    const Stopwatch watch;
    VulkanContext context;
    VERNIER_TRY(context.create({}));
    if (!context.hasCompute()) return unsupported("the queue has no compute");
    Rendering rendering;
    rendering.scene = kernel.name;
    rendering.driver = context.properties().deviceName;
    rendering.version = versionText(context.properties());
    rendering.timing.startUp = watch.milliseconds();
    KernelRun run(context, kernel);
    VERNIER_TRY(run.prepare());
    const Stopwatch first;
    VERNIER_TRY(run.runOneGroup());
    rendering.timing.firstFrame = first.milliseconds();
    rendering.timing.firstImage = watch.milliseconds();
    const Result<FrameTimes> small = measureFrames([&] { return run.runOneGroup(); });
    if (!small) return small.error();
    rendering.timing.warmFrame = small->median;
    const Result<FrameTimes> frames = measureFrames([&] { return run.runOnce(); });
    if (!frames) return frames.error();
    rendering.timing.modules = run.moduleTime();
    rendering.timing.pipelines = run.pipelineTime();
    rendering.timing.frame = frames->median;
    rendering.timing.frames = frames->count;
    rendering.libraries = loadedLibraryBytes() - librariesBefore;
    rendering.images.push_back(run.output());
    return rendering;
}

KernelDifference compareOutputs(const Kernel& kernel, const Rendering& a, const Rendering& b) {
    KernelDifference difference;
    const auto &x = a.images[0].texels, &y = b.images[0].texels;
    const size_t elements = std::min(x.size(), y.size()) / 4;
    size_t beyond = x.size() == y.size() ? 0 : elements;
    for (size_t i = 0; i < elements; ++i) {
        double left = 0, right = 0;
        if (kernel.integers) {
            uint32_t words[2];
            std::memcpy(&words[0], x.data() + i * 4, 4);
            std::memcpy(&words[1], y.data() + i * 4, 4);
            left = words[0];
            right = words[1];
        } else {
            float floats[2];
            std::memcpy(&floats[0], x.data() + i * 4, 4);
            std::memcpy(&floats[1], y.data() + i * 4, 4);
            left = double{floats[0]};
            right = double{floats[1]};
        }
        const double scale = kernel.integers ? 1 : std::max({1.0, std::abs(left), std::abs(right)});
        const double error = std::abs(left - right) / scale;
        if (!(error <= kernel.tolerance)) ++beyond;  // NaN too
        if (!(error <= difference.worst)) difference.worst = error;
    }
    difference.share = elements ? static_cast<double>(beyond) / static_cast<double>(elements) : 1;
    difference.agrees = difference.share <= kernel.share;
    return difference;
}

}  // namespace vernier::bench
