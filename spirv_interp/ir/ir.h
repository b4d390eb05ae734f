// The SSA intermediate form between SPIR-V and the batch interpreter. One Program is one shader stage: a single
// function (calls inlined), every value a scalar (vectors, matrices and structs taken apart), variables turned into SSA
// values where their indices are constant and into invocation-local memory where they are not.
//
// Invariants, checked by verify() (ir/verify.h):
//  - a value is defined once, and its definition dominates its uses (a phi's use is at the end of the predecessor);
//  - blocks[0] is the entry; Block::predecessors lists every edge into the block; phis come first in a block;
//  - blocks stand in structured order: every edge goes forward except back edges, whose target is a loop header; the
//    blocks of a loop are contiguous, its header first. The batch interpreter runs them in this order, with lane masks.
//  - a value defined in a loop and used outside it passes through a phi in a block outside (loop-closed SSA), so that a
//    lane that leaves the loop early keeps its own value while others go round.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spirv_interp/ir/geometry_modes.h"

namespace vernier::ir {

/// Scalar types. i32/i64 carry no sign: operations do. In lanes, b1 is an all-zeros or all-ones 32-bit word.
enum class Type : uint8_t { none, b1, i32, f32, i64, f64 };

inline constexpr uint8_t kAny = 0xFF;

enum class Op : uint8_t {
#define VERNIER_IR_OP(name, operands, results, flags) name,
#include "spirv_interp/ir/ops.def"
#undef VERNIER_IR_OP
};

struct OpInfo {
    std::string_view name;
    uint8_t operands;  // kAny: varies
    uint8_t results;
    char kind;  // P, S, R, X or T as in ops.def
};
const OpInfo& opInfo(Op op);

using ValueId = uint32_t;
using BlockId = uint32_t;
inline constexpr ValueId kNoValue = ~0u;
inline constexpr uint32_t kNoIndex = ~0u;

/// Invocations of a subgroup: consecutive lanes of a batch, whatever the instruction set. In compute they are
/// consecutive by LocalInvocationIndex.
inline constexpr uint32_t kSubgroupSize = 32;

// Limits of compute programs ("Required Limits" in the Vulkan specification asks for 16384, 128 and 128).
inline constexpr uint32_t kMaxWorkgroupMemory = 32768;      // bytes
inline constexpr uint32_t kMaxWorkgroupInvocations = 1024;  // also along each dimension

struct Inst {
    Op op = Op::undef;
    Type type = Type::none;      // of the result(s)
    bool noContraction = false;  // SPIR-V NoContraction: never fused
    bool relaxed = false;        // SPIR-V RelaxedPrecision
    ValueId result = kNoValue;   // the first of opInfo().results consecutive values
    uint32_t firstOperand = 0;   // into Program::operands
    uint16_t operandCount = 0;
    uint32_t line = 0;  // source line, 0 = unknown
    uint32_t file = 0;  // source file: index into Program::files, 0 = unknown
    uint64_t imm = 0;
};

struct Block {
    std::vector<Inst> insts;  // the last is a terminator
    std::vector<BlockId> predecessors, successors;
    std::vector<int32_t> cases;  // of a switchOn
    bool loopHeader = false;
    BlockId loopEnd = 0;  // of a loop header: one past the last block of the loop, in block order
};

enum class Stage : uint8_t { vertex, fragment, compute, control, evaluation, geometry };

/// What a value that crosses the border of a stage stands for. `user` = by location and component.
enum class Builtin : uint8_t {
    user,
    // vertex inputs
    vertexIndex,
    instanceIndex,
    baseVertex,
    baseInstance,
    drawIndex,
    viewIndex,
    // vertex outputs (position also the components of gl_Position)
    position,
    pointSize,
    clipDistance,
    cullDistance,
    layer,
    viewportIndex,
    // fragment inputs
    fragCoord,
    frontFacing,
    pointCoord,
    sampleId,
    samplePosition,
    sampleMaskIn,
    primitiveId,
    helperInvocation,
    baryCoord,  // interpolated as user inputs are (ir/primitive_inputs.h)
    baryCoordNoPersp,
    // fragment outputs
    fragDepth,
    sampleMask,
    fragStencilRef,
    // compute inputs; GlobalInvocationId and the like are computed from these
    workgroupId,
    numWorkgroups,
    localInvocationId,
    localInvocationIndex,
    // inputs of the stages between vertices and fragments
    invocationId,
    patchVertices,
    tessCoord,
    tessLevelOuter,
    tessLevelInner,
    stageOffset,  // bytes from the begin of the program's stageMemory to what is the invocation's
    // what a geometry program tells with each vertex, and at its end: how many it put out (ir/place_vertices.h)
    vertexFlags,
    vertexCount,
};

enum class Interpolation : uint8_t { smooth, noPerspective, flat };
enum class Sampling : uint8_t { center, centroid, sample };

/// One scalar input or output. 64-bit attributes take two 32-bit slots.
struct InterfaceSlot {
    Builtin builtin = Builtin::user;
    uint8_t component = 0;  // of the location, or of the builtin vector / array
    uint16_t location = 0;
    // Of a colour: 1 for the second source of blending. Of an input that primitives have for each of their vertices
    // (geometry, tessellation, PerVertexKHR): the number of the vertex, and one. Of an output of a geometry stage: the
    // vertex stream.
    uint8_t index = 0;
    Type type = Type::f32;  // b1, i32 or f32
    Interpolation interpolation = Interpolation::smooth;
    Sampling sampling = Sampling::center;
    bool operator==(const InterfaceSlot&) const = default;
};

enum class ResourceKind : uint8_t {
    uniformBuffer,
    storageBuffer,
    pushConstants,
    combinedImageSampler,
    sampledImage,
    sampler,
    storageImage,
    uniformTexelBuffer,
    storageTexelBuffer,
    inputAttachment,
    workgroupMemory,  // shared by a work-group; byteSize bytes, no descriptor: WorkGroupContext owns it
    stageMemory,      // what a stage puts out through memory; byteSize bytes, no descriptor: who runs the stage owns it
};

struct Resource {
    ResourceKind kind = ResourceKind::uniformBuffer;
    uint32_t set = 0, binding = 0;
    uint32_t arraySize = 1;  // descriptors; 0 = runtime-sized
    uint32_t byteSize = 0;   // push constants, and memory of a work-group or stage
    bool aliased = false;    // shares memory with the other resources that say so
    bool readOnly = false;   // no store or atomic reaches it
};

enum class ImageDim : uint8_t { d1, d2, d3, cube, buffer, subpass };

enum class ImageKind : uint8_t {
    sampleImplicit,
    sampleLod,
    sampleGrad,
    fetch,
    gather,
    read,
    store,
    atomic,
    querySize,
    queryLevels,
    querySamples,
    queryLod,
};

enum class AtomicOp : uint8_t {
    add,
    sub,
    smin,
    smax,
    umin,
    umax,
    iand,
    ior,
    ixor,
    exchange,
    compareExchange,
    load,
    store,
    fadd,
    fmin,
    fmax,
};

/// How the values of a subgroup are brought together. hadd and hmul are of floats that hold halves: every step is
/// rounded to a half, to nearest even.
enum class ReduceOp : uint8_t {
    iadd,
    fadd,
    imul,
    fmul,
    smin,
    umin,
    fmin,
    smax,
    umax,
    fmax,
    iand,
    ior,
    ixor,
    hadd,
    hmul
};
/// All values of a cluster; those up to a lane's own; those before its own, where the first gets the identity.
enum class ReduceMode : uint8_t { reduce, inclusive, exclusive };

/// The static part of an image instruction. Its operands, in this order, those that are there:
/// descriptor index of the image (i32), descriptor index of the sampler (i32, when samplerResource is another
/// resource), `coords` coordinates (f32, or i32 for fetch/read/store; array layer last), dref (f32), lod or bias (f32;
/// i32 for fetch and querySize), gradients d/dx then d/dy (`gradients` f32 each), offsets (`offsets` i32), sample
/// (i32), minimum of the level of detail (f32), texel (4 values, store) or value[, comparator] (atomic).
struct ImageOp {
    ImageKind kind = ImageKind::sampleImplicit;
    uint32_t imageResource = kNoIndex;    // into Program::resources
    uint32_t samplerResource = kNoIndex;  // the same as imageResource for combined image samplers
    ImageDim dim = ImageDim::d2;
    bool arrayed = false, multisampled = false, depthCompare = false;
    uint8_t coords = 0, gradients = 0, offsets = 0;
    bool hasBias = false, hasLod = false, hasSample = false, hasMinLod = false;
    uint8_t component = 0;  // gather
    AtomicOp atomicOp = AtomicOp::add;
};

struct Program {
    Stage stage = Stage::vertex;
    std::string name;  // entry point
    std::vector<Block> blocks;
    std::vector<ValueId> operands;  // of all instructions
    std::vector<Type> valueTypes;   // by ValueId
    std::vector<InterfaceSlot> inputs, outputs;
    std::vector<Resource> resources;
    std::vector<ImageOp> imageOps;
    std::vector<std::string> files{""};  // names of source files; the first stands for an unknown one
    uint32_t localWords = 0;             // invocation-local memory
    // Fragment execution modes and facts that planning needs; recomputed by analyse() (ir/analyse.h) after passes.
    bool earlyFragmentTests = false;
    bool postDepthCoverage = false;  // the sample mask that it reads is what the early tests have left
    bool usesQuads = false;          // derivatives or implicit LOD: helper lanes are needed
    bool canDiscard = false;         // kill or demote
    bool writesDepth = false, writesSampleMask = false;
    bool hasSideEffects = false;  // stores or atomics to memory
    bool perSample = false;       // reads SampleId/SamplePosition or a sample-qualified input
    bool hasBarriers = false;     // control barriers
    bool usesSubgroups = false;   // operations between the lanes of a subgroup, or their places in it
    std::array<uint32_t, 3> localSize{1, 1, 1};
    GeometryModes geometry;  // of a geometry stage

    std::span<const ValueId> operandsOf(const Inst& inst) const {
        return {operands.data() + inst.firstOperand, inst.operandCount};
    }
    ValueId newValue(Type type, uint32_t count = 1) {
        const auto first = static_cast<ValueId>(valueTypes.size());
        valueTypes.insert(valueTypes.end(), count, type);
        return first;
    }
};

}  // namespace vernier::ir
