#include "api/vulkan/render_pass.h"

#include <algorithm>
#include <bit>
#include <string>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/single_sampled.h"
#include "runtime/raster/depth_resolve.h"
#include "runtime/resource/image.h"

namespace vernier::vulkan {
namespace {

// The two versions of the descriptions differ in their heads and in a few members more: the templates take both.

template <class Reference>
std::vector<uint32_t> indices(uint32_t count, const Reference* references) {
    std::vector<uint32_t> result;
    for (uint32_t i = 0; i < count && references != nullptr; ++i) result.push_back(references[i].attachment);
    return result;
}

Status checkReferences(const char* what, uint32_t subpass, const std::vector<uint32_t>& references, size_t count) {
    for (const uint32_t index : references) {
        if (index == VK_ATTACHMENT_UNUSED || index < count) continue;
        return invalidArgument("subpass " + std::to_string(subpass) + ": " + what + " " + std::to_string(index) +
                               " does not exist; there are " + std::to_string(count) + " attachments");
    }
    return {};
}

/// Attachments that are drawn to together have one sample count; a resolve is to one sample of the same format.
Status checkSamples(const RenderPassObject& pass, uint32_t number) {
    const Subpass& subpass = pass.subpasses[number];
    const auto describe = [&](uint32_t index) -> const VkAttachmentDescription* {
        return index == VK_ATTACHMENT_UNUSED ? nullptr : &pass.attachments[index].description;
    };
    const std::string name = "subpass " + std::to_string(number) + ": ";
    uint32_t samples = subpass.samplesForSingle;
    const auto same = [&](uint32_t index) {
        const VkAttachmentDescription* one = describe(index);
        if (one != nullptr && samples == 0) samples = static_cast<uint32_t>(one->samples);
        return one == nullptr || drawnSamples(static_cast<uint32_t>(one->samples), subpass.samplesForSingle) == samples;
    };
    if (!std::ranges::all_of(subpass.colors, same) || !same(subpass.depthStencil)) {
        return invalidArgument(name + "the attachments have different sample counts");
    }
    const VkAttachmentDescription* depth = describe(subpass.depthStencil);
    const VkAttachmentDescription* depthTo = describe(subpass.depthStencilResolve);
    if (depth != nullptr && depthTo != nullptr &&
        (depthTo->samples != VK_SAMPLE_COUNT_1_BIT || !canResolveDepthStencil(depth->format, depthTo->format))) {
        return invalidArgument(name + "resolve attachment " + std::to_string(subpass.depthStencilResolve) +
                               " must have one sample and the depths and stencils of the depth-stencil attachment");
    }
    for (size_t i = 0; i < subpass.resolves.size(); ++i) {
        const VkAttachmentDescription* to = describe(subpass.resolves[i]);
        const VkAttachmentDescription* from = describe(subpass.colors[i]);
        if (to == nullptr || from == nullptr) continue;
        if (to->samples != VK_SAMPLE_COUNT_1_BIT || to->format != from->format) {
            return invalidArgument(name + "resolve attachment " + std::to_string(subpass.resolves[i]) +
                                   " must have one sample and the format of its colour attachment");
        }
    }
    return {};
}

void markUses(RenderPassObject& pass) {
    for (uint32_t i = 0; i < pass.subpasses.size(); ++i) {
        const auto mark = [&](uint32_t index) {
            if (index == VK_ATTACHMENT_UNUSED) return;
            auto& attachment = pass.attachments[index];
            if (attachment.firstUse == kNoSubpass) attachment.firstUse = i;
            attachment.lastUse = i;
        };
        std::ranges::for_each(pass.subpasses[i].colors, mark);
        mark(pass.subpasses[i].depthStencil);
    }
}

/// A clear happens when a rendering begins, so that an attachment to be cleared cannot be read before it is
/// drawn to.
Status checkInputs(const RenderPassObject& pass) {
    for (uint32_t i = 0; i < pass.subpasses.size(); ++i) {
        for (const uint32_t index : pass.subpasses[i].inputs) {
            if (index == VK_ATTACHMENT_UNUSED || pass.attachments[index].firstUse <= i) continue;
            const VkAttachmentDescription& description = pass.attachments[index].description;
            if (description.loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR ||
                description.stencilLoadOp == VK_ATTACHMENT_LOAD_OP_CLEAR) {
                return unsupported("subpass " + std::to_string(i) + " reads attachment " + std::to_string(index) +
                                   ", which is to be cleared, before any subpass draws to it");
            }
        }
    }
    return {};
}

VkAttachmentDescription attachmentOf(const VkAttachmentDescription& from) {
    return from;
}

VkAttachmentDescription attachmentOf(const VkAttachmentDescription2& from) {
    return {from.flags,         from.format,         from.samples,       from.loadOp,     from.storeOp,
            from.stencilLoadOp, from.stencilStoreOp, from.initialLayout, from.finalLayout};
}

void readExtensions(const VkRenderPassCreateInfo& info, uint32_t index, Subpass& to) {
    const auto* multiview = findInChain<VkRenderPassMultiviewCreateInfo>(info.pNext);
    if (multiview != nullptr && index < multiview->subpassCount) to.viewMask = multiview->pViewMasks[index];
}

void readExtensions(const VkRenderPassCreateInfo2& info, uint32_t index, Subpass& to) {
    const VkSubpassDescription2& from = info.pSubpasses[index];
    to.viewMask = from.viewMask;
    to.samplesForSingle = samplesForSingle(from.pNext);
    const auto* resolve = findInChain<VkSubpassDescriptionDepthStencilResolve>(from.pNext);
    if (resolve == nullptr) return;
    to.depthResolveMode = resolve->depthResolveMode;
    to.stencilResolveMode = resolve->stencilResolveMode;
    if (resolve->pDepthStencilResolveAttachment != nullptr)
        to.depthStencilResolve = resolve->pDepthStencilResolveAttachment->attachment;
}

template <class Info>
Result<RenderPassObject> makeRenderPass(const Info& info) {
    RenderPassObject pass;
    for (uint32_t i = 0; i < info.attachmentCount; ++i)
        pass.attachments.push_back({attachmentOf(info.pAttachments[i])});
    for (uint32_t i = 0; i < info.subpassCount; ++i) {
        const auto& from = info.pSubpasses[i];
        if (from.pipelineBindPoint != VK_PIPELINE_BIND_POINT_GRAPHICS) {
            return unsupported("subpass " + std::to_string(i) + ": pipelineBindPoint must be GRAPHICS");
        }
        if (from.colorAttachmentCount > kMaxColorAttachments) {
            return invalidArgument("subpass " + std::to_string(i) + ": colorAttachmentCount " +
                                   std::to_string(from.colorAttachmentCount) + " is above maxColorAttachments");
        }
        Subpass& to = pass.subpasses.emplace_back();
        to.colors = indices(from.colorAttachmentCount, from.pColorAttachments);
        to.resolves = indices(from.colorAttachmentCount, from.pResolveAttachments);
        to.inputs = indices(from.inputAttachmentCount, from.pInputAttachments);
        if (from.pDepthStencilAttachment != nullptr) to.depthStencil = from.pDepthStencilAttachment->attachment;
        readExtensions(info, i, to);
        const size_t count = pass.attachments.size();
        if (Status s = checkReferences("colour attachment", i, to.colors, count); !s) return s.error();
        if (Status s = checkReferences("resolve attachment", i, to.resolves, count); !s) return s.error();
        if (Status s = checkReferences("input attachment", i, to.inputs, count); !s) return s.error();
        if (Status s = checkReferences("depth-stencil attachment", i, {to.depthStencil, to.depthStencilResolve}, count);
            !s) {
            return s.error();
        }
        if (Status s = checkSamples(pass, i); !s) return s.error();
    }
    markUses(pass);
    if (Status s = checkInputs(pass); !s) return s.error();
    return pass;
}

template <class Info>
VkResult createRenderPass(VkDevice device, const char* command, const Info& info,
                          const VkAllocationCallbacks* callbacks, VkRenderPass* out) {
    return guarded([&] {
        Result<RenderPassObject> pass = makeRenderPass(info);
        if (!pass) return object(device)->report(command, pass.error());
        return createHandle(callbacks, out, std::move(pass).value());
    });
}

/// The views in which earlier subpasses use an attachment.
uint32_t viewsBefore(const RenderPassObject& pass, uint32_t subpass, uint32_t attachment) {
    uint32_t views = 0;
    for (uint32_t i = 0; i < subpass; ++i) {
        const Subpass& earlier = pass.subpasses[i];
        if (earlier.depthStencil == attachment || std::ranges::count(earlier.colors, attachment) != 0)
            views |= earlier.viewMask;
    }
    return views;
}

}  // namespace

Status checkViews(const RenderPassObject& pass, std::span<const ImageView* const> views, const VkExtent2D& extent,
                  uint32_t layers) {
    if (views.size() != pass.attachments.size()) {
        return invalidArgument("attachmentCount is " + std::to_string(views.size()) + "; the render pass has " +
                               std::to_string(pass.attachments.size()));
    }
    uint32_t viewMask = 0;
    for (const Subpass& subpass : pass.subpasses) viewMask |= subpass.viewMask;
    const auto viewLayers = static_cast<uint32_t>(std::bit_width(viewMask));
    for (size_t i = 0; i < views.size(); ++i) {
        const std::string name = "attachment " + std::to_string(i);
        const ImageView* view = views[i];
        if (view == nullptr) return invalidArgument(name + " is VK_NULL_HANDLE");
        if (view->extent().width < extent.width || view->extent().height < extent.height) {
            return invalidArgument(name + " is smaller than the framebuffer");
        }
        if (view->info().range.layerCount < std::max(layers, viewLayers)) {
            return invalidArgument(name + " has fewer layers than the framebuffer");
        }
        const VkAttachmentDescription& description = pass.attachments[i].description;
        if (view->info().format != description.format) {
            return invalidArgument(name + " has the format " + nameOf(view->info().format) + "; the render pass says " +
                                   nameOf(description.format));
        }
        if (view->image().info().samples != static_cast<uint32_t>(description.samples)) {
            return invalidArgument(name + " has another sample count than the render pass says");
        }
    }
    return {};
}

SubpassFormats RenderPassObject::formats(uint32_t subpass) const {
    SubpassFormats result;
    const Subpass& from = subpasses[subpass];
    const auto use = [&](uint32_t index) {
        if (index == VK_ATTACHMENT_UNUSED) return VK_FORMAT_UNDEFINED;
        result.samples = static_cast<uint32_t>(attachments[index].description.samples);
        return attachments[index].description.format;
    };
    result.viewMask = from.viewMask;
    result.colorCount = static_cast<uint32_t>(from.colors.size());
    for (uint32_t i = 0; i < result.colorCount; ++i) result.colors[i] = use(from.colors[i]);
    result.setDepthStencil(use(from.depthStencil));
    if (from.samplesForSingle != 0) result.samples = from.samplesForSingle;
    return result;
}

void SubpassFormats::setDepthStencil(VkFormat format) {
    const FormatInfo* info = findFormat(format);
    const VkImageAspectFlags aspects = info != nullptr ? info->aspects : 0;
    depth = (aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0 ? format : VK_FORMAT_UNDEFINED;
    stencil = (aspects & VK_IMAGE_ASPECT_STENCIL_BIT) != 0 ? format : VK_FORMAT_UNDEFINED;
}

VkRect2D clipArea(const VkRect2D& area, const VkExtent2D& extent) {
    const auto clip = [](int32_t offset, uint32_t size, uint32_t limit, int32_t& start, uint32_t& length) {
        const int64_t first = std::clamp<int64_t>(offset, 0, limit);
        const int64_t last = std::clamp<int64_t>(int64_t{offset} + size, first, limit);
        start = static_cast<int32_t>(first);
        length = static_cast<uint32_t>(last - first);
    };
    VkRect2D result{};
    clip(area.offset.x, area.extent.width, extent.width, result.offset.x, result.extent.width);
    clip(area.offset.y, area.extent.height, extent.height, result.offset.y, result.extent.height);
    return result;
}

command::BeginRendering renderingOf(const RenderPassObject& pass, const std::vector<const ImageView*>& views,
                                    uint32_t layers, uint32_t subpass, const VkRect2D& area,
                                    const std::vector<VkClearValue>& clears) {
    const Subpass& from = pass.subpasses[subpass];
    const auto attach = [&](uint32_t index) {
        RenderingAttachment result;
        if (index == VK_ATTACHMENT_UNUSED) return result;
        const auto& attachment = pass.attachments[index];
        result.view = views[index];
        result.clear = clears[index];
        // With multiview, an attachment is loaded in the first subpass that uses it with the view.
        if (from.viewMask != 0) result.loadViews = from.viewMask & ~viewsBefore(pass, subpass, index);
        if (attachment.firstUse == subpass || (from.viewMask != 0 && result.loadViews != 0)) {
            result.loadOp = attachment.description.loadOp;
            result.stencilLoadOp = attachment.description.stencilLoadOp;
        }
        // A later subpass may read what was stored as an input attachment, so only the attachment's end may
        // drop it.
        if (attachment.lastUse == subpass && subpass + 1 == pass.subpasses.size()) {
            result.storeOp = attachment.description.storeOp;
            result.stencilStoreOp = attachment.description.stencilStoreOp;
        }
        return result;
    };
    command::BeginRendering rendering;
    rendering.colorCount = static_cast<uint32_t>(from.colors.size());
    for (uint32_t i = 0; i < rendering.colorCount; ++i) {
        rendering.colors[i] = attach(from.colors[i]);
        if (i < from.resolves.size() && from.resolves[i] != VK_ATTACHMENT_UNUSED &&
            rendering.colors[i].view != nullptr) {
            rendering.colors[i].resolve = views[from.resolves[i]];
        }
    }
    rendering.depthStencil = attach(from.depthStencil);
    rendering.depthStencil.depthResolveMode = from.depthResolveMode;
    rendering.depthStencil.stencilResolveMode = from.stencilResolveMode;
    if (from.depthStencilResolve != VK_ATTACHMENT_UNUSED && rendering.depthStencil.view != nullptr)
        rendering.depthStencil.resolve = views[from.depthStencilResolve];
    rendering.renderArea = area;
    rendering.layers = layers;
    rendering.viewMask = from.viewMask;
    rendering.samples = std::max(1u, pass.formats(subpass).samples);
    return rendering;
}

VKAPI_ATTR VkResult VKAPI_CALL CreateRenderPass(VkDevice device, const VkRenderPassCreateInfo* pCreateInfo,
                                                const VkAllocationCallbacks* pAllocator, VkRenderPass* pRenderPass) {
    return createRenderPass(device, "vkCreateRenderPass", *pCreateInfo, pAllocator, pRenderPass);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateRenderPass2(VkDevice device, const VkRenderPassCreateInfo2* pCreateInfo,
                                                 const VkAllocationCallbacks* pAllocator, VkRenderPass* pRenderPass) {
    return createRenderPass(device, "vkCreateRenderPass2", *pCreateInfo, pAllocator, pRenderPass);
}

VKAPI_ATTR void VKAPI_CALL DestroyRenderPass(VkDevice, VkRenderPass renderPass,
                                             const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, renderPass);
}

VKAPI_ATTR void VKAPI_CALL GetRenderAreaGranularity(VkDevice, VkRenderPass, VkExtent2D* pGranularity) {
    *pGranularity = {1, 1};
}

VKAPI_ATTR VkResult VKAPI_CALL CreateFramebuffer(VkDevice device, const VkFramebufferCreateInfo* pCreateInfo,
                                                 const VkAllocationCallbacks* pAllocator, VkFramebuffer* pFramebuffer) {
    return guarded([&] {
        Framebuffer framebuffer;
        framebuffer.extent = {pCreateInfo->width, pCreateInfo->height};
        framebuffer.layers = std::max(1u, pCreateInfo->layers);
        if ((pCreateInfo->flags & VK_FRAMEBUFFER_CREATE_IMAGELESS_BIT) == 0) {
            for (uint32_t i = 0; i < pCreateInfo->attachmentCount; ++i) {
                framebuffer.views.push_back(object(pCreateInfo->pAttachments[i]));
            }
            const Status status =
                checkViews(*object(pCreateInfo->renderPass), framebuffer.views, framebuffer.extent, framebuffer.layers);
            if (!status) return object(device)->report("vkCreateFramebuffer", status.error());
        }
        return createHandle(pAllocator, pFramebuffer, std::move(framebuffer));
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyFramebuffer(VkDevice, VkFramebuffer framebuffer,
                                              const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, framebuffer);
}

}  // namespace vernier::vulkan
