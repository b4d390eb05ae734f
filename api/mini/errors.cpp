#include "api/mini/errors.h"

namespace vernier::mini {

VnResult fail(VnDevice device, VnResult result, const std::string& text) {
    {
        const std::lock_guard lock(device->errorMutex);
        device->error = text;
    }
    if (device->message) device->message(device->messageUser, VN_SEVERITY_ERROR, text.c_str());
    return result;
}

VnResult fail(VnDevice device, const char* what, const Error& error) {
    const auto result = [&] {
        switch (error.code) {
            case ErrorCode::invalidArgument:
                return VN_ERROR_INVALID_ARGUMENT;
            case ErrorCode::unsupported:
                return VN_ERROR_UNSUPPORTED;
            case ErrorCode::outOfHostMemory:
            case ErrorCode::outOfDeviceMemory:
                return VN_ERROR_OUT_OF_MEMORY;
            case ErrorCode::deviceLost:
                return VN_ERROR_DEVICE_LOST;
        }
        return VN_ERROR_INVALID_ARGUMENT;
    }();
    return fail(device, result, std::string(what) + ": " + error.message);
}

}  // namespace vernier::mini
