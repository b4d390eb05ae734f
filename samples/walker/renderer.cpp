#include "samples/walker/renderer.h"

namespace samples {
namespace {

const std::string kPush = R"(
layout(push_constant) uniform Push {
    mat4 transform;
    vec2 size;    // of the picture, in pixels
    float scale;  // pixels per unit at distance 1
    float shear;
};
)";

// Pixels to clip space.
const std::string kColumnVertex = "#version 450\n" + kPush + R"(
layout(location = 0) in vec2 pixel;
layout(location = 1) in uint info;
layout(location = 2) in float depth;
layout(location = 0) flat out uint number;
layout(location = 1) flat out float value;
void main() {
    number = info;
    value = depth;
    gl_Position = vec4(pixel / size * 2 - 1, 0, 1);
})";

const std::string kSolidVertex = "#version 450\n" + kPush + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in uint info;
layout(location = 2) in vec2 alongWall;
layout(location = 0) flat out uint number;
layout(location = 1) out vec2 along;
void main() {
    number = info;
    along = alongWall;
    gl_Position = transform * vec4(position, 1);
})";

// The colour of a surface at a distance: its own tint, and darkness that grows.
const std::string kShade = R"(
vec3 shade(uint surface, float far) {
    uint sector = surface >> 4, kind = surface & 7u;
    uint mixed = (sector + 11u) * 2654435761u;
    vec3 tint = 0.75 + 0.25 * vec3(mixed >> 8 & 255u, mixed >> 16 & 255u, mixed >> 24) / 255.0;
    const vec3 colors[5] = vec3[](vec3(0.22, 0.24, 0.32), vec3(0.3, 0.25, 0.2), vec3(0.62, 0.52, 0.4),
                                  vec3(0.42, 0.3, 0.24), vec3(0.36, 0.4, 0.3));
    return colors[min(kind, 4u)] * tint / (1 + far * far * 0.0006 + far * 0.012);
}
)";

const std::string kColumnColors = "#version 450\n" + kPush + kShade + R"(
layout(location = 0) flat in uint number;
layout(location = 1) flat in float value;
layout(location = 0) out vec4 color;
void main() {
    float far = value;
    if ((number & 7u) < 2u) far = value * scale / (size.y * 0.5 - gl_FragCoord.y - shear * scale);
    color = vec4(shade(number, abs(far)) * ((number & 8u) != 0u ? 0.3 : 1.0), 1);
})";

const std::string kSolidColors = "#version 450\n" + kPush + kShade + R"(
layout(location = 0) flat in uint number;
layout(location = 1) in vec2 along;
layout(location = 0) out vec4 color;
void main() {
    vec3 result = shade(number, 1 / gl_FragCoord.w);
    float pixel = fwidth(along.x);
    if ((number & 7u) > 1u && min(along.x, along.y - along.x) < pixel) result *= 0.3;
    color = vec4(result, 1);
})";

const std::string kNumbers = R"(#version 450
layout(location = 0) flat in uint number;
layout(location = 0) out uint result;
void main() { result = (number & ~8u) + 1u; })";

struct Push {
    glm::mat4 transform;
    glm::vec2 size;
    float scale, shear;
};

}  // namespace

WalkerRenderer::WalkerRenderer(App& app, const Map& map) : app_(app), map_(map) {
    columns_ = {app.program(kColumnVertex, kColumnColors), app.program(kColumnVertex, kNumbers)};
    solid_ = {app.program(kSolidVertex, kSolidColors), app.program(kSolidVertex, kNumbers)};
    columnLayout_ = app.layout({{0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ColumnVertex, x)},
                                {1, 0, VK_FORMAT_R32_UINT, offsetof(ColumnVertex, number)},
                                {2, 0, VK_FORMAT_R32_SFLOAT, offsetof(ColumnVertex, depth)}},
                               {{sizeof(ColumnVertex), 0}});
    solidLayout_ = app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(SolidVertex, position)},
                               {1, 0, VK_FORMAT_R32_UINT, offsetof(SolidVertex, number)},
                               {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(SolidVertex, wall)}},
                              {{sizeof(SolidVertex), 0}});
    const std::vector<SolidVertex> solid = solidOf(map);
    triangles_ = app.buffer(solid);
    triangleVertices_ = static_cast<uint32_t>(solid.size());
    depth_ = app.depthState();
    VnRasterStateDesc front{};
    front.cullMode = VK_CULL_MODE_BACK_BIT;
    front.frontFace = VK_FRONT_FACE_CLOCKWISE;
    must(vnCreateRasterState(app.device(), &front, &front_));
}

void WalkerRenderer::beginPass(const Target* numbers) {
    if (numbers)
        app_.beginPass({*numbers}, app_.depth(), glm::vec4(0));
    else
        app_.beginPass({0, 0, 0, 1});
}

void WalkerRenderer::pushAndBind(const Version& version, const View& view, const Target* numbers) {
    app_.push(Push{clipTransform(view), glm::vec2(view.width, view.height), static_cast<float>(view.scale()),
                   static_cast<float>(view.shear)});
    vnBindProgram(app_.context(), numbers ? version.numbers : version.colors);
}

void WalkerRenderer::drawColumns(const View& view, const Target* numbers) {
    VnContext context = app_.context();
    const std::vector<ColumnVertex> lines = samples::drawColumns(map_, view, &statistics_);
    if (lines.size() > lineCapacity_) {
        if (lines_.id) vnDestroyBuffer(app_.device(), lines_);
        lineCapacity_ = lines.size() * 2;
        lines_ = app_.buffer(std::vector<ColumnVertex>(lineCapacity_));
    }
    app_.update(lines_, lines);
    beginPass(numbers);
    pushAndBind(columns_, view, numbers);
    vnBindVertexLayout(context, columnLayout_);
    vnBindVertexBuffer(context, 0, lines_, 0);
    vnBindDepthStencilState(context, VnDepthStencilState{});
    vnBindRasterState(context, VnRasterState{});
    vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 0);
    must(vnDraw(context, static_cast<uint32_t>(lines.size()), 1, 0, 0));
    app_.endPass();
}

void WalkerRenderer::drawSolid(const View& view, const Target* numbers) {
    VnContext context = app_.context();
    beginPass(numbers);
    pushAndBind(solid_, view, numbers);
    vnBindVertexLayout(context, solidLayout_);
    vnBindVertexBuffer(context, 0, triangles_, 0);
    vnBindDepthStencilState(context, depth_);
    vnBindRasterState(context, front_);
    vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 0);
    must(vnDraw(context, triangleVertices_, 1, 0, 0));
    app_.endPass();
}

}  // namespace samples
