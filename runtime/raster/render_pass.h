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
    /// While set, work that a later primitive hides is done all the same, because someone counts its fragments and
    /// samples (queries). Call it before draws or after flush().
    void setExactCounts(bool exact);
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

    /// Sums since begin(); complete after flush() or end().
    const PassStatistics& statistics() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vernier
