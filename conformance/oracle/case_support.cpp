#include "conformance/oracle/case_support.h"

#include "conformance/scenes/recorder.h"

#include <cmath>
#include <cstring>

namespace vernier::conformance::cases {

namespace {

const char* const kPositionVertexGlsl = R"(#version 450
layout(location = 0) in vec4 position;
void main() { gl_Position = position; }
)";

const char* const kCountFragmentGlsl = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(16.0 / 255.0, 0.0, 0.0, 0.0); }
)";

}  // namespace

ClipPosition clipOnGrid(const GridPoint& p, const VkViewport& viewport) {
    const double x = static_cast<double>(p.x) / 256 - viewport.x, y = static_cast<double>(p.y) / 256 - viewport.y;
    return {static_cast<float>(x * 2 / viewport.width - 1), static_cast<float>(y * 2 / viewport.height - 1), 0.5f,
            1.0f};
}

Result<Scene> coverageScene(std::string_view name, std::span<const ClipPosition> positions, VkExtent2D extent,
                            const VkViewport& viewport) {
    SceneRecorder record(name, "Additive coverage counts.");
    const uint32_t target = record.colorTarget("counts", VK_FORMAT_R8G8B8A8_UNORM, extent);
    const uint32_t vertices = record.vertexBuffer("positions", positions);
    VkPipelineColorBlendAttachmentState add{};
    add.blendEnable = VK_TRUE;
    add.srcColorBlendFactor = add.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    add.srcAlphaBlendFactor = add.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    add.colorWriteMask = 0xf;
    const uint32_t pipeline = record.pipeline(record.vertex(kPositionVertexGlsl), record.fragment(kCountFragmentGlsl))
                                  .binding(sizeof(ClipPosition))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                  .blend(add);
    record.pass(extent).color(target, {0, 0, 0, 0});
    record.draw(pipeline, static_cast<uint32_t>(positions.size()))
        .vertices(vertices)
        .viewport(viewport.x, viewport.y, viewport.width, viewport.height);
    record.output(target);
    return record.finish();
}

Result<Scene> coverageScene(std::string_view name, std::span<const GridTriangle> triangles, VkExtent2D extent) {
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    std::vector<ClipPosition> positions;
    for (const GridTriangle& t : triangles) {
        for (const GridPoint& p : t) positions.push_back(clipOnGrid(p, viewport));
    }
    return coverageScene(name, positions, extent, viewport);
}

Result<std::vector<uint32_t>> coverageCounts(const RenderedImage& image, VkExtent2D extent) {
    if (image.format != VK_FORMAT_R8G8B8A8_UNORM || image.extent.width != extent.width ||
        image.extent.height != extent.height || image.texels.size() != size_t{extent.width} * extent.height * 4) {
        return invalidArgument("coverage image has the wrong format or extent");
    }
    std::vector<uint32_t> counts;
    for (size_t i = 0; i < image.texels.size(); i += 4) {
        const auto red = std::to_integer<uint32_t>(image.texels[i]);
        const bool clean = image.texels[i + 1] == std::byte{0} && image.texels[i + 2] == std::byte{0};
        if (red % kCountStep != 0 || !clean) {
            const auto pixel = static_cast<uint32_t>(i / 4);
            return invalidArgument(pixelText(pixel % extent.width, pixel / extent.width) + ": red code " +
                                   std::to_string(red) + " is no sum of exact additions of 16/255");
        }
        counts.push_back(red / kCountStep);
    }
    return counts;
}

uint64_t codeAt(const RenderedImage& image, const exact::PixelFormat& format, uint32_t x, uint32_t y, uint8_t channel) {
    const exact::Component* component = format.channel(channel);
    if (!component) return 0;
    const size_t offset = (size_t{y} * image.extent.width + x) * format.bytes;
    return exact::extractBits(image.texels.data() + offset, component->offset, component->bits);
}

Status checkShape(const CaseImages& images, size_t scenes, size_t outputs, VkExtent2D extent) {
    if (images.size() != scenes) {
        return invalidArgument(std::to_string(images.size()) + " results for " + std::to_string(scenes) + " scenes");
    }
    for (const auto& list : images) {
        if (list.size() != outputs) return invalidArgument("a scene gave " + std::to_string(list.size()) + " images");
        for (const RenderedImage& image : list) {
            const exact::PixelFormat* format = exact::findPixelFormat(image.format);
            if (!format || image.extent.width != extent.width || image.extent.height != extent.height ||
                image.texels.size() != size_t{extent.width} * extent.height * format->bytes) {
                return invalidArgument("an image has the wrong format, extent or size");
            }
        }
    }
    return {};
}

Status verdict(std::string_view name, const std::string& wrong) {
    if (wrong.empty()) return {};
    return invalidArgument(std::string(name).append(": ").append(wrong));
}

std::string pixelText(uint32_t x, uint32_t y) {
    return std::string("pixel (").append(std::to_string(x)).append(", ").append(std::to_string(y)).append(")");
}

Tiling jitteredTiling(uint32_t cells, double cellPixels, double jitterPixels, double resolution, uint32_t seed) {
    std::mt19937 random(seed);
    const auto jitter = [&] {
        const double unit = static_cast<double>(random()) / 4294967296.0;
        return std::floor((unit * 2 - 1) * jitterPixels * resolution) / resolution;
    };
    Tiling tiling;
    for (uint32_t y = 0; y <= cells; ++y) {
        for (uint32_t x = 0; x <= cells; ++x) {
            const double dx = jitter(), dy = jitter();
            tiling.points.push_back({(x + 0.5) * cellPixels + dx, (y + 0.5) * cellPixels + dy});
        }
    }
    const size_t row = cells + 1;
    for (size_t y = 0; y < cells; ++y) {
        for (size_t x = 0; x < cells; ++x) {
            const size_t a = y * row + x, b = a + 1, c = a + row, d = c + 1;
            if (random() & 1) {
                tiling.triangles.push_back({a, b, c});
                tiling.triangles.push_back({d, c, b});
            } else {
                tiling.triangles.push_back({a, b, d});
                tiling.triangles.push_back({c, a, d});
            }
        }
    }
    return tiling;
}

}  // namespace vernier::conformance::cases
