// Runs scenes on whatever Vulkan driver the loader finds, with nothing beyond Vulkan 1.0's core.
#pragma once

#include "conformance/drivers/driver.h"
#include "conformance/drivers/vulkan_context.h"

#include <memory>

namespace vernier::conformance {

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

  private:
    VulkanDriver() = default;

    VulkanContext context_;
    double startUp_ = 0;
};

}  // namespace vernier::conformance
