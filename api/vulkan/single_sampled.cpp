#include "api/vulkan/single_sampled.h"

#include <algorithm>
#include <bit>
#include <new>
#include <vector>

#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"

namespace vernier::vulkan {
namespace {

constexpr VkImageAspectFlags kAllAspects =
    VK_IMAGE_ASPECT_COLOR_BIT | VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;

/// Puts memory of more samples in the place of attachments.
class Samples {
  public:
    Samples(CommandBuffer& buffer, command::BeginRendering& rendering, VkRenderingFlags flags)
        : buffer_(buffer),
          rendering_(rendering),
          resumes_((flags & VK_RENDERING_RESUMING_BIT) != 0),
          suspends_((flags & VK_RENDERING_SUSPENDING_BIT) != 0) {}

    /// Nothing is done for an attachment that has the samples of the rendering.
    Status attach(RenderingAttachment& attachment) {
        const ImageView* const single = attachment.view;
        if (!isSingle(single)) return {};
        if (Status s = find(*single, attachment.view); !s) return s;
        if (!resumes_) load(*single, attachment);
        if (!suspends_) store(*single, attachment);
        return {};
    }
    /// An input attachment that may be drawn to, too.
    Status addInput(const ImageView& single) {
        if (!isSingle(&single)) return {};
        SampledInput input{&single, nullptr};
        if (Status s = find(single, input.samples); !s) return s;
        const auto drawn = [&](const RenderingAttachment& attachment) { return attachment.view == input.samples; };
        if (std::ranges::none_of(rendering_.colors, drawn) && !drawn(rendering_.depthStencil))
            fill(single, *input.samples, kAllAspects, rendering_.viewMask);
        inputs_.push_back(input);
        return {};
    }
    void finish() { rendering_.sampledInputs = buffer_.stream.copy(std::span<const SampledInput>(inputs_)); }

  private:
    bool isSingle(const ImageView* view) const {
        return view != nullptr && view->image().info().samples == 1 && rendering_.samples > 1;
    }
    Status find(const ImageView& single, const ImageView*& samples) const {
        const vernier::Device& device = *buffer_.device.runtime;
        const Result<const ImageView*> found =
            single.withSamples(rendering_.samples, device.desc().allocator, device.isa());
        if (found) samples = *found;
        if (!found && found.error().code == ErrorCode::outOfDeviceMemory) throw std::bad_alloc();
        return found ? Status() : found.error();
    }
    /// Views that are kept are in the attachment, as if they were loaded.
    void load(const ImageView& single, const RenderingAttachment& attachment) {
        VkImageAspectFlags loaded = 0;
        if (attachment.loadOp == VK_ATTACHMENT_LOAD_OP_LOAD)
            loaded |= VK_IMAGE_ASPECT_COLOR_BIT | VK_IMAGE_ASPECT_DEPTH_BIT;
        if (attachment.stencilLoadOp == VK_ATTACHMENT_LOAD_OP_LOAD) loaded |= VK_IMAGE_ASPECT_STENCIL_BIT;
        const uint32_t views = rendering_.viewMask;
        const uint32_t kept = views & ~attachment.loadViews;
        if (kept != 0) fill(single, *attachment.view, kAllAspects, kept);
        if (views == 0 || kept != views) fill(single, *attachment.view, loaded, views & ~kept);
    }
    /// What is not to be stored stays as it is in the attachment.
    void store(const ImageView& single, RenderingAttachment& attachment) const {
        const bool color = (single.image().format().aspects & VK_IMAGE_ASPECT_COLOR_BIT) != 0;
        const bool stores = attachment.storeOp == VK_ATTACHMENT_STORE_OP_STORE;
        if (!stores) attachment.depthResolveMode = VK_RESOLVE_MODE_NONE;
        if (attachment.stencilStoreOp != VK_ATTACHMENT_STORE_OP_STORE)
            attachment.stencilResolveMode = VK_RESOLVE_MODE_NONE;
        const bool aspects = attachment.depthResolveMode != VK_RESOLVE_MODE_NONE ||
                             attachment.stencilResolveMode != VK_RESOLVE_MODE_NONE;
        if (color ? stores : aspects) attachment.resolve = &single;
    }
    /// Gives all samples inside the area of the rendering the texel of the attachment. `views` 0: of all layers.
    void fill(const ImageView& single, const ImageView& samples, VkImageAspectFlags aspects, uint32_t views) {
        aspects &= samples.image().format().aspects;
        if (aspects == 0) return;
        std::vector<VkImageCopy> regions;
        const auto add = [&](uint32_t first, uint32_t count) {
            const VkRect2D& area = rendering_.renderArea;
            const VkImageSubresourceRange& range = single.info().range;
            VkImageCopy region{};
            region.srcSubresource = {aspects, range.baseMipLevel, range.baseArrayLayer + first, count};
            region.srcOffset = {area.offset.x, area.offset.y, 0};
            region.dstSubresource = {aspects, 0, first, count};
            region.dstOffset = {area.offset.x, area.offset.y, 0};
            region.extent = {area.extent.width, area.extent.height, 1};
            regions.push_back(region);
        };
        if (views == 0) add(0, std::min(rendering_.layers, single.info().range.layerCount));
        for (; views != 0; views &= views - 1) add(static_cast<uint32_t>(std::countr_zero(views)), 1);
        buffer_.stream.record(command::CopyImage{&single.image(), &samples.image(),
                                                 buffer_.stream.copy(std::span<const VkImageCopy>(regions))});
    }

    CommandBuffer& buffer_;
    command::BeginRendering& rendering_;
    bool resumes_, suspends_;
    std::vector<SampledInput> inputs_;
};

}  // namespace

uint32_t samplesForSingle(const void* chain) {
    const auto* info = findInChain<VkMultisampledRenderToSingleSampledInfoEXT>(chain);
    const bool enabled = info != nullptr && info->multisampledRenderToSingleSampledEnable != VK_FALSE;
    return enabled ? static_cast<uint32_t>(info->rasterizationSamples) : 0;
}

Status drawToSamples(CommandBuffer& buffer, command::BeginRendering& rendering, VkRenderingFlags flags,
                     std::span<const ImageView* const> inputs) {
    Samples samples(buffer, rendering, flags);
    for (uint32_t i = 0; i < rendering.colorCount; ++i)
        if (Status s = samples.attach(rendering.colors[i]); !s) return s;
    if (Status s = samples.attach(rendering.depthStencil); !s) return s;
    for (const ImageView* input : inputs)
        if (Status s = samples.addInput(*input); !s) return s;
    samples.finish();
    return {};
}

}  // namespace vernier::vulkan
