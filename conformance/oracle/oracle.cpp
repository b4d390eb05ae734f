#include "conformance/oracle/oracle.h"

#include "conformance/oracle/image_store.h"
#include "conformance/oracle/pass_renderer.h"
#include "conformance/oracle/texture_unit.h"

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

StoredTexel storeFiltered(const ImageStore& target, const exact::SampleResult& result) {
    return {exact::quantiseColor(target.format(), result.color), result.flags};
}

void generateMips(ImageStore& image) {
    for (uint32_t mip = 1; mip < image.mipLevels(); ++mip) {
        for (uint32_t layer = 0; layer < image.arrayLayers(); ++layer) {
            const VkExtent2D from = image.level(mip - 1, layer).extent;
            ImageLevel& to = image.level(mip, layer);
            for (uint32_t y = 0; y < to.extent.height; ++y) {
                for (uint32_t x = 0; x < to.extent.width; ++x) {
                    const double u = (x + 0.5) * from.width / to.extent.width;
                    const double v = (y + 0.5) * from.height / to.extent.height;
                    to.at(x, y) = storeFiltered(image, exact::blitTexel(image, mip - 1, layer, u, v, VK_FILTER_LINEAR));
                }
            }
        }
    }
}

Status copyImage(const SceneCopyImage& copy, std::vector<ImageStore>& images) {
    const ImageStore source = images[copy.source];  // a copy: source and destination may be the same image
    ImageStore& destination = images[copy.destination];
    if (source.format().format != destination.format().format) {
        return unsupported("oracle: a copy between images of different formats");
    }
    const VkImageCopy& r = copy.region;
    for (uint32_t layer = 0; layer < r.srcSubresource.layerCount; ++layer) {
        const ImageLevel& from = source.level(r.srcSubresource.mipLevel, r.srcSubresource.baseArrayLayer + layer);
        ImageLevel& to = destination.level(r.dstSubresource.mipLevel, r.dstSubresource.baseArrayLayer + layer);
        for (uint32_t y = 0; y < r.extent.height; ++y) {
            for (uint32_t x = 0; x < r.extent.width; ++x) {
                const uint32_t sx = static_cast<uint32_t>(r.srcOffset.x) + x,
                               sy = static_cast<uint32_t>(r.srcOffset.y) + y;
                const uint32_t dx = static_cast<uint32_t>(r.dstOffset.x) + x,
                               dy = static_cast<uint32_t>(r.dstOffset.y) + y;
                if (sx >= from.extent.width || sy >= from.extent.height || dx >= to.extent.width ||
                    dy >= to.extent.height) {
                    return invalidArgument("oracle: a copy region reaches outside its image");
                }
                for (uint32_t s = 0; s < std::min(from.samples, to.samples); ++s) to.at(dx, dy, s) = from.at(sx, sy, s);
            }
        }
    }
    return {};
}

Status blitImage(const SceneBlitImage& blit, std::vector<ImageStore>& images) {
    const ImageStore source = images[blit.source];
    ImageStore& destination = images[blit.destination];
    const VkImageBlit& r = blit.region;
    const auto [s0, s1] = std::pair{r.srcOffsets[0], r.srcOffsets[1]};
    const auto [d0, d1] = std::pair{r.dstOffsets[0], r.dstOffsets[1]};
    if (d0.x == d1.x || d0.y == d1.y) return {};
    const double scaleX = static_cast<double>(s1.x - s0.x) / (d1.x - d0.x);
    const double scaleY = static_cast<double>(s1.y - s0.y) / (d1.y - d0.y);
    for (uint32_t layer = 0; layer < r.srcSubresource.layerCount; ++layer) {
        ImageLevel& to = destination.level(r.dstSubresource.mipLevel, r.dstSubresource.baseArrayLayer + layer);
        const auto [left, right] = std::minmax(d0.x, d1.x);
        const auto [top, bottom] = std::minmax(d0.y, d1.y);
        if (left < 0 || top < 0 || static_cast<uint32_t>(right) > to.extent.width ||
            static_cast<uint32_t>(bottom) > to.extent.height) {
            return invalidArgument("oracle: a blit region reaches outside its image");
        }
        for (int32_t y = top; y < bottom; ++y) {
            for (int32_t x = left; x < right; ++x) {
                const double u = s0.x + (x + 0.5 - d0.x) * scaleX, v = s0.y + (y + 0.5 - d0.y) * scaleY;
                const auto texel = exact::blitTexel(source, r.srcSubresource.mipLevel,
                                                    r.srcSubresource.baseArrayLayer + layer, u, v, blit.filter);
                to.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) = storeFiltered(destination, texel);
            }
        }
    }
    return {};
}

Status execute(const Scene& scene, const SceneStep& step, const OracleRules& rules, std::vector<ImageStore>& images) {
    if (const auto* pass = std::get_if<ScenePass>(&step)) return exact::renderPass(scene, *pass, rules, images);
    const auto* mips = std::get_if<SceneGenerateMips>(&step);
    const auto* copied = std::get_if<SceneCopyImage>(&step);
    const auto* scaled = std::get_if<SceneBlitImage>(&step);
    for (const uint32_t used :
         {mips ? mips->image : kNone, copied ? copied->source : kNone, copied ? copied->destination : kNone,
          scaled ? scaled->source : kNone, scaled ? scaled->destination : kNone}) {
        if (used != kNone && images[used].kind() == exact::ImageKind::volume)
            return unsupported("oracle: transfers of 3D images");
    }
    if (const auto* copy = std::get_if<SceneCopyImage>(&step)) return copyImage(*copy, images);
    if (const auto* blit = std::get_if<SceneBlitImage>(&step)) return blitImage(*blit, images);
    generateMips(images[std::get<SceneGenerateMips>(step).image]);
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
    std::vector<ImageStore> images;
    for (const SceneImage& image : scene.images) {
        auto store = ImageStore::create(image);
        if (!store) return store.error();
        images.push_back(std::move(*store));
    }
    for (const SceneStep& step : scene.steps) {
        if (Status s = execute(scene, step, rules, images); !s) return s.error();
    }
    std::vector<OracleImage> outputs;
    for (const uint32_t output : scene.outputs) outputs.push_back(readBack(images[output]));
    return outputs;
}

}  // namespace vernier::conformance
