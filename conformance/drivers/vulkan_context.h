// A Vulkan device for running scenes: instance, device, one queue, and the destruction of whatever was made
// on it.
#pragma once

#include "base/result.h"
#include "conformance/drivers/try.h"
#include "conformance/drivers/vulkan_extensions.h"

#include <vulkan/vulkan.h>

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::conformance {

struct VulkanOptions {
    bool validate = false;     // load VK_LAYER_KHRONOS_validation; any error it reports fails the run
    uint32_t deviceIndex = 0;  // among the physical devices the loader offers
    // Switches the feature on, where it is there: for scenes that reach outside of buffers. It costs time that scenes
    // that do not are measured without.
    bool robustBufferAccess = false;
};

/// Runs its functions in reverse order of addition.
class Cleanup {
  public:
    Cleanup() = default;
    ~Cleanup() { run(); }
    Cleanup(const Cleanup&) = delete;
    Cleanup& operator=(const Cleanup&) = delete;

    void add(std::function<void()> function) { functions_.push_back(std::move(function)); }
    void run() {
        while (!functions_.empty()) {
            functions_.back()();
            functions_.pop_back();
        }
    }

  private:
    std::vector<std::function<void()>> functions_;
};

/// The error for a Vulkan call that did not succeed: what was called, and the result's name.
Error vulkanError(std::string_view call, VkResult result);

/// Leaves the calling function with an Error unless the Vulkan call succeeds.
#define VERNIER_TRY_VK(call)                                              \
    do {                                                                  \
        if (const VkResult tryResult = (call); tryResult != VK_SUCCESS)   \
            return ::vernier::conformance::vulkanError(#call, tryResult); \
    } while (false)

/// "driver 1.2.3, Vulkan 1.3.0".
std::string versionText(const VkPhysicalDeviceProperties& properties);

class VulkanContext {
  public:
    VulkanContext() = default;
    VulkanContext(const VulkanContext&) = delete;
    VulkanContext& operator=(const VulkanContext&) = delete;

    /// Creates the instance through the loader (which honours VK_DRIVER_FILES and VK_ICD_FILENAMES), and the
    /// device with every core feature it has. To be called once.
    Status create(const VulkanOptions& options);

    VkDevice device() const { return device_; }
    VkQueue queue() const { return queue_; }
    uint32_t queueFamily() const { return queueFamily_; }
    const VkPhysicalDeviceProperties& properties() const { return properties_; }
    const VkPhysicalDeviceFeatures& features() const { return features_; }
    VkFormatProperties formatProperties(VkFormat format) const;
    /// The sample counts that optimally tiled 2D images of this format and use may have.
    VkSampleCountFlags sampleCounts(VkFormat format, VkImageUsageFlags usage) const;
    /// Whether the queue runs compute work.
    bool hasCompute() const { return compute_; }
    /// Of the instance and the device together.
    uint32_t apiVersion() const { return std::min(instanceVersion_, properties_.apiVersion); }
    const VkPhysicalDeviceDepthStencilResolveProperties& depthStencilResolve() const { return depthStencilResolve_; }
    /// What fragment shaders may do in subgroups: nothing before Vulkan 1.1.
    VkSubgroupFeatureFlags fragmentSubgroups() const {
        return (subgroups_.supportedStages & VK_SHADER_STAGE_FRAGMENT_BIT) != 0 ? subgroups_.supportedOperations : 0;
    }
    /// Whether viewports may have negative heights.
    bool hasNegativeViewports() const { return negativeViewports_; }
    const VulkanExtensions& extensions() const { return extensions_; }

    /// A memory type allowed by `typeBits` with all of `flags`; `unsupported` when there is none.
    Result<uint32_t> memoryType(uint32_t typeBits, VkMemoryPropertyFlags flags) const;

    /// The errors the validation layer reported so far, one a line; empty without validation.
    const std::string& validationErrors() const { return validationErrors_; }

  private:
    template <class Function>
    Function instanceFunction(const char* name) const {
        return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance_, name));
    }
    Status createInstance(bool validate);
    Status createDevice(const VulkanOptions& options);
    static VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                    VkDebugUtilsMessageTypeFlagsEXT types,
                                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void* context);

    std::string validationErrors_;  // outlives the instance, whose destruction may still report
    Cleanup cleanup_;
    VkInstance instance_ = VK_NULL_HANDLE;
    uint32_t instanceVersion_ = VK_API_VERSION_1_0;
    VkPhysicalDevice physicalDevice_ = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties_{};
    VkPhysicalDeviceFeatures features_{};
    VkPhysicalDeviceMemoryProperties memory_{};
    VkPhysicalDeviceDepthStencilResolveProperties depthStencilResolve_{};
    VkPhysicalDeviceSubgroupProperties subgroups_{};
    bool compute_ = false, negativeViewports_ = false;
    VulkanExtensions extensions_;
    VkDevice device_ = VK_NULL_HANDLE;
    uint32_t queueFamily_ = 0;
    VkQueue queue_ = VK_NULL_HANDLE;
};

}  // namespace vernier::conformance
