#include "conformance/hardcases/layer_cases.h"

#include "conformance/hardcases/judges.h"
#include "conformance/scenes/recorder.h"

namespace vernier::conformance::hardcases {
namespace {

// Four layers of 32 x 32 shown side by side.
constexpr VkExtent2D kLayer{32, 32}, kSideBySide{128, 32};

const char* const kViewFragmentGlsl = R"(#version 450
layout(location = 0) in vec4 vColor;
layout(location = 0) out vec4 color;
void main() { color = vColor; }
)";

// `which` tells the number of the view or layer, `choose` writes gl_ViewportIndex and gl_Layer.
std::string viewVertexGlsl(const std::string& extensions, const std::string& which, const std::string& choose) {
    return "#version 450\n" + extensions + R"(layout(push_constant) uniform Number { int number; };
layout(location = 0) out vec4 vColor;
void main() {
    int which = )" +
           which + R"(;
    vec2 corner = vec2(float(gl_VertexIndex & 1), float(gl_VertexIndex >> 1));
    gl_Position = vec4(corner * (1.3 + 0.2 * float(which)) - 0.85, 0.5, 1.0);
    vColor = vec4(0.25 * float(which), corner, 1.0);
    )" + choose +
           "\n}\n";
}

// What viewVertexGlsl() makes of a layer's number, once for each invocation.
const char* const kCornerVertexGlsl = R"(#version 450
layout(location = 0) out vec2 corner;
void main() { corner = vec2(float(gl_VertexIndex & 1), float(gl_VertexIndex >> 1)); }
)";
const char* const kInvocationsGlsl = R"(#version 450
layout(triangles, invocations = 4) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec2 corner[];
layout(location = 0) out vec4 vColor;
void main() {
    int which = gl_InvocationID;
    for (int i = 0; i < 3; ++i) {
        gl_Position = vec4(corner[i] * (1.3 + 0.2 * float(which)) - 0.85, 0.5, 1.0);
        vColor = vec4(0.25 * float(which), corner[i], 1.0);
        gl_ViewportIndex = which & 1;
        gl_Layer = which;
        EmitVertex();
    }
}
)";

/// What tells the copies of a triangle apart.
enum class By : uint8_t { view, instance, invocation };

/// `together`: one draw for all views or layers.
Result<Scene> layeredScene(std::string_view name, By by, bool together) {
    const bool layers = by != By::view;
    SceneRecorder record(name, "Views or layers with viewports of their own.");
    const uint32_t target = record.layeredTarget("layers", VK_FORMAT_R8G8B8A8_UNORM, kLayer, 4);
    const uint32_t flat = record.colorTarget("side by side", VK_FORMAT_R8G8B8A8_UNORM, kSideBySide);
    const std::string array = "#extension GL_ARB_shader_viewport_layer_array : enable\n";
    const std::string views = array + "#extension GL_EXT_multiview : enable\n";
    const std::string viewport = "gl_ViewportIndex = which & 1;";
    const std::string vertex = !together              ? viewVertexGlsl("", "number", "")
                               : by == By::invocation ? kCornerVertexGlsl
                               : by == By::instance
                                   ? viewVertexGlsl(array, "gl_InstanceIndex", viewport + " gl_Layer = which;")
                                   : viewVertexGlsl(views, "gl_ViewIndex", viewport);
    PipelineRecorder pipeline =
        record.pipeline(record.vertex(vertex), record.fragment(kViewFragmentGlsl)).pushConstants(4);
    if (together && by == By::invocation) pipeline.geometry(record.geometry(kInvocationsGlsl));
    const SceneView second{{8, 4, 20, 24, 0, 1}, {{9, 0}, {15, 30}}};
    record.pass(kLayer).color(target, {0.1f, 0.2f, 0.3f, 1}).layers(4);
    const uint32_t mask = layers ? 0b1111 : 0b1011;
    if (together) {
        PassRecorder pass = record.pass(kLayer).loadColor(target);
        layers ? pass.layers(4) : pass.views(mask);
        record.draw(pipeline, 3).instances(by == By::instance ? 4 : 1).view(second);
    } else {
        for (int32_t layer = 0; layer < 4; ++layer) {
            if ((mask >> layer & 1) == 0) continue;
            record.pass(kLayer).loadColor(target).layer(static_cast<uint32_t>(layer));
            auto draw = record.draw(pipeline, 3).push(layer);
            if ((layer & 1) != 0) {
                draw.viewport(second.viewport.x, second.viewport.y, second.viewport.width, second.viewport.height)
                    .scissor(second.scissor.offset.x, second.scissor.offset.y, second.scissor.extent.width,
                             second.scissor.extent.height);
            }
        }
    }
    record.pass(kSideBySide).color(flat, {});
    for (uint32_t layer = 0; layer < 4; ++layer) {
        SceneCopyImage copy{target, flat, {}};
        copy.region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
        copy.region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.region.dstOffset = {static_cast<int32_t>(layer * kLayer.width), 0, 0};
        copy.region.extent = {kLayer.width, kLayer.height, 1};
        record.copy(copy);
    }
    record.output(flat);
    return record.finish();
}

}  // namespace

void v13(CaseInput& input) {
    for (const By by : {By::view, By::instance}) {
        const size_t apart = input.scene(layeredScene("V13", by, false));
        judgeSame(
            input, input.scene(layeredScene("V13", by, true)), apart,
            by == By::instance ? "layers of one draw are draws into each" : "views of one draw are draws into each");
    }
}

void v17(CaseInput& input) {
    const size_t apart = input.scene(layeredScene("V17", By::invocation, false));
    judgeSame(input, input.scene(layeredScene("V17", By::invocation, true)), apart,
              "layers that invocations choose are draws into each");
}

}  // namespace vernier::conformance::hardcases
