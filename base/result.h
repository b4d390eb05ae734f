// Errors as values: what went wrong, in a code and in words. Nothing in Vernier throws across a C boundary, and no
// function below api/ decides what an error means to a caller.
#pragma once

#include <cassert>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace vernier {

enum class ErrorCode : uint8_t {
    invalidArgument,  // the caller broke a rule; the message names the object, the field and the value
    unsupported,      // legal, but not implemented or not available
    outOfHostMemory,
    outOfDeviceMemory,
    deviceLost,
};

struct Error {
    ErrorCode code = ErrorCode::invalidArgument;
    std::string message;
};

inline Error invalidArgument(std::string message) {
    return {ErrorCode::invalidArgument, std::move(message)};
}
inline Error unsupported(std::string message) {
    return {ErrorCode::unsupported, std::move(message)};
}

/// A T or an Error. [[nodiscard]]: a result is looked at.
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    T& value() & {
        assert(ok());
        return std::get<0>(state_);
    }
    const T& value() const& {
        assert(ok());
        return std::get<0>(state_);
    }
    T&& value() && {
        assert(ok());
        return std::get<0>(std::move(state_));
    }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    const Error& error() const {
        assert(!ok());
        return std::get<1>(state_);
    }

  private:
    std::variant<T, Error> state_;
};

/// Success, or an Error.
class [[nodiscard]] Status {
  public:
    Status() = default;
    Status(Error error) : error_(std::move(error)), failed_(true) {}

    bool ok() const { return !failed_; }
    explicit operator bool() const { return ok(); }
    const Error& error() const {
        assert(failed_);
        return error_;
    }

  private:
    Error error_;
    bool failed_ = false;
};

}  // namespace vernier
