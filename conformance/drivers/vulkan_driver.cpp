#include "conformance/drivers/vulkan_driver.h"

#include "conformance/drivers/stopwatch.h"
#include "conformance/drivers/vulkan_passes.h"
#include "conformance/drivers/vulkan_resources.h"
#include "conformance/scene/scene_format.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace vernier::conformance {
namespace {

/// One scene on the device, from its resources to its pixels.
class SceneRun {
  public:
    SceneRun(VulkanContext& context, const Scene& scene)
        : scene_(scene), resources_(context), builder_(context, resources_, scene) {}

    Status prepare() {
        VERNIER_TRY(resources_.create(scene_));
        for (const SceneStep& step : scene_.steps) {
            const auto* pass = std::get_if<ScenePass>(&step);
            if (pass == nullptr) continue;
            Result<VulkanPass> built = builder_.build(*pass);
            if (!built) return built.error();
            passes_.push_back(std::move(*built));
        }
        return record();
    }

    /// Before prepare().
    Status addQueries(const VulkanContext& context, SceneQueries queries, bool precise);
    Result<SceneCounts> readQueries() const;
    Status runFrame() { return resources_.run(frame_); }
    Result<std::vector<RenderedImage>> readBack();
    double moduleTime() const { return builder_.moduleTime(); }
    double pipelineTime() const { return builder_.pipelineTime(); }

  private:
    Status record();
    void beginQueries();
    void endQueries();
    void recordPass(const ScenePass& scene, const VulkanPass& pass);
    void recordDraw(const SceneDraw& scene, const VulkanDraw& draw, const VulkanPipeline& pipeline);
    void recordMips(const SceneGenerateMips& mips);
    void recordCopy(const SceneCopyImage& copy);
    void recordBlit(const SceneBlitImage& blit);
    void useForTransfer(uint32_t image, const VkImageSubresourceLayers& layers, ImageUse use) {
        resources_.use(frame_, image, use, layers.mipLevel, 1, layers.baseArrayLayer, layers.layerCount);
    }

    const Scene& scene_;
    VulkanResources resources_;
    VulkanPassBuilder builder_;
    std::vector<VulkanPass> passes_;
    VkDevice device_ = VK_NULL_HANDLE;  // with queries only
    VkQueryPool occlusion_ = VK_NULL_HANDLE, statistics_ = VK_NULL_HANDLE, timestamps_ = VK_NULL_HANDLE;
    SceneQueries queries_ = SceneQueries::none;
    bool precise_ = false;
    VkCommandBuffer frame_ = VK_NULL_HANDLE;
};

Status SceneRun::record() {
    const Result<VkCommandBuffer> commands = resources_.beginCommands();
    if (!commands) return commands.error();
    frame_ = *commands;
    resources_.startFrame();
    beginQueries();
    if (queries_ == SceneQueries::aroundNothing) endQueries();
    size_t nextPass = 0;
    for (const SceneStep& step : scene_.steps) {
        if (const auto* pass = std::get_if<ScenePass>(&step)) recordPass(*pass, passes_[nextPass++]);
        if (const auto* mips = std::get_if<SceneGenerateMips>(&step)) recordMips(*mips);
        if (const auto* copy = std::get_if<SceneCopyImage>(&step)) recordCopy(*copy);
        if (const auto* blit = std::get_if<SceneBlitImage>(&step)) recordBlit(*blit);
    }
    if (queries_ == SceneQueries::aroundPasses) endQueries();
    resources_.endFrame(frame_);
    VERNIER_TRY_VK(vkEndCommandBuffer(frame_));
    return {};
}

constexpr VkQueryPipelineStatisticFlags kStatistics =
    VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT | VK_QUERY_PIPELINE_STATISTIC_CLIPPING_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_CLIPPING_PRIMITIVES_BIT | VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT;

Status SceneRun::addQueries(const VulkanContext& context, SceneQueries queries, bool precise) {
    if (queries == SceneQueries::none) return {};
    if (context.features().occlusionQueryPrecise == VK_FALSE ||
        context.features().pipelineStatisticsQuery == VK_FALSE ||
        context.properties().limits.timestampComputeAndGraphics == VK_FALSE)
        return unsupported("the device lacks precise occlusion queries, pipeline statistics or time stamps");
    device_ = context.device();
    queries_ = queries;
    precise_ = precise;
    const auto create = [&](VkQueryType type, uint32_t count, VkQueryPool& pool) -> Status {
        VkQueryPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        info.queryType = type;
        info.queryCount = count;
        info.pipelineStatistics = type == VK_QUERY_TYPE_PIPELINE_STATISTICS ? kStatistics : 0;
        VERNIER_TRY_VK(vkCreateQueryPool(device_, &info, nullptr, &pool));
        resources_.cleanup().add([device = device_, pool] { vkDestroyQueryPool(device, pool, nullptr); });
        return {};
    };
    VERNIER_TRY(create(VK_QUERY_TYPE_OCCLUSION, 1, occlusion_));
    VERNIER_TRY(create(VK_QUERY_TYPE_PIPELINE_STATISTICS, 1, statistics_));
    return create(VK_QUERY_TYPE_TIMESTAMP, 2, timestamps_);
}

void SceneRun::beginQueries() {
    if (queries_ == SceneQueries::none) return;
    vkCmdResetQueryPool(frame_, occlusion_, 0, 1);
    vkCmdResetQueryPool(frame_, statistics_, 0, 1);
    vkCmdResetQueryPool(frame_, timestamps_, 0, 2);
    vkCmdWriteTimestamp(frame_, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, timestamps_, 0);
    vkCmdBeginQuery(frame_, occlusion_, 0, precise_ ? VK_QUERY_CONTROL_PRECISE_BIT : 0);
    vkCmdBeginQuery(frame_, statistics_, 0, 0);
}

void SceneRun::endQueries() {
    vkCmdEndQuery(frame_, statistics_, 0);
    vkCmdEndQuery(frame_, occlusion_, 0);
    vkCmdWriteTimestamp(frame_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps_, 1);
}

Result<SceneCounts> SceneRun::readQueries() const {
    SceneCounts counts;
    std::array<uint64_t, 6> statistics{};
    std::array<uint64_t, 2> times{};
    constexpr VkQueryResultFlags kFlags = VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT;
    VERNIER_TRY_VK(vkGetQueryPoolResults(device_, occlusion_, 0, 1, sizeof counts.samplesPassed, &counts.samplesPassed,
                                         sizeof counts.samplesPassed, kFlags));
    VERNIER_TRY_VK(vkGetQueryPoolResults(device_, statistics_, 0, 1, sizeof statistics, statistics.data(),
                                         sizeof statistics, kFlags));
    VERNIER_TRY_VK(
        vkGetQueryPoolResults(device_, timestamps_, 0, 2, sizeof times, times.data(), sizeof times[0], kFlags));
    counts.inputVertices = statistics[0];
    counts.inputPrimitives = statistics[1];
    counts.vertexInvocations = statistics[2];
    counts.clippingInvocations = statistics[3];
    counts.clippingPrimitives = statistics[4];
    counts.fragmentInvocations = statistics[5];
    counts.ticks = times[1] - times[0];
    return counts;
}

/// Whether shaders of a pass may see what those of an earlier one have stored into buffers.
bool bindsBuffers(const ScenePass& scene) {
    return std::any_of(scene.draws.begin(), scene.draws.end(), [](const SceneDraw& draw) {
        return std::any_of(draw.bindings.begin(), draw.bindings.end(),
                           [](const SceneBinding& each) { return each.buffer != kNone; });
    });
}

void SceneRun::recordPass(const ScenePass& scene, const VulkanPass& pass) {
    for (const SceneDraw& draw : scene.draws) {
        for (const SceneBinding& each : draw.bindings) {
            if (each.image == kNone) continue;
            resources_.useAll(frame_, each.image,
                              each.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE ? ImageUse::storage : ImageUse::sampled);
        }
    }
    for (const SceneAttachment& color : scene.colors) {
        resources_.use(frame_, color.image, ImageUse::colorAttachment, color.mipLevel, 1, color.layer,
                       color.layerCount);
        if (color.resolveImage != kNone) {
            resources_.use(frame_, color.resolveImage, ImageUse::colorAttachment, 0, 1, 0, color.layerCount);
        }
    }
    const SceneAttachment& depth = scene.depthStencil;
    if (depth.image != kNone) {
        resources_.use(frame_, depth.image, ImageUse::depthAttachment, depth.mipLevel, 1, depth.layer,
                       depth.layerCount);
        if (depth.resolveImage != kNone) {
            resources_.use(frame_, depth.resolveImage, ImageUse::depthAttachment, 0, 1, 0, depth.layerCount);
        }
    }
    if (bindsBuffers(scene)) {
        VkMemoryBarrier stores{};
        stores.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        stores.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
        stores.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
        vkCmdPipelineBarrier(frame_, VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT, VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT, 0, 1,
                             &stores, 0, nullptr, 0, nullptr);
    }
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = pass.renderPass;
    begin.framebuffer = pass.framebuffer;
    begin.renderArea = {{0, 0}, scene.extent};
    begin.clearValueCount = static_cast<uint32_t>(pass.clears.size());
    begin.pClearValues = pass.clears.data();
    vkCmdBeginRenderPass(frame_, &begin, VK_SUBPASS_CONTENTS_INLINE);
    for (size_t i = 0; i < scene.draws.size(); ++i) {
        recordDraw(scene.draws[i], pass.draws[i], pass.pipelines[pass.draws[i].pipeline]);
    }
    vkCmdEndRenderPass(frame_);
}

void SceneRun::recordDraw(const SceneDraw& scene, const VulkanDraw& draw, const VulkanPipeline& pipeline) {
    vkCmdBindPipeline(frame_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
    vkCmdSetViewport(frame_, 0, 1, &scene.viewport);
    vkCmdSetScissor(frame_, 0, 1, &scene.scissor);
    for (size_t i = 0; i < scene.moreViews.size(); ++i) {
        vkCmdSetViewport(frame_, static_cast<uint32_t>(i + 1), 1, &scene.moreViews[i].viewport);
        vkCmdSetScissor(frame_, static_cast<uint32_t>(i + 1), 1, &scene.moreViews[i].scissor);
    }
    if (!draw.sets.empty()) {
        vkCmdBindDescriptorSets(frame_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout, 0,
                                static_cast<uint32_t>(draw.sets.size()), draw.sets.data(), 0, nullptr);
    }
    if (!scene.pushConstants.empty()) {
        vkCmdPushConstants(frame_, pipeline.layout, kDrawStages, 0, static_cast<uint32_t>(scene.pushConstants.size()),
                           scene.pushConstants.data());
    }
    for (const SceneVertexBuffer& vertices : scene.vertexBuffers) {
        const VkBuffer buffer = resources_.buffer(vertices.buffer);
        vkCmdBindVertexBuffers(frame_, vertices.binding, 1, &buffer, &vertices.offset);
    }
    if (scene.indexBuffer == kNone) {
        vkCmdDraw(frame_, scene.count, scene.instances, scene.first, scene.firstInstance);
        return;
    }
    vkCmdBindIndexBuffer(frame_, resources_.buffer(scene.indexBuffer), scene.indexOffset, scene.indexType);
    vkCmdDrawIndexed(frame_, scene.count, scene.instances, scene.first, scene.vertexOffset, scene.firstInstance);
}

void SceneRun::recordMips(const SceneGenerateMips& mips) {
    const SceneImage& image = scene_.images[mips.image];
    const auto end = [&](uint32_t mip) {
        return VkOffset3D{static_cast<int32_t>(std::max(1u, image.extent.width >> mip)),
                          static_cast<int32_t>(std::max(1u, image.extent.height >> mip)), 1};
    };
    const VkImageAspectFlags aspects = sceneFormat(image.format)->aspects;
    for (uint32_t mip = 1; mip < image.mipLevels; ++mip) {
        recordBlit({mips.image,
                    mips.image,
                    {{aspects, mip - 1, 0, image.arrayLayers},
                     {{0, 0, 0}, end(mip - 1)},
                     {aspects, mip, 0, image.arrayLayers},
                     {{0, 0, 0}, end(mip)}},
                    VK_FILTER_LINEAR});
    }
}

void SceneRun::recordCopy(const SceneCopyImage& copy) {
    useForTransfer(copy.source, copy.region.srcSubresource, ImageUse::transferSource);
    useForTransfer(copy.destination, copy.region.dstSubresource, ImageUse::transferDestination);
    vkCmdCopyImage(frame_, resources_.image(copy.source), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   resources_.image(copy.destination), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy.region);
}

void SceneRun::recordBlit(const SceneBlitImage& blit) {
    useForTransfer(blit.source, blit.region.srcSubresource, ImageUse::transferSource);
    useForTransfer(blit.destination, blit.region.dstSubresource, ImageUse::transferDestination);
    vkCmdBlitImage(frame_, resources_.image(blit.source), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   resources_.image(blit.destination), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit.region,
                   blit.filter);
}

Result<std::vector<RenderedImage>> SceneRun::readBack() {
    const Result<VkCommandBuffer> commands = resources_.beginCommands();
    if (!commands) return commands.error();
    std::vector<VulkanBuffer> buffers;
    std::vector<RenderedImage> images;
    for (const uint32_t output : scene_.outputs) {
        const SceneImage& scene = scene_.images[output];
        const SceneFormat& format = *sceneFormat(scene.format);
        RenderedImage image{scene.format, scene.extent, {}};
        image.texels.resize(size_t{scene.extent.width} * scene.extent.height * format.texelBytes);
        const Result<VulkanBuffer> buffer =
            resources_.createHostBuffer(image.texels.size(), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        if (!buffer) return buffer.error();
        resources_.use(*commands, output, ImageUse::transferSource, 0, 1, 0, 1);
        VkBufferImageCopy region{};
        region.imageSubresource = {format.aspects & ~VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT}, 0, 0, 1};
        region.imageExtent = {scene.extent.width, scene.extent.height, 1};
        vkCmdCopyImageToBuffer(*commands, resources_.image(output), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               buffer->handle, 1, &region);
        buffers.push_back(*buffer);
        images.push_back(std::move(image));
    }
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(*commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                         nullptr, 0, nullptr);
    VERNIER_TRY_VK(vkEndCommandBuffer(*commands));
    VERNIER_TRY(resources_.run(*commands));
    for (size_t i = 0; i < images.size(); ++i) {
        std::memcpy(images[i].texels.data(), buffers[i].mapped, images[i].texels.size());
    }
    return images;
}

bool hasCubicBlit(const Scene& scene) {
    return std::any_of(scene.steps.begin(), scene.steps.end(), [](const SceneStep& step) {
        const auto* blit = std::get_if<SceneBlitImage>(&step);
        return blit != nullptr && blit->filter == VK_FILTER_CUBIC_EXT;
    });
}

bool hasNegativeViewport(const Scene& scene) {
    return std::any_of(scene.steps.begin(), scene.steps.end(), [](const SceneStep& step) {
        const auto* pass = std::get_if<ScenePass>(&step);
        return pass != nullptr && std::any_of(pass->draws.begin(), pass->draws.end(),
                                              [](const SceneDraw& draw) { return draw.viewport.height < 0; });
    });
}

}  // namespace

Result<std::unique_ptr<VulkanDriver>> VulkanDriver::create(const VulkanOptions& options) {
    std::unique_ptr<VulkanDriver> driver(new VulkanDriver);
    const Stopwatch watch;
    if (Status status = driver->context_.create(options); !status) return status.error();
    driver->startUp_ = watch.milliseconds();
    return driver;
}

std::string VulkanDriver::name() const {
    return context_.properties().deviceName;
}

std::string VulkanDriver::version() const {
    return versionText(context_.properties());
}

std::string VulkanDriver::limits() const {
    const VkPhysicalDeviceLimits& limits = context_.properties().limits;
    const auto line = [](const char* name, auto value) {
        return std::string(name) + " " + std::to_string(value) + "\n";
    };
    return line("subPixelPrecisionBits", limits.subPixelPrecisionBits) +
           line("subTexelPrecisionBits", limits.subTexelPrecisionBits) +
           line("mipmapPrecisionBits", limits.mipmapPrecisionBits) +
           line("viewportSubPixelBits", limits.viewportSubPixelBits) +
           line("maxImageDimension2D", limits.maxImageDimension2D) +
           line("standardSampleLocations", limits.standardSampleLocations);
}

Result<SceneCounts> VulkanDriver::count(const Scene& scene, bool precise) {
    VERNIER_TRY(validateScene(scene));
    SceneRun run(context_, scene);
    VERNIER_TRY(run.addQueries(context_, SceneQueries::aroundPasses, precise));
    VERNIER_TRY(run.prepare());
    VERNIER_TRY(run.runFrame());
    return run.readQueries();
}

Result<std::vector<RenderedImage>> VulkanDriver::render(const Scene& scene, Timing* timing) {
    const Stopwatch watch;
    VERNIER_TRY(validateScene(scene));
    if (hasNegativeViewport(scene) && !context_.hasNegativeViewports()) {
        return unsupported("viewports of negative height: the device has neither Vulkan 1.1 nor VK_KHR_maintenance1");
    }
    if (hasCubicBlit(scene) && !context_.extensions().cubicFilters)
        return unsupported("the device lacks cubic filters");
    if (scene.robustBufferAccess && context_.features().robustBufferAccess == VK_FALSE) {
        return unsupported("robustBufferAccess is off");
    }
    SceneRun run(context_, scene);
    VERNIER_TRY(run.addQueries(context_, queries_, false));
    VERNIER_TRY(run.prepare());
    const Stopwatch firstFrame;
    VERNIER_TRY(run.runFrame());
    const double firstFrameTime = firstFrame.milliseconds();
    Result<std::vector<RenderedImage>> images = run.readBack();
    if (images && timing != nullptr) {
        timing->startUp = startUp_;
        timing->modules = run.moduleTime();
        timing->pipelines = run.pipelineTime();
        timing->firstFrame = firstFrameTime;
        timing->firstImage = startUp_ + watch.milliseconds();
        const Result<FrameTimes> frames = meter_([&] { return run.runFrame(); });
        if (!frames) return frames.error();
        timing->frame = timing->warmFrame = frames.value().median;
        timing->frames = frames.value().count;
    }
    if (!context_.validationErrors().empty()) {
        return invalidArgument("validation errors:\n" + context_.validationErrors());
    }
    return images;
}

}  // namespace vernier::conformance
