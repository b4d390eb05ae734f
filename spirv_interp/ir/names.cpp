#include "spirv_interp/ir/names.h"

namespace vernier::ir {
namespace {

struct Entry {
    uint8_t enumeration;  // index among the enumerations, in the order of names.def
    std::string_view name;
    uint8_t value;
};

template <class T>
struct Tag;
#define VERNIER_IR_TAG(type, number)             \
    template <>                                  \
    struct Tag<type> {                           \
        static constexpr uint8_t value = number; \
    };
VERNIER_IR_TAG(Stage, 0)
VERNIER_IR_TAG(Builtin, 1)
VERNIER_IR_TAG(Interpolation, 2)
VERNIER_IR_TAG(Sampling, 3)
VERNIER_IR_TAG(ResourceKind, 4)
VERNIER_IR_TAG(ImageDim, 5)
VERNIER_IR_TAG(ImageKind, 6)
VERNIER_IR_TAG(AtomicOp, 7)
VERNIER_IR_TAG(GeometryInput, 8)
VERNIER_IR_TAG(GeometryOutput, 9)
#undef VERNIER_IR_TAG

constexpr Entry kEntries[] = {
#define VERNIER_IR_NAME(enumeration, enumerator) \
    {Tag<enumeration>::value, #enumerator, static_cast<uint8_t>(enumeration::enumerator)},
#include "spirv_interp/ir/names.def"
#undef VERNIER_IR_NAME
};

template <class Enum>
constexpr size_t countOf() {
    size_t count = 0;
    for (const Entry& entry : kEntries) count += entry.enumeration == Tag<Enum>::value ? 1 : 0;
    return count;
}

template <class Enum>
constexpr std::array<EnumName<Enum>, countOf<Enum>()> makeTable() {
    std::array<EnumName<Enum>, countOf<Enum>()> table{};
    size_t next = 0;
    for (const Entry& entry : kEntries) {
        if (entry.enumeration == Tag<Enum>::value) table[next++] = {entry.name, static_cast<Enum>(entry.value)};
    }
    return table;
}

template <class Enum>
constexpr bool inOrder() {
    size_t next = 0;
    for (const EnumName<Enum>& entry : makeTable<Enum>()) {
        if (static_cast<size_t>(entry.value) != next++) return false;
    }
    return true;
}

}  // namespace

#define VERNIER_IR_TABLE(type)                                      \
    template <>                                                     \
    std::span<const EnumName<type>> enumNames<type>() {             \
        static_assert(inOrder<type>(), "names.def lacks a " #type); \
        static constexpr auto kTable = makeTable<type>();           \
        return kTable;                                              \
    }
VERNIER_IR_TABLE(Stage)
VERNIER_IR_TABLE(Builtin)
VERNIER_IR_TABLE(Interpolation)
VERNIER_IR_TABLE(Sampling)
VERNIER_IR_TABLE(ResourceKind)
VERNIER_IR_TABLE(ImageDim)
VERNIER_IR_TABLE(ImageKind)
VERNIER_IR_TABLE(AtomicOp)
VERNIER_IR_TABLE(GeometryInput)
VERNIER_IR_TABLE(GeometryOutput)
#undef VERNIER_IR_TABLE

}  // namespace vernier::ir
