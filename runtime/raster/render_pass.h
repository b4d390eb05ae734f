// One render pass instance on the backend: targets are begun, draws are handed over in order, end() makes
// everything visible in the images. Geometry of draws is processed in chunks on all threads and binned into
// tiles; tiles are then rasterised, each by one thread at a time, with their primitives in submission order.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>

#include "runtime/geometry/draw_call.h"
#include "runtime/raster/pass_targets.h"

namespace vernier {

class RenderWorkers;

class RenderPass {
  public:
    /// `workers` may be shared by passes that run at the same time.
    explicit RenderPass(RenderWorkers& workers);
    ~RenderPass();

    /// Starts a pass. A pass object is reused from pass to pass and keeps its memory.
    void begin(const PassTargets& targets);
    void draw(const DrawCall& call);
    /// vkCmdClearAttachments: `aspect` colour (attachment index `color`), depth and/or stencil inside `rect`.
    void clear(VkImageAspectFlags aspect, uint32_t color, const VkClearValue& value, const VkClearRect& rect);
    /// From here to the end, and for what is recorded already, work that a later primitive hides is done all the same,
    /// because someone counts its fragments and samples (queries).
    void countExactly();
    /// What is recorded from here on is counted apart. Returns the number of the segment; that of the first is 0.
    uint32_t nextSegment();
    /// Since begin() or flush(). Draws take memory until they are rendered; with multiview a draw counts once per view.
    size_t recordedDraws() const;
    uint64_t recordedPrimitives() const;
    /// Runs vertex programs for the first draws, and nothing that touches an attachment. After it only end() or flush()
    /// may come.
    void prepare();
    /// Finishes all draws so far, so that their results can be read from memory; the pass goes on.
    void flush();
    /// Runs what is left, resolves, and stores. Returns false when a shader ran out of its loop budget.
    bool end();

    /// Sums since begin(), of all segments or of those from `first` to before `end`; complete after flush() or end().
    PassStatistics statistics(uint32_t first = 0, uint32_t end = ~0u) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vernier
