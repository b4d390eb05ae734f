#include "conformance/drivers/driver.h"
#include "conformance/scene/scene_format.h"

#include <algorithm>

namespace vernier::conformance {
namespace {

constexpr uint32_t kMaxPatchVertices = 32;  // what every device with tessellation has

/// "scene 'x': what[i].field is value, must be below limit", or success. kNone passes when `optional`.
class Checker {
  public:
    explicit Checker(const Scene& scene) : scene_(scene) {}

    void index(std::string_view where, uint32_t value, size_t limit, bool optional = false) {
        if (value < limit || (optional && value == kNone)) return;
        fail(std::string(where) + " is " + (value == kNone ? "absent" : std::to_string(value)) + ", must be below " +
             std::to_string(limit));
    }

    void fail(const std::string& message) {
        if (status_.ok()) status_ = invalidArgument("scene '" + scene_.name + "': " + message);
    }

    Status status() const { return status_; }

  private:
    const Scene& scene_;
    Status status_;
};

std::string at(const char* list, size_t index, const char* field) {
    return std::string(list) + "[" + std::to_string(index) + "]." + field;
}

void checkImage(Checker& check, const SceneImage& image, size_t index) {
    const SceneFormat* format = sceneFormat(image.format);
    if (format == nullptr) {
        check.fail(at("images", index, "format") + " is " + std::to_string(image.format) + ", not one scenes may use");
        return;
    }
    const bool volume = image.viewType == VK_IMAGE_VIEW_TYPE_3D;
    if (image.depth == 0 || (!volume && image.depth != 1) || (volume && image.arrayLayers != 1)) {
        check.fail(at("images", index, "depth") + " is " + std::to_string(image.depth) +
                   ": only 3D images, which have one layer, have slices");
    }
    if (image.extent.width == 0 || image.extent.height == 0 || image.mipLevels == 0 || image.arrayLayers == 0) {
        check.fail(at("images", index, "extent") + ", mipLevels or arrayLayers is 0");
        return;
    }
    const size_t subresources = size_t{image.mipLevels} * image.arrayLayers;
    if (!image.data.empty() && image.data.size() != subresources) {
        check.fail(at("images", index, "data") + " has " + std::to_string(image.data.size()) + " entries, not " +
                   std::to_string(subresources));
    }
    for (size_t i = 0; i < image.data.size(); ++i) {
        const uint32_t mip = static_cast<uint32_t>(i / image.arrayLayers);
        const size_t bytes =
            format->imageBytes(std::max(1u, image.extent.width >> mip), std::max(1u, image.extent.height >> mip)) *
            std::max(1u, image.depth >> mip);
        if (!image.data[i].empty() && image.data[i].size() != bytes) {
            check.fail(at("images", index, "data") + " entry " + std::to_string(i) + " has " +
                       std::to_string(image.data[i].size()) + " bytes, not " + std::to_string(bytes));
        }
    }
}

void checkDraw(Checker& check, const Scene& scene, const ScenePass& pass, const SceneDraw& draw) {
    check.index("SceneDraw::pipeline", draw.pipeline, scene.pipelines.size());
    if (draw.pipeline >= scene.pipelines.size()) return;
    const ScenePipeline& pipeline = scene.pipelines[draw.pipeline];
    if (pipeline.blend.size() != pass.colors.size()) {
        check.fail("pipeline " + std::to_string(draw.pipeline) + " blends " + std::to_string(pipeline.blend.size()) +
                   " targets in a pass of " + std::to_string(pass.colors.size()));
    }
    if (draw.moreViews.size() > 15) check.fail("SceneDraw::moreViews has more than 15 entries");
    if (draw.pushConstants.size() > pipeline.pushConstantBytes) {
        check.fail("SceneDraw::pushConstants has " + std::to_string(draw.pushConstants.size()) +
                   " bytes, its pipeline takes " + std::to_string(pipeline.pushConstantBytes));
    }
    check.index("SceneDraw::indexBuffer", draw.indexBuffer, scene.buffers.size(), true);
    for (const SceneVertexBuffer& vertices : draw.vertexBuffers) {
        check.index("SceneVertexBuffer::buffer", vertices.buffer, scene.buffers.size());
    }
    for (const SceneBinding& binding : draw.bindings) {
        if (binding.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER) {
            check.index("SceneBinding::image", binding.image, scene.images.size());
            check.index("SceneBinding::sampler", binding.sampler, scene.samplers.size());
        } else if (binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ||
                   binding.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER) {
            check.index("SceneBinding::buffer", binding.buffer, scene.buffers.size());
        } else if (binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) {
            check.index("SceneBinding::image", binding.image, scene.images.size());
            if (binding.image < scene.images.size() && scene.images[binding.image].mipLevels != 1) {
                check.fail("storage image '" + scene.images[binding.image].name + "' has several levels");
            }
        } else if (binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER ||
                   binding.type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER) {
            check.index("SceneBinding::buffer", binding.buffer, scene.buffers.size());
            if (sceneFormat(binding.texelFormat) == nullptr) {
                check.fail("SceneBinding::texelFormat is " + std::to_string(binding.texelFormat) +
                           ", not one scenes may use");
            }
        } else {
            check.fail("SceneBinding::type is " + std::to_string(binding.type) + ", not one scenes may use");
        }
    }
}

void checkPipeline(Checker& check, const Scene& scene, size_t i) {
    const ScenePipeline& pipeline = scene.pipelines[i];
    const std::vector<std::array<uint8_t, 2>>& locations = pipeline.sampleLocations;
    if (!locations.empty() && locations.size() != static_cast<size_t>(pipeline.samples)) {
        check.fail(at("pipelines", i, "sampleLocations") + " has " + std::to_string(locations.size()) +
                   " entries for " + std::to_string(pipeline.samples) + " samples");
    }
    const bool patches = pipeline.topology == VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
    const auto shader = [&](const char* field, uint32_t index, bool optional) {
        check.index(at("pipelines", i, field), index, scene.shaders.size(), optional);
    };
    shader("vertexShader", pipeline.vertexShader, false);
    shader("controlShader", pipeline.controlShader, !patches);
    shader("evaluationShader", pipeline.evaluationShader, !patches);
    shader("geometryShader", pipeline.geometryShader, true);
    shader("fragmentShader", pipeline.fragmentShader, true);
    if (!patches && (pipeline.controlShader != kNone || pipeline.evaluationShader != kNone))
        check.fail(at("pipelines", i, "topology") + " is " + std::to_string(pipeline.topology) + ", not of patches");
    if (pipeline.patchVertices == 0 || pipeline.patchVertices > kMaxPatchVertices) {
        check.fail(at("pipelines", i, "patchVertices") + " is " + std::to_string(pipeline.patchVertices) +
                   ", must be 1 to " + std::to_string(kMaxPatchVertices));
    }
}

}  // namespace

Status validateScene(const Scene& scene) {
    Checker check(scene);
    const size_t images = scene.images.size();
    for (size_t i = 0; i < images; ++i) checkImage(check, scene.images[i], i);
    for (size_t i = 0; i < scene.buffers.size(); ++i) {
        if (scene.buffers[i].data.empty()) check.fail(at("buffers", i, "data") + " is empty");
    }
    for (size_t i = 0; i < scene.shaders.size(); ++i) {
        if (scene.shaders[i].spirv.empty()) check.fail(at("shaders", i, "spirv") + " is empty");
    }
    for (size_t i = 0; i < scene.pipelines.size(); ++i) checkPipeline(check, scene, i);
    for (const SceneStep& step : scene.steps) {
        if (const auto* pass = std::get_if<ScenePass>(&step)) {
            const auto layers = [&](const SceneAttachment& attachment) {
                if (attachment.image < images &&
                    (attachment.layerCount == 0 ||
                     attachment.layer + attachment.layerCount > scene.images[attachment.image].arrayLayers)) {
                    check.fail("SceneAttachment::layerCount is " + std::to_string(attachment.layerCount) +
                               " from layer " + std::to_string(attachment.layer) + " of image '" +
                               scene.images[attachment.image].name + "'");
                }
            };
            layers(pass->depthStencil);
            check.index("ScenePass::depthStencil resolveImage", pass->depthStencil.resolveImage, images, true);
            for (const SceneAttachment& color : pass->colors) {
                layers(color);
                check.index("ScenePass::colors image", color.image, images);
                check.index("SceneAttachment::resolveImage", color.resolveImage, images, true);
            }
            check.index("ScenePass::depthStencil image", pass->depthStencil.image, images, true);
            for (const SceneDraw& draw : pass->draws) checkDraw(check, scene, *pass, draw);
        } else if (const auto* mips = std::get_if<SceneGenerateMips>(&step)) {
            check.index("SceneGenerateMips::image", mips->image, images);
        } else if (const auto* copy = std::get_if<SceneCopyImage>(&step)) {
            check.index("SceneCopyImage::source", copy->source, images);
            check.index("SceneCopyImage::destination", copy->destination, images);
        } else if (const auto* blit = std::get_if<SceneBlitImage>(&step)) {
            check.index("SceneBlitImage::source", blit->source, images);
            check.index("SceneBlitImage::destination", blit->destination, images);
        }
    }
    if (scene.outputs.empty()) check.fail("no outputs");
    for (const uint32_t output : scene.outputs) {
        check.index("outputs", output, images);
        if (output < images && sceneFormat(scene.images[output].format) != nullptr &&
            sceneFormat(scene.images[output].format)->componentCount == 0) {
            check.fail("output image '" + scene.images[output].name + "' has a format without components of its own");
        }
        if (output < images && scene.images[output].samples != VK_SAMPLE_COUNT_1_BIT) {
            check.fail("output image '" + scene.images[output].name + "' is multisampled");
        }
    }
    return check.status();
}

}  // namespace vernier::conformance
