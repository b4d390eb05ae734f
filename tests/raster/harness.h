// Draws with the rasteriser alone: targets in plain memory, pipelines from embedded shaders.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/format/format.h"
#include "runtime/plan/plan.h"
#include "runtime/raster/render_pass.h"
#include "runtime/raster/render_workers.h"

namespace vernier::raster_test {

/// An attachment in memory of exactly the padded size, so that ASan sees any access outside.
class Surface {
  public:
    Surface(VkFormat format, uint32_t width, uint32_t height, uint32_t samples = 1);
    RenderTarget target();
    /// Clears on load to this.
    RenderTarget cleared(const VkClearValue& value);
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    std::byte* texel(uint32_t x, uint32_t y, uint32_t sample = 0);
    VkClearColorValue color(uint32_t x, uint32_t y, uint32_t sample = 0);
    float red(uint32_t x, uint32_t y, uint32_t sample = 0) { return color(x, y, sample).float32[0]; }
    float depth(uint32_t x, uint32_t y, uint32_t sample = 0);
    uint32_t stencil(uint32_t x, uint32_t y, uint32_t sample = 0);
    /// How many pixels have another red, as those do that were drawn to where it was cleared to this.
    int otherThan(float cleared);
    /// Of everything inside the extent.
    uint64_t hash();

  private:
    const FormatInfo* info_;
    uint32_t width_, height_, samples_, rowPitch_;
    size_t samplePitch_;
    std::vector<std::byte> memory_;
};

struct Vertex {
    std::array<float, 4> position;
    std::array<float, 4> color{1, 1, 1, 1};
};

/// Pixels to clip coordinates of a viewport of the given size, w = 1.
Vertex at(double x, double y, uint32_t width, uint32_t height, std::array<float, 4> color = {1, 1, 1, 1},
          float z = 0.5f);

/// A pipeline with one vertex buffer of Vertex (locations 0 and 1). Empty names: no such stage.
struct PipelineOptions {
    std::string vertex = "color_vert", geometry, fragment = "color_frag";
    std::string control, evaluation;
    GraphicsState state;
    Accuracy accuracy;
    Isa isa = bestIsa();
    Skips skips;
};

/// State for one colour attachment, no blending, everything written.
GraphicsState plainState(VkFormat color, VkFormat depth = VK_FORMAT_UNDEFINED);
void setAdditive(GraphicsState& state);

/// A shader by its name.
ir::Program loadForTest(const std::string& name, ir::Stage stage);
TessellationModes modesForTest(const std::string& name, ir::Stage stage);

std::shared_ptr<const GraphicsPipeline> makePipeline(const PipelineOptions& options);

DynamicState dynamicFor(uint32_t width, uint32_t height);

/// One pass over the given surfaces.
class Pass {
  public:
    Pass(ThreadPool& pool, std::vector<RenderTarget> colors, RenderTarget depth, uint32_t width, uint32_t height,
         uint32_t samples = 1);
    PassTargets& targets() { return targets_; }
    void begin() { pass_.begin(targets_); }
    /// Draws non-indexed, or indexed when there are indices. Keeps what it needs alive.
    void draw(std::shared_ptr<const GraphicsPipeline> pipeline, const DynamicState& dynamic,
              const std::vector<Vertex>& vertices, const std::vector<uint32_t>& indices = {}, uint32_t instances = 1);
    RenderPass& pass() { return pass_; }
    void end() { ASSERT_TRUE(pass_.end()); }

  private:
    struct Kept {
        std::shared_ptr<const GraphicsPipeline> pipeline;
        DynamicState dynamic;
        std::vector<Vertex> vertices;
        std::vector<uint32_t> indices;
    };
    PassTargets targets_;
    RenderWorkers workers_;
    RenderPass pass_;
    std::vector<std::unique_ptr<Kept>> kept_;
};

}  // namespace vernier::raster_test
