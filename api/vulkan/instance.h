// The instance and its physical devices: one, unless several accuracies are asked for.
#pragma once

#include <memory>
#include <vector>

#include "api/vulkan/configuration.h"
#include "api/vulkan/explain_log.h"
#include "api/vulkan/extension.h"
#include "api/vulkan/handle.h"
#include "api/vulkan/message.h"
#include "api/vulkan/physical_device.h"

namespace vernier::vulkan {

struct Instance : Dispatchable {
    explicit Instance(const Configuration& settings) : configuration(settings) {
        for (const DeviceAccuracy& accuracy : settings.accuracies)
            physicalDevices.push_back(std::make_unique<PhysicalDevice>(*this, settings, accuracy));
    }

    Configuration configuration;
    ExtensionSet extensions;
    Messages messages;
    ExplainLog explainLog;
    std::vector<std::unique_ptr<PhysicalDevice>> physicalDevices;
};

}  // namespace vernier::vulkan
