// Geometry stages: what they put out is drawn as the same primitives are that come from vertices.
#include <cmath>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

constexpr uint32_t kSize = 32;
constexpr VkFormat kWide = VK_FORMAT_R32G32B32A32_SFLOAT;

class Geometry : public testing::Test {
  protected:
    struct Draw {
        VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        std::vector<Vertex> vertices;
        std::string geometry;
        std::vector<uint32_t> indices{};
        std::string vertex = "color_vert", fragment = "color_frag";
        bool provokingLast = false, restart = false;
        uint32_t instances = 1, threads = 2;
    };
    std::unique_ptr<Surface> draw(const Draw& what) {
        PipelineOptions options;
        options.vertex = what.vertex;
        options.geometry = what.geometry;
        options.fragment = what.fragment;
        options.state = plainState(kWide);
        options.state.topology = what.topology;
        options.state.provokingVertexLast = what.provokingLast;
        options.state.primitiveRestart = what.restart;
        auto surface = std::make_unique<Surface>(kWide, kSize, kSize);
        VkClearValue clear{};
        clear.color.float32[0] = -1;
        ThreadPool pool(what.threads);
        Pass pass(pool, {surface->cleared(clear)}, {}, kSize, kSize);
        pass.begin();
        pass.draw(makePipeline(options), dynamicFor(kSize, kSize), what.vertices, what.indices, what.instances);
        pass.end();
        statistics_ = pass.pass().statistics();
        return surface;
    }
    PassStatistics statistics_;
};

/// Vertices from left to right in a zigzag, with colours of their own.
std::vector<Vertex> ribbon(int count) {
    std::vector<Vertex> v;
    for (int n = 0; n < count; ++n)
        v.push_back(at(1 + n * 29.0 / count, n % 2 == 0 ? 4 + n % 3 : 25 - n % 5, kSize, kSize,
                       {static_cast<float>(n), 1, static_cast<float>(n % 4), 2}));
    return v;
}

TEST_F(Geometry, TrianglesThatGoThroughStayWhatTheyAre) {
    for (const VkPrimitiveTopology topology :
         {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP,
          VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN}) {
        for (const bool last : {false, true}) {
            const Draw plain{topology, ribbon(9), "", {}, "color_vert", "color_frag", last};
            Draw through = plain;
            through.geometry = "pass_geom";
            const auto expected = draw(plain);
            const uint64_t clipped = statistics_.clippingInvocations;
            EXPECT_GT(expected->otherThan(-1), 100);
            EXPECT_EQ(draw(through)->hash(), expected->hash()) << topology << last;
            EXPECT_EQ(statistics_.geometryInvocations, clipped);
            EXPECT_EQ(statistics_.geometryPrimitives, clipped);
            EXPECT_EQ(statistics_.clippingInvocations, clipped);
        }
    }
}

TEST_F(Geometry, RestartAndIndicesGoOn) {
    Draw plain{
        VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, ribbon(9), "", {0, 1, 2, 3, 0xFFFFFFFF, 4, 5, 0xFFFFFFFF, 5, 6, 7}};
    plain.restart = true;
    Draw through = plain;
    through.geometry = "pass_geom";
    const auto expected = draw(plain);
    EXPECT_EQ(draw(through)->hash(), expected->hash());
    EXPECT_EQ(statistics_.geometryPrimitives, 3u);
    EXPECT_EQ(statistics_.vertexInvocations, 7u);
}

TEST_F(Geometry, LinesAndPointsGoThrough) {
    for (const VkPrimitiveTopology topology : {VK_PRIMITIVE_TOPOLOGY_LINE_LIST, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP}) {
        const auto expected = draw({topology, ribbon(8), ""});
        EXPECT_EQ(draw({topology, ribbon(8), "passlines_geom"})->hash(), expected->hash());
        EXPECT_GT(expected->otherThan(-1), 50);
    }
    // The program makes squares of two pixels.
    const auto points =
        draw({VK_PRIMITIVE_TOPOLOGY_POINT_LIST, {at(6, 8, kSize, kSize, {1, 1, 1, 2})}, "passpoints_geom"});
    EXPECT_EQ(points->otherThan(-1), 4);
}

TEST_F(Geometry, InvocationsPutOutStripsInTheirOrder) {
    const std::vector<Vertex> points{at(2, 2, kSize, kSize), at(5, 17, kSize, kSize), at(2.5, 17, kSize, kSize)};
    std::vector<Vertex> list;
    for (size_t p = 0; p < points.size(); ++p) {
        for (int invocation = 0; invocation < 3; ++invocation) {
            for (int strip = 0; strip < 2; ++strip) {
                const auto corner = [&](double x, double y) {
                    Vertex v = points[p];
                    v.position[0] += static_cast<float>(invocation * 0.25 + x);
                    v.position[1] += static_cast<float>(strip * 0.25 + y);
                    v.color = {static_cast<float>(p), static_cast<float>(invocation), 1, 1};
                    return v;
                };
                const Vertex a = corner(0, 0), b = corner(0.125, 0), c = corner(0, 0.125), d = corner(0.125, 0.125);
                list.insert(list.end(), {a, b, c, b, d, c});
            }
        }
    }
    const auto expected = draw({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, list, ""});
    EXPECT_EQ(draw({VK_PRIMITIVE_TOPOLOGY_POINT_LIST, points, "fans_geom"})->hash(), expected->hash());
    EXPECT_EQ(statistics_.geometryInvocations, 9u);
    EXPECT_EQ(statistics_.geometryPrimitives, 36u);
    EXPECT_EQ(statistics_.inputPrimitives, 3u);
    // The fragment program sees the numbers that the geometry program gives.
    const auto ids = draw({VK_PRIMITIVE_TOPOLOGY_POINT_LIST, {points[0]}, "fans_geom", {}, "color_vert", "ids_frag"});
    EXPECT_EQ(ids->red(3, 3), 0);
    EXPECT_EQ(ids->red(7, 3), 1);
    EXPECT_EQ(ids->red(11, 7), 2);
}

TEST_F(Geometry, AsManyVerticesAsThereAre) {
    const auto three = [](float count) {
        std::vector<Vertex> v{at(2, 2, kSize, kSize, {count, 5, 6, 7}), at(12, 3, kSize, kSize, {8, 9, 1, 2}),
                              at(3, 14, kSize, kSize, {3, 4, 5, 6})};
        return v;
    };
    const auto strip = [&](int count) {
        std::vector<Vertex> v = three(static_cast<float>(count)), out;
        for (int n = 0; n < std::min(count, 5); ++n) {
            Vertex vertex = v[static_cast<size_t>(n % 3)];
            vertex.position[0] += static_cast<float>(n / 3) * 0.5f;
            vertex.color = v[static_cast<size_t>((n + 1) % 3)].color;
            out.push_back(vertex);
        }
        return out;
    };
    for (const int count : {0, 1, 2, 3, 4, 5, 6, 9}) {
        const auto expected = draw({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, strip(count), ""});
        const auto got = draw({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, three(static_cast<float>(count)), "uneven_geom"});
        EXPECT_EQ(got->hash(), expected->hash()) << count;
        EXPECT_EQ(statistics_.geometryPrimitives, static_cast<uint64_t>(std::max(0, std::min(count, 5) - 2)));
    }
}

TEST_F(Geometry, NeighboursOfTriangles) {
    // A list names them; of a strip, the numbers are those of the specification's table.
    std::vector<Vertex> v;
    for (int n = 0; n < 12; ++n)
        v.push_back(at(16 + (6 + n) * std::cos(n * 2.1), 16 + (6 + n) * std::sin(n * 2.1), kSize, kSize,
                       {static_cast<float>(n), 0, 0, 1}));
    const auto sides = [&](const std::vector<std::array<uint32_t, 6>>& primitives) {
        std::vector<Vertex> list;
        for (const auto& p : primitives)
            for (const size_t side : {0u, 2u, 4u})
                list.insert(list.end(), {v[p[side]], v[p[side + 1]], v[p[(side + 2) % 6]]});
        return list;
    };
    const auto listed =
        draw({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, sides({{0, 1, 2, 3, 4, 5}, {6, 7, 8, 9, 10, 11}}), ""});
    EXPECT_EQ(draw({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY, v, "adjacency_geom"})->hash(), listed->hash());
    const std::vector<std::vector<std::array<uint32_t, 6>>> strips{
        {{0, 1, 2, 5, 4, 3}},
        {{0, 1, 2, 6, 4, 3}, {2, 5, 6, 7, 4, 0}},
        {{0, 1, 2, 6, 4, 3}, {2, 5, 6, 8, 4, 0}, {4, 2, 6, 9, 8, 7}},
        {{0, 1, 2, 6, 4, 3}, {2, 5, 6, 8, 4, 0}, {4, 2, 6, 10, 8, 7}, {6, 9, 10, 11, 8, 4}}};
    for (size_t n = 0; n < strips.size(); ++n) {
        const std::vector<Vertex> some(v.begin(), v.begin() + static_cast<ptrdiff_t>(2 * n + 6));
        const auto expected = draw({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, sides(strips[n]), ""});
        EXPECT_EQ(draw({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY, some, "adjacency_geom"})->hash(),
                  expected->hash())
            << n;
    }
}

TEST_F(Geometry, NeighboursOfLines) {
    const std::vector<Vertex> v = ribbon(8);
    const auto expected = draw({VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, v, ""});
    const auto overlapping = draw({VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY, v, "adjacentlines_geom"});
    EXPECT_EQ(overlapping->hash(), expected->hash());
    EXPECT_EQ(statistics_.geometryInvocations, 5u);
    const std::vector<uint32_t> two{0, 1, 2, 3, 0xFFFFFFFF, 4, 5, 6, 7};
    Draw apart{VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, v, "", two};
    apart.restart = true;
    EXPECT_EQ(draw({VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY, v, "adjacentlines_geom"})->hash(),
              draw(apart)->hash());
}

TEST_F(Geometry, ManyPrimitivesInTheirOrderWhateverRunsThem) {
    std::vector<Vertex> v;
    for (int n = 0; n < 5000; ++n) {
        const double x = n % 29, y = n / 29 % 28;
        const auto c = static_cast<float>(n);
        for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {3.0, 0.5}, {1.0, 4.0}})
            v.push_back(at(x + dx, y + dy, kSize, kSize, {c, c, c, 1}));
    }
    Draw what{VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, v, ""};
    what.instances = 2;
    const uint64_t expected = draw(what)->hash();
    what.geometry = "pass_geom";
    for (const uint32_t threads : {1u, 2u, 5u}) {
        what.threads = threads;
        EXPECT_EQ(draw(what)->hash(), expected) << threads;
    }
    EXPECT_EQ(statistics_.geometryPrimitives, 10000u);
}

TEST_F(Geometry, PrimitivesThatDoNotFitAreRefused) {
    const ir::Program vertex = loadForTest("color_vert", ir::Stage::vertex),
                      geometry = loadForTest("pass_geom", ir::Stage::geometry);
    ShaderProgramDesc desc;
    desc.vertex = &vertex;
    desc.geometry = &geometry;
    auto program = ShaderProgram::create(desc);
    ASSERT_TRUE(program) << program.error().message;
    GraphicsState state = plainState(kWide);
    state.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
    const auto pipeline = GraphicsPipeline::create({state, *program});
    ASSERT_FALSE(pipeline);
    EXPECT_EQ(pipeline.error().message, "geometry shader: it takes triangles, the topology is of lines");
}

}  // namespace
}  // namespace vernier::raster_test
