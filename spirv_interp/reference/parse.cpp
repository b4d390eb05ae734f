// Words to instructions: the module's sections and the bodies of functions. What an instruction means is left
// to the files of types and constants, and to the machine.
#include <algorithm>

#define SPV_ENABLE_UTILITY_CODE
#include <spirv/unified1/spirv.hpp>

#include "spirv_interp/reference/module_data.h"

namespace vernier::reference {
namespace {

constexpr size_t kHeaderWords = 5;
constexpr uint32_t kMaxBound = 0x400000;  // SPIR-V specification, "Universal Limits"

/// Splits the word stream and calls visit(Instruction) for each instruction.
template <class Visit>
void forEachInstruction(std::span<const uint32_t> words, const Visit& visit) {
    for (size_t at = kHeaderWords; at < words.size();) {
        const uint32_t length = words[at] >> 16;
        const auto op = static_cast<spv::Op>(words[at] & 0xFFFF);
        if (length == 0) fail("word " + std::to_string(at) + ": instruction of length 0");
        if (length > words.size() - at)
            fail("word " + std::to_string(at) + ": " + name(op) + " of " + std::to_string(length) +
                 " words is cut off by the end of the module");
        Instruction instruction;
        instruction.op = op;
        bool hasResult = false, hasType = false;
        spv::HasResultAndType(op, &hasResult, &hasType);
        const size_t leading = 1 + (hasResult ? 1 : 0) + (hasType ? 1 : 0);
        if (length < leading) fail("word " + std::to_string(at) + ": " + name(op) + " has too few words");
        if (hasType) instruction.type = words[at + 1];
        if (hasResult) instruction.result = words[at + leading - 1];
        instruction.operands = words.subspan(at + leading, length - leading);
        if (hasResult && instruction.result == 0) fail(name(op) + " has result id 0");
        visit(instruction);
        at += length;
    }
}

bool isTerminator(spv::Op op) {
    switch (op) {
        case spv::OpBranch:
        case spv::OpBranchConditional:
        case spv::OpSwitch:
        case spv::OpReturn:
        case spv::OpReturnValue:
        case spv::OpKill:
        case spv::OpTerminateInvocation:
        case spv::OpUnreachable:
            return true;
        default:
            return false;
    }
}

class Parser {
  public:
    explicit Parser(ModuleData& module) : module_(module) {}

    void run() {
        checkHeader();
        uint32_t maxId = 0;
        forEachInstruction(module_.words,
                           [&](const Instruction& instruction) { maxId = std::max(maxId, instruction.result); });
        if (maxId >= module_.words[3])
            fail("result " + name(maxId) + " is not below the bound " + std::to_string(module_.words[3]));
        module_.ids.resize(size_t{maxId} + 1);
        forEachInstruction(module_.words, [this](const Instruction& instruction) { visit(instruction); });
        if (function_) fail("the module ends inside function " + name(function_->id));
        for (const size_t k : localSizeIds_)
            for (uint32_t& size : module_.entryPoints[k].modes.localSize)
                size = static_cast<uint32_t>(module_.constantInteger(size));
        for (const EntryPointData& entry : module_.entryPointData)
            if (module_.info(entry.function).kind != IdKind::function)
                fail("entry point " + name(entry.function) + " is no function");
    }

  private:
    void checkHeader() const {
        const auto& words = module_.words;
        if (words.size() < kHeaderWords) fail("a SPIR-V module has at least 5 words");
        if (words[0] != spv::MagicNumber) fail("not a SPIR-V module in this machine's byte order: wrong magic number");
        if ((words[1] >> 16) != 1 || ((words[1] >> 8) & 0xFF) > 6)
            failUnsupported("SPIR-V version " + std::to_string((words[1] >> 16) & 0xFF) + "." +
                            std::to_string((words[1] >> 8) & 0xFF));
        if (words[3] == 0 || words[3] > kMaxBound) fail("id bound " + std::to_string(words[3]));
    }

    void define(Id id, const IdInfo& info) {
        IdInfo& slot = module_.ids[id];
        if (slot.kind != IdKind::none) fail(name(id) + " is defined twice");
        slot = info;
    }

    void visit(const Instruction& i) {
        switch (i.op) {
            case spv::OpNop:
                return;
            case spv::OpLine:
                line_ = i.operand(1);
                return;
            case spv::OpNoLine:
                line_ = 0;
                return;
            case spv::OpFunction:
                return beginFunction(i);
            default:
                break;
        }
        if (function_)
            visitInFunction(i);
        else
            visitGlobal(i);
    }

    void visitGlobal(const Instruction& i) {
        switch (i.op) {
            case spv::OpCapability:
            case spv::OpExtension:
            case spv::OpSource:
            case spv::OpSourceExtension:
            case spv::OpSourceContinued:
            case spv::OpString:
            case spv::OpModuleProcessed:
            case spv::OpDecorateId:
            case spv::OpDecorateString:
            case spv::OpMemberDecorateString:
                return;
            case spv::OpExtInst:
                if (module_.info(i.operand(0)).kind != IdKind::ignoredSet) fail("OpExtInst outside a function");
                return;
            case spv::OpExtInstImport:
                return importSet(i);
            case spv::OpMemoryModel:
                if (i.operand(0) != spv::AddressingModelLogical &&
                    i.operand(0) != spv::AddressingModelPhysicalStorageBuffer64)
                    failUnsupported("addressing model " + std::to_string(i.operand(0)));
                return;
            case spv::OpEntryPoint:
                return entryPoint(i);
            case spv::OpExecutionMode:
            case spv::OpExecutionModeId:
                return executionMode(i);
            case spv::OpName:
                module_.names[i.operand(0)] = literalString(i.operands, 1).first;
                return;
            case spv::OpMemberName:
                module_.memberNames[{i.operand(0), i.operand(1)}] = literalString(i.operands, 2).first;
                return;
            case spv::OpDecorate:
                return decorate(module_.decorations[i.operand(0)], i, 1);
            case spv::OpMemberDecorate:
                return decorate(module_.memberDecorations[{i.operand(0), i.operand(1)}], i, 2);
            case spv::OpVariable:
                return globalVariable(i);
            case spv::OpUndef:
            case spv::OpConstantTrue:
            case spv::OpConstantFalse:
            case spv::OpConstant:
            case spv::OpConstantComposite:
            case spv::OpConstantNull:
            case spv::OpSpecConstantTrue:
            case spv::OpSpecConstantFalse:
            case spv::OpSpecConstant:
            case spv::OpSpecConstantComposite:
            case spv::OpSpecConstantOp:
                define(i.result, {IdKind::constant, static_cast<uint32_t>(module_.constants.size()),
                                  module_.typeIndex(i.type), 0});
                return parseConstant(module_, i);
            case spv::OpTypeVoid:
            case spv::OpTypeBool:
            case spv::OpTypeInt:
            case spv::OpTypeFloat:
            case spv::OpTypeVector:
            case spv::OpTypeMatrix:
            case spv::OpTypeImage:
            case spv::OpTypeSampler:
            case spv::OpTypeSampledImage:
            case spv::OpTypeArray:
            case spv::OpTypeRuntimeArray:
            case spv::OpTypeStruct:
            case spv::OpTypePointer:
            case spv::OpTypeFunction: {
                const bool forward = module_.ids[i.result].kind != IdKind::none;
                parseType(module_, i);
                if (forward) return;
                return define(i.result, {IdKind::type, static_cast<uint32_t>(module_.types.size() - 1), 0, 0});
            }
            case spv::OpTypeForwardPointer:
                if (i.operand(0) >= module_.ids.size()) fail(name(i.operand(0)) + " is used but not defined");
                parseType(module_, i);
                return define(i.operand(0), {IdKind::type, static_cast<uint32_t>(module_.types.size() - 1), 0, 0});
            case spv::OpDecorationGroup:
                return;  // its decorations are kept like anything's
            case spv::OpGroupDecorate:
                for (const Id target : i.operands.subspan(1)) copyGroup(i.operand(0), module_.decorations[target]);
                return;
            case spv::OpGroupMemberDecorate:
                for (size_t k = 1; k + 1 < i.operands.size(); k += 2)
                    copyGroup(i.operand(0), module_.memberDecorations[{i.operands[k], i.operands[k + 1]}]);
                return;
            default:
                failUnsupported(name(i.op) + " outside a function");
        }
    }

    void importSet(const Instruction& i) {
        const std::string set = literalString(i.operands, 0).first;
        if (set == "GLSL.std.450") return define(i.result, {IdKind::glslSet, 0, 0, 0});
        if (set.starts_with("NonSemantic.")) return define(i.result, {IdKind::ignoredSet, 0, 0, 0});
        failUnsupported("extended instruction set \"" + set + "\"");
    }

    void entryPoint(const Instruction& i) {
        EntryPoint entry;
        entry.model = enumerant<spv::ExecutionModel>(i.operand(0));
        EntryPointData data;
        data.function = i.operand(1);
        auto [text, next] = literalString(i.operands, 2);
        entry.name = std::move(text);
        data.interface.assign(i.operands.begin() + static_cast<ptrdiff_t>(next), i.operands.end());
        module_.entryPoints.push_back(std::move(entry));
        module_.entryPointData.push_back(std::move(data));
    }

    void executionMode(const Instruction& i) {
        const Id function = i.operand(0);
        const auto mode = enumerant<spv::ExecutionMode>(i.operand(1));
        for (size_t k = 0; k < module_.entryPoints.size(); ++k) {
            if (module_.entryPointData[k].function != function) continue;
            ExecutionModes& modes = module_.entryPoints[k].modes;
            switch (mode) {
                case spv::ExecutionModeOriginUpperLeft:
                    modes.originUpperLeft = true;
                    break;
                case spv::ExecutionModeOriginLowerLeft:
                    modes.originLowerLeft = true;
                    break;
                case spv::ExecutionModePixelCenterInteger:
                    modes.pixelCenterInteger = true;
                    break;
                case spv::ExecutionModeEarlyFragmentTests:
                    modes.earlyFragmentTests = true;
                    break;
                case spv::ExecutionModeDepthReplacing:
                    modes.depthReplacing = true;
                    break;
                case spv::ExecutionModeDepthGreater:
                    modes.depthGreater = true;
                    break;
                case spv::ExecutionModeDepthLess:
                    modes.depthLess = true;
                    break;
                case spv::ExecutionModeDepthUnchanged:
                    modes.depthUnchanged = true;
                    break;
                case spv::ExecutionModeOutputVertices:
                    modes.outputVertices = i.operand(2);
                    break;
                case spv::ExecutionModeOutputLineStrip:
                    modes.primitiveVertices = 2;
                    break;
                case spv::ExecutionModeOutputTriangleStrip:
                    modes.primitiveVertices = 3;
                    break;
                case spv::ExecutionModeInvocations:
                    modes.invocations = i.operand(2);
                    break;
                case spv::ExecutionModeLocalSize:
                case spv::ExecutionModeLocalSizeId:
                    for (size_t d = 0; d < 3; ++d) modes.localSize[d] = i.operand(2 + d);
                    // The constants of LocalSizeId come later in the module.
                    if (mode == spv::ExecutionModeLocalSizeId) localSizeIds_.push_back(k);
                    break;
                default:
                    break;  // the other modes concern other stages or leave results open
            }
        }
    }

    /// The decorations of a group on top of those that are there.
    void copyGroup(Id group, Decorations& d) const {
        const Decorations& from = module_.decorationsOf(group);
        const auto take = [](auto& to, const auto& value) {
            if (value) to = value;
        };
        take(d.location, from.location);
        take(d.component, from.component);
        take(d.index, from.index);
        take(d.builtin, from.builtin);
        take(d.specId, from.specId);
        take(d.arrayStride, from.arrayStride);
        take(d.matrixStride, from.matrixStride);
        take(d.offset, from.offset);
        take(d.binding, from.binding);
        take(d.set, from.set);
        take(d.inputAttachmentIndex, from.inputAttachmentIndex);
        take(d.flat, from.flat);
        take(d.noPerspective, from.noPerspective);
        take(d.centroid, from.centroid);
        take(d.perVertex, from.perVertex);
        take(d.patch, from.patch);
        take(d.sample, from.sample);
        take(d.block, from.block);
        take(d.bufferBlock, from.bufferBlock);
        take(d.rowMajor, from.rowMajor);
        take(d.isVolatile, from.isVolatile);
        take(d.towardsZero, from.towardsZero);
    }

    static void decorate(Decorations& d, const Instruction& i, size_t first) {
        switch (enumerant<spv::Decoration>(i.operand(first))) {
            case spv::DecorationLocation:
                d.location = i.operand(first + 1);
                break;
            case spv::DecorationComponent:
                d.component = i.operand(first + 1);
                break;
            case spv::DecorationIndex:
                d.index = i.operand(first + 1);
                break;
            case spv::DecorationBuiltIn:
                d.builtin = i.operand(first + 1);
                break;
            case spv::DecorationSpecId:
                d.specId = i.operand(first + 1);
                break;
            case spv::DecorationArrayStride:
                d.arrayStride = i.operand(first + 1);
                break;
            case spv::DecorationMatrixStride:
                d.matrixStride = i.operand(first + 1);
                break;
            case spv::DecorationOffset:
                d.offset = i.operand(first + 1);
                break;
            case spv::DecorationBinding:
                d.binding = i.operand(first + 1);
                break;
            case spv::DecorationDescriptorSet:
                d.set = i.operand(first + 1);
                break;
            case spv::DecorationInputAttachmentIndex:
                d.inputAttachmentIndex = i.operand(first + 1);
                break;
            case spv::DecorationFlat:
                d.flat = true;
                break;
            case spv::DecorationNoPerspective:
                d.noPerspective = true;
                break;
            case spv::DecorationCentroid:
                d.centroid = true;
                break;
            case spv::DecorationSample:
                d.sample = true;
                break;
            case spv::DecorationPerVertexKHR:
                d.perVertex = true;
                break;
            case spv::DecorationPatch:
                d.patch = true;
                break;
            case spv::DecorationBlock:
                d.block = true;
                break;
            case spv::DecorationBufferBlock:
                d.bufferBlock = true;
                break;
            case spv::DecorationRowMajor:
                d.rowMajor = true;
                break;
            case spv::DecorationColMajor:
                d.rowMajor = false;
                break;
            case spv::DecorationVolatile:
                d.isVolatile = true;
                break;
            case spv::DecorationFPRoundingMode:
                d.towardsZero = i.operand(first + 1) == spv::FPRoundingModeRTZ;
                break;
            default:
                break;  // precision, aliasing, invariance: no difference to an interpreter that never
                        // contracts
        }
    }

    void globalVariable(const Instruction& i) {
        Variable variable;
        variable.id = i.result;
        variable.pointerType = module_.typeIndex(i.type);
        variable.storage = enumerant<spv::StorageClass>(i.operand(0));
        if (i.operands.size() > 1) variable.initializer = i.operands[1];
        if (module_.types[variable.pointerType].kind != TypeKind::pointer)
            fail("the type of variable " + name(i.result) + " is no pointer");
        switch (variable.storage) {
            case spv::StorageClassUniformConstant:
            case spv::StorageClassInput:
            case spv::StorageClassUniform:
            case spv::StorageClassOutput:
            case spv::StorageClassPrivate:
            case spv::StorageClassWorkgroup:
            case spv::StorageClassPushConstant:
            case spv::StorageClassStorageBuffer:
                break;
            default:
                failUnsupported("variable " + name(i.result) + " of storage class " +
                                std::to_string(static_cast<uint32_t>(variable.storage)));
        }
        if (variable.initializer != 0) module_.constant(variable.initializer);
        define(i.result, {IdKind::variable, static_cast<uint32_t>(module_.variables.size()), variable.pointerType, 0});
        module_.variables.push_back(variable);
    }

    void beginFunction(const Instruction& i) {
        if (function_) fail("function " + name(i.result) + " inside another");
        const Type& type = module_.typeOf(i.operand(1));
        if (type.kind != TypeKind::function) fail("the type of function " + name(i.result) + " is no function type");
        const auto index = static_cast<uint32_t>(module_.functions.size());
        define(i.result, {IdKind::function, index, 0, 0});
        module_.functions.emplace_back();
        function_ = &module_.functions.back();
        function_->id = i.result;
        function_->returnType = type.element;
        functionType_ = module_.typeIndex(i.operand(1));
        inBlock_ = false;
    }

    void defineLocal(Id id, uint32_t type) {
        define(id, {IdKind::local, function_->slots++, type, static_cast<uint32_t>(module_.functions.size() - 1)});
    }

    void visitInFunction(const Instruction& i) {
        switch (i.op) {
            case spv::OpFunctionEnd:
                if (inBlock_) fail("function " + name(function_->id) + " ends in a block without terminator");
                if (function_->parameters.size() != module_.types[functionType_].members.size())
                    fail("function " + name(function_->id) + " has not the parameters of its type");
                orderBlocks(*function_);
                function_ = nullptr;
                return;
            case spv::OpFunctionParameter:
                if (!function_->blocks.empty()) fail("OpFunctionParameter after the first block");
                defineLocal(i.result, module_.typeIndex(i.type));
                function_->parameters.emplace_back(i.result, module_.typeIndex(i.type));
                return;
            case spv::OpLabel: {
                if (inBlock_) fail("block " + name(function_->blocks.back().label) + " has no terminator");
                const auto index = static_cast<uint32_t>(function_->blocks.size());
                if (!function_->blockOf.emplace(i.result, index).second) fail(name(i.result) + " is defined twice");
                function_->blocks.push_back({i.result, function_->instructions.size(), 0});
                inBlock_ = true;
                return;
            }
            // Structure says where invocations that have parted come together again.
            case spv::OpSelectionMerge:
            case spv::OpLoopMerge:
                if (!inBlock_) fail(name(i.op) + " outside a block");
                function_->blocks.back().merge = i.operand(0);
                if (i.op == spv::OpLoopMerge) function_->blocks.back().continueTarget = i.operand(1);
                return;
            default:
                break;
        }
        if (!inBlock_) fail(name(i.op) + " outside a block");
        if (i.op == spv::OpExtInst && module_.info(i.operand(0)).kind == IdKind::ignoredSet) return;
        if (i.result != 0) defineLocal(i.result, module_.typeIndex(i.type));
        function_->instructions.push_back(i);
        function_->instructions.back().line = line_;
        if (!isTerminator(i.op)) return;
        function_->blocks.back().end = function_->instructions.size();
        inBlock_ = false;
    }

    ModuleData& module_;
    Function* function_ = nullptr;  // the one being parsed
    uint32_t functionType_ = 0;
    bool inBlock_ = false;
    uint32_t line_ = 0;                 // of the source
    std::vector<size_t> localSizeIds_;  // entry points
};

}  // namespace

std::pair<std::string, size_t> literalString(std::span<const uint32_t> words, size_t first) {
    std::string text;
    for (size_t at = first; at < words.size(); ++at)
        for (uint32_t byte = 0; byte < 4; ++byte) {
            const auto character = static_cast<char>((words[at] >> (8 * byte)) & 0xFF);
            if (character == 0) return {std::move(text), at + 1};
            text += character;
        }
    fail("a string without end");
}

void parseModule(ModuleData& module) {
    Parser(module).run();
}

}  // namespace vernier::reference
