// Writes a random program as a module. Around main's body stands what every module has: inputs are brought in, results
// handed on.
#pragma once

#include <map>
#include <optional>

#include "tests/proof/module_builder.h"
#include "tests/proof/random_module.h"

namespace vernier::proof {

constexpr uint32_t kGroupSize = 64;
constexpr uint32_t kWords = 8, kVectors = 4;  // an invocation's own parts of the buffers

class Emitter {
  public:
    explicit Emitter(const RandomProgram& program) : program_(program) {}

    Words run();

  private:
    // --- types and constants

    Id voidType() { return b_.type(spv::OpTypeVoid, {}); }
    Id scalarType(Base base);
    Id typeId(ValueType type) {
        const Id scalar = scalarType(type.base);
        const Id column = type.rows == 1 ? scalar : b_.type(spv::OpTypeVector, {scalar, type.rows});
        return type.columns == 1 ? column : b_.type(spv::OpTypeMatrix, {column, type.columns});
    }
    Id variableType(const Variable& v) {
        const Id type = typeId(v.type);
        return v.length == 0 ? type : b_.type(spv::OpTypeArray, {type, constantU32(v.length)});
    }
    Id pointerType(spv::StorageClass storage, Id type) {
        return b_.type(spv::OpTypePointer, {static_cast<uint32_t>(storage), type});
    }
    Id constantU32(uint32_t value) { return b_.constant(scalarType(Base::u32), {value}); }
    Id constant(ValueType type, uint64_t bits);

    // --- what is around the program

    Id global(Id type, spv::StorageClass storage) {
        const Id pointer = pointerType(storage, type), id = b_.newId();
        b_.add(ModuleBuilder::globals, spv::OpVariable, {pointer, id, static_cast<uint32_t>(storage)});
        return id;
    }
    Id bufferOf(Id member, uint32_t stride, uint32_t binding, bool readOnly);
    Id bound(Id variable, uint32_t binding) {
        b_.decorate(variable, spv::DecorationDescriptorSet, {0});
        b_.decorate(variable, spv::DecorationBinding, {binding});
        return variable;
    }
    void resources();
    static ValueType ioType(uint32_t k) {
        constexpr Base kBases[] = {Base::f32, Base::i32, Base::u32};
        return {kBases[k], 4, 1};
    }
    Id interface(ValueType type, spv::StorageClass storage, spv::Decoration decoration, uint32_t value);
    Id load(Id type, Id pointer) { return b_.value(spv::OpLoad, type, {pointer}); }
    void store(Id pointer, Id value) { b_.add(ModuleBuilder::functions, spv::OpStore, {pointer, value}); }
    void label(Id id) {
        b_.add(ModuleBuilder::functions, spv::OpLabel, {id});
        block_ = id;
        ended_ = false;
    }
    void jump(Id to) {
        if (!ended_) b_.add(ModuleBuilder::functions, spv::OpBranch, {to});
        ended_ = true;
    }
    void end(spv::Op op, std::initializer_list<uint32_t> operands = {}) {
        if (!ended_) b_.add(ModuleBuilder::functions, op, operands);
        ended_ = true;
    }
    Id beginFunction(Id id, Id result, const std::vector<Id>& parameters);

    void main();

    void function(size_t index);

    /// A counter for every loop: variables stand at the start of a function.
    void countLoops(const Statements& list);

    // --- statements

    void statements(const Statements& list);
    Id condition(Id value, Id yes, Id no) {
        end(spv::OpBranchConditional, {value, yes, no});
        return value;
    }
    void statement(const Statement& s);
    void barrier() {
        b_.add(ModuleBuilder::functions, spv::OpControlBarrier,
               {constantU32(spv::ScopeWorkgroup), constantU32(spv::ScopeWorkgroup),
                constantU32(spv::MemorySemanticsAcquireReleaseMask | spv::MemorySemanticsWorkgroupMemoryMask)});
    }
    void choice(const Statement& s);
    void loop(const Statement& s);

    // --- expressions

    Id own(Id index, uint32_t size) {
        const Id u32 = scalarType(Base::u32);
        const Id base = b_.value(spv::OpIMul, u32, {load(u32, invocation_), constantU32(size)});
        return b_.value(spv::OpIAdd, u32, {base, index});
    }
    Id wordPointer(Id index) {
        return b_.value(spv::OpAccessChain, pointerType(spv::StorageClassStorageBuffer, scalarType(Base::u32)),
                        {words_, constantU32(0), own(index, kWords)});
    }
    Id vectorPointer(Id index) {
        // Behind an invocation's vectors is room for a compute shader's results.
        return b_.value(spv::OpAccessChain, pointerType(spv::StorageClassStorageBuffer, typeId({Base::f32, 4, 1})),
                        {vectors_, constantU32(0), own(index, kVectors + 3)});
    }
    std::vector<Id> arguments(const Expression& e) {
        std::vector<Id> ids;
        for (const ExpressionPtr& arg : e.args) ids.push_back(expression(*arg));
        return ids;
    }
    Id extended(uint32_t function, Id type, const std::vector<Id>& args) {
        std::vector<uint32_t> words{glsl_, function};
        words.insert(words.end(), args.begin(), args.end());
        return b_.value(spv::OpExtInst, type, words);
    }
    Id subgroup(const Expression& e);
    Id image(const Expression& e);
    Id expression(const Expression& e);

    const RandomProgram& program_;
    ModuleBuilder b_;
    Id glsl_ = 0, words_ = 0, vectors_ = 0, uniforms_ = 0, source_ = 0, shared_ = 0, local_ = 0, invocation_ = 0,
       block_ = 0;
    std::array<Id, 3> inputs_{};
    std::array<Id, 2> images_{};
    std::vector<Id> interface_, pointers_, functions_, breaks_, continues_;
    std::map<const Statement*, Id> counters_;
    std::optional<ValueType> result_;
    bool ended_ = false;
};

}  // namespace vernier::proof
