// Devices: creation, what they are, their last error.
#include <algorithm>
#include <cstring>

#include "api/mini/context.h"
#include "api/mini/errors.h"
#include "runtime/accuracy.h"

using namespace vernier;
using namespace vernier::mini;

#define VN_TEXT_(x) #x
#define VN_TEXT(x) VN_TEXT_(x)

namespace {

constexpr const char* kVersion = VN_TEXT(VN_VERSION_MAJOR) "." VN_TEXT(VN_VERSION_MINOR) "." VN_TEXT(VN_VERSION_PATCH);

/// Tells the handles of several devices apart; chance decides the rest, so this is a check and not a lock.
uint16_t saltOf(const void* address) {
    const auto bits = reinterpret_cast<uintptr_t>(address);
    return static_cast<uint16_t>((bits >> 4 ^ bits >> 20 ^ bits >> 36) * 0x9E37u | 1u);
}

VnResult report(const VnDeviceDesc& desc, VnResult result, const std::string& text) {
    if (desc.message) desc.message(desc.messageUser, VN_SEVERITY_ERROR, ("vnCreateDevice: " + text).c_str());
    return result;
}

VnResult createDevice(const VnDeviceDesc& desc, VnDevice* device) {
    if (desc._start != 0 || desc._end != 0)
        return report(desc._start != 0 ? VnDeviceDesc{} : desc, VN_ERROR_INVALID_ARGUMENT,
                      "desc is not initialised (_start and _end must be 0)");
    if (!desc.allocator.allocate != !desc.allocator.release)
        return report(desc, VN_ERROR_INVALID_ARGUMENT, "allocator has only one of allocate and release");
    DeviceDesc runtime;
    runtime.threads = desc.threads;
    const Result<Accuracy> accuracy = accuracyFrom(desc.profile, desc.axes, accuracyOf(Profile::standard));
    if (!accuracy) return report(desc, VN_ERROR_INVALID_ARGUMENT, accuracy.error().message);
    runtime.accuracy = *accuracy;
    runtime.allocator = {desc.allocator.user, desc.allocator.allocate, desc.allocator.release};
    const Result<Skips> skips = skipsFrom(desc.skips ? desc.skips : "");
    if (!skips) return report(desc, VN_ERROR_INVALID_ARGUMENT, "skips: " + skips.error().message);
    runtime.skips = *skips;
    if (desc.maxIsa) {
        const auto isa = isaFromName(desc.maxIsa);
        if (!isa)
            return report(desc, VN_ERROR_INVALID_ARGUMENT,
                          std::string("maxIsa is \"") + desc.maxIsa + "\"; allowed: " + std::string(isaNames()));
        runtime.maxIsa = *isa;
    }
    Result<std::unique_ptr<Device>> created = Device::create(runtime);
    if (!created)
        return report(
            desc,
            created.error().code == ErrorCode::invalidArgument ? VN_ERROR_INVALID_ARGUMENT : VN_ERROR_OUT_OF_MEMORY,
            created.error().message);
    *device = new VnDevice_T(std::move(created).value(), desc);
    return VN_SUCCESS;
}

}  // namespace

VnDevice_T::VnDevice_T(std::unique_ptr<Device> runtimeDevice, const VnDeviceDesc& desc)
    : runtime(std::move(runtimeDevice)), message(desc.message), messageUser(desc.messageUser), salt(saltOf(this)) {
    error.reserve(kOutOfMemoryLength);
}

VnDevice_T::~VnDevice_T() {
    // Contexts take themselves out of the list as they go.
    while (!contexts.empty()) vnDestroyContext(contexts.back());
}

VnResult vnCreateDevice(const VnDeviceDesc* desc, VnDevice* device) {
    if (!device) return VN_ERROR_INVALID_ARGUMENT;
    *device = nullptr;
    const VnDeviceDesc defaults{};
    try {
        return createDevice(desc ? *desc : defaults, device);
    } catch (...) {
        if (desc && desc->message) desc->message(desc->messageUser, VN_SEVERITY_ERROR, "vnCreateDevice: out of memory");
        return VN_ERROR_OUT_OF_MEMORY;
    }
}

void vnDestroyDevice(VnDevice device) {
    delete device;
}

size_t vnGetError(VnDevice device, char* text, size_t capacity) {
    if (!device) return 0;
    const std::lock_guard lock(device->errorMutex);
    return copyText(device->error, text, capacity);
}

VnResult vnGetDeviceInfo(VnDevice device, VnDeviceInfo* info) {
    return guarded(device, "vnGetDeviceInfo", [&] {
        if (!info) return invalid(device, "vnGetDeviceInfo", "info is NULL");
        *info = {};
        info->version = kVersion;
        info->isa = isaName(device->runtime->isa()).data();
        info->threads = device->runtime->pool().threadCount();
        info->maxImageSize = kMaxImageDimension2D;
        info->maxSamples = kMaxSamples;
        info->maxColorAttachments = kMaxColorAttachments;
        info->maxVertexAttributes = kMaxVertexAttributes;
        info->subPixelBits = device->runtime->desc().accuracy.subPixelBits;
        return VN_SUCCESS;
    });
}

VkFormatFeatureFlags vnGetFormatFeatures(VnDevice, VkFormat format) {
    const FormatInfo* info = findFormat(format);
    return info ? info->optimalTilingFeatures | info->bufferFeatures : 0;
}

namespace vernier::mini {

Result<Accuracy> accuracyFrom(VnProfile profile, const char* axes, const Accuracy& whenDefault) {
    if (profile < VN_PROFILE_DEFAULT || profile > VN_PROFILE_REFERENCE)
        return invalidArgument("profile is " + std::to_string(profile));
    Accuracy accuracy = profile == VN_PROFILE_DEFAULT ? whenDefault : accuracyOf(kProfiles[profile - VN_PROFILE_DRAFT]);
    if (Status status = setAxes(accuracy, axes ? axes : ""); !status) return status.error();
    return accuracy;
}

size_t copyText(const std::string& source, char* text, size_t capacity) {
    if (text && capacity > 0) {
        const size_t length = std::min(source.size(), capacity - 1);
        std::memcpy(text, source.data(), length);
        text[length] = '\0';
    }
    return source.size();
}

}  // namespace vernier::mini
