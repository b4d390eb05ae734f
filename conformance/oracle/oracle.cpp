#include "conformance/oracle/oracle.h"

#include "conformance/oracle/image_store.h"
#include "conformance/oracle/memory.h"
#include "conformance/oracle/pass_renderer.h"
#include "conformance/oracle/transfers.h"

#include <algorithm>
#include <string>

namespace vernier::conformance {

namespace {

using exact::ImageLevel;
using exact::ImageStore;
using exact::StoredTexel;

// Everything that an index of the scene may name is checked once, before anything is executed.
class SceneCheck {
  public:
    explicit SceneCheck(const Scene& scene) : scene_(scene) {}

    Status run() {
        for (size_t i = 0; i < scene_.pipelines.size(); ++i) checkPipeline(i);
        for (const SceneStep& step : scene_.steps) {
            if (const auto* pass = std::get_if<ScenePass>(&step)) checkPass(*pass);
            if (const auto* mips = std::get_if<SceneGenerateMips>(&step)) image(mips->image, "mip generation");
            if (const auto* copy = std::get_if<SceneCopyImage>(&step)) {
                image(copy->source, "copy source");
                image(copy->destination, "copy destination");
            }
            if (const auto* blit = std::get_if<SceneBlitImage>(&step)) {
                image(blit->source, "blit source");
                image(blit->destination, "blit destination");
            }
        }
        for (const uint32_t output : scene_.outputs) image(output, "output");
        return status_;
    }

  private:
    void fail(const std::string& message) {
        if (status_.ok()) status_ = invalidArgument("oracle: scene '" + scene_.name + "': " + message);
    }
    void index(uint32_t value, size_t size, const char* what) {
        if (value >= size) fail(std::string(what) + " " + std::to_string(value) + " does not exist");
    }
    void image(uint32_t value, const char* what) { index(value, scene_.images.size(), what); }

    void checkPipeline(size_t i) {
        const ScenePipeline& pipeline = scene_.pipelines[i];
        index(pipeline.vertexShader, scene_.shaders.size(), "vertex shader");
        const bool patches = pipeline.topology == VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
        if (patches || pipeline.controlShader != kNone)
            index(pipeline.controlShader, scene_.shaders.size(), "control shader");
        if (patches || pipeline.evaluationShader != kNone)
            index(pipeline.evaluationShader, scene_.shaders.size(), "evaluation shader");
        if (patches != (pipeline.controlShader != kNone)) fail("tessellation shaders without patches");
        if (patches && (pipeline.patchVertices == 0 || pipeline.patchVertices > 32))
            fail("patches of " + std::to_string(pipeline.patchVertices) + " vertices");
        if (pipeline.geometryShader != kNone) index(pipeline.geometryShader, scene_.shaders.size(), "geometry shader");
        if (pipeline.fragmentShader != kNone) index(pipeline.fragmentShader, scene_.shaders.size(), "fragment shader");
    }

    void checkAttachment(const SceneAttachment& a, VkExtent2D extent) {
        image(a.image, "attachment image");
        if (!status_.ok()) return;
        const SceneImage& target = scene_.images[a.image];
        index(a.mipLevel, target.mipLevels, "attachment level");
        index(a.layer, target.arrayLayers, "attachment layer");
        if (extent.width > std::max(1u, target.extent.width >> a.mipLevel) ||
            extent.height > std::max(1u, target.extent.height >> a.mipLevel)) {
            fail("the pass is larger than attachment '" + target.name + "'");
        }
        if (a.resolveImage == kNone) return;
        image(a.resolveImage, "resolve image");
        if (status_.ok() && (scene_.images[a.resolveImage].extent.width < extent.width ||
                             scene_.images[a.resolveImage].extent.height < extent.height)) {
            fail("the pass is larger than resolve image '" + scene_.images[a.resolveImage].name + "'");
        }
    }

    void checkPass(const ScenePass& pass) {
        for (const SceneAttachment& a : pass.colors) checkAttachment(a, pass.extent);
        if (pass.depthStencil.image != kNone) checkAttachment(pass.depthStencil, pass.extent);
        for (const SceneDraw& draw : pass.draws) {
            index(draw.pipeline, scene_.pipelines.size(), "pipeline");
            if (draw.indexBuffer != kNone) index(draw.indexBuffer, scene_.buffers.size(), "index buffer");
        }
    }

    const Scene& scene_;
    Status status_;
};

Status execute(const Scene& scene, const SceneStep& step, const OracleRules& rules, exact::Memory& memory) {
    if (const auto* pass = std::get_if<ScenePass>(&step)) return exact::renderPass(scene, *pass, rules, memory);
    if (const auto* copy = std::get_if<SceneCopyImage>(&step)) return exact::copyImage(*copy, memory.images);
    if (const auto* blit = std::get_if<SceneBlitImage>(&step)) return exact::blitImage(*blit, rules, memory.images);
    exact::generateMips(memory.images[std::get<SceneGenerateMips>(step).image]);
    return {};
}

OracleImage readBack(const ImageStore& image) {
    const ImageLevel& level = image.level(0, 0);
    OracleImage result{image.format().format, level.extent, {}};
    for (uint32_t y = 0; y < level.extent.height; ++y) {
        for (uint32_t x = 0; x < level.extent.width; ++x) {
            const StoredTexel& texel = level.at(x, y);
            OraclePixel pixel{};
            for (size_t c = 0; c < 4; ++c) {
                pixel.value[c] = texel.channels[c].value;
                pixel.low[c] = texel.channels[c].low;
                pixel.high[c] = texel.channels[c].high;
            }
            pixel.flags = texel.flags;
            result.pixels.push_back(pixel);
        }
    }
    return result;
}

}  // namespace

Result<std::vector<OracleImage>> renderOracle(const Scene& scene, const OracleRules& rules) {
    if (Status s = SceneCheck(scene).run(); !s) return s.error();
    exact::Memory memory;
    for (const SceneImage& image : scene.images) {
        auto store = ImageStore::create(image);
        if (!store) return store.error();
        memory.images.push_back(std::move(*store));
    }
    for (const SceneStep& step : scene.steps) {
        if (Status s = execute(scene, step, rules, memory); !s) return s.error();
    }
    std::vector<OracleImage> outputs;
    for (const uint32_t output : scene.outputs) outputs.push_back(readBack(memory.images[output]));
    return outputs;
}

}  // namespace vernier::conformance
