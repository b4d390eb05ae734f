// Tessellation in whole scenes: pictures by hand, faults that must be caught, what is refused.
#include "tests/oracle/small_scene.h"

#include <string>

namespace vernier::conformance {
namespace {

using namespace small_scene;

struct Patch {
    std::string modes = "quads, equal_spacing, ccw";
    std::string outer = "3.0, 2.0, 4.0, 1.0", inner = "4.0, 3.0";
    std::string body = "gl_Position = vec4(t.x * 1.75 - 0.9375, t.y * 1.75 - 0.9375, 0.5, 1.0);";
    uint32_t vertices = 4;
    bool lowerLeft = false;
    VkCullModeFlags cull = VK_CULL_MODE_NONE;
};

/// One patch of the vertices of a 16 x 16 scene; the body places the point `t`.
Scene patchScene(const Patch& patch, const std::string& fragment = kSmooth) {
    SceneRecorder record("patch", "");
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kExtent);
    const std::vector<Vertex> vertices(4, vertex(2, 2, kRed));
    const uint32_t control = record.control(R"(#version 450
layout(vertices = 1) out;
layout(location = 0) in vec4 smoothColor[];
layout(location = 0) out vec4 colors[];
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[0].gl_Position;
    colors[gl_InvocationID] = smoothColor[0];
    gl_TessLevelOuter = float[4]()" + patch.outer +
                                            R"();
    gl_TessLevelInner = float[2]()" + patch.inner +
                                            R"();
}
)");
    const uint32_t evaluation = record.evaluation("#version 450\nlayout(" + patch.modes + R"() in;
layout(location = 0) in vec4 colors[];
layout(location = 0) out vec4 smoothColor;
void main() {
    vec3 t = gl_TessCoord;
    smoothColor = colors[0];
    )" + patch.body + "\n}\n");
    PipelineRecorder pipeline = record.pipeline(record.vertex(kVertex), record.fragment(fragment))
                                    .binding(sizeof(Vertex))
                                    .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                    .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 16)
                                    .patches(patch.vertices, control, evaluation)
                                    .cull(patch.cull, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    if (patch.lowerLeft) pipeline.domainLowerLeft();
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    record.draw(pipeline, 4).vertices(record.vertexBuffer("vertices", vertices));
    record.output(target);
    auto scene = record.finish();
    EXPECT_TRUE(scene.ok()) << scene.error().message;
    return scene.ok() ? *scene : Scene{};
}

size_t red(const OracleImage& image) {
    return static_cast<size_t>(
        std::ranges::count_if(image.pixels, [](const OraclePixel& p) { return p.value[0] > 0.5; }));
}

/// Points at the centres of pixels 0 to 15 for coordinates that are fifteenths.
constexpr const char* kOnPixels = "gl_Position = vec4((t.xy * 15.0 + 0.5) / 8.0 - 1.0, 0.5, 1.0); gl_PointSize = 1.0;";

TEST(Tessellation, PointsByHand) {
    // 5 lines of 3 segments, of which the last but one is at v = 4/5.
    const OracleImage lines =
        render(patchScene({"isolines, equal_spacing, point_mode", "5.0, 3.0, 0.0, 0.0", "1.0, 1.0", kOnPixels}));
    for (uint32_t y = 0; y < 16; ++y) {
        for (uint32_t x = 0; x < 16; ++x)
            EXPECT_EQ(at(lines, x, y).value[0], x % 5 == 0 && y % 3 == 0 && y < 15 ? 1.0 : 0.0) << x << ' ' << y;
    }
    const OracleImage mesh =
        render(patchScene({"quads, equal_spacing, point_mode", "1.0, 3.0, 5.0, 1.0", "3.0, 5.0", kOnPixels}));
    EXPECT_EQ(red(mesh), 4u + 2 + 4 + 2 * 4);
    EXPECT_EQ(at(mesh, 5, 0).value[0], 1) << "v = 0 has the second outer level";
    EXPECT_EQ(at(mesh, 15, 3).value[0], 1) << "u = 1 the third";
    EXPECT_EQ(at(mesh, 5, 3).value[0], 1) << "three columns, five rows inside";
    EXPECT_EQ(at(mesh, 10, 12).value[0], 1);
}

TEST(Tessellation, PatchesThatAreDiscardedOrNotWhole) {
    EXPECT_EQ(red(render(patchScene({}))), 14u * 14);
    Patch patch;
    patch.outer = "3.0, 2.0, 0.0, 1.0";
    EXPECT_EQ(red(render(patchScene(patch))), 0u);
    patch = {};
    patch.vertices = 5;
    EXPECT_EQ(red(render(patchScene(patch))), 0u);
}

TEST(Tessellation, FaultsInPointsAreCaught) {
    Patch right{"quads, fractional_odd_spacing, point_mode", "1.0, 3.0, 5.0, 7.0", "3.0, 5.0", kOnPixels};
    const auto wrong = [&](const Patch& patch) { return judge(patchScene(right), patchScene(patch)).outside; };
    const auto changed = [&](std::string Patch::*member, const std::string& value) {
        Patch patch = right;
        patch.*member = value;
        return wrong(patch);
    };
    EXPECT_EQ(wrong(right), 0u);
    EXPECT_GT(changed(&Patch::inner, "5.0, 3.0"), 0u) << "inner levels swapped";
    EXPECT_GT(changed(&Patch::outer, "3.0, 1.0, 5.0, 7.0"), 0u) << "outer levels swapped";
    EXPECT_GT(changed(&Patch::outer, "5.0, 3.0, 1.0, 7.0"), 0u) << "opposite sides swapped";
    EXPECT_GT(changed(&Patch::inner, "3.0, 4.0"), 0u) << "not rounded";
    EXPECT_GT(changed(&Patch::modes, "quads, fractional_even_spacing, point_mode"), 0u);
    EXPECT_GT(changed(&Patch::modes, "triangles, fractional_odd_spacing, point_mode"), 0u);
    EXPECT_GT(changed(&Patch::body, "t.y = 1.0 - t.y; " + right.body), 0u) << "the domain upside down";
}

TEST(Tessellation, FaultsInOutlinesAreCaught) {
    // The sides become arcs; a side of so many segments becomes a polygon.
    const std::string arcs =
        "vec2 s = t.xy * 2.0 - 1.0; gl_Position = vec4(s * (1.0 - 0.4 * s.yx * s.yx) * 0.97, 0.5, 1.0);";
    Patch right{"quads, equal_spacing, ccw", "1.0, 2.0, 4.0, 3.0", "2.0, 2.0", arcs};
    const auto wrong = [&](const std::string& outer) {
        Patch patch = right;
        patch.outer = outer;
        return judge(patchScene(right), patchScene(patch)).outside;
    };
    EXPECT_EQ(wrong("1.0, 2.0, 4.0, 3.0"), 0u);
    EXPECT_GT(wrong("2.0, 1.0, 4.0, 3.0"), 0u);
    EXPECT_GT(wrong("4.0, 2.0, 1.0, 3.0"), 0u);
    EXPECT_GT(wrong("1.0, 3.0, 4.0, 2.0"), 0u);
}

TEST(Tessellation, FaultsInWindingAreCaught) {
    for (const std::string domain : {"triangles", "quads"}) {
        Patch right;
        right.modes = domain + ", equal_spacing, ccw";
        right.cull = VK_CULL_MODE_BACK_BIT;
        const Scene scene = patchScene(right);
        EXPECT_GT(red(render(scene)), 0u) << "u to the right, v downwards, as on the screen";
        EXPECT_EQ(judge(scene, scene).outside, 0u);
        Patch wrong = right;
        wrong.modes = domain + ", equal_spacing, cw";
        EXPECT_GT(judge(scene, patchScene(wrong)).outside, 0u);
        wrong.lowerLeft = true;
        EXPECT_EQ(judge(scene, patchScene(wrong)).outside, 0u) << "clockwise with v upwards";
        right.lowerLeft = true;
        EXPECT_GT(judge(scene, patchScene(right)).outside, 0u);
    }
}

TEST(Tessellation, NumbersOfPartsAreRefused) {
    const auto images = renderOracle(patchScene({}, R"(#version 450
layout(location = 0) in vec4 smoothColor;
layout(location = 0) out vec4 color;
void main() { color = smoothColor * float(gl_PrimitiveID); }
)"));
    ASSERT_FALSE(images.ok());
    EXPECT_EQ(images.error().code, ErrorCode::unsupported);
    EXPECT_NE(images.error().message.find("come out of patches"), std::string::npos);
}

TEST(Tessellation, BrokenScenesAreNamed) {
    const auto broken = [](const Configure& configure) {
        Scene scene = patchScene({});
        configure(scene);
        const auto images = renderOracle(scene);
        return images.ok() ? std::string() : images.error().message;
    };
    EXPECT_NE(broken([](Scene& s) { s.pipelines[0].controlShader = kNone; }).find("control shader"), std::string::npos);
    EXPECT_NE(broken([](Scene& s) { s.pipelines[0].evaluationShader = 9; }).find("evaluation shader 9"),
              std::string::npos);
    EXPECT_NE(broken([](Scene& s) { s.pipelines[0].patchVertices = 33; }).find("33"), std::string::npos);
    EXPECT_NE(broken([](Scene& s) { s.pipelines[0].topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST; }).find("patches"),
              std::string::npos);
}

}  // namespace
}  // namespace vernier::conformance
