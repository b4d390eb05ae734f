// Render passes and framebuffers. A subpass becomes one rendering of the runtime: an attachment is loaded as
// its description says in the first subpass that uses it and kept from then on.
#pragma once

#include <span>
#include <vector>

#include "api/vulkan/handle.h"
#include "base/result.h"
#include "runtime/command/commands.h"
#include "runtime/limits.h"

namespace vernier::vulkan {

inline constexpr uint32_t kNoSubpass = ~0u;

struct Subpass {
    std::vector<uint32_t> colors;    // attachment indices, VK_ATTACHMENT_UNUSED
    std::vector<uint32_t> resolves;  // empty, or one per colour
    uint32_t depthStencil = VK_ATTACHMENT_UNUSED;
    uint32_t depthStencilResolve = VK_ATTACHMENT_UNUSED;
    VkResolveModeFlagBits depthResolveMode = VK_RESOLVE_MODE_NONE, stencilResolveMode = VK_RESOLVE_MODE_NONE;
    std::vector<uint32_t> inputs;
    uint32_t viewMask = 0;          // not 0: multiview
    uint32_t samplesForSingle = 0;  // not 0: of attachments that have one (samplesForSingle() of its chain)
};

/// What a pipeline must have been made for to draw in a subpass ("Render Pass Compatibility").
struct SubpassFormats {
    uint32_t colorCount = 0;
    VkFormat colors[kMaxColorAttachments] = {};
    VkFormat depth = VK_FORMAT_UNDEFINED, stencil = VK_FORMAT_UNDEFINED;  // the same one where both are there
    uint32_t samples = 0;                                                 // 0: no attachments, any
    uint32_t viewMask = 0;
    bool operator==(const SubpassFormats&) const = default;
    VkFormat depthStencil() const { return depth != VK_FORMAT_UNDEFINED ? depth : stencil; }
    /// An attachment for both of the aspects that the format has.
    void setDepthStencil(VkFormat format);
};

struct RenderPassObject {
    struct Attachment {
        VkAttachmentDescription description{};
        uint32_t firstUse = kNoSubpass, lastUse = kNoSubpass;  // as colour or depth/stencil attachment
    };
    std::vector<Attachment> attachments;
    std::vector<Subpass> subpasses;

    SubpassFormats formats(uint32_t subpass) const;
};

struct Framebuffer {
    std::vector<const ImageView*> views;  // empty if imageless: they are given when a render pass begins
    VkExtent2D extent{};
    uint32_t layers = 1;
};

/// The rendering that a subpass is. `clears` has an entry for each attachment, zeros where none was given.
command::BeginRendering renderingOf(const RenderPassObject& pass, const std::vector<const ImageView*>& views,
                                    uint32_t layers, uint32_t subpass, const VkRect2D& area,
                                    const std::vector<VkClearValue>& clears);

/// The part of the area that lies inside the extent.
VkRect2D clipArea(const VkRect2D& area, const VkExtent2D& extent);

/// Whether the views can stand for the attachments of the pass in a framebuffer of this size.
Status checkViews(const RenderPassObject& pass, std::span<const ImageView* const> views, const VkExtent2D& extent,
                  uint32_t layers);

}  // namespace vernier::vulkan
