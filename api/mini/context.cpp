// Contexts and passes.
#include <algorithm>
#include <bit>

#include "api/mini/context_guard.h"
#include "runtime/raster/depth_resolve.h"

using namespace vernier;
using namespace vernier::mini;

void VnContext_T::submit() {
    // All that may fail comes before the submission: after it, nothing may be recorded twice or waited for in vain.
    auto next = std::make_shared<Recording>();
    Submission submission;
    submission.commands = {&recording->commands};
    const uint64_t number = submitted + 1;
    // The recording, and with it everything it uses, dies on the queue's thread when it has run.
    submission.done = [this, number, kept = recording]() mutable {
        kept.reset();
        done.signal(number);
    };
    device->runtime->queue().submit(std::move(submission));
    submitted = number;
    startRecording(std::move(next));
}

VnResult vnCreateContext(VnDevice device, const VnContextDesc* desc, VnContext* context) {
    return guarded(device, __func__, [&] {
        const VnContextDesc defaults{};
        if (VnResult result = checkDesc(device, "vnCreateContext", desc ? desc : &defaults, context)) return result;
        auto made = std::make_unique<VnContext_T>(device);
        const std::lock_guard lock(device->contextMutex);
        device->contexts.push_back(made.get());
        *context = made.release();
        return VN_SUCCESS;
    });
}

void vnDestroyContext(VnContext context) {
    if (!context) return;
    context->waitIdle();
    {
        const std::lock_guard lock(context->device->contextMutex);
        std::erase(context->device->contexts, context);
    }
    delete context;
}

VnResult vnFlush(VnContext context) {
    return guardedContext(context, __func__, [&] {
        if (VnResult result = checkSubmit(context, "vnFlush")) return result;
        if (context->recording->commands.first()) context->submit();
        return VN_SUCCESS;
    });
}

VnResult vnFinish(VnContext context) {
    return guardedContext(context, __func__, [&] { return finish(context, "vnFinish"); });
}

namespace {

/// VK_ATTACHMENT_STORE_OP_NONE is no small number.
VnResult checkOperations(VnDevice device, const VnAttachment& attachment, const std::string& name) {
    const struct {
        const char* name;
        int64_t value, last;
    } fields[] = {{" loadOp", enumValue(attachment.loadOp), VK_ATTACHMENT_LOAD_OP_DONT_CARE},
                  {" storeOp", enumValue(attachment.storeOp), VK_ATTACHMENT_STORE_OP_DONT_CARE},
                  {" stencilLoadOp", enumValue(attachment.stencilLoadOp), VK_ATTACHMENT_LOAD_OP_DONT_CARE},
                  {" stencilStoreOp", enumValue(attachment.stencilStoreOp), VK_ATTACHMENT_STORE_OP_DONT_CARE}};
    for (const auto& field : fields)
        if (VnResult r = checkEnum(device, "vnBeginPass", name + field.name, field.value, field.last)) return r;
    return VN_SUCCESS;
}

/// One attachment of a pass as the recording needs it.
VnResult attachmentOf(VnContext context, const VnAttachment& from, const char* name, RenderingAttachment& to,
                      const ViewObject** viewObject) {
    const auto view = context->device->views.find(from.view.id);
    if (!view) return badHandle(context->device, "vnBeginPass", (std::string(name) + " view").c_str());
    if (VnResult result = checkOperations(context->device, from, name)) return result;
    if (view->view.info().range.levelCount != 1)
        return invalid(context->device, "vnBeginPass", std::string(name) + " view has more than one mip level");
    if (view->view.info().type == VK_IMAGE_VIEW_TYPE_3D)
        return invalid(context->device, "vnBeginPass", std::string(name) + " view is 3D; draw to a view of its slices");
    to.view = &context->recording->keep(view).view;
    to.loadOp = from.loadOp;
    to.storeOp = from.storeOp;
    to.stencilLoadOp = from.stencilLoadOp;
    to.stencilStoreOp = from.stencilStoreOp;
    to.clear = from.clear;
    *viewObject = view.get();
    if (!from.resolve.id) return VN_SUCCESS;
    const auto resolve = context->device->views.find(from.resolve.id);
    if (!resolve) return badHandle(context->device, "vnBeginPass", (std::string(name) + " resolve view").c_str());
    const VkExtent2D a = view->view.extent(), b = resolve->view.extent();
    if (resolve->image->image.info().samples != 1 || view->image->image.info().samples == 1 || a.width != b.width ||
        a.height != b.height || resolve->view.info().format != view->view.info().format)
        return invalid(
            context->device, "vnBeginPass",
            std::string(name) + " resolve must be single-sampled, of a multisampled view of the same size and format");
    if (resolve->view.info().range.layerCount < view->view.info().range.layerCount)
        return invalid(context->device, "vnBeginPass", std::string(name) + " resolve has fewer layers than the view");
    const auto mode = [](VkResolveModeFlagBits wanted) {
        return wanted == VK_RESOLVE_MODE_NONE ? VK_RESOLVE_MODE_SAMPLE_ZERO_BIT : wanted;
    };
    to.depthResolveMode = mode(from.depthResolve);
    to.stencilResolveMode = mode(from.stencilResolve);
    if ((to.depthResolveMode & kDepthResolveModes) == 0 || (to.stencilResolveMode & kStencilResolveModes) == 0)
        return invalid(context->device, "vnBeginPass",
                       std::string(name) + " depthResolve or stencilResolve is no mode of that aspect");
    to.resolve = &context->recording->keep(resolve).view;
    return VN_SUCCESS;
}

class PassBuilder {
  public:
    explicit PassBuilder(VnContext context) : context_(context) { key_.samples = 0; }

    VnResult add(const VnAttachment& attachment, const char* name, bool depth, RenderingAttachment& to) {
        const ViewObject* view = nullptr;
        if (VnResult result = attachmentOf(context_, attachment, name, to, &view)) return result;
        const FormatInfo& format = *findFormat(view->view.info().format);
        const VkFormatFeatureFlags wanted =
            depth ? VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
        if (!(format.optimalTilingFeatures & wanted))
            return fail(context_->device, VN_ERROR_UNSUPPORTED,
                        std::string("vnBeginPass: format ") + format.name + " of " + name + " cannot be drawn to");
        const uint32_t samples = view->image->image.info().samples;
        if (key_.samples != 0 && key_.samples != samples)
            return invalid(context_->device, "vnBeginPass",
                           std::string(name) + " has " + std::to_string(samples) + " samples, the others have " +
                               std::to_string(key_.samples));
        key_.samples = samples;
        if (VnResult result = checkUnique(*view, name)) return result;
        const float clearDepth = attachment.clear.depthStencil.depth;
        if (depth && attachment.loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR && !(clearDepth >= 0 && clearDepth <= 1))
            return invalid(context_->device, "vnBeginPass",
                           std::string(name) + " clear depth is " + std::to_string(clearDepth) + ", not in 0 .. 1");
        const VkExtent2D extent = view->view.extent();
        extent_ = {std::min(extent_.width, extent.width), std::min(extent_.height, extent.height)};
        layers_ = std::min(layers_, view->view.info().range.layerCount);
        return VN_SUCCESS;
    }

    PipelineKey key_;
    VkExtent2D extent_{UINT32_MAX, UINT32_MAX};
    uint32_t layers_ = UINT32_MAX;

  private:
    /// What two attachments write to the same texels would have no order.
    VnResult checkUnique(const ViewObject& view, const char* name) {
        const auto covers = [](const ViewObject& a, const ViewObject& b) {
            const VkImageSubresourceRange &x = a.view.info().range, &y = b.view.info().range;
            return a.image == b.image && x.baseMipLevel == y.baseMipLevel && x.baseArrayLayer == y.baseArrayLayer;
        };
        for (const auto& [other, otherName] : seen_)
            if (covers(*other, view))
                return invalid(context_->device, "vnBeginPass",
                               std::string(name) + " is the same image as " + otherName);
        seen_.emplace_back(&view, name);
        return VN_SUCCESS;
    }

    VnContext context_;
    std::vector<std::pair<const ViewObject*, std::string>> seen_;
};

VnResult checkRenderArea(VnContext context, const VkRect2D& area, const VkExtent2D& extent) {
    const auto inside = [](int64_t offset, int64_t size, int64_t limit) {
        return offset >= 0 && size > 0 && offset + size <= limit;
    };
    if (inside(area.offset.x, area.extent.width, extent.width) &&
        inside(area.offset.y, area.extent.height, extent.height))
        return VN_SUCCESS;
    return invalid(context->device, "vnBeginPass",
                   "renderArea is not inside the attachments of " + std::to_string(extent.width) + " x " +
                       std::to_string(extent.height));
}

VnResult beginPass(VnContext context, const VnPassDesc& desc) {
    command::BeginRendering begin;
    PassBuilder pass(context);
    for (uint32_t i = 0; i < kMaxColorAttachments; ++i) {
        if (!desc.colors[i].view.id) continue;
        const std::string name = "colors[" + std::to_string(i) + "]";
        if (VnResult result = pass.add(desc.colors[i], name.c_str(), false, begin.colors[i])) return result;
        pass.key_.colorFormats[i] = begin.colors[i].view->info().format;
        begin.colorCount = pass.key_.colorCount = i + 1;
    }
    if (desc.depthStencil.view.id) {
        if (VnResult result = pass.add(desc.depthStencil, "depthStencil", true, begin.depthStencil)) return result;
        pass.key_.depthStencilFormat = begin.depthStencil.view->info().format;
    }
    if (pass.key_.samples == 0) return invalid(context->device, "vnBeginPass", "there is no attachment");
    begin.samples = pass.key_.samples;
    begin.layers = pass.layers_;
    begin.viewMask = desc.viewMask;
    if (static_cast<uint32_t>(std::bit_width(desc.viewMask)) > pass.layers_)
        return invalid(context->device, "vnBeginPass",
                       "viewMask is " + std::to_string(desc.viewMask) + ", but the attachments have " +
                           std::to_string(pass.layers_) + " layers");
    begin.renderArea = desc.renderArea;
    if (begin.renderArea.extent.width == 0 && begin.renderArea.extent.height == 0)
        begin.renderArea = {{0, 0}, pass.extent_};
    if (VnResult result = checkRenderArea(context, begin.renderArea, pass.extent_)) return result;
    begin.statistics = &context->statistics;
    context->recording->commands.record(begin);

    const VkRect2D& area = begin.renderArea;
    context->inPass = true;
    context->renderArea = area;
    context->scissors.fill(area);
    context->viewports.fill({static_cast<float>(area.offset.x), static_cast<float>(area.offset.y),
                             static_cast<float>(area.extent.width), static_cast<float>(area.extent.height), 0, 1});
    PipelineKey key = context->key;
    key.colorCount = pass.key_.colorCount;
    key.colorFormats = pass.key_.colorFormats;
    key.depthStencilFormat = pass.key_.depthStencilFormat;
    key.samples = pass.key_.samples;
    context->key = key;
    context->pipelineChanged = context->dynamicChanged = true;
    return VN_SUCCESS;
}

}  // namespace

VnResult vnBeginPass(VnContext context, const VnPassDesc* desc) {
    return guardedContext(context, __func__, [&] {
        if (context->inPass) return wrongState(context, "vnBeginPass", "a pass is open already");
        if (VnResult result = checkDesc(context->device, "vnBeginPass", desc, desc)) return result;
        return beginPass(context, *desc);
    });
}

VnResult vnEndPass(VnContext context) {
    return guardedContext(context, __func__, [&] {
        if (!context->inPass) return wrongState(context, "vnEndPass", "no pass is open");
        if (std::any_of(context->queries.begin(), context->queries.end(),
                        [](const auto& query) { return query.inPass; }))
            return wrongState(context, "vnEndPass", "a query has begun in the pass and not ended");
        context->recording->commands.record(command::EndRendering{});
        context->inPass = false;
        return VN_SUCCESS;
    });
}

VnResult vnPassBarrier(VnContext context) {
    return guardedContext(context, __func__, [&] {
        if (!context->inPass) return wrongState(context, "vnPassBarrier", "no pass is open");
        context->recording->commands.record(command::Flush{});
        return VN_SUCCESS;
    });
}

namespace {

VnResult clearAttachment(VnContext context, const char* function, const VkClearAttachment& clear,
                         const VkRect2D* rect) {
    if (!context->inPass) return wrongState(context, function, "no pass is open");
    CommandBuffer& commands = context->recording->commands;
    const VkClearRect where{rect ? *rect : context->renderArea, 0, 1};
    command::ClearAttachments command;
    command.attachments = commands.copy(std::span(&clear, 1));
    command.rects = commands.copy(std::span(&where, 1));
    commands.record(command);
    return VN_SUCCESS;
}

}  // namespace

VnResult vnClearColor(VnContext context, uint32_t attachment, const VkClearColorValue* value, const VkRect2D* rect) {
    return guardedContext(context, __func__, [&] {
        if (!value) return invalid(context->device, "vnClearColor", "value is NULL");
        if (context->inPass &&
            (attachment >= kMaxColorAttachments || context->key.colorFormats[attachment] == VK_FORMAT_UNDEFINED))
            return invalid(context->device, "vnClearColor",
                           "attachment " + std::to_string(attachment) + " is not in the pass");
        VkClearAttachment clear{VK_IMAGE_ASPECT_COLOR_BIT, attachment, {}};
        clear.clearValue.color = *value;
        return clearAttachment(context, "vnClearColor", clear, rect);
    });
}

VnResult vnClearDepthStencil(VnContext context, VkImageAspectFlags aspects, float depth, uint32_t stencil,
                             const VkRect2D* rect) {
    return guardedContext(context, __func__, [&] {
        if (!(depth >= 0 && depth <= 1))
            return invalid(context->device, "vnClearDepthStencil", "depth is " + std::to_string(depth));
        const FormatInfo* format = findFormat(context->key.depthStencilFormat);
        const VkImageAspectFlags there = format ? format->aspects : 0;
        if (context->inPass && (aspects == 0 || (aspects & ~there) != 0))
            return invalid(
                context->device, "vnClearDepthStencil",
                "aspects is " + std::to_string(aspects) + ", but the pass has no depth or stencil like that");
        VkClearAttachment clear{aspects, 0, {}};
        clear.clearValue.depthStencil = {depth, stencil};
        return clearAttachment(context, "vnClearDepthStencil", clear, rect);
    });
}
