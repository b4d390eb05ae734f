// The instance and its one physical device.
#pragma once

#include "api/vulkan/configuration.h"
#include "api/vulkan/extension.h"
#include "api/vulkan/handle.h"
#include "api/vulkan/message.h"
#include "api/vulkan/physical_device.h"

namespace vernier::vulkan {

struct Instance : Dispatchable {
    explicit Instance(const Configuration& settings) : configuration(settings), physicalDevice(*this, settings) {}

    Configuration configuration;
    ExtensionSet extensions = 0;
    Messages messages;
    PhysicalDevice physicalDevice;
};

}  // namespace vernier::vulkan
