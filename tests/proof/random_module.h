// Random valid modules. A program is a tree: statements and expressions name variables and never each other's values,
// so that any statement can be taken away and what is left is still a program. That is how a failing one is made small.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/proof/proof.h"

namespace vernier::proof {

enum class Base : uint8_t { boolean, i32, u32, f32, i64, f64, i8, u8, i16, u16, f16 };

/// A scalar, vector or float matrix.
struct ValueType {
    Base base = Base::f32;
    uint8_t rows = 1, columns = 1;
    bool operator==(const ValueType&) const = default;
    ValueType scalar() const { return {base, 1, 1}; }
    ValueType of(Base other) const { return {other, rows, columns}; }
    bool isMatrix() const { return columns > 1; }
};

struct Expression;
using ExpressionPtr = std::shared_ptr<Expression>;

struct Expression {
    enum class Kind : uint8_t {
        constant,      // literal: the scalar's bits, for every component
        variable,      // index; args: the array index, if it is an array
        input,         // index 0 to 2: vec4, ivec4, uvec4
        uniform,       // index 0 or 1: vec4 or ivec4 at [arg]; 2: the matrix
        bufferWord,    // u32 at [arg] of the invocation's own part
        bufferVector,  // vec4 at [arg]
        op,            // SPIR-V instruction `op` on args
        extended,      // GLSL.std.450 instruction `op` on args
        structMember,  // member `index` of what `op` gives, two members of the args' type
        extendedMember,
        construct,  // from args
        extract,    // component `index` of a vector, column of a matrix
        shuffle,    // two components of two vectors; literal: indices in bytes
        call,       // function `index`; args by value, then a pointer to variable `literal`
        both,       // arg 0 and arg 1 or (literal) or: with a branch and a phi
        choose,     // arg 0 ? arg 1 : arg 2, with branches and a phi
        subgroup,   // group instruction `op` on args; literal: its group operation (size of clusters << 8), or ~0
        fetch,      // the texel at arg 0, an ivec2, of level of detail arg 1; index 0: floats, 1: integers
        sample,     // the image of floats at arg 0, a vec2, with level of detail arg 1
    };
    Kind kind = Kind::constant;
    ValueType type;
    uint32_t op = 0, index = 0;
    uint64_t literal = 0;
    std::vector<ExpressionPtr> args;
};

struct Statement;
using Statements = std::vector<std::shared_ptr<Statement>>;

struct Statement {
    enum class Kind : uint8_t {
        assign,      // variable `index` [args 1] = args 0; component `literal` unless ~0
        bufferWord,  // [args 1] = args 0
        bufferVector,
        branch,    // if args 0: bodies 0, else bodies 1
        choice,    // switch args 0: case k: bodies k, the last is the default; bit k of literal: falls through
        loop,      // at most literal times while args 0 (tested before or after: index); bodies 0
        leave,     // break
        next,      // continue
        giveBack,  // return args 0, or nothing
        discard,
        shared,      // compute: args 0 goes to work-group memory, variable `index` gets what another invocation put
        derivative,  // fragment: variable `index` = dFdx or the like (literal) of args 0
    };
    Kind kind = Kind::assign;
    uint32_t index = 0;
    uint64_t literal = ~0ull;
    std::vector<ExpressionPtr> args;
    std::vector<Statements> bodies;
};

struct Variable {
    ValueType type;
    uint32_t length = 0;  // of an array; 0: none
    bool isPrivate = false;
};

struct RandomFunction {
    ValueType result;                  // functions[0] is main's body and gives nothing
    std::vector<uint32_t> parameters;  // variables that the arguments are copied to
    uint32_t pointer = ~0u;            // the variable that the last parameter points at
    std::vector<uint32_t> locals;      // the function's own variables, parameters among them
    Statements body;
};

struct RandomProgram {
    ir::Stage stage = ir::Stage::fragment;
    std::vector<Variable> variables;  // parameters (after the locals of a function) are variables too
    std::vector<RandomFunction> functions;
};

RandomProgram generateProgram(uint64_t seed);
Words emitProgram(const RandomProgram& program);
/// The program's inputs and memory.
Case caseOf(const RandomProgram& program, uint64_t seed);

/// Takes statements away and makes expressions smaller as long as `fails` says that the program still does.
RandomProgram shrink(RandomProgram program, const std::function<bool(const RandomProgram&)>& fails, size_t attempts);

}  // namespace vernier::proof
