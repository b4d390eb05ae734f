#include "api/mini/errors.h"

#include <array>
#include <cstdio>

namespace vernier::mini {

VnResult fail(VnDevice device, VnResult result, const std::string& text) {
    {
        const std::lock_guard lock(device->errorMutex);
        device->error = text;
    }
    if (device->message) device->message(device->messageUser, VN_SEVERITY_ERROR, text.c_str());
    return result;
}

VnResult failOutOfMemory(VnDevice device, const char* function) noexcept {
    std::array<char, kOutOfMemoryLength> text{};
    std::snprintf(text.data(), text.size(), "%s: out of memory", function);
    {
        const std::lock_guard lock(device->errorMutex);
        device->error.assign(text.data());  // there is room: see VnDevice_T
    }
    if (device->message) device->message(device->messageUser, VN_SEVERITY_ERROR, text.data());
    return VN_ERROR_OUT_OF_MEMORY;
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
