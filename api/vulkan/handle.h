// Which C++ object stands behind each Vulkan handle. A handle is the object's address. The objects of
// dispatchable handles start with a word that belongs to the loader.
#pragma once

#include <vulkan/vk_icd.h>
#include <vulkan/vulkan_core.h>

#include <atomic>
#include <cstdint>
#include <type_traits>

namespace vernier {
class Buffer;
class BufferView;
class Image;
class ImageView;
class QueryPool;
class BinarySignal;
struct SamplerState;
struct YcbcrConversion;
}  // namespace vernier

namespace vernier::vulkan {

/// First base of every object behind a dispatchable handle.
struct Dispatchable {
    uintptr_t loaderMagic = ICD_LOADER_MAGIC;
};

struct Instance;
struct PhysicalDevice;
struct Device;
struct Queue;
struct CommandBuffer;
struct DeviceMemory;
struct ShaderModule;
struct PipelineCache;
struct PipelineLayout;
struct Pipeline;
struct DescriptorSetLayoutObject;
struct DescriptorPool;
struct DescriptorSetObject;
struct DescriptorUpdateTemplate;
struct RenderPassObject;
struct Framebuffer;
struct CommandPool;
struct Semaphore;
struct Event;
struct Surface;
struct Swapchain;
struct DebugMessenger;
struct PrivateDataSlot;
struct ValidationCache;

template <class Handle>
struct HandleTraits;
#define VERNIER_HANDLE(handle, object) \
    template <>                        \
    struct HandleTraits<handle> {      \
        using Object = object;         \
    };
VERNIER_HANDLE(VkInstance, Instance)
VERNIER_HANDLE(VkPhysicalDevice, PhysicalDevice)
VERNIER_HANDLE(VkDevice, Device)
VERNIER_HANDLE(VkQueue, Queue)
VERNIER_HANDLE(VkCommandBuffer, CommandBuffer)
VERNIER_HANDLE(VkDeviceMemory, DeviceMemory)
VERNIER_HANDLE(VkBuffer, vernier::Buffer)
VERNIER_HANDLE(VkBufferView, vernier::BufferView)
VERNIER_HANDLE(VkImage, vernier::Image)
VERNIER_HANDLE(VkImageView, vernier::ImageView)
VERNIER_HANDLE(VkSampler, vernier::SamplerState)
VERNIER_HANDLE(VkSamplerYcbcrConversion, vernier::YcbcrConversion)
VERNIER_HANDLE(VkShaderModule, ShaderModule)
VERNIER_HANDLE(VkPipelineCache, PipelineCache)
VERNIER_HANDLE(VkPipelineLayout, PipelineLayout)
VERNIER_HANDLE(VkPipeline, Pipeline)
VERNIER_HANDLE(VkDescriptorSetLayout, DescriptorSetLayoutObject)
VERNIER_HANDLE(VkDescriptorPool, DescriptorPool)
VERNIER_HANDLE(VkDescriptorSet, DescriptorSetObject)
VERNIER_HANDLE(VkDescriptorUpdateTemplate, DescriptorUpdateTemplate)
VERNIER_HANDLE(VkRenderPass, RenderPassObject)
VERNIER_HANDLE(VkFramebuffer, Framebuffer)
VERNIER_HANDLE(VkCommandPool, CommandPool)
VERNIER_HANDLE(VkFence, vernier::BinarySignal)
VERNIER_HANDLE(VkSemaphore, Semaphore)
VERNIER_HANDLE(VkEvent, Event)
VERNIER_HANDLE(VkQueryPool, vernier::QueryPool)
VERNIER_HANDLE(VkSurfaceKHR, Surface)
VERNIER_HANDLE(VkSwapchainKHR, Swapchain)
VERNIER_HANDLE(VkDebugUtilsMessengerEXT, DebugMessenger)
VERNIER_HANDLE(VkPrivateDataSlot, PrivateDataSlot)
VERNIER_HANDLE(VkValidationCacheEXT, ValidationCache)
#undef VERNIER_HANDLE

template <class Handle>
using ObjectOf = typename HandleTraits<Handle>::Object;

/// The object behind a handle; nullptr for VK_NULL_HANDLE.
template <class Handle>
ObjectOf<Handle>* object(Handle handle) {
    return reinterpret_cast<ObjectOf<Handle>*>(handle);
}

template <class Handle>
Handle handleOf(ObjectOf<Handle>* object) {
    return reinterpret_cast<Handle>(object);
}

}  // namespace vernier::vulkan
