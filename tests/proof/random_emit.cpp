// Programs to modules: types, constants, resources, functions.
#include <algorithm>

#include "tests/proof/random_emitter.h"

namespace vernier::proof {

namespace {

constexpr uint32_t kVersion = 0x00010300;

}  // namespace

Words Emitter::run() {
    b_.capability(spv::CapabilityShader);
    b_.add(ModuleBuilder::extensions, spv::OpExtension, ModuleBuilder::text("SPV_KHR_storage_buffer_storage_class"));
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

Id Emitter::scalarType(Base base) {
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
        case Base::i8:
        case Base::u8:
            b_.capability(spv::CapabilityInt8);
            return b_.type(spv::OpTypeInt, {8, base == Base::i8 ? 1u : 0u});
        case Base::i16:
        case Base::u16:
            b_.capability(spv::CapabilityInt16);
            return b_.type(spv::OpTypeInt, {16, base == Base::i16 ? 1u : 0u});
        case Base::f16:
            b_.capability(spv::CapabilityFloat16);
            return b_.type(spv::OpTypeFloat, {16});
    }
    return 0;
}

Id Emitter::constant(ValueType type, uint64_t bits) {
    if (type.rows > 1) {
        const ValueType part = type.isMatrix() ? ValueType{type.base, type.rows, 1} : type.scalar();
        const std::vector<Id> parts(type.isMatrix() ? type.columns : type.rows, constant(part, bits));
        return b_.compositeConstant(typeId(type), parts);
    }
    const Id id = scalarType(type.base);
    if (type.base == Base::boolean) return b_.boolConstant(id, bits != 0);
    if (type.base == Base::i64 || type.base == Base::f64)
        return b_.constant(id, {static_cast<uint32_t>(bits), static_cast<uint32_t>(bits >> 32)});
    // Narrow integers fill their word by their sign; halves by zeros.
    switch (type.base) {
        case Base::i8:
            return b_.constant(id, {static_cast<uint32_t>(static_cast<int8_t>(bits))});
        case Base::i16:
            return b_.constant(id, {static_cast<uint32_t>(static_cast<int16_t>(bits))});
        case Base::u8:
            return b_.constant(id, {static_cast<uint8_t>(bits)});
        case Base::u16:
        case Base::f16:
            return b_.constant(id, {static_cast<uint16_t>(bits)});
        default:
            return b_.constant(id, {static_cast<uint32_t>(bits)});
    }
}

Id Emitter::bufferOf(Id member, uint32_t stride, uint32_t binding, bool readOnly) {
    const Id array = b_.newId(), block = b_.newId();
    b_.add(ModuleBuilder::globals, spv::OpTypeRuntimeArray, {array, member});
    b_.decorate(array, spv::DecorationArrayStride, {stride});
    b_.add(ModuleBuilder::globals, spv::OpTypeStruct, {block, array});
    b_.decorate(block, spv::DecorationBlock);
    b_.memberDecorate(block, 0, spv::DecorationOffset, {0});
    if (readOnly) b_.memberDecorate(block, 0, spv::DecorationNonWritable, {});
    return bound(global(block, spv::StorageClassStorageBuffer), binding);
}

void Emitter::resources() {
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
    for (uint32_t k = 0; k < 2; ++k) {
        const Id image =
            b_.type(spv::OpTypeImage, {scalarType(k == 0 ? Base::f32 : Base::i32), spv::Dim2D, 0, 0, 0, 1, 0});
        images_[k] = bound(global(b_.type(spv::OpTypeSampledImage, {image}), spv::StorageClassUniformConstant), 4 + k);
    }
    invocation_ = global(scalarType(Base::u32), spv::StorageClassPrivate);
    for (uint32_t k = 0; k < 3; ++k) inputs_[k] = global(typeId(ioType(k)), spv::StorageClassPrivate);
    if (program_.stage == ir::Stage::compute) {
        shared_ = global(b_.type(spv::OpTypeArray, {scalarType(Base::u32), constantU32(kGroupSize)}),
                         spv::StorageClassWorkgroup);
    }
}

Id Emitter::interface(ValueType type, spv::StorageClass storage, spv::Decoration decoration, uint32_t value) {
    const Id id = global(typeId(type), storage);
    b_.decorate(id, decoration, {value});
    if (decoration == spv::DecorationLocation && storage == spv::StorageClassInput && type.base != Base::f32 &&
        program_.stage == ir::Stage::fragment)
        b_.decorate(id, spv::DecorationFlat);
    interface_.push_back(id);
    return id;
}

Id Emitter::beginFunction(Id id, Id result, const std::vector<Id>& parameters) {
    std::vector<uint32_t> words{result};
    words.insert(words.end(), parameters.begin(), parameters.end());
    const Id type = b_.type(spv::OpTypeFunction, words);
    b_.add(ModuleBuilder::functions, spv::OpFunction, {result, id, 0, type});
    return type;
}

void Emitter::main() {
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

void Emitter::function(size_t index) {
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
                pointer = b_.value(spv::OpAccessChain, pointerType(spv::StorageClassFunction, typeId(variable.type)),
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

void Emitter::countLoops(const Statements& list) {
    for (const auto& s : list) {
        if (s->kind == Statement::Kind::loop) {
            const Id type = pointerType(spv::StorageClassFunction, scalarType(Base::u32));
            counters_[s.get()] = b_.value(spv::OpVariable, type, {spv::StorageClassFunction});
        }
        for (const Statements& body : s->bodies) countLoops(body);
    }
}

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
    world.integerImages[{0, 5, 0}] = true;
    return subject;
}

}  // namespace vernier::proof
