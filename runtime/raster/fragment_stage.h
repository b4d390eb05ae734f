// Fragments of a tile: collected into batches, shaded, tested, and written. One per thread.
#pragma once

#include <cstdint>
#include <memory>

#include "runtime/geometry/vertex_stage.h"
#include "runtime/raster/color_block.h"
#include "runtime/raster/color_output.h"
#include "runtime/raster/coverage.h"
#include "runtime/raster/depth_stencil.h"
#include "runtime/raster/fragment_batch.h"
#include "runtime/raster/interpolate.h"
#include "runtime/raster/small_primitives.h"

namespace vernier {

class FragmentStage {
  public:
    FragmentStage();

    void startPass(const PassTargets& targets);
    /// Other attachments of the same kinds: those of another layer.
    void setTargets(const PassTargets& targets) {
        targets_ = &targets;
        unbind();
    }
    void startTile(int32_t tileX, int32_t tileY);
    /// The state of the fragments to come. Flushes when it differs from the current one. `token` identifies
    /// the bindings.
    void bind(const PreparedDraw& draw, uint64_t token);
    /// The planes of the primitive whose blocks come next: to be filled by the caller.
    TrianglePlanes& startPrimitive();
    /// What the primitive covers before any test: of Plan::maskBeforeTests.
    void keepCoverage(const BlockCoverage* blocks, uint32_t count);
    /// Pixels of the current primitive that passed the early tests.
    void add(const BlockCoverage& block);
    /// Room for what waitsFor() and add() need to know of fragments that come later: pixels of a block of the tile.
    void expect(uint32_t block, uint64_t pixels) {
        inBatch_[block] |= pixels;
        blocksInBatch_ |= uint64_t{1} << block;
    }
    /// Fragments of these pixels must wait until what is collected, or expected, is written.
    bool waitsFor(uint32_t block, uint64_t pixels) const {
        return (plan_->ordered && (inBatch_[block] & pixels) != 0) ||
               (isHeld(block) && (held_[block].pixels & pixels) != 0);
    }
    /// Fragments of small primitives that passed the early tests, all of them expected. Of a draw with
    /// Plan::packsSmall. The list has room for one vector more.
    void addSmall(const SmallGroup& group, const SmallFragment* fragments, uint32_t count);
    /// Shades and writes what is collected.
    void flush();
    /// The draw must be bound anew: its memory may be gone.
    void unbind() { draw_ = nullptr; }

    const DepthStencilState& depthState() const { return depthState_; }
    /// There are tests, and an attachment to test against.
    bool testsDepth() const { return plan_->depth.any() && depthState_.target.data != nullptr; }
    PassStatistics& statistics() { return statistics_; }
    bool outOfBudget() const { return outOfBudget_; }
    ContextCache& contexts() { return contexts_; }

  private:
    void flushBatch();
    uint32_t appendSpan(int32_t x, int32_t y, uint32_t lanes);
    void reserve(uint32_t lanes);
    void addPixels(const BlockCoverage& block, uint64_t any);
    void addQuads(const BlockCoverage& block, uint64_t any);
    void setCoverage(const BlockCoverage& block, uint32_t bit, uint32_t lane);
    BatchContext* begin(const PreparedDraw& draw, const std::shared_ptr<const BatchProgram>& program);
    void bindInputs();
    void bindInterpolation();
    void bindSmall();
    void takeSmallInputs(const FragmentBatch& batch);
    // fragment_blocks.cpp
    void placeBlock();
    void runBlock(int32_t x, int32_t y, uint64_t pixels);
    void hold(uint32_t block, uint64_t pixels);
    void runHeld(uint32_t block);
    void runWithHeld(uint32_t block, uint64_t pixels);
    bool isHeld(uint32_t block) const { return (heldBlocks_ >> block & 1) != 0; }

    void run(FragmentBatch& batch);
    void runSamples(FragmentBatch& batch);  // fragment_samples.cpp
    void bindCoarse();                      // fragment_coarse.cpp, likewise the next two
    void addCoarse(const BlockCoverage& block, uint64_t pixels);
    void runCoarse();
    void fillInputs(const FragmentBatch& batch);
    void interpolate(const FragmentBatch& batch, InterpolationInput& input);
    void fillBuiltins(const FragmentBatch& batch, std::span<const BuiltinSlot> builtins, BatchContext& context);
    void fillBuiltin(const FragmentBatch& batch, const BuiltinSlot& builtin, float* plane);
    void centroidOffsets(const FragmentBatch& batch);
    // fragment_late.cpp
    void reduceCoverage(FragmentBatch& batch);
    void testLate(FragmentBatch& batch);
    void testLateSamples(FragmentBatch& batch);
    void testLateSpans(FragmentBatch& batch);
    void testLateRectangle(FragmentBatch& batch);
    void testLateBlock(BlockCoverage& block, const TrianglePlanes& planes, const float* exported);
    void bindColors(Isa isa);
    void smoothAlpha(const FragmentBatch& batch);
    void writeColors(const FragmentBatch& batch, uint32_t sample, const uint32_t* mask);
    struct BoundColor;
    void writeSpans(BoundColor& color, const FragmentBatch& batch);
    void writePartial(const FragmentBatch& batch);
    /// The pixels of block_ that a sample covers, by lane of LaneOrder::rows.
    uint64_t blockPixels(uint32_t sample) const { return blockMasks_[sample] >> blockShift_ & blockRectangle_; }
    const float* outputPlane(uint32_t slot, uint32_t component) const;
    static void interpolateAt(void* self, uint32_t slot, uint32_t where, uint32_t lanes, const float* a, const float* b,
                              float* result);

    const PassTargets* targets_ = nullptr;
    int32_t tileX_ = 0, tileY_ = 0;
    const PreparedDraw* draw_ = nullptr;
    const Plan* plan_ = nullptr;
    uint64_t token_ = 0;
    BatchContext* context_ = nullptr;
    BatchContext* pixelContext_ = nullptr;  // where a part of the fragment program runs per pixel
    uint32_t capacity_ = 0;
    uint32_t samples_ = 1;
    const SamplePosition* positions_ = nullptr;
    // Inputs of the program: those taken at the pixel, at the centroid and at the sample.
    struct VaryingTargets {
        std::vector<VaryingTarget> smooth, linear, flat;
        bool empty() const { return smooth.empty() && linear.empty() && flat.empty(); }
    };
    VaryingTargets centreTargets_, centroidTargets_, sampleTargets_;
    VaryingTargets pixelTargets_;  // of the part that runs per pixel
    InterpolationInput centreInput_{}, centroidInput_{}, sampleInput_{}, pixelInput_{};
    // Attributes of small primitives: smooth, linear, flat. Their lanes wait apart from the program's inputs, which
    // blocks that are run at once use, too.
    std::vector<VaryingTarget> smallTargets_;
    std::vector<SmallAttribute> smallAttributes_;
    std::vector<std::array<float, kLaneRoom>> smallPlanes_;
    std::vector<float*> smallPlaces_;  // where in smallPlanes_ the next lanes go
    GatherSmallFn gatherSmall_ = nullptr;
    ShadeSmallFn shadeSmall_ = nullptr;
    InterpolateFn interpolate_ = nullptr;
    PlaceLanesFn placeLanes_ = nullptr;
    SpreadPixelsFn spreadPixels_ = nullptr;
    CollectPixelsFn collectPixels_ = nullptr;
    BlendFn blend_ = nullptr;
    /// An attachment that changes, bound to the planes of the program's outputs.
    struct BoundColor {
        ColorOutputInput general;
        BlockColorInput block;
        BlockColorFn blockRoutine = nullptr;  // nullptr: there is none
    };
    std::array<BoundColor, kMaxColorAttachments> boundColors_{};
    size_t boundColorCount_ = 0;
    // Fragments of 2x2 pixels: the blocks whose fragments wait in batch_, and outputs of the program spread over
    // pixels.
    struct CoarseBlock {
        static constexpr uint32_t kNone = ~0u;
        int32_t x, y;       // first pixel
        uint64_t pixels;    // that are covered
        uint32_t quads[4];  // the first lane of each quad of fragments, which are 4x4 pixels; kNone: none is covered
    };
    struct CoarseOutput {
        const float* fragments;
        float* pixels;
    };
    std::array<CoarseBlock, kMaxFragmentLanes / 4> coarseBlocks_;
    uint32_t coarseCount_ = 0;
    std::vector<CoarseOutput> coarseOutputs_;
    std::vector<std::array<float, kLaneRoom>> coarsePlanes_;
    bool readsPixels_ = false;  // somebody other than interpolation reads x, y, or coverage of a batch
    DepthStencilState depthState_;

    FragmentBatch batch_;                             // waiting, in spans
    FragmentBatch block_;                             // a block of which most is covered, run at once
    std::array<uint64_t, kMaxSamples> blockMasks_{};  // its coverage
    uint32_t blockShift_ = 0;                         // bits of it before the rows that are run
    uint64_t blockRectangle_ = 0;                     // as many bits as block_ has lanes
    uint64_t secondPixels_ = 0;                       // of the block: those of its second segment, if there is one
    const FragmentBatch* current_ = nullptr;          // the one that runs
    // Of the primitives in batch_; slot planesCount_ - 1 belongs to the primitive being added.
    std::array<TrianglePlanes, kMaxFragmentLanes + 1> planes_;
    uint32_t planesCount_ = 0;
    ColorScratch colors_;
    bool texelsPacked_ = false;  // colors_ has the texels of the batch that runs, the same for all its samples
    alignas(64) std::array<float, kLaneRoom> fragZ_, fragInverseW_;
    alignas(64) std::array<float, kLaneRoom> centroidX_, centroidY_;
    alignas(64) std::array<uint32_t, kLaneRoom> mask_;
    alignas(64) std::array<uint32_t, kLaneRoom> pixelCoverage_;  // of all samples, while they run one by one
    alignas(64) std::array<float, kLaneRoom> zeros_, ones_;
    alignas(64) std::array<float, kLaneRoom> smoothAlpha_;  // of colour 0, times the area that a smooth line covers
    std::array<uint64_t, kBlocksPerTile> inBatch_{};        // pixels of the tile that wait in batch_
    uint64_t blocksInBatch_ = 0;                            // blocks that have some
    std::array<SampleMasks, kBlocksPerTile> rasterized_{};  // of the current primitive, where the program reads them
    /// Part of a block, which waits for a primitive that has the rest: none of it waits in batch_.
    struct HeldBlock {
        uint64_t pixels = 0;
        TrianglePlanes planes;
    };
    bool holdsBlocks_ = false;  // primitives may share the run of a block
    std::array<HeldBlock, kBlocksPerTile> held_;
    uint64_t heldBlocks_ = 0;
    bool outOfBudget_ = false;
    PassStatistics statistics_;
    ContextCache contexts_;
};

}  // namespace vernier
