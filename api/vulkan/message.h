// Telling the application what went wrong in words: through VK_EXT_debug_utils messengers, and to stderr with
// VERNIER_LOG.
#pragma once

#include <vulkan/vulkan_core.h>

#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/result.h"

namespace vernier::vulkan {

struct DebugMessenger {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    explicit DebugMessenger(const VkDebugUtilsMessengerCreateInfoEXT& createInfo) : info(createInfo) {
        info.pNext = nullptr;
    }
};

/// What a message is about.
struct MessageObject {
    VkObjectType type = VK_OBJECT_TYPE_UNKNOWN;
    uint64_t handle = 0;
};

/// Thread-safe.
class Messages {
  public:
    void add(const DebugMessenger* messenger);
    /// Waits for its callbacks that run, on the queue's thread for one: none runs or is called afterwards.
    void remove(const DebugMessenger* messenger);
    void setLog(bool log) { log_ = log; }

    void send(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
              const VkDebugUtilsMessengerCallbackDataEXT& data) const;

    /// An error of the driver: `command` failed on `about` for this reason.
    void error(const char* command, MessageObject about, std::string_view text) const;

  private:
    /// A callback that has been called and has not returned.
    struct Running {
        const DebugMessenger* messenger;
        std::thread::id thread;
        bool operator==(const Running&) const = default;
    };

    mutable std::mutex mutex_;
    mutable std::condition_variable returned_;
    std::vector<const DebugMessenger*> messengers_;
    mutable std::vector<Running> running_;
    bool log_ = false;
};

/// The result code for an error of the runtime.
VkResult resultOf(const Error& error);

/// "VK_FORMAT_R8_UNORM", or the number.
std::string nameOf(VkResult value);
std::string nameOf(VkFormat value);
std::string nameOf(VkDescriptorType value);
std::string nameOf(VkObjectType value);

}  // namespace vernier::vulkan
