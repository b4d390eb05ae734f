// Dispatches.
#include "api/mini/context_guard.h"

using namespace vernier;
using namespace vernier::mini;

namespace {

/// Records everything that changed since the last dispatch.
VnResult prepareDispatch(VnContext context, const char* function) {
    if (context->inPass) return wrongState(context, function, "a pass is open");
    if (!context->computeProgram) return wrongState(context, function, "no compute program is bound");
    CommandBuffer& commands = context->recording->commands;
    const ComputePipeline& pipeline = *context->computeProgram->compute;
    if (context->computeResourcesChanged) {
        const ir::Program* programs[] = {&pipeline.ir()};
        if (VnResult result = recordResources(context, function, command::BindPoint::compute, programs)) return result;
        context->computeResourcesChanged = false;
    }
    if (context->computeProgramChanged) {
        context->recording->keep(context->computeProgram->compute);
        commands.record(command::BindComputePipeline{&pipeline});
        context->computeProgramChanged = false;
    }
    if (context->computePushConstantsChanged) {
        const std::span<const std::byte> bytes(context->pushConstants);
        commands.record(command::PushConstants{VK_SHADER_STAGE_COMPUTE_BIT, 0, commands.copy(bytes)});
        context->computePushConstantsChanged = false;
    }
    return VN_SUCCESS;
}

}  // namespace

VnResult vnDispatch(VnContext context, uint32_t groupsX, uint32_t groupsY, uint32_t groupsZ) {
    return guardedContext(context, __func__, [&] {
        const std::array<uint32_t, 3> count{groupsX, groupsY, groupsZ};
        if (Status status = checkGroupCounts(count); !status)
            return fail(context->device, "vnDispatch", status.error());
        if (VnResult result = prepareDispatch(context, "vnDispatch")) return result;
        context->recording->commands.record(command::Dispatch{{}, count, &context->statistics});
        ++context->dispatches;
        return VN_SUCCESS;
    });
}

VnResult vnDispatchIndirect(VnContext context, VnBuffer buffer, uint64_t offset) {
    return guardedContext(context, __func__, [&] {
        const auto object = context->device->buffers.find(buffer.id);
        if (!object) return badHandle(context->device, "vnDispatchIndirect", "buffer");
        const uint64_t size = object->buffer.size();
        if (offset % 4 != 0 || offset > size || size - offset < sizeof(VkDispatchIndirectCommand))
            return invalid(context->device, "vnDispatchIndirect",
                           "three counts at offset " + std::to_string(offset) + " are not inside the buffer's " +
                               std::to_string(size) + " bytes, or it is no multiple of 4");
        if (VnResult result = prepareDispatch(context, "vnDispatchIndirect")) return result;
        const command::BufferRange arguments{&context->recording->keep(object).buffer, offset};
        context->recording->commands.record(command::DispatchIndirect{arguments, &context->statistics});
        ++context->dispatches;
        return VN_SUCCESS;
    });
}
