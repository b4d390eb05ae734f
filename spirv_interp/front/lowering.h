// Lowers one entry point of a valid module to the IR. The class is one; its parts are spread over lower_*.cpp by theme.
//
// Inside front/ what cannot be lowered is thrown as a LoweringError and caught in load_shader.cpp: the errors come from
// deep inside expressions, and every one of them ends the whole lowering.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "base/arena.h"
#include "base/result.h"
#include "spirv_interp/capture.h"
#include "spirv_interp/front/emitter.h"
#include "spirv_interp/front/module.h"
#include "spirv_interp/front/scalars.h"
#include "spirv_interp/front/structure.h"
#include "spirv_interp/front/types.h"
#include "spirv_interp/program.h"

namespace vernier {

/// Bytes. As far as that nothing lies in a buffer, and two such distances can be added in 32 bits.
inline constexpr uint32_t kFarOutside = 0x7FFFFFFF;
static_assert(kFarOutside - kMaxBufferBytes >= kMaxBufferBytes - 1);

/// Where a pointer points, known while lowering: a variable and a path into it.
struct Pointer {
    enum class Base : uint8_t {
        ssa,      // scalars that are SSA variables: `root` is the first
        local,    // invocation-local memory: `root` is its first word, `extent` its words
        stage,    // outputs that the invocations of a patch share: `root` is the first word, `extent` their number
        input,    // input slots: `root` is the first, `extent` their number
        builtin,  // a built-in variable made of others (lower_builtins.cpp): `root` is the spv::BuiltIn
        buffer,   // `root` is the id of the variable, or of a pointer into any buffer
        address,  // of a physical storage buffer: `dynamic` is the address, i64; `root` is the id of the pointer
        handle,   // an image or sampler: `root` is the id of the variable
        texel,    // of a storage image: `texel` tells
    };
    Base base = Base::ssa;
    uint32_t type = 0;  // of what it points to
    uint32_t root = 0, extent = 0;
    uint32_t offset = 0;  // constant part, in leaves (ssa), words (local, stage, input, builtin) or bytes (buffer)
    ir::ValueId dynamic = ir::kNoValue;      // the rest, in the same unit; ssa: which of `choices` equal parts
    uint32_t choices = 0, choiceStride = 0;  // ssa with `dynamic`: the parts and the leaves from one to the next
    ir::ValueId descriptor = ir::kNoValue;   // buffer, handle: index in the array of descriptors
    bool anyResource = false;                // buffer: `descriptor` is a buffer handle, which names the resource too
    bool fromResource = false;               // buffer: the offset counts from the resource's begin, not the variable's
    bool descriptorArray = false;            // the next indices select a descriptor
    uint32_t matrixStride = 0;               // buffer: of the matrices inside
    bool rowMajor = false;
    uint32_t elementStride = 0;  // buffer: bytes between the components of a vector that is a matrix's column
    bool wordLayout = false;     // buffer: without layout decorations, the words of the leaves one after the other
    const struct Texel* texel = nullptr;

    /// Laid out by decorations, in bytes.
    bool inBytes() const { return base == Base::buffer || base == Base::address; }
};

/// An image, a sampler or both.
struct Handle {
    uint32_t imageType = 0;  // id of the OpTypeImage; 0 for a sampler
    uint32_t imageResource = ir::kNoIndex, samplerResource = ir::kNoIndex;
    ir::ValueId imageIndex = ir::kNoValue, samplerIndex = ir::kNoValue;  // descriptors
};

struct Texel {
    Handle image;
    Scalars coords;
    ir::ValueId sample = ir::kNoValue;
};

/// What an id stands for at this point of the lowering. Functions are inlined one call at a time and never inside
/// themselves, so one table serves them all.
struct IdValue {
    enum class Kind : uint8_t { none, value, pointer, handle };
    Kind kind = Kind::none;
    uint32_t type = 0;
    Scalars leaves;
    const Pointer* pointer = nullptr;
    const Handle* handle = nullptr;
};

spv::ExecutionModel modelOf(ir::Stage stage);

class Lowering {
  public:
    Lowering(const Module& module, const ShaderSource& source, ir::Program& program)
        : module_(module), source_(source), program_(program), emitter_(program) {}

    /// Fills the program. Throws LoweringError.
    void run();
    /// After run(): what transform feedback keeps.
    const CaptureLayout& capture() const { return capture_; }

  private:
    using Leaves = Scalars;
    using LeafTypes = CheckedSpan<const LeafType>;
    struct Frame;
    /// Where a slot's decorations are: on a variable or on a member of a block.
    struct SlotPlace {
        uint32_t variable = 0;
        uint32_t structure = 0, member = Decoration::kNoMember;
        bool input = true;
    };
    /// How access chains index a variable: by constants only; at run time, but only once and among few parts, so that
    /// selects between SSA values serve best; or in any way, which takes memory.
    enum class Indexing : uint8_t { constant, choice, memory };
    static constexpr uint32_t kSeveral = ~0u;
    struct SlotCursor {
        uint32_t location = 0, component = 0;
        // Transform feedback: where the next scalar goes, if it has an Offset and a buffer.
        bool captured = false;
        uint32_t buffer = kNoBuffer, stride = 0;
        uint64_t offset = 0;
        static constexpr uint32_t kNoBuffer = ~0u;
    };
    struct Output {
        Pointer pointer;
        uint32_t firstSlot = 0;  // in Program::outputs, one per word
    };

    // classify.cpp: facts about variables and pointers, from the words of the module
    void classifyVariables();
    Indexing indexingOf(const Instruction& chain, Indexing before) const;
    bool isConstantId(uint32_t id) const;
    void classifyPointers();
    bool isBufferPointer(uint32_t type) const;
    uint32_t onlyVariableOf(uint32_t pointer) const;

    // lowering.cpp: the whole, ids, errors
    void lowerExecutionModes(const EntryPoint& entry);
    void lowerGlobals();
    [[noreturn]] void refuse(const Instruction& inst, const std::string& reason) const;
    [[noreturn]] void refuseId(uint32_t id, const std::string& reason) const;
    std::string describe(const Instruction& inst) const;
    const IdValue& idValue(uint32_t id) const;
    Leaves leavesOf(uint32_t id);
    ir::ValueId scalarOf(uint32_t id) { return leavesOf(id)[0]; }
    const Pointer& pointerOf(uint32_t id);
    const Handle& handleOf(uint32_t id) const;
    /// Ends the lowering when scalars are not those of a type; `id` is what the message names.
    void require(Leaves leaves, uint32_t type, uint32_t id);
    void setValue(uint32_t id, uint32_t type, Leaves leaves);
    void setScalar(uint32_t id, uint32_t type, ir::ValueId value);
    void setPointer(uint32_t id, const Pointer& pointer);
    void setHandle(uint32_t id, const Handle& handle);
    /// The scalar that a scalar or vector with this id is made of; for a pointer with a value, that value.
    const LeafType& scalarOfId(uint32_t id);
    NewScalars newLeaves(size_t count) {
        const NewScalars leaves = arena_.array<ir::ValueId>(count);
        std::fill(leaves.begin(), leaves.end(), ir::kNoValue);
        return leaves;
    }

    // lower_types.cpp
    void lowerType(const Instruction& inst);
    const SpirvType& typeInfo(uint32_t id) const;
    LeafTypes leafTypes(uint32_t id);
    void appendLeafTypes(uint32_t id, std::vector<LeafType>& types) const;
    uint32_t typeOfId(uint32_t id) const { return idValue(id).type; }
    const LeafType& scalarType(uint32_t id) const { return typeInfo(id).scalar; }

    // lower_debug.cpp: source lines
    void lowerLine(const Instruction& inst);
    void lowerDebugInstruction(const Instruction& inst);
    uint32_t fileIndex(uint32_t stringId);
    std::string where() const;

    // lower_constants.cpp
    void lowerConstant(const Instruction& inst);
    ir::ValueId constantOfBits(const LeafType& type, uint64_t bits);
    uint64_t specialised(const Instruction& inst, uint64_t bits, uint32_t bytes) const;
    uint32_t constantIndex(uint32_t id);
    std::optional<uint32_t> constantOf(uint32_t id);
    Leaves zeroOf(uint32_t type);
    Leaves undefOf(uint32_t type);

    // lower_function.cpp
    void lowerEntry(const EntryPoint& entry);
    void lowerFunction(const Function& function, Frame& frame);
    void lowerBlock(const SpirvBlock& block, Frame& frame);
    void lowerInstruction(const Instruction& inst);
    bool lowerTerminator(const Instruction& inst, const SpirvBlock& block, Frame& frame);
    void lowerSwitch(const Instruction& inst, Frame& frame);
    void lowerCall(const Instruction& inst);
    void lowerReturn(const Instruction& inst, Frame& frame);
    void writePhis(uint32_t fromLabel, const Instruction& terminator, Frame& frame);
    ir::BlockId blockOf(uint32_t label, const Instruction& inst, Frame& frame);

    // lower_interface.cpp: variables and the borders of the stage
    void lowerVariable(const Instruction& inst);
    void lowerStageVariable(const Instruction& inst, bool input);
    void initialise(const Instruction& inst, const Pointer& pointer);
    void appendSlots(uint32_t type, const SlotPlace& place, ir::InterfaceSlot slot, SlotCursor& at,
                     std::vector<ir::InterfaceSlot>& slots);
    void decorateSlot(const SlotPlace& place, ir::InterfaceSlot& slot, SlotCursor& at) const;
    void captureScalar(const SlotPlace& place, const LeafType& scalar, std::span<const ir::InterfaceSlot> slots,
                       SlotCursor& at);
    ir::Builtin builtinOf(const SlotPlace& place, uint32_t builtin) const;
    bool isNumberedByVertex(uint32_t variable, const SpirvType& type) const;
    template <class Visit>
    void visitOutputs(const Visit& visit);
    void storeOutputs();
    void storeVertex(ir::ValueId vertex, uint32_t stream);

    // lower_vertices.cpp: what geometry stages put out
    bool lowerGeometryMode(const Instruction& mode);
    void checkGeometryModes() const;
    void beginVertices();
    void endVertices();
    bool lowerEmission(const Instruction& inst);
    uint32_t streamOf(const Instruction& inst);

    // lower_patch.cpp: tessellation stages
    bool lowerTessellationMode(const Instruction& mode);
    void lowerPatchOutput(const Instruction& inst);
    void endPatch();
    ir::ValueId patchPlace(const Pointer& pointer, uint32_t at);

    // lower_builtins.cpp: built-in inputs that are computed, the size of a work-group, barriers
    bool isComputedBuiltin(uint32_t variable) const;
    Leaves builtinLeaves(spv::BuiltIn builtin);
    ir::ValueId inputSlot(ir::Builtin builtin, uint8_t component, ir::Type type);
    ir::ValueId localInvocationId(uint8_t component);
    ir::ValueId localInvocationIndex();
    ir::ValueId subgroupMask(spv::BuiltIn builtin);
    void setLocalSize(const Instruction& mode);
    void checkLocalSize(const EntryPoint& entry);
    bool lowerBarrier(const Instruction& inst);
    void lowerClock(const Instruction& inst);

    // lower_subgroup.cpp
    bool lowerSubgroup(const Instruction& inst);
    bool lowerBallot(const Instruction& inst);
    bool lowerVote(const Instruction& inst);
    bool lowerShuffle(const Instruction& inst);
    void lowerReduction(const Instruction& inst, ir::ReduceOp op);
    ir::ValueId subgroupInvocation();
    ir::ValueId firstInvocation();
    ir::ValueId ballot(ir::ValueId condition);
    ir::ValueId lanesBefore(bool itself);
    ir::ValueId shuffle(ir::Op op, ir::ValueId value, ir::ValueId place);
    void shuffleEach(const Instruction& inst, ir::Op op, uint32_t valueId, ir::ValueId place);
    void setBallot(const Instruction& inst, ir::ValueId word);
    ir::ValueId allEqual(Leaves values);

    // lower_resources.cpp
    uint32_t resourceOf(uint32_t variable);
    ir::ResourceKind resourceKindOf(uint32_t variable, spv::StorageClass storage, uint32_t type) const;
    uint32_t byteSizeOf(uint32_t type, uint32_t matrixStride, bool rowMajor) const;
    uint32_t workgroupResourceOf(uint32_t variable);
    uint32_t bufferOffsetOf(uint32_t variable);

    // lower_memory.cpp
    Pointer stepInto(const Pointer& pointer, uint32_t indexId, const Instruction& inst);
    void stepDescriptor(Pointer& pointer, const SpirvType& type, uint32_t indexId);
    void advance(Pointer& pointer, uint32_t indexId, uint32_t count, uint32_t stride);
    void advanceElement(Pointer& pointer, uint32_t indexId, uint32_t stride);
    void addDistance(Pointer& pointer, ir::ValueId index, uint32_t stride);
    ir::ValueId notFarther(ir::ValueId distance);
    bool isWorkgroupMemory(const Pointer& pointer);
    Pointer wholly(const Pointer& pointer, uint32_t at);
    void lowerAccessChain(const Instruction& inst);
    void lowerPtrAccessChain(const Instruction& inst);
    Leaves load(const Pointer& pointer);
    void storeChoice(const Pointer& pointer, Leaves leaves);
    void store(const Pointer& pointer, Leaves leaves);
    void lowerArrayLength(const Instruction& inst);
    bool lowerAtomic(const Instruction& inst);
    ir::ValueId atomic(const Pointer& pointer, ir::AtomicOp op, ir::Type type, Leaves values);
    bool lowerMemory(const Instruction& inst);
    ir::ValueId place(const Pointer& pointer, uint32_t more);
    ir::ValueId descriptorOf(const Pointer& pointer);
    ir::ValueId loadWord(const Pointer& pointer, uint32_t at, ir::Type type, uint32_t bytes = 0);
    ir::ValueId loadScalar(const Pointer& pointer, uint32_t at, const LeafType& type);
    void storeScalar(const Pointer& pointer, uint32_t at, ir::ValueId value, const LeafType& type);
    void storeWord(const Pointer& pointer, uint32_t at, ir::ValueId value, uint32_t bytes = 0);
    template <class Visit>
    void visitBuffer(const Pointer& pointer, uint32_t at, const Visit& visit);

    // lower_pointer.cpp: pointers as values
    Leaves pointerLeaves(uint32_t id, const Pointer& pointer);
    Pointer pointerOfLeaves(uint32_t id, uint32_t type, Leaves leaves);
    bool lowerPointer(const Instruction& inst);
    void lowerPointerDifference(const Instruction& inst);
    uint32_t resourceOrAny(const Pointer& pointer);
    uint32_t strideOfPointer(uint32_t pointerId, const Pointer& pointer);

    // lower_narrow.cpp: scalars of less than 32 bits
    ir::ValueId emitTyped(ir::Op op, const LeafType& to, Leaves operands, const LeafType& from, uint64_t imm = 0);
    ir::ValueId halfFma(Leaves operands);
    ir::ValueId normalised(ir::ValueId value, const LeafType& type);
    Leaves rounded(uint32_t type, NewScalars leaves);
    ir::ValueId signExtended(ir::ValueId value, const LeafType& type);
    ir::ValueId convertNumber(ir::Op op, const LeafType& to, ir::ValueId value, const LeafType& from, uint32_t result);
    ir::ValueId convertInteger(bool isSigned, const LeafType& to, ir::ValueId value, const LeafType& from);
    ir::ValueId pieceOf(ir::ValueId value, const LeafType& type);
    ir::ValueId ofPiece(ir::ValueId piece, const LeafType& type);
    ir::ValueId indexOf(uint32_t id);

    // lower_arith.cpp, lower_matrix.cpp, lower_composite.cpp
    bool lowerArithmetic(const Instruction& inst);
    bool lowerElementwise(const Instruction& inst);
    bool lowerExtendedResult(const Instruction& inst);
    std::pair<ir::ValueId, ir::ValueId> extended(spv::Op op, ir::ValueId a, ir::ValueId b, const LeafType& type);
    void lowerBitcast(const Instruction& inst);
    void lowerSelect(const Instruction& inst);
    ir::ValueId toI32(ir::ValueId value);
    ir::ValueId withType(ir::ValueId value, ir::Type type);
    bool lowerMatrix(const Instruction& inst);
    bool lowerIntegerDot(const Instruction& inst);
    ir::ValueId saturatingSum(ir::ValueId a, ir::ValueId b, const LeafType& type, bool isSigned);
    bool lowerComposite(const Instruction& inst);
    uint32_t leafOfPart(uint32_t type, const Instruction& inst, uint32_t firstWord, uint32_t& partType) const;
    ir::ValueId chooseLeaf(Leaves values, ir::ValueId index);
    ir::ValueId dot(Leaves a, Leaves b);
    ir::ValueId add(ir::ValueId a, ir::ValueId b) { return binary(ir::Op::fadd, a, b); }
    ir::ValueId sub(ir::ValueId a, ir::ValueId b) { return binary(ir::Op::fsub, a, b); }
    ir::ValueId mul(ir::ValueId a, ir::ValueId b) { return binary(ir::Op::fmul, a, b); }
    ir::ValueId binary(ir::Op op, ir::ValueId a, ir::ValueId b) {
        return emitter_.emit(op, emitter_.typeOf(a), {a, b});
    }
    ir::ValueId unary(ir::Op op, ir::ValueId a) { return emitter_.emit(op, emitter_.typeOf(a), {a}); }
    ir::ValueId compare(ir::Op op, ir::ValueId a, ir::ValueId b) {
        return emitter_.emit(op, ir::Type::b1, {a, b}, static_cast<uint64_t>(emitter_.typeOf(a)));
    }
    ir::ValueId convert(ir::Op op, ir::Type to, ir::ValueId a) {
        return emitter_.emit(op, to, {a}, static_cast<uint64_t>(emitter_.typeOf(a)));
    }

    // lower_glsl450.cpp, lower_glsl450_geometry.cpp, lower_glsl450_pack.cpp
    void lowerExtended(const Instruction& inst);
    bool lowerExtendedElementwise(const Instruction& inst);
    bool lowerGeometric(const Instruction& inst);
    bool lowerPacking(const Instruction& inst);
    void lowerSplit(const Instruction& inst);
    ir::ValueId withSignOf(ir::ValueId value, ir::ValueId x);
    void lowerInterpolate(const Instruction& inst);
    void lowerNormalize(const Instruction& inst);
    void lowerRefract(const Instruction& inst);
    ir::ValueId determinant(Leaves m, uint32_t size);
    ir::ValueId minorOf(Leaves m, uint32_t size, uint32_t column, uint32_t row);
    void lowerInverse(const Instruction& inst);
    ir::ValueId packNorm(Leaves components, uint32_t bits, bool isSigned);
    ir::ValueId unpackNorm(ir::ValueId word, uint32_t index, uint32_t bits, bool isSigned);

    // lower_image.cpp, lower_image_access.cpp
    bool lowerImage(const Instruction& inst);
    void lowerSample(const Instruction& inst);
    void lowerFetch(const Instruction& inst);
    ir::ValueId fragmentPixel(uint8_t axis);
    void lowerGather(const Instruction& inst);
    void lowerImageQuery(const Instruction& inst);
    void lowerImageWrite(const Instruction& inst);
    void lowerTexelPointer(const Instruction& inst);
    void appendImageOperands(const Instruction& inst, uint32_t maskWord, ir::ImageOp& op,
                             std::vector<ir::ValueId>& operands, uint32_t* constOffsets);
    ir::ImageOp imageOpOf(const Handle& handle, ir::ImageKind kind) const;
    std::vector<ir::ValueId> imageOperandsOf(const Handle& handle) const;
    void appendCoords(const Handle& handle, Leaves coords, ir::ImageOp& op, std::vector<ir::ValueId>& operands);
    ir::ValueId emitImage(const ir::ImageOp& op, ir::Type type, std::span<const ir::ValueId> operands);
    void setTexel(const Instruction& inst, ir::ValueId first);

    const Module& module_;
    const ShaderSource& source_;
    ir::Program& program_;
    Emitter emitter_;
    Arena arena_{16 * 1024};

    std::vector<IdValue> ids_;
    std::vector<uint32_t> typeIndex_;  // by id, into types_
    std::vector<SpirvType> types_{SpirvType{}};
    std::vector<std::vector<LeafType>> leafTypes_{{}};
    std::vector<Indexing> indexing_;       // by id of a variable or parameter
    std::vector<uint32_t> pointerClass_;   // by id, union-find: pointers that may hold each other's values
    std::vector<uint32_t> classVariable_;  // by class: the buffer variable its pointers point into; kSeveral
    std::vector<Output> outputs_;
    CaptureLayout capture_;
    bool captures_ = false;               // the execution mode Xfb
    std::vector<uint32_t> interface_;     // ids of the entry point's interface variables
    std::vector<uint32_t> resourceOfId_;  // by id of a variable; kNoIndex = not used so far
    std::vector<uint32_t> localOfId_;     // by id of a variable in local memory: its first word
    std::vector<uint32_t>
        workgroupOffset_;           // by id of a variable in work-group memory: its first byte, once it is used
    bool workgroupBlocks_ = false;  // work-group memory is laid out by decorations
    uint32_t workgroupSizeId_ = 0;  // the constant that is the built-in WorkgroupSize
    uint32_t callCount_ = 0;
    uint32_t vertexCount_ = 0, startsStrip_ = 0;  // variables of a geometry stage
    uint32_t flagsSlot_ = 0;
    uint32_t patchVertices_ = 0;             // that a control stage puts out
    uint32_t patchResource_ = ir::kNoIndex;  // memory of its outputs
    std::vector<uint32_t> fileOfId_;         // by id of an OpString: index into Program::files; 0 = not used so far
    std::vector<const Function*> calls_;     // functions being inlined, outermost first
};

}  // namespace vernier
