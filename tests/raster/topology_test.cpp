// Primitive assembly, facing, points and lines.
#include <cmath>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

constexpr uint32_t kSize = 32;
constexpr VkFormat kWide = VK_FORMAT_R32G32B32A32_SFLOAT;

class Topology : public testing::Test {
  protected:
    std::unique_ptr<Surface> draw(VkPrimitiveTopology topology, const std::vector<Vertex>& vertices,
                                  const std::vector<uint32_t>& indices = {},
                                  const std::function<void(GraphicsState&)>& change = {},
                                  const std::string& fragment = "color_frag", float lineWidth = 1,
                                  const std::string& vertex = "color_vert") {
        PipelineOptions options;
        options.vertex = vertex;
        options.fragment = fragment;
        options.state = plainState(kWide);
        options.state.topology = topology;
        if (change) change(options.state);
        auto surface = std::make_unique<Surface>(kWide, kSize, kSize);
        VkClearValue clear{};
        clear.color.float32[0] = -1;
        Pass pass(pool_, {surface->cleared(clear)}, {}, kSize, kSize);
        DynamicState dynamic = dynamicFor(kSize, kSize);
        dynamic.lineWidth = lineWidth;
        pass.begin();
        pass.draw(makePipeline(options), dynamic, vertices, indices);
        pass.end();
        statistics_ = pass.pass().statistics();
        return surface;
    }
    ThreadPool pool_{2};
    PassStatistics statistics_;
};

std::vector<Vertex> ribbon() {
    std::vector<Vertex> v;
    for (int n = 0; n < 8; ++n)
        v.push_back(at(2 + n * 4, n % 2 == 0 ? 4 : 25, kSize, kSize, {static_cast<float>(n), 0, 0, 1}));
    return v;
}

TEST_F(Topology, StripEqualsList) {
    std::vector<Vertex> list;
    const std::vector<Vertex> v = ribbon();
    for (size_t n = 0; n + 2 < v.size(); ++n)
        for (const size_t k : {n, n + 1 + n % 2, n + 2 - n % 2}) list.push_back(v[k]);
    const auto cull = [](GraphicsState& s) { s.cullMode = VK_CULL_MODE_BACK_BIT; };
    const auto strip = draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, v, {}, cull);
    EXPECT_EQ(strip->hash(), draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, list, {}, cull)->hash());
    EXPECT_GT(strip->otherThan(-1), 200);
    EXPECT_EQ(statistics_.inputPrimitives, 6u);
}

TEST_F(Topology, FanEqualsList) {
    std::vector<Vertex> v{at(16, 16, kSize, kSize, {9, 0, 0, 1})}, list;
    for (int n = 0; n <= 9; ++n)
        v.push_back(at(16 + 12 * std::cos(n * 0.69), 16 + 12 * std::sin(n * 0.69), kSize, kSize,
                       {static_cast<float>(n), 0, 0, 1}));
    for (size_t n = 1; n + 1 < v.size(); ++n)
        for (const size_t k : {n, n + 1, size_t{0}}) list.push_back(v[k]);
    EXPECT_EQ(draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, v)->hash(),
              draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, list)->hash());
}

TEST_F(Topology, ProvokingVertices) {
    // Flat red is the number of the provoking vertex; the vertex program takes it from blue.
    const auto flat = [&](VkPrimitiveTopology topology, bool last, double x, double y) {
        std::vector<Vertex> v = ribbon();
        if (topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN) {
            v = {at(16, 16, kSize, kSize), at(30, 16, kSize, kSize), at(16, 30, kSize, kSize), at(2, 16, kSize, kSize),
                 at(16, 2, kSize, kSize)};
        }
        for (size_t n = 0; n < v.size(); ++n) v[n].color[2] = static_cast<float>(n);
        const auto surface = draw(
            topology, v, {}, [&](GraphicsState& s) { s.provokingVertexLast = last; }, "varyings_frag", 1,
            "varyings_vert");
        return surface->color(static_cast<uint32_t>(x), static_cast<uint32_t>(y)).float32[2];
    };
    // Strip triangle 0 around (6, 11), triangle 1 around (10, 18).
    EXPECT_EQ(flat(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, false, 6, 11), 0);
    EXPECT_EQ(flat(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, true, 6, 11), 2);
    EXPECT_EQ(flat(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, false, 10, 18), 1);
    EXPECT_EQ(flat(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, true, 10, 18), 3);
    EXPECT_EQ(flat(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, false, 20, 20), 1);
    EXPECT_EQ(flat(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, true, 20, 20), 2);
}

TEST_F(Topology, PrimitiveRestart) {
    const std::vector<Vertex> v = ribbon();
    const uint32_t restart = 0xFFFFFFFF;
    const auto on = [](GraphicsState& s) { s.primitiveRestart = true; };
    // Consecutive restarts, and runs too short for a triangle.
    const auto got = draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, v,
                          {restart, 0, 1, 2, restart, restart, 3, 4, restart, 4, 5, 6, 7, restart}, on);
    EXPECT_EQ(statistics_.inputPrimitives, 3u);
    const auto list = draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, v, {0, 1, 2, 4, 5, 6, 5, 7, 6});
    EXPECT_EQ(got->hash(), list->hash());
}

TEST_F(Topology, VerticesAreSharedInsideAChunk) {
    std::vector<uint32_t> indices;
    for (uint32_t n = 0; n + 2 < 8; ++n) indices.insert(indices.end(), {n, n + 1, n + 2});
    draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, ribbon(), indices);
    EXPECT_EQ(statistics_.vertexInvocations, 8u);
}

TEST_F(Topology, IndicesOutsideTheirBuffersAreHarmless) {
    const auto surface = draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, ribbon(), {0, 1, 0x7FFFFFFF, 0xFFFFFFFE, 2, 3});
    EXPECT_LE(surface->otherThan(-1), 1024);
}

TEST_F(Topology, FacingAndCulling) {
    const std::vector<Vertex> clockwise{at(2, 2, kSize, kSize), at(30, 2, kSize, kSize), at(2, 30, kSize, kSize)};
    for (const VkFrontFace face : {VK_FRONT_FACE_CLOCKWISE, VK_FRONT_FACE_COUNTER_CLOCKWISE}) {
        const bool front = face == VK_FRONT_FACE_CLOCKWISE;
        for (uint32_t mode = 0; mode < 4; ++mode) {
            const auto surface = draw(
                VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, clockwise, {},
                [&](GraphicsState& s) {
                    s.frontFace = face;
                    s.cullMode = mode;
                },
                "ids_frag");
            const bool culled = (mode & (front ? VK_CULL_MODE_FRONT_BIT : VK_CULL_MODE_BACK_BIT)) != 0;
            ASSERT_EQ(surface->red(5, 5) == -1, culled);
            if (!culled) {
                EXPECT_EQ(surface->color(5, 5).float32[1], front ? 1 : 0);
            }
        }
    }
}

TEST_F(Topology, PrimitiveIdsCountPerInstance) {
    std::vector<Vertex> v;
    for (int n = 0; n < 3000; ++n) {
        const double x = n % 30, y = n / 30 % 30;
        v.insert(v.end(), {at(x, y, kSize, kSize), at(x + 1, y, kSize, kSize), at(x + 0.5, y + 2, kSize, kSize)});
    }
    const auto surface = draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, v, {}, {}, "ids_frag");
    EXPECT_EQ(surface->red(4, 3),
              2700 + 3 * 30 + 4);  // the last of those on this pixel: later ones lie over it
}

TEST_F(Topology, Points) {
    const auto surface = draw(VK_PRIMITIVE_TOPOLOGY_POINT_LIST, {at(5.5, 7.5, kSize, kSize), at(20, 21, kSize, kSize)},
                              {}, {}, "ids_frag");
    EXPECT_EQ(surface->otherThan(-1), 2);
    EXPECT_EQ(surface->red(5, 7), 0);
    const VkClearColorValue c = surface->color(5, 7);
    EXPECT_EQ(c.float32[2], 0.5f);
    EXPECT_EQ(c.float32[3], 0.5f);
}

TEST_F(Topology, LinesAreRectangles) {
    for (const float width : {1.0f, 3.0f}) {
        const auto horizontal =
            draw(VK_PRIMITIVE_TOPOLOGY_LINE_LIST, {at(4, 10.5, kSize, kSize), at(20, 10.5, kSize, kSize)}, {}, {},
                 "color_frag", width);
        EXPECT_EQ(horizontal->otherThan(-1), static_cast<int>(16 * width));
        const auto strip = draw(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP,
                                {at(4.5, 4, kSize, kSize), at(4.5, 12, kSize, kSize), at(4.5, 20, kSize, kSize)}, {},
                                {}, "color_frag", width);
        EXPECT_EQ(strip->otherThan(-1), static_cast<int>(16 * width));
    }
    EXPECT_EQ(draw(VK_PRIMITIVE_TOPOLOGY_LINE_LIST, {at(4, 4, kSize, kSize), at(4, 4, kSize, kSize)})->otherThan(-1),
              0);
}

TEST_F(Topology, LineAttributesAlongTheLine) {
    const auto surface = draw(VK_PRIMITIVE_TOPOLOGY_LINE_LIST,
                              {at(4, 10.5, kSize, kSize, {0, 0, 0, 0}), at(20, 10.5, kSize, kSize, {1, 1, 1, 1})});
    for (uint32_t x = 4; x < 20; ++x) EXPECT_NEAR(surface->red(x, 10), (x + 0.5 - 4) / 16, 1e-6);
}

TEST_F(Topology, PolygonModes) {
    const std::vector<Vertex> v{at(4.5, 4.5, kSize, kSize), at(26.5, 4.5, kSize, kSize), at(4.5, 26.5, kSize, kSize)};
    const auto lines = draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, v, {},
                            [](GraphicsState& s) { s.polygonMode = VK_POLYGON_MODE_LINE; });
    EXPECT_NE(lines->red(15, 4), -1);
    EXPECT_EQ(lines->red(10, 10), -1);
    const auto points = draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, v, {},
                             [](GraphicsState& s) { s.polygonMode = VK_POLYGON_MODE_POINT; });
    EXPECT_EQ(points->otherThan(-1), 3);
}

// "The size of a point" is the vertex program's for the corners of polygons, too, and between them where one is cut.
TEST_F(Topology, PolygonsAsPointsOfTheirSizes) {
    const auto corner = [](double x, double y, float size, float z = 0.5f) {
        return at(x, y, kSize, kSize, {1, 1, 1, size}, z);
    };
    const auto asPoints = [](GraphicsState& s) { s.polygonMode = VK_POLYGON_MODE_POINT; };
    const auto points =
        draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, {corner(6.5, 6.5, 5), corner(24.5, 6.5, 1), corner(6.5, 24.5, 3)}, {},
             asPoints, "color_frag", 1, "point_vert");
    EXPECT_EQ(points->otherThan(-1), 25 + 1 + 9);
    // The first corner lies before the near plane: the middles of its edges take its place.
    const auto cut = draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
                          {corner(4.5, 4.5, 5, -0.5f), corner(24.5, 4.5, 1), corner(4.5, 24.5, 1)}, {}, asPoints,
                          "color_frag", 1, "point_vert");
    EXPECT_EQ(cut->otherThan(-1), 9 + 9 + 1 + 1);
}

TEST_F(Topology, RefusedStates) {
    GraphicsState state = plainState(kWide);
    PipelineOptions options;
    options.state = state;
    const auto pipeline = makePipeline(options);
    const auto refused = [&](const std::function<void(GraphicsState&)>& change, ErrorCode code,
                             const std::string& word) {
        GraphicsState changed = plainState(kWide);
        change(changed);
        // The program of the other pipeline will do: the state is checked first.
        auto program = std::shared_ptr<const ShaderProgram>(pipeline, &pipeline->program());
        auto result = GraphicsPipeline::create({changed, program});
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(result.error().code, code);
        EXPECT_NE(result.error().message.find(word), std::string::npos) << result.error().message;
    };
    refused([](GraphicsState& s) { s.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST; }, ErrorCode::invalidArgument,
            "topology");
    refused([](GraphicsState& s) { s.samples = 32; }, ErrorCode::unsupported, "32 samples");
    refused([](GraphicsState& s) { s.colorFormats[0] = VK_FORMAT_D16_UNORM; }, ErrorCode::unsupported, "D16_UNORM");
    refused([](GraphicsState& s) { s.vertexAttributes[0].binding = 3; }, ErrorCode::invalidArgument, "binding 3");
    refused([](GraphicsState& s) { s.vertexAttributes.pop_back(); }, ErrorCode::invalidArgument, "location 1");
    EXPECT_NE(factsText(pipeline->explain(dynamicFor(4, 4))).find("left out"), std::string::npos);
}

}  // namespace
}  // namespace vernier::raster_test
