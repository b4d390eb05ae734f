// The plan of a graphics pipeline: which stages run, at what rate and accuracy. Plain data, made once when
// the pipeline is created; the renderer does what it says and explain() prints it, so that the two cannot
// differ.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/format/format.h"
#include "runtime/limits.h"
#include "runtime/plan/fact.h"
#include "runtime/plan/graphics_state.h"
#include "runtime/plan/shader_program.h"
#include "runtime/skips.h"
#include "spirv_interp/ir/ir.h"

namespace vernier {

inline constexpr uint32_t kNoSlot = ~0u;

/// How one vertex attribute reaches the inputs of the vertex program.
struct AttributeFetch {
    FormatOps ops;
    bool words = false;       // components are whole 32-bit words: copied, not converted
    uint32_t components = 0;  // that the format has
    uint32_t texelBytes = 0;
    uint32_t binding = 0, offset = 0, stride = 0;
    bool perInstance = false;
    uint32_t divisor = 1;    // instances that read the same texel; 0: all
    uint32_t alphaBits = 0;  // what A is when the format has none: 1 as float or integer
    std::array<uint32_t, 4> slots{kNoSlot, kNoSlot, kNoSlot, kNoSlot};
};

struct BuiltinSlot {
    ir::Builtin builtin = ir::Builtin::user;
    uint32_t component = 0;
    uint32_t slot = 0;
};

/// One scalar that travels from the last program before the rasteriser to the fragment program, or that each primitive
/// gives its own copies of its vertices for the fragment program.
struct Varying {
    enum class Source : uint8_t {
        vertex,    // what that program writes
        weight,    // BaryCoordKHR: 1 at the vertex with the number, 0 at the others
        ofVertex,  // PerVertexKHR: at all of them what that program wrote for that vertex
    };
    uint32_t vertexSlot = kNoSlot;    // kNoSlot: nobody writes it, it reads as 0
    uint32_t fragmentSlot = kNoSlot;  // of the fragment program, or of the part of it that runs per sample
    uint32_t pixelSlot = kNoSlot;     // of the part that runs per pixel
    ir::Interpolation interpolation = ir::Interpolation::smooth;
    ir::Sampling sampling = ir::Sampling::center;
    Source source = Source::vertex;
    uint8_t number = 0;  // of the vertex, unless `source` is vertex
};

/// An input of a stage between vertices and the rasteriser that is a value of one of its primitive's vertices.
struct StageInput {
    uint32_t slot = 0;
    uint32_t from = kNoSlot;  // output of the stage before; kNoSlot: nobody writes it, it reads as 0
    uint32_t vertex = 0;      // of the primitive
};

/// What such a stage gets. Of an evaluation stage, StageInput::from is the word of a patch's row, and those of the
/// patch as a whole are among the inputs.
struct StagePlan {
    std::vector<StageInput> inputs;
    std::vector<BuiltinSlot> builtins;
};

enum class DepthStorage : uint8_t { none, d16, d24, d32f, d32fs8 };

/// none for a format without depth.
DepthStorage depthStorage(VkFormat format);
bool isFixedPoint(DepthStorage storage);

struct DepthPlan {
    DepthStorage storage = DepthStorage::none;
    bool hasStencil = false;  // the attachment has a stencil aspect
    bool test = false, write = false;
    bool bounds = false, stencil = false;
    bool early = true;             // before the fragment program
    bool rejects = false;          // not early, but what fails before the program would fail after it, too
    bool clampToViewport = false;  // depth clamping
    bool unrestricted = false;     // depths may lie outside 0..1
    uint8_t compare = 7;           // bit 0: passes when less, bit 1: equal, bit 2: greater (as VkCompareOp is numbered)
    bool any() const { return test || bounds || stencil; }
};

/// A value that the part of a fragment program that runs per sample takes from the part that runs per pixel.
struct CarriedValue {
    uint32_t from = 0;  // output of the one
    uint32_t to = 0;    // input of the other
};

/// How colours get into an attachment.
enum class ColorPath : uint8_t {
    store,  // converted and stored
    blend,  // a blend equation
    logic,  // a logic operation on the stored bits
};

struct ColorPlan {
    uint32_t attachment = 0;
    ColorPath path = ColorPath::store;
    VkFormat format = VK_FORMAT_UNDEFINED;
    FormatOps ops;
    uint32_t texelBytes = 0;
    bool readsDestination = false;
    bool partialMask = false;  // some stored components keep their bits
    bool clampInputs = false;  // fixed-point: sources and factors are clamped before blending
    float clampLow = 0;
    std::array<std::byte, 16> writeBits{};                                  // of a texel: the bits that may change
    std::array<uint32_t, 4> slots{kNoSlot, kNoSlot, kNoSlot, kNoSlot};      // of the fragment program's outputs
    std::array<uint32_t, 4> dualSlots{kNoSlot, kNoSlot, kNoSlot, kNoSlot};  // second source
    VkPipelineColorBlendAttachmentState blend{};
    VkLogicOp logicOp = VK_LOGIC_OP_COPY;
};

struct Plan {
    // Geometry.
    std::vector<AttributeFetch> attributes;
    std::vector<BuiltinSlot> vertexBuiltins;
    bool stages = false;         // there are some between vertices and the rasteriser
    uint32_t inputVertices = 3;  // of a primitive that goes into them, those of its neighbours included
    StagePlan control, evaluation, geometry;
    TessellationModes tessellation;  // as the state's domain origin has them
    // Words of a patch's row, by level.
    std::array<uint32_t, 4> outerLevelWords{kNoSlot, kNoSlot, kNoSlot, kNoSlot};
    std::array<uint32_t, 2> innerLevelWords{kNoSlot, kNoSlot};
    // What reaches the rasteriser: the state's topology, or that of what stages make.
    VkPrimitiveTopology rasterTopology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    // Outputs of the last stage before the rasteriser.
    uint32_t primitiveIdSlot = kNoSlot, vertexFlagsSlot = kNoSlot;
    std::array<uint32_t, 4> positionSlots{kNoSlot, kNoSlot, kNoSlot, kNoSlot};
    uint32_t pointSizeSlot = kNoSlot;
    uint32_t layerSlot = kNoSlot, viewportIndexSlot = kNoSlot;
    std::vector<uint32_t> clipDistanceSlots, cullDistanceSlots;
    std::vector<Varying> varyings;  // smooth first, then noPerspective, then flat
    bool ownVertices = false;       // some are of the primitive
    uint32_t smoothCount = 0, linearCount = 0;

    // Fragments.
    bool runsFragments = false;   // the fragment program has an effect
    bool usesQuads = false;       // derivatives: whole 2x2 quads run, helper lanes included
    bool quadsForLevels = false;  // usesQuads, for nothing but levels of detail of images
    bool perSample = false;       // one run per sample
    bool allAtSample = false;     // all inputs are taken at the sample, whatever they say of themselves
    bool splitSamples = false;    // perSample: a part of the program runs once per pixel
    bool coarse = false;          // the program runs once for 2x2 pixels, at the point where they meet
    std::vector<CarriedValue> carried;
    bool needsBarycentrics = false;
    bool needsCentroid = false;         // some input is evaluated inside the covered part of the pixel
    bool ordered = false;               // a batch holds each pixel once: colours are read back
    bool readsAttachments = false;      // the program reads some: ordered, and nothing before it may be left out
    bool preciseInterpolation = false;  // double
    bool keepsCoverage = true;          // nothing after the early tests drops a sample
    bool countsEarly = false;           // samples are counted before the program may drop them (EarlyFragmentTests)
    bool maskBeforeTests = false;       // the program reads the sample mask as it was before the early tests
    bool coverageIsFull = false;        // every lane of a batch is one covered sample, and stays so
    bool usesFragCoord = false;
    bool interpolates = false;  // the program itself asks for inputs at other places
    bool packsSmall = false;  // primitives of a few pixels may be drawn many at a time: lanes of a batch need not know
                              // their primitive, and the early test is one of depth at most
    uint32_t samples = 1;
    uint32_t sampleMask = ~0u;
    bool alphaToCoverage = false, alphaToOne = false;
    bool smoothLines = false;  // alpha of colour 0 is multiplied with what a line covers of the pixel
    std::vector<BuiltinSlot> fragmentBuiltins, pixelBuiltins;
    uint32_t fragDepthSlot = kNoSlot, stencilRefSlot = kNoSlot, sampleMaskSlot = kNoSlot, alphaSlot = kNoSlot;
    DepthPlan depth;
    std::vector<ColorPlan> colors;  // the attachments that change

    Skips skips;  // which of what is not needed is left out
    std::vector<Fact> facts;
};

/// The state and the program have passed check_state.h.
Plan makePlan(const GraphicsState& state, const ShaderProgram& program);
/// Of a plan with quadsForLevels, what draws follow whose images need no level of detail.
Plan planWithoutQuads(Plan plan);

}  // namespace vernier
