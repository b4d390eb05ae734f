#include "spirv_interp/front/lowering.h"

#include <algorithm>

#include <spirv-tools/libspirv.h>

#include "spirv_interp/front/spelling.h"
#include "spirv_interp/ir/names.h"

namespace vernier {
namespace {

using spv::Capability;

constexpr Capability kCapabilities[] = {
    Capability::Matrix,
    Capability::Shader,
    Capability::Float64,
    Capability::Int64,
    Capability::Int8,
    Capability::Int16,
    Capability::Float16,
    Capability::StorageBuffer16BitAccess,
    Capability::UniformAndStorageBuffer16BitAccess,
    Capability::StoragePushConstant16,
    Capability::StorageInputOutput16,
    Capability::StorageBuffer8BitAccess,
    Capability::UniformAndStorageBuffer8BitAccess,
    Capability::StoragePushConstant8,
    Capability::Geometry,  // also declared by fragment shaders that read PrimitiveId or Layer
    Capability::GeometryPointSize,
    Capability::GeometryStreams,
    Capability::Tessellation,
    Capability::TessellationPointSize,
    Capability::ImageGatherExtended,
    Capability::StorageImageMultisample,
    Capability::UniformBufferArrayDynamicIndexing,
    Capability::SampledImageArrayDynamicIndexing,
    Capability::StorageBufferArrayDynamicIndexing,
    Capability::StorageImageArrayDynamicIndexing,
    Capability::ClipDistance,
    Capability::CullDistance,
    Capability::ImageCubeArray,
    Capability::SampleRateShading,
    Capability::InputAttachment,
    Capability::Sampled1D,
    Capability::Image1D,
    Capability::SampledCubeArray,
    Capability::SampledBuffer,
    Capability::ImageBuffer,
    Capability::ImageMSArray,
    Capability::StorageImageExtendedFormats,
    Capability::ImageQuery,
    Capability::DerivativeControl,
    Capability::InterpolationFunction,
    Capability::FragmentBarycentricKHR,
    Capability::StorageImageReadWithoutFormat,
    Capability::StorageImageWriteWithoutFormat,
    Capability::MultiViewport,
    Capability::ShaderLayer,
    Capability::ShaderViewportIndex,
    Capability::DrawParameters,
    Capability::DeviceGroup,
    Capability::MultiView,
    Capability::TransformFeedback,
    Capability::DenormPreserve,
    Capability::SignedZeroInfNanPreserve,
    Capability::RoundingModeRTE,
    Capability::StencilExportEXT,
    Capability::ShaderViewportIndexLayerEXT,
    Capability::ShaderNonUniform,
    Capability::RuntimeDescriptorArray,
    Capability::InputAttachmentArrayDynamicIndexing,
    Capability::UniformTexelBufferArrayDynamicIndexing,
    Capability::StorageTexelBufferArrayDynamicIndexing,
    Capability::UniformBufferArrayNonUniformIndexing,
    Capability::SampledImageArrayNonUniformIndexing,
    Capability::StorageBufferArrayNonUniformIndexing,
    Capability::StorageImageArrayNonUniformIndexing,
    Capability::InputAttachmentArrayNonUniformIndexing,
    Capability::UniformTexelBufferArrayNonUniformIndexing,
    Capability::StorageTexelBufferArrayNonUniformIndexing,
    Capability::VulkanMemoryModel,
    Capability::VulkanMemoryModelDeviceScope,
    Capability::DemoteToHelperInvocationEXT,
    Capability::WorkgroupMemoryExplicitLayoutKHR,
    Capability::GroupNonUniform,
    Capability::GroupNonUniformVote,
    Capability::GroupNonUniformArithmetic,
    Capability::GroupNonUniformBallot,
    Capability::GroupNonUniformShuffle,
    Capability::GroupNonUniformShuffleRelative,
    Capability::GroupNonUniformClustered,
    Capability::GroupNonUniformQuad,
    Capability::SubgroupBallotKHR,
    Capability::SubgroupVoteKHR,
    Capability::Int64Atomics,
    Capability::AtomicFloat32AddEXT,
    Capability::AtomicFloat64AddEXT,
    Capability::AtomicFloat32MinMaxEXT,
    Capability::AtomicFloat64MinMaxEXT,
    Capability::VariablePointersStorageBuffer,
    Capability::VariablePointers,
    Capability::PhysicalStorageBufferAddresses,
    Capability::MinLod,
    Capability::DotProduct,
    Capability::DotProductInputAll,
    Capability::DotProductInput4x8Bit,
    Capability::DotProductInput4x8BitPacked,
    Capability::ExpectAssumeKHR,
    Capability::ShaderClockKHR,
    Capability::SampleMaskPostDepthCoverage,
};

}  // namespace

spv::ExecutionModel modelOf(ir::Stage stage) {
    switch (stage) {
        case ir::Stage::vertex:
            return spv::ExecutionModel::Vertex;
        case ir::Stage::fragment:
            return spv::ExecutionModel::Fragment;
        case ir::Stage::geometry:
            return spv::ExecutionModel::Geometry;
        case ir::Stage::control:
            return spv::ExecutionModel::TessellationControl;
        case ir::Stage::evaluation:
            return spv::ExecutionModel::TessellationEvaluation;
        case ir::Stage::compute:
            break;
    }
    return spv::ExecutionModel::GLCompute;
}

void Lowering::run() {
    const auto& entries = module_.entryPoints();
    const auto found = std::find_if(entries.begin(), entries.end(), [this](const EntryPoint& entry) {
        return entry.name == source_.entryPoint && entry.model == modelOf(source_.stage);
    });
    if (found == entries.end()) {
        throw LoweringError{invalidArgument("SPIR-V: the module has no " + std::string(ir::nameOf(source_.stage)) +
                                            " entry point named '" + source_.entryPoint + "'")};
    }
    program_.stage = source_.stage;
    program_.name = found->name;
    interface_ = found->interface;
    ids_.resize(module_.bound());
    typeIndex_.assign(module_.bound(), 0);
    indexing_.assign(module_.bound(), Indexing::constant);
    resourceOfId_.assign(module_.bound(), ir::kNoIndex);
    localOfId_.assign(module_.bound(), ir::kNoIndex);
    workgroupOffset_.assign(module_.bound(), 0);
    classifyVariables();
    classifyPointers();
    emitter_.begin(emitter_.newBlock());
    lowerGlobals();
    lowerExecutionModes(*found);
    lowerEntry(*found);
    emitter_.finish();
}

void Lowering::lowerGlobals() {
    for (uint32_t offset = Module::kFirstInstruction; offset < module_.globalsEnd();) {
        const Instruction inst = module_.next(offset);
        const auto op = static_cast<uint32_t>(inst.op);
        if (inst.op == spv::Op::OpCapability) {
            const auto capability = static_cast<Capability>(inst[1]);
            if (std::find(std::begin(kCapabilities), std::end(kCapabilities), capability) == std::end(kCapabilities)) {
                throw LoweringError{unsupported("SPIR-V: capability " + nameOf(capability) + " is not supported")};
            }
        } else if (inst.op == spv::Op::OpLine || inst.op == spv::Op::OpNoLine) {
            lowerLine(inst);
        } else if (inst.op == spv::Op::OpExtInstImport) {
            const std::string_view set = module_.extendedSet(inst[1]);
            if (set != "GLSL.std.450" && !set.starts_with("NonSemantic.")) {
                refuse(inst, "the instruction set '" + std::string(set) + "' is not supported");
            }
        } else if (op >= static_cast<uint32_t>(spv::Op::OpTypeVoid) &&
                   op <= static_cast<uint32_t>(spv::Op::OpTypeForwardPointer)) {
            lowerType(inst);
        } else if ((op >= static_cast<uint32_t>(spv::Op::OpConstantTrue) &&
                    op <= static_cast<uint32_t>(spv::Op::OpSpecConstantOp)) ||
                   inst.op == spv::Op::OpUndef) {
            lowerConstant(inst);
            const Decoration* builtin = module_.findDecoration(inst[2], spv::Decoration::BuiltIn);
            if (builtin != nullptr && builtin->value == static_cast<uint32_t>(spv::BuiltIn::WorkgroupSize)) {
                workgroupSizeId_ = inst[2];
            }
        } else if (inst.op == spv::Op::OpVariable) {
            lowerVariable(inst);
        }
    }
    emitter_.setLine(0);
}

void Lowering::lowerExecutionModes(const EntryPoint& entry) {
    for (uint32_t offset : module_.executionModes()) {
        const Instruction inst = module_.next(offset);
        if (inst[1] != entry.function || lowerGeometryMode(inst) || lowerTessellationMode(inst)) continue;
        switch (static_cast<spv::ExecutionMode>(inst[2])) {
            case spv::ExecutionMode::EarlyFragmentTests:
                program_.earlyFragmentTests = true;
                break;
            case spv::ExecutionMode::PostDepthCoverage:
                program_.postDepthCoverage = true;
                break;
            case spv::ExecutionMode::LocalSize:
            case spv::ExecutionMode::LocalSizeId:
                setLocalSize(inst);
                break;
            case spv::ExecutionMode::Xfb:
                captures_ = true;
                break;
            case spv::ExecutionMode::OriginUpperLeft:
            case spv::ExecutionMode::DepthReplacing:
            case spv::ExecutionMode::DepthGreater:
            case spv::ExecutionMode::DepthLess:
            case spv::ExecutionMode::DepthUnchanged:
            case spv::ExecutionMode::StencilRefReplacingEXT:
            // What they ask for is what every program gets.
            case spv::ExecutionMode::SubgroupUniformControlFlowKHR:
            case spv::ExecutionMode::DenormPreserve:
            case spv::ExecutionMode::SignedZeroInfNanPreserve:
            case spv::ExecutionMode::RoundingModeRTE:
                break;
            default:
                refuse(inst, "execution mode " + executionModeOf(inst) + " is not supported");
        }
    }
    if (!captures_) capture_ = {};
    checkLocalSize(entry);
    checkGeometryModes();
    endPatch();
}

// --- ids
// ----------------------------------------------------------------------------------------------------------------

const IdValue& Lowering::idValue(uint32_t id) const {
    if (id >= ids_.size() || ids_[id].kind == IdValue::Kind::none) refuseId(id, "is used where it has no value");
    return ids_[id];
}

Lowering::Leaves Lowering::leavesOf(uint32_t id) {
    const IdValue& value = idValue(id);
    if (value.kind == IdValue::Kind::pointer) return pointerLeaves(id, *value.pointer);
    if (value.kind != IdValue::Kind::value || value.leaves.empty()) refuseId(id, "is not a value of scalars");
    return value.leaves;
}

const LeafType& Lowering::scalarOfId(uint32_t id) {
    const LeafTypes types = leafTypes(module_.definition(id)[1]);
    if (types.empty()) refuseId(id, "is not a value of scalars");
    return types[0];
}

const Pointer& Lowering::pointerOf(uint32_t id) {
    const IdValue& value = idValue(id);
    if (value.kind == IdValue::Kind::value && typeInfo(value.type).kind == SpirvType::Kind::pointer) {
        return *arena_.create(pointerOfLeaves(id, value.type, value.leaves));
    }
    if (value.kind != IdValue::Kind::pointer) refuseId(id, "is not a pointer");
    return *value.pointer;
}

const Handle& Lowering::handleOf(uint32_t id) const {
    const IdValue& value = idValue(id);
    if (value.kind != IdValue::Kind::handle) refuseId(id, "is not an image or sampler");
    return *value.handle;
}

void Lowering::require(Leaves leaves, uint32_t type, uint32_t id) {
    const LeafTypes types = leafTypes(type);
    bool fits = leaves.size() == types.size();
    for (size_t i = 0; fits && i < types.size(); ++i) fits = emitter_.hasType(leaves[i], types[i].type);
    if (!fits) refuseId(id, "is not of the type that is asked for");
}

void Lowering::setValue(uint32_t id, uint32_t type, Leaves leaves) {
    require(leaves, type, id);
    ids_[id] = {IdValue::Kind::value, type, leaves, nullptr, nullptr};
}

void Lowering::setScalar(uint32_t id, uint32_t type, ir::ValueId value) {
    const NewScalars leaves = newLeaves(1);
    leaves[0] = value;
    setValue(id, type, leaves);
}

void Lowering::setPointer(uint32_t id, const Pointer& pointer) {
    ids_[id] = {IdValue::Kind::pointer, pointer.type, {}, arena_.create(pointer), nullptr};
}

void Lowering::setHandle(uint32_t id, const Handle& handle) {
    ids_[id] = {IdValue::Kind::handle, handle.imageType, {}, nullptr, arena_.create(handle)};
}

// --- errors
// -------------------------------------------------------------------------------------------------------------

std::string Lowering::describe(const Instruction& inst) const {
    std::string text = std::string("Op") + spvOpcodeString(static_cast<uint32_t>(inst.op));
    bool hasResult = false, hasType = false;
    spv::HasResultAndType(inst.op, &hasResult, &hasType);
    if (hasResult) text += " " + module_.nameOf(inst[hasType ? 2 : 1]);
    return text + where();
}

void Lowering::refuse(const Instruction& inst, const std::string& reason) const {
    throw LoweringError{unsupported("SPIR-V: " + describe(inst) + ": " + reason)};
}

void Lowering::refuseId(uint32_t id, const std::string& reason) const {
    throw LoweringError{unsupported("SPIR-V: " + module_.nameOf(id) + " " + reason + where())};
}

}  // namespace vernier
