// Turning what goes wrong into a result code, a text and a message.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>

#include "api/mini/objects.h"

namespace vernier::mini {

/// Remembers `text` as the device's last error, sends it to the message callback, and returns `result`.
VnResult fail(VnDevice device, VnResult result, const std::string& text);

/// The same for an Error of the runtime; `what` names the object, e.g. "vnCreateImage".
VnResult fail(VnDevice device, const char* what, const Error& error);

/// VN_ERROR_OUT_OF_MEMORY, told without taking memory.
VnResult failOutOfMemory(VnDevice device, const char* function) noexcept;

/// Runs `body` (returning VnResult) so that no exception leaves the C boundary: there is none but for memory that ran
/// out (std::bad_alloc, std::length_error). `device` NULL gives INVALID_HANDLE.
template <class Body>
VnResult guarded(VnDevice device, const char* function, Body body) noexcept {
    if (!device) return VN_ERROR_INVALID_HANDLE;
    try {
        return body();
    } catch (...) {
        return failOutOfMemory(device, function);
    }
}

/// The common start of every create function: pointers and canaries.
template <class Desc, class Handle>
VnResult checkDesc(VnDevice device, const char* function, const Desc* desc, const Handle* handle) {
    if (!desc) return fail(device, VN_ERROR_INVALID_ARGUMENT, std::string(function) + ": desc is NULL");
    if (!handle)
        return fail(device, VN_ERROR_INVALID_ARGUMENT, std::string(function) + ": the place for the handle is NULL");
    if (desc->_start != 0 || desc->_end != 0)
        return fail(device, VN_ERROR_INVALID_ARGUMENT,
                    std::string(function) + ": desc is not initialised (_start is " + std::to_string(desc->_start) +
                        ", _end is " + std::to_string(desc->_end) + ", both must be 0)");
    return VN_SUCCESS;
}

inline VnResult badHandle(VnDevice device, const char* function, const char* kind) {
    return fail(device, VN_ERROR_INVALID_HANDLE,
                std::string(function) + ": the " + kind + " is null, destroyed, or of another device");
}

inline VnResult invalid(VnDevice device, const char* function, const std::string& text) {
    return fail(device, VN_ERROR_INVALID_ARGUMENT, std::string(function) + ": " + text);
}

/// What a C caller put into an enum: it may be no value of the enum at all, so that it must not be read as one.
template <class Enum>
int64_t enumValue(const Enum& field) {
    static_assert(std::is_enum_v<Enum> && sizeof(Enum) == sizeof(uint32_t));
    uint32_t value;
    std::memcpy(&value, &field, sizeof value);
    return value;
}

/// Of an enum, or of what enumValue() made of one, whose values are 0 .. `last`.
template <class Value>
VnResult checkEnum(VnDevice device, const char* function, const std::string& field, const Value& given, int64_t last) {
    int64_t value;
    if constexpr (std::is_enum_v<Value>)
        value = enumValue(given);
    else
        value = given;
    if (value >= 0 && value <= last) return VN_SUCCESS;
    return invalid(device, function, field + " is " + std::to_string(value) + ", which stands for nothing");
}

/// The common body of every destroy function.
template <class Object>
VnResult destroyIn(VnDevice device, const char* function, const char* kind, HandleTable<Object>& table, uint64_t id) {
    return guarded(device, function, [&] { return table.remove(id) ? VN_SUCCESS : badHandle(device, function, kind); });
}

}  // namespace vernier::mini
