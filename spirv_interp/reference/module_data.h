// The parsed module as the interpreter sees it: types, constants, variables, functions. Every value is
// flattened: a composite is the row of its scalars in order, so that a member is a sub-row and copying needs
// no recursion.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "spirv_interp/reference/interpreter.h"

namespace vernier::reference {

using Id = uint32_t;
inline constexpr uint32_t kNoIndex = ~0u;

/// Thrown inside the reference interpreter only; every public function turns it into its Error.
struct Failure {
    Error error;
};
[[noreturn]] void fail(std::string message);
[[noreturn]] void failUnsupported(std::string message);
std::string name(Id id);       // "%12"
std::string name(spv::Op op);  // "OpFAdd" or "opcode 4711"

/// The largest value a shader may hold: keeps broken modules from asking for all memory.
inline constexpr uint64_t kMaxScalars = uint64_t{1} << 18;
inline constexpr uint32_t kMaxTypeDepth = 64;

struct Decorations {
    std::optional<uint32_t> location, component, index, builtin, specId, arrayStride, matrixStride, offset, binding,
        set, inputAttachmentIndex;
    bool flat = false, noPerspective = false, centroid = false, sample = false, perVertex = false, patch = false;
    bool block = false, bufferBlock = false, rowMajor = false, isVolatile = false;
    bool towardsZero = false;  // FPRoundingMode
};

enum class TypeKind : uint8_t {
    voidType,
    boolean,
    integer,
    floating,
    vector,
    matrix,
    array,
    runtimeArray,
    structure,
    pointer,
    function,
    image,
    sampler,
    sampledImage,
};

struct Type {
    Id id = 0;
    TypeKind kind = TypeKind::voidType;
    uint32_t width = 32;            // integer, floating, pointer
    bool isSigned = false;          // integer
    uint32_t element = 0;           // index of the element type (vector, matrix, array), pointee, image of a sampled
                                    // image, return type of a function
    uint32_t count = 0;             // components, columns, array length
    std::vector<uint32_t> members;  // type indices: of a struct, parameters of a function
    std::vector<uint64_t> cellOffsets;  // struct: first scalar of each member
    uint64_t scalars = 0;               // when flattened; 0 for opaque types, saturating
    uint32_t depth = 0;                 // nesting
    bool holdable = false;              // has values that variables and results can hold; then scalars > 0
    uint64_t bytes = 0;                 // struct: ModuleData::byteSize
    spv::StorageClass storage = spv::StorageClassFunction;  // pointer
    ImageShape shape;                                       // image

    bool isScalar() const {
        return kind == TypeKind::boolean || kind == TypeKind::integer || kind == TypeKind::floating;
    }
    bool isArray() const { return kind == TypeKind::array || kind == TypeKind::runtimeArray; }
    bool isOpaque() const {
        return kind == TypeKind::image || kind == TypeKind::sampler || kind == TypeKind::sampledImage;
    }
};

struct Instruction {
    spv::Op op = spv::OpNop;
    Id type = 0;  // result type
    Id result = 0;
    std::span<const uint32_t> operands;  // without result type and result
    uint32_t line = 0;                   // source line, 0 = unknown

    uint32_t operand(size_t index) const {
        if (index >= operands.size()) fail(name(op) + " has too few operands");
        return operands[index];
    }
};

/// A word as one of SPIR-V's enumerations, whose values end at 0x7FFFFFFF (...Max).
template <class Enum>
Enum enumerant(uint32_t word) {
    return static_cast<Enum>(word < 0x7FFFFFFFu ? word : 0x7FFFFFFFu);
}

/// The text in `words` from `first`, and the index of the word after it.
std::pair<std::string, size_t> literalString(std::span<const uint32_t> words, size_t first);

struct Block {
    Id label = 0;
    size_t begin = 0, end = 0;         // Function::instructions
    Id merge = 0, continueTarget = 0;  // of its OpSelectionMerge or OpLoopMerge
    // structure.cpp: the place in structured order, and for the header of a loop one past the last place in it.
    uint32_t rank = 0;
    uint32_t loopEnd = 0;  // 0: no loop header
};

struct Function {
    Id id = 0;
    uint32_t returnType = 0;
    std::vector<std::pair<Id, uint32_t>> parameters;  // id, type index
    std::vector<Instruction> instructions;            // of all blocks; OpLabel is not among them
    std::vector<Block> blocks;
    std::map<Id, uint32_t> blockOf;  // by label
    uint32_t slots = 0;              // results, parameters included
};

struct Variable {
    Id id = 0;
    uint32_t pointerType = 0;
    spv::StorageClass storage = spv::StorageClassPrivate;
    Id initializer = 0;
};

/// A scalar of a constant: the same in all number types.
struct ConstantScalar {
    double number = 0;
    uint64_t bits = 0;
};

struct Constant {
    uint32_t type = 0;
    std::vector<ConstantScalar> scalars;
};

enum class IdKind : uint8_t { none, type, constant, variable, function, local, glslSet, ignoredSet };

struct IdInfo {
    IdKind kind = IdKind::none;
    uint32_t index = 0;     // into types, constants, variables, functions; slot of a local
    uint32_t type = 0;      // type index of a constant, variable or local
    uint32_t function = 0;  // local
};

/// Where one scalar of an interface variable comes from or goes to.
struct InterfaceCell {
    uint32_t cell = 0;  // in the variable
    uint32_t type = 0;  // type index
    bool isBuiltin = false;
    spv::BuiltIn builtin = spv::BuiltInMax;
    uint32_t element = 0;  // of the built-in
    Location location;
    uint32_t component = 0;
    uint32_t vertex = 0;  // as InterfaceVariable::vertex
};

struct InterfaceLayout {
    uint32_t variable = 0;  // index
    bool output = false;
    std::vector<InterfaceCell> cells;  // by cell
};

struct EntryPointData {
    Id function = 0;
    std::vector<Id> interface;
    std::vector<InterfaceLayout> layouts;
    std::vector<InterfaceVariable> variables;
};

struct ModuleData {
    std::vector<uint32_t> words;  // instructions point into it
    std::vector<IdInfo> ids;
    std::vector<Type> types;
    std::vector<Constant> constants;
    std::vector<Variable> variables;
    std::vector<Function> functions;
    std::map<Id, Decorations> decorations;
    std::map<std::pair<Id, uint32_t>, Decorations> memberDecorations;
    std::map<Id, std::string> names;
    std::map<std::pair<Id, uint32_t>, std::string> memberNames;
    Module::Specialization specialization;
    uint64_t constantScalars = 0;  // of all constants together

    std::vector<EntryPoint> entryPoints;
    std::vector<EntryPointData> entryPointData;
    std::vector<DescriptorBinding> bindings;
    uint64_t pushConstantSize = 0;

    const IdInfo& info(Id id) const;
    const Decorations& decorationsOf(Id id) const;
    const Decorations& decorationsOf(Id structure, uint32_t member) const;
    uint32_t typeIndex(Id id) const;  // of an OpType...
    const Type& typeOf(Id id) const { return types[typeIndex(id)]; }
    /// Type of a value: constant, variable, parameter or result.
    const Type& valueType(Id id) const;
    /// The scalar type that a scalar, vector or matrix is made of.
    const Type& scalarType(const Type& type) const;

    const Constant& constant(Id id) const;
    /// An integer constant as a number; fails for anything else.
    uint64_t constantInteger(Id id) const;

    /// Number of scalars of a value that a shader can hold; fails for opaque, unsized or too large types.
    uint64_t valueScalars(const Type& type) const;
    /// Sub-row of a flattened value.
    struct Range {
        uint32_t type = 0;  // index
        uint64_t first = 0;
        uint64_t count = 0;
    };
    Range subrange(const Type& type, std::span<const uint32_t> indices) const;

    /// Bytes that a type takes in a buffer up to its last scalar, a trailing runtime array counted as empty.
    uint64_t byteSize(const Type& type, uint32_t matrixStride, bool rowMajor) const;
};

/// Of a scalar type.
ScalarKind scalarKind(const Type& type);

/// The stages of parsing, in order.
void parseModule(ModuleData& module);                                    // parse.cpp
void parseType(ModuleData& module, const Instruction& instruction);      // types.cpp
void parseConstant(ModuleData& module, const Instruction& instruction);  // constants.cpp
void orderBlocks(Function& function);                                    // structure.cpp
void reflect(ModuleData& module);                                        // reflect.cpp

}  // namespace vernier::reference
