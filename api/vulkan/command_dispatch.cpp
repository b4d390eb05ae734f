// Dispatches.
#include "api/vulkan/command_buffer.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/pipeline.h"
#include "runtime/resource/memory.h"

namespace vernier::vulkan {
namespace {

/// A dispatch that cannot run is left out and remembered as an error.
template <class Command>
void recordDispatch(VkCommandBuffer handle, const char* name, const Command& command) {
    recording(handle, [&](CommandBuffer& buffer) {
        if (buffer.pass.inside) return buffer.fail(name, "not allowed inside a render pass");
        if (buffer.computePipeline == nullptr) return buffer.fail(name, "no compute pipeline is bound");
        buffer.stream.record(command);
    });
}

void recordGroups(VkCommandBuffer handle, const char* name, const std::array<uint32_t, 3>& base,
                  const std::array<uint32_t, 3>& count) {
    if (const Status status = checkGroupCounts(count); !status) {
        return recording(handle, [&](CommandBuffer& buffer) { buffer.fail(name, status.error().message); });
    }
    recordDispatch(handle, name, command::Dispatch{base, count});
}

}  // namespace

VKAPI_ATTR void VKAPI_CALL CmdDispatch(VkCommandBuffer commandBuffer, uint32_t groupCountX, uint32_t groupCountY,
                                       uint32_t groupCountZ) {
    recordGroups(commandBuffer, "vkCmdDispatch", {}, {groupCountX, groupCountY, groupCountZ});
}

VKAPI_ATTR void VKAPI_CALL CmdDispatchBase(VkCommandBuffer commandBuffer, uint32_t baseGroupX, uint32_t baseGroupY,
                                           uint32_t baseGroupZ, uint32_t groupCountX, uint32_t groupCountY,
                                           uint32_t groupCountZ) {
    recordGroups(commandBuffer, "vkCmdDispatchBase", {baseGroupX, baseGroupY, baseGroupZ},
                 {groupCountX, groupCountY, groupCountZ});
}

VKAPI_ATTR void VKAPI_CALL CmdDispatchIndirect(VkCommandBuffer commandBuffer, VkBuffer buffer, VkDeviceSize offset) {
    if (offset % 4 != 0) {
        return recording(commandBuffer, [](CommandBuffer& into) {
            into.fail("vkCmdDispatchIndirect", "offset must be a multiple of 4");
        });
    }
    recordDispatch(commandBuffer, "vkCmdDispatchIndirect", command::DispatchIndirect{{object(buffer), offset}});
}

}  // namespace vernier::vulkan
