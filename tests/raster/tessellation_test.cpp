// Tessellation: patches become what the tessellator makes of their domains, and are drawn as that.
#include <algorithm>
#include <random>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

constexpr uint32_t kSize = 64;
constexpr VkFormat kWide = VK_FORMAT_R32G32B32A32_SFLOAT;

/// A corner of a patch, by pixels; its levels go with it as tests/raster/shaders/tri.tesc and quad.tesc have them.
Vertex corner(double x, double y, float inner, float outer, float red = 1) {
    return at(x, y, kSize, kSize, {red, 0, inner, outer});
}

class Tessellation : public testing::Test {
  protected:
    struct Draw {
        std::vector<Vertex> vertices;
        std::string control = "tri_tesc", evaluation = "tri_tese", geometry{};
        uint32_t patchVertices = 3;
        std::vector<uint32_t> indices{};
        bool restart = false, lowerLeft = false;
        VkCullModeFlags cull = VK_CULL_MODE_NONE;
        uint32_t instances = 1, threads = 2;
        Isa isa = bestIsa();
    };
    /// Adds up what is drawn: alpha counts how often a pixel is covered.
    std::unique_ptr<Surface> draw(const Draw& what) {
        PipelineOptions options;
        options.control = what.control;
        options.evaluation = what.evaluation;
        options.geometry = what.geometry;
        options.isa = what.isa;
        options.state = plainState(kWide);
        setAdditive(options.state);
        options.state.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
        options.state.patchControlPoints = what.patchVertices;
        options.state.domainLowerLeft = what.lowerLeft;
        options.state.primitiveRestart = what.restart;
        options.state.cullMode = what.cull;
        auto surface = std::make_unique<Surface>(kWide, kSize, kSize);
        ThreadPool pool(what.threads);
        Pass pass(pool, {surface->cleared({})}, {}, kSize, kSize);
        pass.begin();
        pass.draw(makePipeline(options), dynamicFor(kSize, kSize), what.vertices, what.indices, what.instances);
        pass.end();
        statistics_ = pass.pass().statistics();
        return surface;
    }
    static float alpha(Surface& surface, uint32_t x, uint32_t y) { return surface.color(x, y).float32[3]; }
    static double covered(Surface& surface) {
        double sum = 0;
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x) sum += double{alpha(surface, x, y)};
        return sum;
    }
    PassStatistics statistics_;
};

/// A grid of squares over more than the target, each two triangles whose sides have the same levels from either patch.
std::vector<Vertex> sheet(uint32_t seed) {
    constexpr uint32_t kCells = 4;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> level(0.3f, 9.0f);
    std::array<std::array<std::array<float, 3>, kCells + 1>, kCells + 1> levels{};  // by cell: left, top, diagonal
    for (auto& row : levels)
        for (auto& cell : row)
            for (float& l : cell) l = level(random);
    std::array<std::array<std::array<double, 2>, kCells + 1>, kCells + 1> places{};
    for (uint32_t j = 0; j <= kCells; ++j) {
        for (uint32_t i = 0; i <= kCells; ++i) {
            const bool inside = i > 0 && j > 0 && i < kCells && j < kCells;
            const auto shift = [&] { return inside ? double{level(random)} - 4.0 : 0.0; };
            places[j][i] = {i * 20.0 - 8 + shift(), j * 20.0 - 8 + shift()};
        }
    }
    std::vector<Vertex> vertices;
    for (uint32_t j = 0; j < kCells; ++j) {
        for (uint32_t i = 0; i < kCells; ++i) {
            const auto& a = places[j][i];
            const auto& b = places[j][i + 1];
            const auto& c = places[j + 1][i];
            const auto& d = places[j + 1][i + 1];
            const auto& own = levels[j][i];
            const float inner = level(random);
            // The level of a vertex is that of the side opposite to it.
            vertices.push_back(corner(a[0], a[1], inner, own[2]));
            vertices.push_back(corner(b[0], b[1], inner, own[0]));
            vertices.push_back(corner(c[0], c[1], inner, own[1]));
            vertices.push_back(corner(d[0], d[1], inner, own[2]));
            vertices.push_back(corner(c[0], c[1], inner, levels[j][i + 1][0]));
            vertices.push_back(corner(b[0], b[1], inner, levels[j + 1][i][1]));
        }
    }
    return vertices;
}

TEST_F(Tessellation, SheetsOfPatchesCoverEveryPixelOnce) {
    for (uint32_t seed = 0; seed < 12; ++seed) {
        const auto surface = draw({sheet(seed)});
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x)
                ASSERT_EQ(alpha(*surface, x, y), 1.0f) << seed << ": " << x << ", " << y;
        EXPECT_EQ(statistics_.controlPatches, 32u);
        EXPECT_EQ(statistics_.inputPrimitives, 32u);
    }
}

TEST_F(Tessellation, TheSameWithAnyThreadsAndInstructionSets) {
    Draw what{sheet(3)};
    what.instances = 3;
    what.threads = 1;
    const uint64_t expected = draw(what)->hash();
    const PassStatistics statistics = statistics_;
    for (const uint32_t threads : {2u, 5u}) {
        what.threads = threads;
        EXPECT_EQ(draw(what)->hash(), expected);
        EXPECT_EQ(statistics_.evaluationInvocations, statistics.evaluationInvocations);
        EXPECT_EQ(statistics_.clippingInvocations, statistics.clippingInvocations);
    }
    what.isa = kLowestIsa;
    EXPECT_EQ(draw(what)->hash(), expected);
}

TEST_F(Tessellation, ValuesOfVerticesAndOfThePatchArrive) {
    const auto surface = draw({{corner(-70, -70, 5, 5, 0), corner(200, -70, 5, 4, 27), corner(-70, 200, 5, 7, 0)}});
    for (const uint32_t x : {3u, 30u, 60u}) {
        const VkClearColorValue color = surface->color(x, 20);
        EXPECT_NEAR(color.float32[0], (x + 70.5) / 10, 1e-3);
        EXPECT_EQ(color.float32[1], 0.0f);
        EXPECT_NEAR(color.float32[2], 3.0f, 1e-5);
    }
    EXPECT_EQ(statistics_.controlPatches, 1u);
}

TEST_F(Tessellation, PrimitiveIdsAreThoseOfPatches) {
    std::vector<Vertex> vertices;
    for (int n = 0; n < 8; ++n)
        for (const auto& [dx, dy] : {std::pair(0, 0), std::pair(8, 0), std::pair(0, 90)})
            vertices.push_back(corner(n * 8 + dx, dy, 3, 3));
    const auto surface = draw({vertices});
    for (uint32_t n = 0; n < 8; ++n) EXPECT_NEAR(surface->color(n * 8 + 1, 1).float32[1], n, 1e-4);
}

TEST_F(Tessellation, CountsOfPointsLinesAndTriangles) {
    const std::vector<Vertex> patch{corner(2.5, 2.5, 6, 4), corner(60.5, 2.5, 6, 5), corner(2.5, 60.5, 6, 7)};
    draw({patch, "tri_tesc", "tripoints_tese"});
    // Sides, then rings of 4 and 2 segments a side, then the middle.
    const uint32_t points = 4 + 5 + 7 + 12 + 6 + 1;
    EXPECT_EQ(statistics_.evaluationInvocations, points);
    EXPECT_EQ(statistics_.clippingInvocations, points);
    EXPECT_EQ(statistics_.rasterPrimitives, points);
    draw({patch, "tri_tesc", "trilines_tese"});
    EXPECT_EQ(statistics_.evaluationInvocations, 4u * 6);
    EXPECT_EQ(statistics_.clippingInvocations, 4u * 5);
    draw({patch});  // fractional odd: 5, 5, 7 and 7
    EXPECT_EQ(statistics_.evaluationInvocations, 5u + 5 + 7 + 15 + 9 + 3);
}

TEST_F(Tessellation, LinesFollowTheirDomain) {
    const auto surface =
        draw({{corner(0, 0.5, 1, 4), corner(64, 0.5, 1, 8), corner(0, 64.5, 1, 1)}, "tri_tesc", "trilines_tese"});
    for (const uint32_t line : {0u, 1u, 2u, 3u}) {
        EXPECT_EQ(alpha(*surface, 10, line * 16), 1.0f);
        EXPECT_NEAR(surface->color(10, line * 16).float32[0], 10.5 / 64, 1e-3);
        EXPECT_NEAR(surface->color(10, line * 16).float32[1], line / 4.0, 1e-6);
    }
    EXPECT_EQ(alpha(*surface, 10, 8), 0.0f);
}

TEST_F(Tessellation, QuadsOfMoreVerticesThanTheDomainNeeds) {
    // The fifth vertex of each patch goes in, and is not read.
    std::vector<Vertex> patch{corner(0, 0, 3, 2), corner(64, 0, 2, 1), corner(64, 64, 1, 5), corner(0, 64, 1, 64),
                              corner(5, 5, 0, 0)};
    for (const uint32_t vertices : {4u, 5u}) {
        Draw what{patch, "quad_tesc", "quad_tese"};
        what.patchVertices = vertices;
        const auto surface = draw(what);
        EXPECT_EQ(covered(*surface), double{kSize} * kSize);
        EXPECT_EQ(statistics_.evaluationInvocations, 2u + 1 + 5 + 64 + 2 * 1);
        const VkClearColorValue color = surface->color(16, 40);
        EXPECT_NEAR(color.float32[0], 16.5 / 64, 1e-4);
        EXPECT_NEAR(color.float32[1], 40.5 / 64, 1e-4);
        EXPECT_NEAR(color.float32[2], 1 + 2, 1e-5);
    }
}

TEST_F(Tessellation, CulledPatchesLeaveNothing) {
    std::vector<Vertex> vertices = sheet(1);
    for (size_t n = 0; n < vertices.size(); n += 6) vertices[n + 1].color[3] = -1;
    const auto surface = draw({vertices});
    EXPECT_LT(covered(*surface), 0.75 * kSize * kSize);
    EXPECT_GT(covered(*surface), 0.25 * kSize * kSize);
    EXPECT_EQ(statistics_.controlPatches, 32u);
    for (Vertex& vertex : vertices) vertex.color[3] = 0;
    EXPECT_EQ(covered(*draw({vertices})), 0);
    EXPECT_EQ(statistics_.evaluationInvocations, 0u);
}

TEST_F(Tessellation, WindingTurnsWithTheDomainsOrigin) {
    Draw what{{corner(0, 0, 3, 3), corner(64, 0, 3, 3), corner(0, 64, 3, 3)}};
    what.cull = VK_CULL_MODE_BACK_BIT;
    const double front = covered(*draw(what));
    what.lowerLeft = true;
    const double turned = covered(*draw(what));
    EXPECT_GT(std::max(front, turned), 1500);
    EXPECT_EQ(std::min(front, turned), 0);
}

TEST_F(Tessellation, IndicesRestartAndLeaveIncompletePatches) {
    const std::vector<Vertex> corners{corner(0, 0, 2, 2), corner(64, 0, 2, 2), corner(0, 64, 2, 2),
                                      corner(64, 64, 2, 2)};
    Draw what{corners};
    what.indices = {0, 1, 2, 3, ~0u, 3, 2, 1, 0};
    what.restart = true;
    EXPECT_EQ(covered(*draw(what)), double{kSize} * kSize);
    EXPECT_EQ(statistics_.controlPatches, 2u);
    what.indices = {0, 1, 2, 3, 2, 1, 0, 1};
    what.restart = false;
    EXPECT_EQ(covered(*draw(what)), double{kSize} * kSize);
}

TEST_F(Tessellation, GeometryStagesGetWhatPatchesBecome) {
    Draw what{sheet(5)};
    const uint64_t expected = draw(what)->hash();
    const uint64_t triangles = statistics_.clippingInvocations;
    what.geometry = "pass_geom";
    EXPECT_EQ(draw(what)->hash(), expected);
    EXPECT_EQ(statistics_.geometryInvocations, triangles);
    EXPECT_EQ(statistics_.geometryPrimitives, triangles);
}

TEST_F(Tessellation, WhatDoesNotFitIsRefused) {
    const ir::Program vertex = loadForTest("color_vert", ir::Stage::vertex);
    const ir::Program control = loadForTest("tri_tesc", ir::Stage::control);
    const ir::Program evaluation = loadForTest("tri_tese", ir::Stage::evaluation);
    ShaderProgramDesc desc;
    desc.vertex = &vertex;
    desc.control = &control;
    EXPECT_FALSE(ShaderProgram::create(desc).ok());
    desc.evaluation = &evaluation;
    EXPECT_FALSE(ShaderProgram::create(desc).ok());  // no domain
    desc.tessellation =
        joined(modesForTest("tri_tesc", ir::Stage::control), modesForTest("tri_tese", ir::Stage::evaluation));
    const auto program = ShaderProgram::create(desc);
    ASSERT_TRUE(program.ok()) << program.error().message;
    GraphicsState state = plainState(kWide);
    EXPECT_FALSE(GraphicsPipeline::create({state, *program}).ok());
    state.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
    state.patchControlPoints = 33;
    EXPECT_FALSE(GraphicsPipeline::create({state, *program}).ok());
    state.patchControlPoints = 32;
    EXPECT_TRUE(GraphicsPipeline::create({state, *program}).ok());
}

}  // namespace
}  // namespace vernier::raster_test
