#include "tests/raster/harness.h"

#include <map>
#include <span>

#include "shaders/all_shaders.h"

namespace vernier::raster_test {
namespace {

constexpr uint32_t kPadding = 8;  // attachments are padded to whole blocks

uint32_t padded(uint32_t size) {
    return (size + kPadding - 1) / kPadding * kPadding;
}

}  // namespace

ir::Program loadForTest(const std::string& name, ir::Stage stage) {
    ShaderSource source;
    source.words = kShaders.at(name);
    source.stage = stage;
    Result<ir::Program> program = loadShader(source);
    if (!program) {
        ADD_FAILURE() << name << ": " << program.error().message;
        std::abort();
    }
    return std::move(*program);
}

TessellationModes modesForTest(const std::string& name, ir::Stage stage) {
    ShaderSource source;
    source.words = kShaders.at(name);
    source.stage = stage;
    return tessellationModes(source).value();
}

Surface::Surface(VkFormat format, uint32_t width, uint32_t height, uint32_t samples)
    : info_(findFormat(format)),
      width_(width),
      height_(height),
      samples_(samples),
      rowPitch_(padded(width) * info_->bytesPerTexel),
      samplePitch_(size_t{rowPitch_} * padded(height)),
      memory_(samplePitch_ * samples) {}

RenderTarget Surface::target() {
    RenderTarget target;
    target.format = info_->format;
    target.data = memory_.data();
    target.rowPitch = rowPitch_;
    target.samplePitch = samplePitch_;
    target.layerPitch = memory_.size();
    target.extent = {width_, height_};
    target.samples = samples_;
    return target;
}

RenderTarget Surface::cleared(const VkClearValue& value) {
    RenderTarget result = target();
    result.loadOp = result.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    result.clear = value;
    return result;
}

std::byte* Surface::texel(uint32_t x, uint32_t y, uint32_t sample) {
    return memory_.data() + sample * samplePitch_ + size_t{y} * rowPitch_ + size_t{x} * info_->bytesPerTexel;
}

VkClearColorValue Surface::color(uint32_t x, uint32_t y, uint32_t sample) {
    return unpackTexel(info_->color, texel(x, y, sample));
}

float Surface::depth(uint32_t x, uint32_t y, uint32_t sample) {
    return unpackTexel(info_->depth, texel(x, y, sample)).float32[0];
}

uint32_t Surface::stencil(uint32_t x, uint32_t y, uint32_t sample) {
    return unpackTexel(info_->stencil, texel(x, y, sample)).uint32[0];
}

int Surface::otherThan(float cleared) {
    int count = 0;
    for (uint32_t y = 0; y < height_; ++y)
        for (uint32_t x = 0; x < width_; ++x) count += red(x, y) != cleared;
    return count;
}

uint64_t Surface::hash() {
    uint64_t hash = 14695981039346656037u;  // FNV-1a
    for (uint32_t s = 0; s < samples_; ++s)
        for (uint32_t y = 0; y < height_; ++y)
            for (size_t b = 0; b < size_t{width_} * info_->bytesPerTexel; ++b)
                hash = (hash ^ static_cast<uint64_t>(texel(0, y, s)[b])) * 1099511628211u;
    return hash;
}

Vertex at(double x, double y, uint32_t width, uint32_t height, std::array<float, 4> color, float z) {
    return {{static_cast<float>(2 * x / width - 1), static_cast<float>(2 * y / height - 1), z, 1}, color};
}

GraphicsState plainState(VkFormat color, VkFormat depth) {
    GraphicsState state;
    state.vertexBindings = {{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX}};
    state.vertexAttributes = {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, position)},
                              {1, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, color)}};
    state.colorCount = color == VK_FORMAT_UNDEFINED ? 0 : 1;
    state.colorFormats[0] = color;
    for (auto& blend : state.blend) blend.colorWriteMask = 0xF;
    state.depthStencilFormat = depth;
    return state;
}

void setAdditive(GraphicsState& state) {
    auto& blend = state.blend[0];
    blend.blendEnable = VK_TRUE;
    blend.srcColorBlendFactor = blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    blend.srcAlphaBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
}

std::shared_ptr<const GraphicsPipeline> makePipeline(const PipelineOptions& options) {
    const ir::Program vertex = loadForTest(options.vertex, ir::Stage::vertex);
    ir::Program control, evaluation, geometry, fragment;
    ShaderProgramDesc desc;
    if (!options.control.empty()) {
        control = loadForTest(options.control, ir::Stage::control);
        evaluation = loadForTest(options.evaluation, ir::Stage::evaluation);
        desc.control = &control;
        desc.evaluation = &evaluation;
        desc.tessellation = joined(modesForTest(options.control, ir::Stage::control),
                                   modesForTest(options.evaluation, ir::Stage::evaluation));
        desc.patchControlPoints = options.state.patchControlPoints;
    }
    if (!options.geometry.empty()) geometry = loadForTest(options.geometry, ir::Stage::geometry);
    if (!options.fragment.empty()) fragment = loadForTest(options.fragment, ir::Stage::fragment);
    desc.vertex = &vertex;
    desc.geometry = options.geometry.empty() ? nullptr : &geometry;
    desc.fragment = options.fragment.empty() ? nullptr : &fragment;
    desc.accuracy = options.accuracy;
    desc.isa = options.isa;
    desc.skips = options.skips;
    auto program = ShaderProgram::create(desc);
    if (!program) {
        ADD_FAILURE() << program.error().message;
        std::abort();
    }
    auto pipeline = GraphicsPipeline::create({options.state, *program});
    if (!pipeline) {
        ADD_FAILURE() << pipeline.error().message;
        std::abort();
    }
    return *pipeline;
}

DynamicState dynamicFor(uint32_t width, uint32_t height) {
    DynamicState dynamic;
    dynamic.viewports[0] = {0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1};
    dynamic.scissors[0] = {{0, 0}, {width, height}};
    return dynamic;
}

Pass::Pass(ThreadPool& pool, std::vector<RenderTarget> colors, RenderTarget depth, uint32_t width, uint32_t height,
           uint32_t samples)
    : workers_(pool), pass_(workers_) {
    targets_.colorCount = static_cast<uint32_t>(colors.size());
    for (size_t n = 0; n < colors.size(); ++n) targets_.colors[n] = colors[n];
    targets_.depthStencil = depth;
    targets_.renderArea = {{0, 0}, {width, height}};
    targets_.samples = samples;
}

void Pass::draw(std::shared_ptr<const GraphicsPipeline> pipeline, const DynamicState& dynamic,
                const std::vector<Vertex>& vertices, const std::vector<uint32_t>& indices, uint32_t instances) {
    Kept& kept = *kept_.emplace_back(new Kept{std::move(pipeline), dynamic, vertices, indices});
    DrawCall call;
    call.pipeline = kept.pipeline.get();
    call.dynamic = &kept.dynamic;
    call.vertexStreams[0] = {reinterpret_cast<const std::byte*>(kept.vertices.data()),
                             kept.vertices.size() * sizeof(Vertex)};
    call.count = static_cast<uint32_t>(kept.vertices.size());
    call.instances = instances;
    if (!kept.indices.empty()) {
        call.indices = {reinterpret_cast<const std::byte*>(kept.indices.data()), kept.indices.size() * 4,
                        VK_INDEX_TYPE_UINT32};
        call.count = static_cast<uint32_t>(kept.indices.size());
    }
    pass_.draw(call);
}

}  // namespace vernier::raster_test
