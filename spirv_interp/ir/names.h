// Names of the enumerators of ir.h, both ways, for the text form and for messages.
#pragma once

#include <optional>
#include <string_view>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

template <class Enum>
struct EnumName {
    std::string_view name;
    Enum value;
};

/// The table of an enumeration in declaration order, made from names.def.
template <class Enum>
std::span<const EnumName<Enum>> enumNames();

template <class Enum>
std::string_view nameOf(Enum value) {
    return enumNames<Enum>()[static_cast<size_t>(value)].name;
}

template <class Enum>
std::optional<Enum> fromName(std::string_view name) {
    for (const EnumName<Enum>& entry : enumNames<Enum>()) {
        if (entry.name == name) return entry.value;
    }
    return std::nullopt;
}

}  // namespace vernier::ir
