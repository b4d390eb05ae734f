// Runs scenes on whatever Vulkan driver the loader finds, with Vulkan 1.0's core and the extensions that a scene asks
// for (vulkan_extensions.h).
#pragma once

#include "conformance/drivers/driver.h"
#include "conformance/drivers/stopwatch.h"
#include "conformance/drivers/vulkan_context.h"

#include <functional>
#include <memory>

namespace vernier::conformance {

/// What queries around all passes of a scene count.
struct SceneCounts {
    uint64_t samplesPassed = 0;  // an occlusion query
    // Pipeline statistics, in the order of their bits.
    uint64_t inputVertices = 0, inputPrimitives = 0, vertexInvocations = 0;
    uint64_t clippingInvocations = 0, clippingPrimitives = 0, fragmentInvocations = 0;
    uint64_t ticks = 0;  // between time stamps before and after
};

/// Queries of occlusion, statistics and time in the frames of a scene.
enum class SceneQueries : uint8_t {
    none,
    aroundNothing,  // begun and ended before the passes
    aroundPasses,
};

class VulkanDriver final : public Driver {
  public:
    /// Which driver is found is up to the loader: set VK_DRIVER_FILES and VK_ICD_FILENAMES before, once per
    /// process.
    static Result<std::unique_ptr<VulkanDriver>> create(const VulkanOptions& options);

    std::string name() const override;
    std::string version() const override;
    std::string limits() const override;
    uint32_t subPixelBits() const override { return context_.properties().limits.subPixelPrecisionBits; }
    Result<std::vector<RenderedImage>> render(const Scene& scene, Timing* timing) override;

    /// Draws the scene once inside queries; `precise` is the occlusion query's. `unsupported` without precise queries,
    /// pipeline statistics or time stamps.
    Result<SceneCounts> count(const Scene& scene, bool precise);

    /// The queries of the frames that render() draws. Where the device lacks them, render() is `unsupported`.
    void setQueries(SceneQueries queries) { queries_ = queries; }

    /// How frames are measured when render() is asked for timings: by measureFrames() unless said otherwise. The meter
    /// gets a function that runs one frame, which has run once before.
    using FrameMeter = std::function<Result<FrameTimes>(const std::function<Status()>& runFrame)>;
    void setFrameMeter(FrameMeter meter) { meter_ = std::move(meter); }

  private:
    VulkanDriver() = default;

    VulkanContext context_;
    double startUp_ = 0;
    SceneQueries queries_ = SceneQueries::none;
    FrameMeter meter_ = [](const std::function<Status()>& runFrame) { return measureFrames(runFrame); };
};

}  // namespace vernier::conformance
