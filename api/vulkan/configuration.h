// What the environment says about the driver:
//
//   VERNIER_PROFILE      draft, fast, standard (default), fine, reference: the accuracy of everything the device
//                        computes. draft and fast are below what Vulkan asks for and are never chosen unasked.
//                        Several, with commas between: a physical device each, in that order
//   VERNIER_AXIS_<NAME>  one axis of accuracy alone, e.g. VERNIER_AXIS_SUBPIXEL=12: see runtime/accuracy.h
//   VERNIER_DEVICE_TYPE  cpu (default), integrated, discrete, virtual, other: some programs refuse a CPU device
//   VERNIER_THREADS      a number of threads; default: as many as there are usable CPUs
//   VERNIER_ISA          sse4, avx2, avx512: the best instruction set to use. The pictures are the same
//   VERNIER_SKIP         off: what draws do not need is done all the same, with the same pictures; "hidden_work=off",
//                        one rule of leaving out alone: see runtime/skips.h
//   VERNIER_EXPLAIN      stderr, or a file that is appended to: what every pipeline runs and leaves out, and why, and
//                        what every submission ran; an object a line where its name ends in .json
//   VERNIER_REFRESH      how often a second swapchains show an image in the modes FIFO and MAILBOX, 0 to 1000; default
//                        60, 0: at once; a Wayland compositor says it itself, unless it is 0
//   VERNIER_LOG          set and not 0: messages go to stderr, too
//   VERNIER_VALIDATE     set and not 0: wrong use that does no harm here, but does elsewhere, is told as well, on
//   stderr,
//                        too: descriptors that are not bound, fences that are signalled when they are submitted, memory
//                        mapped twice or left when the device is destroyed. Less than the Khronos validation layer, and
//                        as fast as without
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/simd.h"
#include "runtime/accuracy.h"
#include "runtime/skips.h"

namespace vernier::vulkan {

struct DeviceAccuracy {
    std::string name;  // "standard", "fine, subpixel=16"
    Accuracy accuracy;
};

struct Configuration {
    /// A physical device each.
    std::vector<DeviceAccuracy> accuracies;
    VkPhysicalDeviceType deviceType = VK_PHYSICAL_DEVICE_TYPE_CPU;
    uint32_t threads = 0;
    Isa maxIsa = kHighestIsa;
    Skips skips;
    std::string explain;
    uint32_t refreshRate = 60;  // of swapchains, in Hz; 0: they do not wait
    bool log = false, validate = false;
};

/// An unknown value is an error: a picture of another accuracy than the one asked for must not go unnoticed.
Result<Configuration> readConfiguration();

}  // namespace vernier::vulkan
