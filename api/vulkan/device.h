// The device and its one queue.
#pragma once

#include <atomic>
#include <memory>

#include "api/vulkan/extension.h"
#include "api/vulkan/handle.h"
#include "api/vulkan/message.h"
#include "api/vulkan/physical_device.h"
#include "api/vulkan/private_data.h"
#include "runtime/command/device.h"

namespace vernier::vulkan {

struct Queue : Dispatchable {
    explicit Queue(Device& owner) : device(owner) {}
    Device& device;
};

struct Device : Dispatchable {
    Device(PhysicalDevice& parent, ExtensionSet enabled, std::unique_ptr<vernier::Device> made)
        : physicalDevice(parent), extensions(enabled), runtime(std::move(made)), queue(*this) {}

    PhysicalDevice& physicalDevice;
    ExtensionSet extensions;  // of the instance and of the device
    std::unique_ptr<vernier::Device> runtime;
    Queue queue;
    PrivateData privateData;
    std::atomic<VkDeviceSize> allocated{0};  // bytes of device memory

    Messages& messages() const;
    bool lost() const { return runtime->queue().lost(); }
    /// Sends the error as a message about the device and returns the result code for it.
    VkResult report(const char* command, const Error& error) const;
    VkResult report(const char* command, VkResult result, std::string_view text) const;
    /// Whether wrong use is to be told that needs no error: VERNIER_VALIDATE.
    bool validates() const { return physicalDevice.configuration.validate; }
};

}  // namespace vernier::vulkan
