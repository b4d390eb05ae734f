// Push descriptors (VK_KHR_push_descriptor): descriptors that are part of a command buffer.
#include "api/vulkan/command_buffer.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"

namespace vernier::vulkan {
namespace {

/// Records a set with the descriptors pushed so far and those that write(set) writes: draws before keep theirs.
template <class Write>
void push(CommandBuffer& buffer, const char* name, VkPipelineBindPoint point, const PipelineLayout& layout,
          uint32_t set, Write&& write) {
    const bool isCompute = point == VK_PIPELINE_BIND_POINT_COMPUTE;
    if (!isCompute && point != VK_PIPELINE_BIND_POINT_GRAPHICS) {
        return buffer.fail(name, "pipelineBindPoint must be GRAPHICS or COMPUTE");
    }
    if (set >= layout.sets.size() || layout.sets[set] == nullptr)
        return buffer.fail(name, "the layout has no such set");
    auto made = std::make_unique<DescriptorSetObject>(layout.sets[set], 0);
    DescriptorSetObject*& latest = buffer.latestPush[isCompute ? 1 : 0];
    // What was pushed to another set, or another layout, is not looked at any more.
    if (latest != nullptr && latest->layout->bindings == made->layout->bindings) {
        for (uint32_t slot = 0; slot < made->set.slots().size(); ++slot) made->set.takeSlot(slot, latest->set);
    }
    write(made->set);
    latest = made.get();
    buffer.pushed.push_back(std::move(made));
    const std::span sets = buffer.stream.arena().array<const DescriptorSet*>(1);
    sets[0] = &latest->set;
    buffer.stream.record(command::BindDescriptorSets{
        isCompute ? command::BindPoint::compute : command::BindPoint::graphics, set, sets, {}});
}

}  // namespace

VKAPI_ATTR void VKAPI_CALL CmdPushDescriptorSetKHR(VkCommandBuffer commandBuffer, VkPipelineBindPoint pipelineBindPoint,
                                                   VkPipelineLayout layout, uint32_t set, uint32_t descriptorWriteCount,
                                                   const VkWriteDescriptorSet* pDescriptorWrites) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        push(buffer, "vkCmdPushDescriptorSetKHR", pipelineBindPoint, *object(layout), set,
             [&](DescriptorSet& to) { writeDescriptors(buffer.device, to, descriptorWriteCount, pDescriptorWrites); });
    });
}

VKAPI_ATTR void VKAPI_CALL CmdPushDescriptorSetWithTemplateKHR(VkCommandBuffer commandBuffer,
                                                               VkDescriptorUpdateTemplate descriptorUpdateTemplate,
                                                               VkPipelineLayout layout, uint32_t set,
                                                               const void* pData) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        const DescriptorUpdateTemplate& entries = *object(descriptorUpdateTemplate);
        push(buffer, "vkCmdPushDescriptorSetWithTemplateKHR", entries.bindPoint, *object(layout), set,
             [&](DescriptorSet& to) { writeDescriptors(buffer.device, to, entries, pData); });
    });
}

}  // namespace vernier::vulkan
