// Dynamic rendering (VK_KHR_dynamic_rendering): passes without render pass objects.
#include <algorithm>
#include <bit>
#include <string>

#include "api/vulkan/command_buffer.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/single_sampled.h"
#include "runtime/raster/depth_resolve.h"
#include "runtime/resource/image.h"

namespace vernier::vulkan {
namespace {

/// The attachment, with its operations for colour or depth; a part of a pass that is continued elsewhere neither loads
/// what another part has left nor drops what another part needs, and the last part resolves.
RenderingAttachment attachmentOf(const VkRenderingAttachmentInfo& info, VkRenderingFlags flags) {
    RenderingAttachment result;
    if (info.imageView == VK_NULL_HANDLE) return result;
    const bool resumes = (flags & VK_RENDERING_RESUMING_BIT) != 0,
               suspends = (flags & VK_RENDERING_SUSPENDING_BIT) != 0;
    result.view = object(info.imageView);
    if (info.resolveMode != VK_RESOLVE_MODE_NONE && !suspends) result.resolve = object(info.resolveImageView);
    result.depthResolveMode = result.stencilResolveMode = info.resolveMode;
    result.loadOp = resumes ? VK_ATTACHMENT_LOAD_OP_LOAD : info.loadOp;
    result.storeOp = suspends ? VK_ATTACHMENT_STORE_OP_STORE : info.storeOp;
    result.clear = info.clearValue;
    return result;
}

/// Both aspects as one attachment: their views are the same where both are there.
RenderingAttachment depthStencilOf(const VkRenderingInfo& info) {
    RenderingAttachment depth, stencil;
    if (info.pDepthAttachment != nullptr) depth = attachmentOf(*info.pDepthAttachment, info.flags);
    if (info.pStencilAttachment != nullptr) stencil = attachmentOf(*info.pStencilAttachment, info.flags);
    RenderingAttachment result = depth.view != nullptr ? depth : stencil;
    // An aspect that is no attachment is neither loaded nor stored: what is there stays.
    result.loadOp = depth.view != nullptr ? depth.loadOp : VK_ATTACHMENT_LOAD_OP_LOAD;
    result.storeOp = depth.view != nullptr ? depth.storeOp : VK_ATTACHMENT_STORE_OP_STORE;
    result.stencilLoadOp = stencil.view != nullptr ? stencil.loadOp : VK_ATTACHMENT_LOAD_OP_LOAD;
    result.stencilStoreOp = stencil.view != nullptr ? stencil.storeOp : VK_ATTACHMENT_STORE_OP_STORE;
    if (stencil.view != nullptr) result.clear.depthStencil.stencil = stencil.clear.depthStencil.stencil;
    result.depthResolveMode = depth.depthResolveMode;
    result.stencilResolveMode = stencil.stencilResolveMode;
    result.resolve = depth.resolve != nullptr ? depth.resolve : stencil.resolve;
    return result;
}

/// Collects what the attachments of a pass must have in common, and what is wrong with them.
class Check {
  public:
    Check(const VkRect2D& area, uint32_t layers, uint32_t samplesForSingle)
        : extent_{end(area.offset.x, area.extent.width), end(area.offset.y, area.extent.height)},
          layers_(layers),
          samplesForSingle_(samplesForSingle),
          samples_(samplesForSingle) {}

    Status attachment(const std::string& name, const RenderingAttachment& attachment, VkFormatFeatureFlags feature) {
        if (attachment.view == nullptr) return {};
        const ImageView& view = *attachment.view;
        if (Status s = target(name, view, feature); !s) return s;
        const uint32_t samples = drawnSamples(view.image().info().samples, samplesForSingle_);
        if (samples_ == 0) samples_ = samples;
        if (samples != samples_) return invalidArgument(name + " has another sample count than the attachments before");
        if (attachment.resolve == nullptr) return {};
        const ImageView& to = *attachment.resolve;
        if (Status s = target("the resolve image of " + name, to, feature); !s) return s;
        const bool formatsFit = feature == VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT
                                    ? to.info().format == view.info().format
                                    : canResolveDepthStencil(view.info().format, to.info().format);
        if (to.image().info().samples != 1 || !formatsFit) {
            return invalidArgument("the resolve image of " + name +
                                   " must have one sample and the attachment's format");
        }
        return {};
    }
    uint32_t samples() const { return samples_; }
    const VkExtent2D& extent() const { return extent_; }

  private:
    static uint32_t end(int32_t offset, uint32_t size) {
        const uint64_t sum = static_cast<uint64_t>(std::max(offset, 0)) + size;
        return static_cast<uint32_t>(std::min<uint64_t>(sum, kMaxImageDimension2D));
    }
    Status target(const std::string& name, const ImageView& view, VkFormatFeatureFlags feature) {
        const FormatInfo* format = findFormat(view.info().format);
        if (format == nullptr || (format->optimalTilingFeatures & feature) == 0) {
            return invalidArgument(name + " has a format that cannot be such an attachment");
        }
        if (view.info().range.layerCount < layers_) return invalidArgument(name + " has fewer layers than the pass");
        extent_.width = std::min(extent_.width, view.extent().width);
        extent_.height = std::min(extent_.height, view.extent().height);
        return {};
    }

    VkExtent2D extent_;
    uint32_t layers_, samplesForSingle_, samples_;
};

/// Fills the rendering and the formats that pipelines must have.
Status readRendering(const VkRenderingInfo& info, command::BeginRendering& rendering, SubpassFormats& formats) {
    if (info.colorAttachmentCount > kMaxColorAttachments) {
        return invalidArgument("colorAttachmentCount is above maxColorAttachments");
    }
    rendering.viewMask = info.viewMask;
    rendering.layers = std::clamp(info.layerCount, 1u, kMaxArrayLayers);
    const bool views = info.viewMask != 0;
    Check check(info.renderArea, views ? static_cast<uint32_t>(std::bit_width(info.viewMask)) : rendering.layers,
                samplesForSingle(info.pNext));
    formats.colorCount = rendering.colorCount = info.colorAttachmentCount;
    for (uint32_t i = 0; i < info.colorAttachmentCount; ++i) {
        RenderingAttachment& color = rendering.colors[i] = attachmentOf(info.pColorAttachments[i], info.flags);
        const std::string name = "colour attachment " + std::to_string(i);
        if (Status s = check.attachment(name, color, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT); !s) return s;
        if (color.view != nullptr) formats.colors[i] = color.view->info().format;
    }
    RenderingAttachment& depthStencil = rendering.depthStencil = depthStencilOf(info);
    if (Status s = check.attachment("the depth-stencil attachment", depthStencil,
                                    VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT);
        !s) {
        return s;
    }
    const auto isThere = [](const VkRenderingAttachmentInfo* attachment) {
        return attachment != nullptr && attachment->imageView != VK_NULL_HANDLE;
    };
    if (isThere(info.pDepthAttachment) && isThere(info.pStencilAttachment) &&
        object(info.pDepthAttachment->imageView) != object(info.pStencilAttachment->imageView)) {
        return invalidArgument("the depth and stencil attachments must be one view");
    }
    if (depthStencil.view != nullptr) {
        formats.setDepthStencil(depthStencil.view->info().format);
        if (!isThere(info.pDepthAttachment)) formats.depth = VK_FORMAT_UNDEFINED;
        if (!isThere(info.pStencilAttachment)) formats.stencil = VK_FORMAT_UNDEFINED;
    }
    formats.samples = check.samples();
    formats.viewMask = info.viewMask;
    rendering.samples = std::max(1u, check.samples());
    rendering.renderArea = clipArea(info.renderArea, check.extent());
    return {};
}

}  // namespace

VKAPI_ATTR void VKAPI_CALL CmdBeginRendering(VkCommandBuffer commandBuffer, const VkRenderingInfo* pRenderingInfo) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        if (buffer.pass.inside) return buffer.fail("vkCmdBeginRendering", "not allowed inside a render pass");
        command::BeginRendering rendering;
        SubpassFormats formats;
        Status status = readRendering(*pRenderingInfo, rendering, formats);
        if (status) status = drawToSamples(buffer, rendering, pRenderingInfo->flags, {});
        if (!status) return buffer.fail("vkCmdBeginRendering", status.error().message);
        buffer.pass.inside = true;
        buffer.pass.layers = rendering.layers;
        buffer.pass.formats = formats;
        buffer.stream.record(rendering);
        buffer.checkPipeline();
    });
}

VKAPI_ATTR void VKAPI_CALL CmdEndRendering(VkCommandBuffer commandBuffer) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        if (!buffer.pass.begunHere() || buffer.pass.pass != nullptr) {
            return buffer.fail("vkCmdEndRendering", "vkCmdBeginRendering has not been called");
        }
        buffer.stream.record(command::EndRendering{});
        buffer.pass = {};
        buffer.checkPipeline();
    });
}

}  // namespace vernier::vulkan
