// Runs scenes on Vernier's own C API, through nothing but its public header.
#pragma once

#include "conformance/drivers/driver.h"

#include <vernier/vernier.h>

#include <memory>

namespace vernier::conformance {

struct ApiOptions {
    VnProfile profile = VN_PROFILE_DEFAULT;
    uint32_t threads = 0;          // 0: one per usable CPU
    const char* maxIsa = nullptr;  // as in VnDeviceDesc; nullptr: the best of this CPU
    const char* axes = nullptr;    // VnDeviceDesc::axes
    const char* skips = nullptr;   // VnDeviceDesc::skips
};

class ApiDriver final : public Driver {
  public:
    static Result<std::unique_ptr<ApiDriver>> create(const ApiOptions& options);
    ~ApiDriver() override;

    std::string name() const override { return "Vernier API"; }
    std::string version() const override;
    std::string limits() const override;
    uint32_t subPixelBits() const override { return info_.subPixelBits; }
    /// Plans are made on first use, so that their time shows in the first image; Timing::pipelines is that of
    /// programs and state objects.
    Result<std::vector<RenderedImage>> render(const Scene& scene, Timing* timing) override;
    std::vector<std::string> notNeeded() const override { return notNeeded_; }

  private:
    ApiDriver() = default;

    VnDevice device_ = nullptr;
    VnDeviceInfo info_{};
    double startUp_ = 0;
    std::vector<std::string> notNeeded_;
};

}  // namespace vernier::conformance
