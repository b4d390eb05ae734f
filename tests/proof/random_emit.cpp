// Programs to modules. Around main's body stands what every module has: inputs are brought in, results handed on.
#include <algorithm>
#include <map>
#include <optional>

#include <spirv/unified1/GLSL.std.450.h>

#include "tests/proof/module_builder.h"
#include "tests/proof/random_module.h"

namespace vernier::proof {
namespace {

constexpr uint32_t kVersion = 0x00010300;
constexpr uint32_t kGroupSize = 64;
constexpr uint32_t kWords = 8, kVectors = 4;  // an invocation's own parts of the buffers

class Emitter {
  public:
    explicit Emitter(const RandomProgram& program) : program_(program) {}

    Words run() {
        b_.capability(spv::CapabilityShader);
        b_.add(ModuleBuilder::extensions, spv::OpExtension,
               ModuleBuilder::text("SPV_KHR_storage_buffer_storage_class"));
        glsl_ = b_.newId();
        std::vector<uint32_t> words{glsl_};
        const auto name = ModuleBuilder::text("GLSL.std.450");
        words.insert(words.end(), name.begin(), name.end());
        b_.add(ModuleBuilder::imports, spv::OpExtInstImport, words);
        b_.add(ModuleBuilder::memoryModel, spv::OpMemoryModel, {spv::AddressingModelLogical, spv::MemoryModelGLSL450});
        resources();
        for (size_t k = 0; k < program_.variables.size(); ++k) {
            pointers_.push_back(0);
            if (program_.variables[k].isPrivate)
                pointers_[k] = global(variableType(program_.variables[k]), spv::StorageClassPrivate);
        }
        for (size_t f = 0; f < program_.functions.size(); ++f) functions_.push_back(b_.newId());
        main();
        for (size_t f = 0; f < program_.functions.size(); ++f) function(f);
        return b_.words(kVersion);
    }

  private:
    // --- types and constants

    Id voidType() { return b_.type(spv::OpTypeVoid, {}); }
    Id scalarType(Base base) {
        switch (base) {
            case Base::boolean:
                return b_.type(spv::OpTypeBool, {});
            case Base::i32:
                return b_.type(spv::OpTypeInt, {32, 1});
            case Base::u32:
                return b_.type(spv::OpTypeInt, {32, 0});
            case Base::f32:
                return b_.type(spv::OpTypeFloat, {32});
            case Base::i64:
                b_.capability(spv::CapabilityInt64);
                return b_.type(spv::OpTypeInt, {64, 1});
            case Base::f64:
                b_.capability(spv::CapabilityFloat64);
                return b_.type(spv::OpTypeFloat, {64});
        }
        return 0;
    }
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
    Id constant(ValueType type, uint64_t bits) {
        if (type.rows > 1) {
            const ValueType part = type.isMatrix() ? ValueType{type.base, type.rows, 1} : type.scalar();
            const std::vector<Id> parts(type.isMatrix() ? type.columns : type.rows, constant(part, bits));
            return b_.compositeConstant(typeId(type), parts);
        }
        const Id id = scalarType(type.base);
        if (type.base == Base::boolean) return b_.boolConstant(id, bits != 0);
        if (type.base == Base::i64 || type.base == Base::f64)
            return b_.constant(id, {static_cast<uint32_t>(bits), static_cast<uint32_t>(bits >> 32)});
        return b_.constant(id, {static_cast<uint32_t>(bits)});
    }

    // --- what is around the program

    Id global(Id type, spv::StorageClass storage) {
        const Id pointer = pointerType(storage, type), id = b_.newId();
        b_.add(ModuleBuilder::globals, spv::OpVariable, {pointer, id, static_cast<uint32_t>(storage)});
        return id;
    }
    Id bufferOf(Id member, uint32_t stride, uint32_t binding, bool readOnly) {
        const Id array = b_.newId(), block = b_.newId();
        b_.add(ModuleBuilder::globals, spv::OpTypeRuntimeArray, {array, member});
        b_.decorate(array, spv::DecorationArrayStride, {stride});
        b_.add(ModuleBuilder::globals, spv::OpTypeStruct, {block, array});
        b_.decorate(block, spv::DecorationBlock);
        b_.memberDecorate(block, 0, spv::DecorationOffset, {0});
        if (readOnly) b_.memberDecorate(block, 0, spv::DecorationNonWritable, {});
        return bound(global(block, spv::StorageClassStorageBuffer), binding);
    }
    Id bound(Id variable, uint32_t binding) {
        b_.decorate(variable, spv::DecorationDescriptorSet, {0});
        b_.decorate(variable, spv::DecorationBinding, {binding});
        return variable;
    }
    void resources() {
        const Id vec4 = typeId({Base::f32, 4, 1}), ivec4 = typeId({Base::i32, 4, 1});
        words_ = bufferOf(scalarType(Base::u32), 4, 0, false);
        vectors_ = bufferOf(vec4, 16, 1, false);
        if (program_.stage == ir::Stage::compute) source_ = bufferOf(typeId(ioType(2)), 16, 3, true);
        const Id floats = b_.newId(), integers = b_.newId(), block = b_.newId();
        for (const auto& [array, element] : {std::pair{floats, vec4}, {integers, ivec4}}) {
            b_.add(ModuleBuilder::globals, spv::OpTypeArray, {array, element, constantU32(8)});
            b_.decorate(array, spv::DecorationArrayStride, {16});
        }
        b_.add(ModuleBuilder::globals, spv::OpTypeStruct, {block, floats, integers, typeId({Base::f32, 4, 4})});
        b_.decorate(block, spv::DecorationBlock);
        for (uint32_t m = 0; m < 3; ++m) b_.memberDecorate(block, m, spv::DecorationOffset, {m * 128});
        b_.memberDecorate(block, 2, spv::DecorationMatrixStride, {16});
        b_.memberDecorate(block, 2, spv::DecorationRowMajor, {});
        uniforms_ = bound(global(block, spv::StorageClassUniform), 2);
        invocation_ = global(scalarType(Base::u32), spv::StorageClassPrivate);
        for (uint32_t k = 0; k < 3; ++k) inputs_[k] = global(typeId(ioType(k)), spv::StorageClassPrivate);
        if (program_.stage == ir::Stage::compute) {
            shared_ = global(b_.type(spv::OpTypeArray, {scalarType(Base::u32), constantU32(kGroupSize)}),
                             spv::StorageClassWorkgroup);
        }
    }
    static ValueType ioType(uint32_t k) {
        constexpr Base kBases[] = {Base::f32, Base::i32, Base::u32};
        return {kBases[k], 4, 1};
    }
    Id interface(ValueType type, spv::StorageClass storage, spv::Decoration decoration, uint32_t value) {
        const Id id = global(typeId(type), storage);
        b_.decorate(id, decoration, {value});
        if (decoration == spv::DecorationLocation && storage == spv::StorageClassInput && type.base != Base::f32 &&
            program_.stage == ir::Stage::fragment)
            b_.decorate(id, spv::DecorationFlat);
        interface_.push_back(id);
        return id;
    }
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
    Id beginFunction(Id id, Id result, const std::vector<Id>& parameters) {
        std::vector<uint32_t> words{result};
        words.insert(words.end(), parameters.begin(), parameters.end());
        const Id type = b_.type(spv::OpTypeFunction, words);
        b_.add(ModuleBuilder::functions, spv::OpFunction, {result, id, 0, type});
        return type;
    }

    void main() {
        const Id entry = b_.newId(), u32 = scalarType(Base::u32), zero = constantU32(0);
        beginFunction(entry, voidType(), {});
        label(b_.newId());
        if (program_.stage == ir::Stage::compute) {
            const Id builtin = interface({Base::u32, 3, 1}, spv::StorageClassInput, spv::DecorationBuiltIn,
                                         spv::BuiltInGlobalInvocationId);
            const Id number = b_.value(spv::OpCompositeExtract, u32, {load(typeId({Base::u32, 3, 1}), builtin), 0});
            store(invocation_, number);
            for (uint32_t k = 0; k < 3; ++k) {
                const Id base = b_.value(spv::OpIMul, u32, {number, constantU32(3)});
                const Id at = b_.value(spv::OpIAdd, u32, {base, constantU32(k)});
                // As integers: a float that is loaded and stored may lose what tells one NaN from another.
                const Id uvec4 = typeId(ioType(2));
                Id value = load(uvec4, b_.value(spv::OpAccessChain, pointerType(spv::StorageClassStorageBuffer, uvec4),
                                                {source_, zero, at}));
                if (k != 2) value = b_.value(spv::OpBitcast, typeId(ioType(k)), {value});
                store(inputs_[k], value);
            }
            local_ = interface({Base::u32, 1, 1}, spv::StorageClassInput, spv::DecorationBuiltIn,
                               spv::BuiltInLocalInvocationIndex);
        } else {
            const Id number = interface({Base::u32, 1, 1}, spv::StorageClassInput, spv::DecorationLocation, 3);
            store(invocation_, load(u32, number));
            for (uint32_t k = 0; k < 3; ++k) {
                const Id in = interface(ioType(k), spv::StorageClassInput, spv::DecorationLocation, k);
                store(inputs_[k], load(typeId(ioType(k)), in));
            }
        }
        for (size_t v = 0; v < program_.variables.size(); ++v)
            if (program_.variables[v].isPrivate) store(pointers_[v], constant(program_.variables[v].type, 0));
        b_.value(spv::OpFunctionCall, voidType(), {functions_[0]});
        for (uint32_t k = 0; k < 3; ++k) {
            Id value = load(typeId(ioType(k)), pointers_[k]);
            if (program_.stage != ir::Stage::compute) {
                store(interface(ioType(k), spv::StorageClassOutput, spv::DecorationLocation, k), value);
                continue;
            }
            const Id vec4 = typeId({Base::f32, 4, 1});
            if (k != 0) value = b_.value(spv::OpBitcast, vec4, {value});
            store(vectorPointer(constantU32(kVectors + k)), value);
        }
        if (program_.stage == ir::Stage::vertex)
            store(interface({Base::f32, 4, 1}, spv::StorageClassOutput, spv::DecorationBuiltIn, spv::BuiltInPosition),
                  constant({Base::f32, 4, 1}, 0));
        end(spv::OpReturn);
        b_.add(ModuleBuilder::functions, spv::OpFunctionEnd, {});
        constexpr spv::ExecutionModel kModels[] = {spv::ExecutionModelVertex, spv::ExecutionModelFragment,
                                                   spv::ExecutionModelGLCompute};
        std::vector<uint32_t> words{static_cast<uint32_t>(kModels[static_cast<size_t>(program_.stage)]), entry};
        const auto name = ModuleBuilder::text("main");
        words.insert(words.end(), name.begin(), name.end());
        words.insert(words.end(), interface_.begin(), interface_.end());
        b_.add(ModuleBuilder::entryPoints, spv::OpEntryPoint, words);
        if (program_.stage == ir::Stage::fragment)
            b_.add(ModuleBuilder::modes, spv::OpExecutionMode, {entry, spv::ExecutionModeOriginUpperLeft});
        if (program_.stage == ir::Stage::compute)
            b_.add(ModuleBuilder::modes, spv::OpExecutionMode, {entry, spv::ExecutionModeLocalSize, kGroupSize, 1, 1});
    }

    void function(size_t index) {
        const RandomFunction& f = program_.functions[index];
        std::vector<Id> types, arguments;
        for (const uint32_t p : f.parameters) types.push_back(typeId(program_.variables[p].type));
        if (f.pointer != ~0u)
            types.push_back(pointerType(spv::StorageClassFunction, typeId(program_.variables[f.pointer].type)));
        result_ = index == 0 ? std::nullopt : std::optional(f.result);
        beginFunction(functions_[index], index == 0 ? voidType() : typeId(f.result), types);
        for (const Id type : types) arguments.push_back(b_.value(spv::OpFunctionParameter, type, {}));
        label(b_.newId());
        for (const uint32_t v : f.locals) {
            const Id type = pointerType(spv::StorageClassFunction, variableType(program_.variables[v]));
            pointers_[v] = b_.value(spv::OpVariable, type, {spv::StorageClassFunction});
        }
        counters_.clear();
        countLoops(f.body);
        for (const uint32_t v : f.locals) {
            const Variable& variable = program_.variables[v];
            for (uint32_t k = 0; k < std::max(variable.length, 1u); ++k) {
                Id pointer = pointers_[v];
                if (variable.length != 0)
                    pointer =
                        b_.value(spv::OpAccessChain, pointerType(spv::StorageClassFunction, typeId(variable.type)),
                                 {pointer, constantU32(k)});
                store(pointer, constant(variable.type, 0));
            }
        }
        for (size_t k = 0; k < f.parameters.size(); ++k) store(pointers_[f.parameters[k]], arguments[k]);
        if (f.pointer != ~0u) pointers_[f.pointer] = arguments.back();
        statements(f.body);
        if (index == 0) {
            end(spv::OpReturn);
        } else if (!ended_) {
            end(spv::OpReturnValue, {constant(f.result, 0)});
        }
        b_.add(ModuleBuilder::functions, spv::OpFunctionEnd, {});
    }

    /// A counter for every loop: variables stand at the start of a function.
    void countLoops(const Statements& list) {
        for (const auto& s : list) {
            if (s->kind == Statement::Kind::loop) {
                const Id type = pointerType(spv::StorageClassFunction, scalarType(Base::u32));
                counters_[s.get()] = b_.value(spv::OpVariable, type, {spv::StorageClassFunction});
            }
            for (const Statements& body : s->bodies) countLoops(body);
        }
    }

    // --- statements

    void statements(const Statements& list) {
        for (const auto& s : list) {
            if (ended_) return;  // what follows a jump is never reached
            statement(*s);
        }
    }
    Id condition(Id value, Id yes, Id no) {
        end(spv::OpBranchConditional, {value, yes, no});
        return value;
    }
    void statement(const Statement& s) {
        switch (s.kind) {
            case Statement::Kind::assign: {
                const Id value = expression(*s.args[0]);
                const Variable& v = program_.variables[s.index];
                const spv::StorageClass storage = v.isPrivate ? spv::StorageClassPrivate : spv::StorageClassFunction;
                std::vector<uint32_t> chain{pointers_[s.index]};
                if (v.length != 0) chain.push_back(expression(*s.args[1]));
                ValueType type = v.type;
                if (s.literal != ~0ull) {
                    chain.push_back(constantU32(static_cast<uint32_t>(s.literal)));
                    type = type.scalar();
                }
                store(chain.size() == 1 ? chain[0]
                                        : b_.value(spv::OpAccessChain, pointerType(storage, typeId(type)), chain),
                      value);
                return;
            }
            case Statement::Kind::bufferWord: {
                const Id value = expression(*s.args[0]);
                store(wordPointer(expression(*s.args[1])), value);
                return;
            }
            case Statement::Kind::bufferVector: {
                const Id value = expression(*s.args[0]);
                store(vectorPointer(expression(*s.args[1])), value);
                return;
            }
            case Statement::Kind::branch: {
                const Id value = expression(*s.args[0]), yes = b_.newId(), merge = b_.newId();
                const Id no = s.bodies[1].empty() ? merge : b_.newId();
                b_.add(ModuleBuilder::functions, spv::OpSelectionMerge, {merge, 0});
                condition(value, yes, no);
                label(yes);
                statements(s.bodies[0]);
                jump(merge);
                if (no != merge) {
                    label(no);
                    statements(s.bodies[1]);
                    jump(merge);
                }
                label(merge);
                return;
            }
            case Statement::Kind::choice:
                choice(s);
                return;
            case Statement::Kind::loop:
                loop(s);
                return;
            case Statement::Kind::leave:
                jump(breaks_.back());
                return;
            case Statement::Kind::next:
                jump(continues_.back());
                return;
            case Statement::Kind::giveBack:
                if (result_) {
                    const Id value = expression(*s.args[0]);
                    end(spv::OpReturnValue, {value});
                } else {
                    end(spv::OpReturn);
                }
                return;
            case Statement::Kind::discard:
                end(spv::OpKill);
                return;
            case Statement::Kind::shared: {
                const Id u32 = scalarType(Base::u32), type = pointerType(spv::StorageClassWorkgroup, u32);
                const Id value = expression(*s.args[0]), local = load(u32, local_);
                store(b_.value(spv::OpAccessChain, type, {shared_, local}), value);
                barrier();
                const Id other =
                    b_.value(spv::OpBitwiseAnd, u32,
                             {b_.value(spv::OpIAdd, u32, {local, constantU32(static_cast<uint32_t>(s.literal))}),
                              constantU32(kGroupSize - 1)});
                const Id got = load(u32, b_.value(spv::OpAccessChain, type, {shared_, other}));
                barrier();
                const Id component = b_.value(spv::OpAccessChain, pointerType(spv::StorageClassPrivate, u32),
                                              {pointers_[s.index], constantU32(1)});
                store(component, got);
                return;
            }
            case Statement::Kind::derivative: {
                const Id value = expression(*s.args[0]);
                store(pointers_[s.index],
                      b_.value(static_cast<spv::Op>(s.literal), typeId({Base::f32, 4, 1}), {value}));
                return;
            }
        }
    }
    void barrier() {
        b_.add(ModuleBuilder::functions, spv::OpControlBarrier,
               {constantU32(spv::ScopeWorkgroup), constantU32(spv::ScopeWorkgroup),
                constantU32(spv::MemorySemanticsAcquireReleaseMask | spv::MemorySemanticsWorkgroupMemoryMask)});
    }
    void choice(const Statement& s) {
        const Id selector = expression(*s.args[0]), merge = b_.newId();
        std::vector<Id> labels;
        for (size_t k = 0; k < s.bodies.size(); ++k) labels.push_back(b_.newId());
        if (labels.empty()) labels.push_back(merge);
        b_.add(ModuleBuilder::functions, spv::OpSelectionMerge, {merge, 0});
        std::vector<uint32_t> words{selector, labels.back()};
        for (uint32_t k = 0; k + 1 < s.bodies.size(); ++k) {
            words.push_back(k);
            words.push_back(labels[k]);
        }
        b_.add(ModuleBuilder::functions, spv::OpSwitch, words);
        ended_ = true;
        breaks_.push_back(merge);
        for (size_t k = 0; k < s.bodies.size(); ++k) {
            label(labels[k]);
            statements(s.bodies[k]);
            const bool through = k + 1 < s.bodies.size() && (s.literal >> k & 1) != 0;
            jump(through ? labels[k + 1] : merge);
        }
        breaks_.pop_back();
        label(merge);
    }
    void loop(const Statement& s) {
        const Id u32 = scalarType(Base::u32), boolean = scalarType(Base::boolean), counter = counters_.at(&s);
        const Id header = b_.newId(), test = b_.newId(), body = b_.newId(), next = b_.newId(), merge = b_.newId();
        const bool testFirst = s.index == 0;
        store(counter, constantU32(0));
        jump(header);
        label(header);
        b_.add(ModuleBuilder::functions, spv::OpLoopMerge, {merge, next, 0});
        jump(testFirst ? test : body);
        const auto goOn = [&] {
            const Id more = b_.value(spv::OpULessThan, boolean,
                                     {load(u32, counter), constantU32(static_cast<uint32_t>(s.literal))});
            return b_.value(spv::OpLogicalAnd, boolean, {more, expression(*s.args[0])});
        };
        if (testFirst) {
            label(test);
            condition(goOn(), body, merge);
        }
        label(body);
        breaks_.push_back(merge);
        continues_.push_back(next);
        statements(s.bodies[0]);
        jump(next);
        breaks_.pop_back();
        continues_.pop_back();
        label(next);
        store(counter, b_.value(spv::OpIAdd, u32, {load(u32, counter), constantU32(1)}));
        if (testFirst) {
            jump(header);
        } else {
            // The counter is bumped first, so that the loop ends; no branches of the expression's own may stand here.
            const Id more = b_.value(spv::OpULessThan, boolean,
                                     {load(u32, counter), constantU32(static_cast<uint32_t>(s.literal))});
            condition(more, header, merge);
        }
        label(merge);
    }

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
    Id expression(const Expression& e) {
        using Kind = Expression::Kind;
        const Id type = typeId(e.type);
        switch (e.kind) {
            case Kind::constant:
                return constant(e.type, e.literal);
            case Kind::variable: {
                const Variable& v = program_.variables[e.index];
                if (v.length == 0) return load(type, pointers_[e.index]);
                const Id at = expression(*e.args[0]);
                return load(type, b_.value(spv::OpAccessChain, pointerType(spv::StorageClassFunction, type),
                                           {pointers_[e.index], at}));
            }
            case Kind::input:
                return load(type, inputs_[e.index]);
            case Kind::uniform: {
                std::vector<uint32_t> chain{uniforms_, constantU32(e.index)};
                for (const Id id : arguments(e)) chain.push_back(id);
                return load(type, b_.value(spv::OpAccessChain, pointerType(spv::StorageClassUniform, type), chain));
            }
            case Kind::bufferWord:
                return load(type, wordPointer(expression(*e.args[0])));
            case Kind::bufferVector:
                return load(type, vectorPointer(expression(*e.args[0])));
            case Kind::op:
                return b_.value(static_cast<spv::Op>(e.op), type, arguments(e));
            case Kind::extended:
                return extended(e.op, type, arguments(e));
            case Kind::structMember:
                return b_.value(
                    spv::OpCompositeExtract, type,
                    {b_.value(static_cast<spv::Op>(e.op), b_.type(spv::OpTypeStruct, {type, type}), arguments(e)),
                     e.index});
            case Kind::extendedMember: {
                const Id second = e.op == GLSLstd450FrexpStruct ? typeId(e.type.of(Base::i32)) : type;
                return b_.value(spv::OpCompositeExtract, type,
                                {extended(e.op, b_.type(spv::OpTypeStruct, {type, second}), arguments(e)), e.index});
            }
            case Kind::construct:
                return b_.value(spv::OpCompositeConstruct, type, arguments(e));
            case Kind::extract:
                return b_.value(spv::OpCompositeExtract, type, {expression(*e.args[0]), e.index});
            case Kind::shuffle: {
                std::vector<uint32_t> words = arguments(e);
                for (uint32_t k = 0; k < e.type.rows; ++k)
                    words.push_back(static_cast<uint32_t>(e.literal >> (8 * k) & 0xFF));
                return b_.value(spv::OpVectorShuffle, type, words);
            }
            case Kind::call: {
                std::vector<uint32_t> words = arguments(e);
                words.insert(words.begin(), functions_[e.index]);
                words.push_back(pointers_[e.literal]);
                return b_.value(spv::OpFunctionCall, type, words);
            }
            case Kind::both: {
                const Id first = expression(*e.args[0]), from = block_, more = b_.newId(), merge = b_.newId();
                b_.add(ModuleBuilder::functions, spv::OpSelectionMerge, {merge, 0});
                condition(first, e.literal != 0 ? merge : more, e.literal != 0 ? more : merge);
                label(more);
                const Id second = expression(*e.args[1]), to = block_;
                jump(merge);
                label(merge);
                return b_.value(spv::OpPhi, type, {first, from, second, to});
            }
            case Kind::choose: {
                const Id value = expression(*e.args[0]), yes = b_.newId(), no = b_.newId(), merge = b_.newId();
                b_.add(ModuleBuilder::functions, spv::OpSelectionMerge, {merge, 0});
                condition(value, yes, no);
                label(yes);
                const Id a = expression(*e.args[1]), fromYes = block_;
                jump(merge);
                label(no);
                const Id b = expression(*e.args[2]), fromNo = block_;
                jump(merge);
                label(merge);
                return b_.value(spv::OpPhi, type, {a, fromYes, b, fromNo});
            }
        }
        return 0;
    }

    const RandomProgram& program_;
    ModuleBuilder b_;
    Id glsl_ = 0, words_ = 0, vectors_ = 0, uniforms_ = 0, source_ = 0, shared_ = 0, local_ = 0, invocation_ = 0,
       block_ = 0;
    std::array<Id, 3> inputs_{};
    std::vector<Id> interface_, pointers_, functions_, breaks_, continues_;
    std::map<const Statement*, Id> counters_;
    std::optional<ValueType> result_;
    bool ended_ = false;
};

}  // namespace

Words emitProgram(const RandomProgram& program) {
    return Emitter(program).run();
}

Case caseOf(const RandomProgram& program, uint64_t seed) {
    Case subject;
    subject.name = "seed " + std::to_string(seed);
    subject.words = emitProgram(program);
    subject.stage = program.stage;
    World& world = subject.world;
    world.seed = seed;
    world.inputAt[0] = {seed % 3 == 0 ? Filling::Kind::special : Filling::Kind::uniform, -4, 4};
    world.inputAt[1] = {seed % 3 == 1 ? Filling::Kind::special : Filling::Kind::integer, -20, 20};
    world.inputAt[2] = {seed % 3 == 2 ? Filling::Kind::special : Filling::Kind::integer, 0, 40};
    world.inputAt[3] = {Filling::Kind::index, 0, 1};
    world.bufferAt[{0, 0, 0}] = {kWords * 64 * 4, {Filling::Kind::integer, -8, 8}};
    world.bufferAt[{0, 1, 0}] = {(kVectors + 3) * 64 * 16, {Filling::Kind::uniform, -2, 2}};
    world.bufferAt[{0, 2, 0}] = {320, {Filling::Kind::uniform, -2, 2}};
    world.bufferAt[{0, 3, 0}] = {64 * 3 * 16, {Filling::Kind::special, 0, 0}};
    return subject;
}

// --- making a program smaller

namespace {

RandomProgram copyOf(const RandomProgram& program);

ExpressionPtr copyOf(const ExpressionPtr& e) {
    auto copy = std::make_shared<Expression>(*e);
    for (ExpressionPtr& arg : copy->args) arg = copyOf(arg);
    return copy;
}
Statements copyOf(const Statements& list) {
    Statements copies;
    for (const auto& s : list) {
        auto copy = std::make_shared<Statement>(*s);
        for (ExpressionPtr& arg : copy->args) arg = copyOf(arg);
        for (Statements& body : copy->bodies) body = copyOf(body);
        copies.push_back(copy);
    }
    return copies;
}
RandomProgram copyOf(const RandomProgram& program) {
    RandomProgram copy = program;
    for (RandomFunction& f : copy.functions) f.body = copyOf(f.body);
    return copy;
}

/// Visits every list of statements and every expression; stops where `place` runs out.
struct Editor {
    size_t place;
    bool done = false;

    void lists(Statements& list) {
        for (size_t k = 0; k < list.size() && !done; ++k) {
            if (place-- == 0) {
                list.erase(list.begin() + static_cast<ptrdiff_t>(k));
                done = true;
                return;
            }
            for (Statements& body : list[k]->bodies) lists(body);
        }
    }
    void expressions(Statements& list) {
        for (auto& s : list) {
            for (ExpressionPtr& arg : s->args) expression(arg);
            for (Statements& body : s->bodies) expressions(body);
        }
    }
    void expression(ExpressionPtr& e) {
        if (done) return;
        // A child of the same type stands in for the whole, or else a constant.
        for (const ExpressionPtr& arg : e->args) {
            if (!(arg->type == e->type)) continue;
            if (place-- == 0) {
                e = arg;
                done = true;
                return;
            }
        }
        if (e->kind != Expression::Kind::constant && place-- == 0) {
            auto constant = std::make_shared<Expression>();
            constant->type = e->type;
            constant->literal = e->type.base == Base::f32 ? 0x3F800000u : 1;
            e = constant;
            done = true;
            return;
        }
        for (ExpressionPtr& arg : e->args) expression(arg);
    }
};

}  // namespace

RandomProgram shrink(RandomProgram program, const std::function<bool(const RandomProgram&)>& fails, size_t attempts) {
    for (const bool ofStatements : {true, false, true}) {
        for (size_t place = 0; attempts > 0;) {
            RandomProgram smaller = copyOf(program);
            Editor editor{place};
            for (RandomFunction& f : smaller.functions) {
                if (editor.done) break;
                if (ofStatements) {
                    editor.lists(f.body);
                } else {
                    editor.expressions(f.body);
                }
            }
            if (!editor.done) break;
            --attempts;
            if (fails(smaller)) {
                program = std::move(smaller);
            } else {
                ++place;
            }
        }
    }
    return program;
}

}  // namespace vernier::proof
