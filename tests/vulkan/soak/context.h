// What the threads of the soak share: a device through the Vulkan loader, its one queue, and how things fail.
#pragma once

#include <vulkan/vulkan.h>

#include <atomic>
#include <cstdint>
#include <mutex>
#include <random>
#include <string>
#include <vector>

#include "tests/vulkan/structures.h"

namespace vernier::soak {

/// Says what went wrong, once, and makes every thread stop. Thread-safe.
class Verdict {
  public:
    void fail(const std::string& text);
    bool failed() const { return failed_; }
    bool stopped() const { return failed_ || stop_; }
    void stop() { stop_ = true; }

  private:
    std::atomic<bool> failed_{false}, stop_{false};
    std::mutex mutex_;
};

/// A result that is not a success ends the run.
void check(Verdict& verdict, VkResult result, const char* command);
#define SOAK_CHECK(verdict, command, ...) ::vernier::soak::check(verdict, command(__VA_ARGS__), #command)

using Random = std::mt19937;
/// From 0 to below `limit`.
inline uint32_t below(Random& random, uint32_t limit) {
    return static_cast<uint32_t>(uint64_t{random()} * limit >> 32);
}

using test::flatImage;
using test::make;

/// Held where the Vulkan loader reads or changes its list of instances and their devices: creating and destroying
/// these, surfaces and swapchains. It frees devices of one thread while another walks over them, even from an instance
/// that has nothing to do with it (Vulkan-Loader, issue 2018).
std::mutex& loaderMutex();

struct Context {
    explicit Context(Verdict& owner);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    Verdict& verdict;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::mutex queueMutex;  // queues are externally synchronised
    std::atomic<uint64_t> presentations{0};

    /// GLSL to a module; kept by the caller.
    VkShaderModule compile(VkShaderStageFlagBits stage, const char* glsl) const;

  private:
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

/// Creates, fills, draws, copies and destroys at random until the verdict stops; what comes out of the device is
/// compared with a model. Returns the number of submissions.
uint64_t work(Context& context, uint32_t seed);
/// Presents on a headless surface, with swapchains that come and go, and counts in `context.presentations`.
void present(Context& context, uint32_t seed);
/// Makes devices of its own, uses them for a moment and destroys them. Returns their number.
uint64_t makeDevices(Verdict& verdict, uint32_t seed);

}  // namespace vernier::soak
