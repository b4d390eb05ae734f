#include "conformance/drivers/api_driver.h"

#include "conformance/drivers/api_objects.h"
#include "conformance/drivers/stopwatch.h"
#include "conformance/drivers/try.h"
#include "conformance/scene/scene_format.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string_view>

namespace vernier::conformance {
namespace {

struct ContextOwner {
    VnContext context = nullptr;
    ~ContextOwner() { vnDestroyContext(context); }
};

/// One scene in a context, from its objects to its pixels.
class SceneRun {
  public:
    SceneRun(VnDevice device, VnContext context, const Scene& scene)
        : device_(device), context_(context), scene_(scene), objects_(device, context) {}

    Status prepare(double& pipelineTime) {
        VERNIER_TRY(objects_.createResources(scene_));
        const Stopwatch watch;
        VERNIER_TRY(objects_.createPipelines(scene_));
        pipelineTime = watch.milliseconds();
        return {};
    }

    Status runFrame();
    Result<std::vector<RenderedImage>> readBack();
    /// Runs a frame and returns what its draws leave out.
    Result<std::vector<std::string>> notNeeded();

  private:
    Status runPass(const ScenePass& pass);
    Status runDraw(const SceneDraw& draw);
    Status bindResources(const SceneDraw& draw);
    Status explainDraw();
    Status runCopy(const SceneCopyImage& copy);
    Status runBlit(const SceneBlitImage& blit);
    Result<VnAttachment> attachment(const SceneAttachment& scene);

    VnDevice device_;
    VnContext context_;
    const Scene& scene_;
    ApiObjects objects_;
    // While notNeeded() runs: facts of draws, and how many draws have them.
    bool explaining_ = false;
    uint32_t explainedDraws_ = 0;
    std::map<std::string, uint32_t> leftOut_;
};

Status SceneRun::runFrame() {
    for (const SceneStep& step : scene_.steps) {
        if (const auto* pass = std::get_if<ScenePass>(&step)) VERNIER_TRY(runPass(*pass));
        if (const auto* copy = std::get_if<SceneCopyImage>(&step)) VERNIER_TRY(runCopy(*copy));
        if (const auto* blit = std::get_if<SceneBlitImage>(&step)) VERNIER_TRY(runBlit(*blit));
        if (const auto* mips = std::get_if<SceneGenerateMips>(&step)) {
            VERNIER_TRY_API(vnGenerateMips(context_, objects_.image(mips->image)));
        }
    }
    VERNIER_TRY_API(vnFinish(context_));
    return {};
}

Result<VnAttachment> SceneRun::attachment(const SceneAttachment& scene) {
    VnAttachment attachment{};
    const Result<VnView> view =
        objects_.attachmentView(scene_, scene.image, scene.mipLevel, scene.layer, scene.layerCount);
    if (!view) return view.error();
    attachment.view = view.value();
    if (scene.resolveImage != kNone) {
        const Result<VnView> resolve = objects_.attachmentView(scene_, scene.resolveImage, 0, 0, scene.layerCount);
        if (!resolve) return resolve.error();
        attachment.resolve = resolve.value();
    }
    attachment.loadOp = attachment.stencilLoadOp = scene.loadOp;
    attachment.clear = scene.clear;
    attachment.depthResolve = scene.depthResolve;
    attachment.stencilResolve = scene.stencilResolve;
    return attachment;
}

Status SceneRun::runPass(const ScenePass& pass) {
    VnPassDesc desc{};
    for (size_t i = 0; i < pass.colors.size(); ++i) {
        const Result<VnAttachment> color = attachment(pass.colors[i]);
        if (!color) return color.error();
        desc.colors[i] = color.value();
    }
    if (pass.depthStencil.image != kNone) {
        const Result<VnAttachment> depth = attachment(pass.depthStencil);
        if (!depth) return depth.error();
        desc.depthStencil = depth.value();
    }
    desc.renderArea.extent = pass.extent;
    desc.viewMask = pass.viewMask;
    VERNIER_TRY_API(vnBeginPass(context_, &desc));
    for (const SceneDraw& draw : pass.draws) VERNIER_TRY(runDraw(draw));
    VERNIER_TRY_API(vnEndPass(context_));
    return {};
}

Status SceneRun::bindResources(const SceneDraw& draw) {
    for (const SceneVertexBuffer& each : draw.vertexBuffers) {
        VERNIER_TRY_API(vnBindVertexBuffer(context_, each.binding, objects_.buffer(each.buffer), each.offset));
    }
    for (const SceneBinding& each : draw.bindings) {
        const uint64_t size = each.range == VK_WHOLE_SIZE ? 0 : each.range;
        switch (each.type) {
            case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
            case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE: {
                const Result<VnView> view = objects_.sampledView(scene_, each);
                if (!view) return view.error();
                const VnSampler sampler = each.sampler == kNone ? VnSampler{} : objects_.sampler(each.sampler);
                VERNIER_TRY_API(vnBindTexture(context_, each.set, each.binding, 0, view.value(), sampler));
                break;
            }
            case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
            case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
                VERNIER_TRY_API(vnBindTexelBuffer(context_, each.set, each.binding, 0, objects_.buffer(each.buffer),
                                                  each.texelFormat, each.offset, size));
                break;
            default:
                VERNIER_TRY_API(
                    vnBindBuffer(context_, each.set, each.binding, 0, objects_.buffer(each.buffer), each.offset, size));
                break;
        }
    }
    if (!draw.pushConstants.empty()) {
        VERNIER_TRY_API(
            vnPushConstants(context_, 0, draw.pushConstants.data(), static_cast<uint32_t>(draw.pushConstants.size())));
    }
    return {};
}

Status SceneRun::runDraw(const SceneDraw& draw) {
    const ScenePipeline& scene = scene_.pipelines[draw.pipeline];
    const ApiPipeline& pipeline = objects_.pipeline(draw.pipeline);
    VERNIER_TRY_API(vnBindProgram(context_, pipeline.program));
    VERNIER_TRY_API(vnBindVertexLayout(context_, pipeline.layout));
    VERNIER_TRY_API(vnBindRasterState(context_, pipeline.raster));
    VERNIER_TRY_API(vnBindDepthStencilState(context_, pipeline.depthStencil));
    VERNIER_TRY_API(vnBindBlendState(context_, pipeline.blend));
    VERNIER_TRY_API(vnSetTopology(context_, scene.topology, scene.primitiveRestart));
    VERNIER_TRY_API(vnSetPatchVertices(context_, scene.patchVertices));
    VERNIER_TRY_API(vnSetBlendConstants(context_, scene.blendConstants.data()));
    VERNIER_TRY_API(vnSetStencilReference(context_, scene.front.reference, scene.back.reference));
    VERNIER_TRY_API(vnSetViewport(context_, &draw.viewport));
    VERNIER_TRY_API(vnSetScissor(context_, &draw.scissor));
    for (uint32_t i = 0; i < draw.moreViews.size(); ++i) {
        VERNIER_TRY_API(vnSetViewports(context_, i + 1, 1, &draw.moreViews[i].viewport));
        VERNIER_TRY_API(vnSetScissors(context_, i + 1, 1, &draw.moreViews[i].scissor));
    }
    VERNIER_TRY(bindResources(draw));
    if (explaining_) VERNIER_TRY(explainDraw());
    if (draw.indexBuffer == kNone) {
        VERNIER_TRY_API(vnDraw(context_, draw.count, draw.instances, draw.first, draw.firstInstance));
        return {};
    }
    VERNIER_TRY_API(vnBindIndexBuffer(context_, objects_.buffer(draw.indexBuffer), draw.indexOffset, draw.indexType));
    VERNIER_TRY_API(
        vnDrawIndexed(context_, draw.count, draw.instances, draw.first, draw.vertexOffset, draw.firstInstance));
    return {};
}

Status SceneRun::explainDraw() {
    size_t length = 0;
    VERNIER_TRY_API(vnExplain(context_, VN_EXPLAIN_TEXT, nullptr, 0, &length));
    std::string text(length, '\0');
    VERNIER_TRY_API(vnExplain(context_, VN_EXPLAIN_TEXT, text.data(), length + 1, nullptr));
    ++explainedDraws_;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        constexpr std::string_view kLeftOut = "left out  ";
        if (line.starts_with(kLeftOut)) ++leftOut_[line.substr(kLeftOut.size())];
    }
    return {};
}

Result<std::vector<std::string>> SceneRun::notNeeded() {
    explaining_ = true;
    VERNIER_TRY(runFrame());
    explaining_ = false;
    std::vector<std::string> lines;
    for (const auto& [line, draws] : leftOut_) {
        const std::string share = std::to_string(draws) + " of " + std::to_string(explainedDraws_);
        lines.push_back(draws == explainedDraws_ ? line : line + " (" + share + " draws)");
    }
    return lines;
}

/// The region of one layer between two corners, in any order; a blit mirrors by VnRegion::mirror.
Result<VnRegion> regionBetween(const VkImageSubresourceLayers& layers, const VkOffset3D& first,
                               const VkOffset3D& second) {
    if (layers.layerCount != 1) return unsupported("copies of several layers cannot be said in the API");
    VnRegion region{};
    region.mip = layers.mipLevel;
    region.layer = layers.baseArrayLayer;
    region.x = static_cast<uint32_t>(std::min(first.x, second.x));
    region.y = static_cast<uint32_t>(std::min(first.y, second.y));
    region.width = static_cast<uint32_t>(std::abs(second.x - first.x));
    region.height = static_cast<uint32_t>(std::abs(second.y - first.y));
    return region;
}

Status SceneRun::runCopy(const SceneCopyImage& copy) {
    const auto corner = [&](const VkOffset3D& offset) {
        return VkOffset3D{offset.x + static_cast<int32_t>(copy.region.extent.width),
                          offset.y + static_cast<int32_t>(copy.region.extent.height), 1};
    };
    const VkImageCopy& region = copy.region;
    const Result<VnRegion> source = regionBetween(region.srcSubresource, region.srcOffset, corner(region.srcOffset));
    if (!source) return source.error();
    const Result<VnRegion> target = regionBetween(region.dstSubresource, region.dstOffset, corner(region.dstOffset));
    if (!target) return target.error();
    VERNIER_TRY_API(vnCopyImage(context_, objects_.image(copy.source), &source.value(),
                                objects_.image(copy.destination), &target.value()));
    return {};
}

Status SceneRun::runBlit(const SceneBlitImage& blit) {
    const VkImageBlit& region = blit.region;
    const Result<VnRegion> source = regionBetween(region.srcSubresource, region.srcOffsets[0], region.srcOffsets[1]);
    if (!source) return source.error();
    Result<VnRegion> target = regionBetween(region.dstSubresource, region.dstOffsets[0], region.dstOffsets[1]);
    if (!target) return target.error();
    // Turned round is what one of the two regions runs against the other.
    const auto turned = [&](int32_t VkOffset3D::*axis) {
        return (region.srcOffsets[0].*axis > region.srcOffsets[1].*axis) !=
               (region.dstOffsets[0].*axis > region.dstOffsets[1].*axis);
    };
    target->mirror = (turned(&VkOffset3D::x) ? 1u : 0u) | (turned(&VkOffset3D::y) ? 2u : 0u);
    VERNIER_TRY_API(vnBlitImage(context_, objects_.image(blit.source), &source.value(),
                                objects_.image(blit.destination), &target.value(), blit.filter));
    return {};
}

Result<std::vector<RenderedImage>> SceneRun::readBack() {
    std::vector<RenderedImage> images;
    for (const uint32_t output : scene_.outputs) {
        const SceneImage& scene = scene_.images[output];
        RenderedImage image{scene.format, scene.extent, {}};
        image.texels.resize(size_t{scene.extent.width} * scene.extent.height * sceneFormat(scene.format)->texelBytes);
        VERNIER_TRY_API(
            vnReadImage(context_, objects_.image(output), nullptr, image.texels.data(), image.texels.size()));
        images.push_back(std::move(image));
    }
    return images;
}

}  // namespace

Result<std::unique_ptr<ApiDriver>> ApiDriver::create(const ApiOptions& options) {
    std::unique_ptr<ApiDriver> driver(new ApiDriver);
    const Stopwatch watch;
    VnDeviceDesc desc{};
    desc.profile = options.profile;
    desc.threads = options.threads;
    desc.maxIsa = options.maxIsa;
    desc.skips = options.skips;
    desc.axes = options.axes;
    if (const VnResult result = vnCreateDevice(&desc, &driver->device_); result != VN_SUCCESS) {
        return apiError(nullptr, "vnCreateDevice", result);
    }
    VnDevice device_ = driver->device_;
    VERNIER_TRY_API(vnGetDeviceInfo(device_, &driver->info_));
    driver->startUp_ = watch.milliseconds();
    return driver;
}

ApiDriver::~ApiDriver() {
    vnDestroyDevice(device_);
}

std::string ApiDriver::version() const {
    return std::string(info_.version) + ", " + info_.isa + ", " + std::to_string(info_.threads) + " threads";
}

std::string ApiDriver::limits() const {
    return "subPixelPrecisionBits " + std::to_string(info_.subPixelBits) + "\nmaxImageDimension2D " +
           std::to_string(info_.maxImageSize) + "\n";
}

Result<std::vector<RenderedImage>> ApiDriver::render(const Scene& scene, Timing* timing) {
    const Stopwatch watch;
    VERNIER_TRY(validateScene(scene));
    ContextOwner owner;
    VERNIER_TRY_API(vnCreateContext(device_, nullptr, &owner.context));
    SceneRun run(device_, owner.context, scene);
    double pipelineTime = 0;
    VERNIER_TRY(run.prepare(pipelineTime));
    const Stopwatch firstFrame;
    VERNIER_TRY(run.runFrame());
    const double firstFrameTime = firstFrame.milliseconds();
    Result<std::vector<RenderedImage>> images = run.readBack();
    if (!images || timing == nullptr) return images;
    timing->startUp = startUp_;
    timing->pipelines = pipelineTime;
    timing->firstFrame = firstFrameTime;
    timing->firstImage = startUp_ + watch.milliseconds();
    const Result<FrameTimes> frames = measureFrames([&] { return run.runFrame(); });
    if (!frames) return frames.error();
    timing->frame = timing->warmFrame = frames.value().median;
    timing->frames = frames.value().count;
    Result<std::vector<std::string>> facts = run.notNeeded();
    if (!facts) return facts.error();
    notNeeded_ = std::move(facts).value();
    return images;
}

}  // namespace vernier::conformance
