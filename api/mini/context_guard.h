// What every function of a context begins with.
#pragma once

#include "api/mini/context.h"
#include "api/mini/errors.h"

namespace vernier::mini {

template <class Body>
VnResult guardedContext(VnContext context, const char* function, Body body) {
    return context ? guarded(context->device, function, body) : VN_ERROR_INVALID_HANDLE;
}

inline VnResult wrongState(VnContext context, const char* function, const std::string& text) {
    return fail(context->device, VN_ERROR_INVALID_STATE, std::string(function) + ": " + text);
}

/// Whether what is recorded may be submitted.
inline VnResult checkSubmit(VnContext context, const char* function) {
    if (context->inPass) return wrongState(context, function, "a pass is open");
    return context->queries.empty() ? VN_SUCCESS : wrongState(context, function, "a query has begun and not ended");
}

/// Submits what is recorded and waits for all of it.
inline VnResult finish(VnContext context, const char* function) {
    if (VnResult result = checkSubmit(context, function)) return result;
    if (context->recording->commands.first()) context->submit();
    context->waitIdle();
    if (context->device->runtime->queue().lost())
        return fail(
            context->device, VN_ERROR_DEVICE_LOST,
            std::string(function) + ": a shader looped beyond the budget, or memory ran out; the device is lost");
    return VN_SUCCESS;
}

}  // namespace vernier::mini
