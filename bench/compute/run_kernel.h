// Running a kernel on a Vulkan driver, with timings.
#pragma once

#include <filesystem>
#include <string>

#include "base/result.h"
#include "bench/compute/kernel.h"
#include "conformance/tool/driver_choice.h"
#include "conformance/tool/rendering.h"

namespace vernier::bench {

/// Runs `kernel` on the driver of that name, in this process, through the Vulkan loader. The rendering has one image:
/// the output buffer, a row of R32 texels. `unsupported` when the driver has no compute queue.
Result<conformance::Rendering> runKernel(const conformance::DriverPaths& paths, const std::string& driver,
                                         const Kernel& kernel);

/// How the outputs of two drivers differ.
struct KernelDifference {
    double worst = 0;  // |a - b| / max(1, |a|, |b|)
    double share = 0;  // of the elements beyond the kernel's tolerance
    bool agrees = false;
};
KernelDifference compareOutputs(const Kernel& kernel, const conformance::Rendering& a, const conformance::Rendering& b);

}  // namespace vernier::bench
