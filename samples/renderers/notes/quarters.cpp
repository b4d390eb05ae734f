#include "samples/renderers/notes/quarters.h"

#include "samples/common/trigonometry.h"

namespace samples {

const char* const Quarters::kHead =
    "#version 450\n"
    "layout(push_constant) uniform Push { mat4 transform; vec4 eye; vec4 tint; vec4 options; };\n";

const std::string Quarters::kWorldVertex = std::string(kHead) + R"(
layout(location = 0) in vec3 position;
void main() { gl_Position = vec4(position, 1); })";

const std::string Quarters::kFacetFragment = std::string(kHead) + R"(
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 color;
layout(location = 0) out vec4 result;
void main() {
    vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
    if (dot(normal, eye.xyz - place) < 0) normal = -normal;
    result = vec4(color * (0.3 + 0.7 * max(dot(normal, normalize(vec3(0.5, 1, 0.3))), 0)), 1);
})";

const std::string Quarters::kColorFragment = std::string(kHead) + R"(
layout(location = 1) in vec3 color;
layout(location = 0) out vec4 result;
void main() { result = vec4(color, 1); })";

Quarters::Quarters(App& app) : app_(app) {
    layout_ = app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}}, {{sizeof(glm::vec3), 0}});
    depth_ = app.depthState(true, VK_COMPARE_OP_LESS_OR_EQUAL);
    for (const int gl : {0, 1})
        for (const int cull : {0, 1})
            for (const int outlines : {0, 1}) {
                VnRasterStateDesc desc{};
                desc.depthNegativeOneToOne = gl;
                desc.cullMode = cull ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
                desc.polygonMode = outlines ? VK_POLYGON_MODE_LINE : VK_POLYGON_MODE_FILL;
                desc.depthBias = !outlines;
                desc.depthBiasConstant = 4;
                desc.depthBiasSlope = 1.5f;
                must(vnCreateRasterState(app.device(), &desc, &rasters_[gl][cull][outlines]));
            }
}

VnProgram Quarters::program(const StageSources& sources) {
    const auto shader = [&](VkShaderStageFlagBits stage, const std::string& glsl) {
        return glsl.empty() ? VnShader{} : app_.shader(stage, glsl);
    };
    VnProgramDesc desc{};
    desc.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, sources.vertex);
    desc.control = shader(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, sources.control);
    desc.evaluation = shader(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, sources.evaluation);
    desc.geometry = shader(VK_SHADER_STAGE_GEOMETRY_BIT, sources.geometry);
    desc.fragment = shader(VK_SHADER_STAGE_FRAGMENT_BIT, sources.fragment);
    VnProgram program{};
    must(vnCreateProgram(app_.device(), &desc, &program));
    return program;
}

void Quarters::begin(const PageView& view, float distance, float height) {
    view_ = view;
    const double angle = view.seconds * 0.2 + 0.4;
    eye_ = glm::vec3(distance * sineF(angle), height, distance * cosineF(angle));
    const auto projection = view.gl ? perspectiveGl : perspective;
    transform_ =
        projection(0.7, app_.aspect(), 0.3, 60) * glm::lookAt(eye_, glm::vec3(0, -0.1f, 0), glm::vec3(0, 1, 0));
    app_.beginPass({0.03f, 0.04f, 0.06f, 1});
}

void Quarters::select(int quarter) {
    const float width = static_cast<float>(app_.width()) / 2, height = static_cast<float>(app_.height()) / 2;
    const float x = quarter % 2 ? width : 0, y = quarter < 2 ? 0 : height;
    const VkViewport part{x, view_.gl ? y + height : y, width, view_.gl ? -height : height, 0, 1};
    must(vnSetViewport(app_.context(), &part));
}

void Quarters::bind(VnProgram program, VnBuffer buffer, VkPrimitiveTopology topology, bool outlines) {
    VnContext context = app_.context();
    must(vnBindProgram(context, program));
    must(vnBindVertexLayout(context, layout_));
    must(vnBindVertexBuffer(context, 0, buffer, 0));
    must(vnBindDepthStencilState(context, depth_));
    must(vnBindRasterState(context, rasters_[view_.gl][view_.cull][outlines]));
    must(vnSetTopology(context, topology, 0));
}

void Quarters::push(const glm::vec3& tint, const glm::vec4& options) {
    const struct {
        glm::mat4 transform;
        glm::vec4 eye, tint, options;
    } constants{transform_, glm::vec4(eye_, 1), glm::vec4(tint, 1), options};
    app_.push(constants);
}

}  // namespace samples
