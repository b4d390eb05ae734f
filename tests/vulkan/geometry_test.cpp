// Geometry shaders through the driver: what the stage is given, what it puts out, and how large that may be.
#include <numeric>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{96, 80};  // more than one tile of the rasteriser
constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;

class GeometryTest : public ComputeTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_EXTENDED_DYNAMIC_STATE_EXTENSION_NAME, VK_KHR_MULTIVIEW_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        dynamic_.extendedDynamicState = VK_TRUE;
        multiview_.multiview = multiview_.multiviewGeometryShader = VK_TRUE;
        dynamic_.pNext = &multiview_;
        return &dynamic_;
    }
    TestImage target(uint32_t layers = 1) {
        return makeImage(kFormat, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_1_BIT, layers);
    }
    static PipelineDesc pointsIn() {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.change = [](const PipelineStates& states) { states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST; };
        return desc;
    }
    VkShaderModule vertex(const std::string& more = "") {
        return makeShader(VK_SHADER_STAGE_VERTEX_BIT,
                          "#version 450\nlayout(location = 0) flat out int number;\n"
                          "void main() { gl_Position = vec4(0, 0, 0.5, 1);"
                          " number = gl_VertexIndex;" +
                              more + "}");
    }
    VkShaderModule geometry(const std::string& glsl) {
        return makeShader(VK_SHADER_STAGE_GEOMETRY_BIT, "#version 450\n" + glsl);
    }
    VkShaderModule fragment(const std::string& glsl) {
        return makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, "#version 450\nlayout(location = 0) out vec4 color;\n" + glsl);
    }
    VkQueryPool statistics(VkQueryPipelineStatisticFlags bits) {
        return makeQueries(VK_QUERY_TYPE_PIPELINE_STATISTICS, 1, bits);
    }
    struct Draw {
        uint32_t vertices = 1, instances = 1;
        VkDescriptorSet set = VK_NULL_HANDLE;
        VkPipelineLayout layout = VK_NULL_HANDLE;
        std::vector<uint32_t> push{};
    };
    /// One draw of a pass; the values of the query, if there is one.
    std::vector<uint64_t> render(const Pass& pass, VkPipeline pipeline, const Draw& draw,
                                 VkQueryPool queries = VK_NULL_HANDLE, uint32_t values = 0) {
        const VkCommandBuffer commands = begin();
        if (queries != VK_NULL_HANDLE) vkCmdResetQueryPool(commands, queries, 0, 1);
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        if (draw.set != VK_NULL_HANDLE)
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, draw.layout, 0, 1, &draw.set, 0,
                                    nullptr);
        if (!draw.push.empty())
            vkCmdPushConstants(commands, draw.layout, VK_SHADER_STAGE_GEOMETRY_BIT, 0,
                               static_cast<uint32_t>(4 * draw.push.size()), draw.push.data());
        if (queries != VK_NULL_HANDLE) vkCmdBeginQuery(commands, queries, 0, 0);
        vkCmdDraw(commands, draw.vertices, draw.instances, 0, 0);
        if (queries != VK_NULL_HANDLE) vkCmdEndQuery(commands, queries, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        std::vector<uint64_t> counts(values);
        if (queries != VK_NULL_HANDLE) {
            EXPECT_EQ(vkGetQueryPoolResults(device, queries, 0, 1, 8 * values, counts.data(), 8 * values,
                                            VK_QUERY_RESULT_64_BIT),
                      VK_SUCCESS);
        }
        return counts;
    }
    std::vector<uint32_t> pixels(const TestImage& image, uint32_t layer = 0) {
        const std::vector<uint8_t> bytes = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4, layer);
        std::vector<uint32_t> words(bytes.size() / 4);
        std::memcpy(words.data(), bytes.data(), bytes.size());
        return words;
    }
    static uint32_t at(const std::vector<uint32_t>& words, uint32_t x, uint32_t y) {
        return words[y * kExtent.width + x];
    }
    static size_t drawn(const std::vector<uint32_t>& words) {
        return words.size() - static_cast<size_t>(std::count(words.begin(), words.end(), 0u));
    }

  private:
    VkPhysicalDeviceExtendedDynamicStateFeaturesEXT dynamic_ = make<VkPhysicalDeviceExtendedDynamicStateFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE_FEATURES_EXT);
    VkPhysicalDeviceMultiviewFeatures multiview_ =
        make<VkPhysicalDeviceMultiviewFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES);
};

// A bar for each point, as descriptors, push constants, constants and the vertex say; and what the stage writes itself.
TEST_F(GeometryTest, everythingThatAStageIsGiven) {
    const TestImage image = target();
    const Pass pass = makePass(image);
    const TestBuffer heights = makeStorage(6), counter = makeStorage(1);
    std::iota(words(heights), words(heights) + 6, 1u);
    PipelineDesc desc = pointsIn();
    desc.vertex = vertex();
    desc.geometry = geometry(R"(
layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
layout(constant_id = 3) const int kWidth = 1;
layout(set = 0, binding = 0) readonly buffer Heights { uint heights[]; };
layout(set = 0, binding = 1) buffer Counter { uint count; };
layout(push_constant) uniform Push { float step, unit; } push;
layout(location = 0) flat in int number[];
layout(location = 0) flat out int bar;
void corner(float x, float y) {
    gl_Position = vec4(x * push.unit - 1.0, y * 0.1 - 1.0, 0.5, 1.0);
    bar = number[0] + 1;
    EmitVertex();
}
void main() {
    float left = float(number[0]) * push.step, right = left + float(kWidth), top = float(heights[number[0]]);
    corner(left, 0.0);
    corner(right, 0.0);
    corner(left, top);
    corner(right, top);
    atomicAdd(count, uint(gl_PrimitiveIDIn) + 1u);
})");
    desc.fragment = fragment("layout(location = 0) flat in int bar; void main() { color = vec4(bar / 255.0); }");
    const uint32_t wide = 8;
    const VkSpecializationMapEntry entry{3, 0, 4};
    const VkSpecializationInfo special{1, &entry, 4, &wide};
    desc.specialization = &special;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    const VkDescriptorSet set = makeSet({storageBuffer(heights), storageBuffer(counter)}, &setLayout);
    desc.layout = makeLayout({setLayout}, 8, VK_SHADER_STAGE_GEOMETRY_BIT);
    const float push[2] = {16, 2.0f / 96};
    uint32_t bits[2];
    std::memcpy(bits, push, sizeof bits);
    render(pass, makePipeline(pass.pass, desc), {6, 1, set, desc.layout, {bits[0], bits[1]}});
    const std::vector<uint32_t> got = pixels(image);
    for (uint32_t bar = 0; bar < 6; ++bar) {
        for (const uint32_t y : {0u, 4 * bar + 3, 4 * bar + 4}) {
            EXPECT_EQ(at(got, bar * 16 + 3, y) & 0xFF, y < 4 * (bar + 1) ? bar + 1 : 0) << bar << " " << y;
            EXPECT_EQ(at(got, bar * 16 + 12, y), 0u);
        }
    }
    EXPECT_EQ(words(counter)[0], 21u);
}

// The six faces of a cube from one triangle, each by an invocation, into layers; odd ones through another viewport.
TEST_F(GeometryTest, layersAndViewportsByInvocation) {
    const TestImage image = target(6);
    const Pass pass = makePass(image, nullptr, nullptr, VK_SAMPLE_COUNT_1_BIT, 6);
    PipelineDesc desc;
    desc.extent = kExtent;
    const VkViewport viewports[2] = {{0, 0, 96, 80, 0, 1}, {48, 40, 48, 40, 0, 1}};
    const VkRect2D scissors[2] = {{{0, 0}, kExtent}, {{50, 40}, {40, 40}}};
    desc.change = [&](const PipelineStates& states) {
        states.viewport.viewportCount = states.viewport.scissorCount = 2;
        states.viewport.pViewports = viewports;
        states.viewport.pScissors = scissors;
    };
    desc.vertex = fullScreen();
    desc.geometry = geometry(R"(
layout(triangles, invocations = 6) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) flat out int face;
void main() {
    if (gl_InvocationID == 2) return;
    for (int v = 0; v < 3; ++v) {
        gl_Position = gl_in[v].gl_Position;
        gl_Layer = gl_InvocationID;
        gl_ViewportIndex = gl_InvocationID & 1;
        gl_PrimitiveID = 10 + gl_InvocationID;
        face = gl_InvocationID + 1;
        EmitVertex();
    }
})");
    desc.fragment = fragment(
        "layout(location = 0) flat in int face;"
        "void main() { color = vec4(face, gl_PrimitiveID, gl_Layer, gl_ViewportIndex) / 255.0; }");
    render(pass, makePipeline(pass.pass, desc), {3});
    for (uint32_t layer = 0; layer < 6; ++layer) {
        const std::vector<uint32_t> got = pixels(image, layer);
        const uint32_t odd = layer & 1, value = (layer + 1) | (10 + layer) << 8 | layer << 16 | odd << 24;
        EXPECT_EQ(at(got, 60, 60), layer == 2 ? 0 : value) << layer;
        EXPECT_EQ(at(got, 49, 60), layer == 2 || odd != 0 ? 0 : value) << layer;
        EXPECT_EQ(at(got, 3, 3), layer == 2 || odd != 0 ? 0 : value) << layer;
    }
}

TEST_F(GeometryTest, everyViewHasAStageOfItsOwn) {
    const TestImage image = target(3);
    const Pass pass = makePass(image, nullptr, nullptr, VK_SAMPLE_COUNT_1_BIT, 1, 0b110);
    PipelineDesc desc;
    desc.extent = kExtent;
    desc.vertex = fullScreen();
    desc.geometry = geometry(R"(
#extension GL_EXT_multiview : require
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) flat out int view;
void main() {
    for (int v = 0; v < 3 * gl_ViewIndex - 2; ++v) {
        gl_Position = gl_in[v].gl_Position;
        view = gl_ViewIndex;
        EmitVertex();
    }
})");
    desc.fragment = fragment("layout(location = 0) flat in int view; void main() { color = vec4(view / 255.0); }");
    render(pass, makePipeline(pass.pass, desc), {3});
    // The first view's strip is too short for a triangle.
    EXPECT_EQ(drawn(pixels(image, 1)), 0u);
    EXPECT_EQ(at(pixels(image, 2), 40, 40), 0x02020202u);
}

TEST_F(GeometryTest, pointsOfTheirSizesAndClippedTriangles) {
    const TestImage image = target();
    const Pass pass = makePass(image);
    PipelineDesc desc = pointsIn();
    desc.vertex = vertex("gl_PointSize = 1;");
    desc.geometry = geometry(R"(
layout(points) in;
layout(points, max_vertices = 3) out;
in gl_PerVertex { vec4 gl_Position; float gl_PointSize; } gl_in[];
out gl_PerVertex { vec4 gl_Position; float gl_PointSize; };
void main() {
    for (int n = 0; n < 3; ++n) {
        gl_Position = vec4(float(n) * 0.5 - 0.5, 0.0, 0.5, 1.0);
        gl_PointSize = gl_in[0].gl_PointSize * float(2 << n);
        EmitVertex();
    }
})");
    desc.fragment = constantColor("1");
    render(pass, makePipeline(pass.pass, desc), {1});
    EXPECT_EQ(drawn(pixels(image)), 4u + 16u + 64u);

    const TestImage half = target();
    const Pass clipped = makePass(half);
    PipelineDesc cut;
    cut.extent = kExtent;
    cut.vertex = fullScreen();
    cut.fragment = desc.fragment;
    cut.geometry = geometry(R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 6) out;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; float gl_CullDistance[1]; };
void main() {
    for (int copy = 0; copy < 2; ++copy) {
        for (int v = 0; v < 3; ++v) {
            gl_Position = gl_in[v].gl_Position;
            gl_ClipDistance[0] = copy == 0 ? gl_Position.x : 1.0;
            gl_CullDistance[0] = copy == 0 ? 1.0 : -1.0;
            EmitVertex();
        }
        EndPrimitive();
    }
})");
    render(clipped, makePipeline(clipped.pass, cut), {3});
    const std::vector<uint32_t> got = pixels(half);
    EXPECT_EQ(drawn(got), 48u * 80u);
    EXPECT_EQ(at(got, 47, 40), 0u);
    EXPECT_EQ(at(got, 48, 40), ~0u);
}

TEST_F(GeometryTest, invocationsAndPrimitivesAreCounted) {
    const TestImage image = target();
    const Pass pass = makePass(image);
    PipelineDesc desc = pointsIn();
    desc.vertex = vertex();
    desc.geometry = geometry(R"(
layout(points, invocations = 4) in;
layout(triangle_strip, max_vertices = 7) out;
layout(location = 0) flat in int number[];
void main() {
    for (int v = 0; v < 4 + gl_InvocationID; ++v) {
        gl_Position = vec4(float(v & 1), float(v), 0.5, 1.0);
        EmitVertex();
        if (number[0] == 1 && v == 1) EndPrimitive();
    }
})");
    desc.fragment = constantColor("1");
    const VkQueryPool queries = statistics(VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT |
                                           VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_INVOCATIONS_BIT |
                                           VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_PRIMITIVES_BIT |
                                           VK_QUERY_PIPELINE_STATISTIC_CLIPPING_INVOCATIONS_BIT);
    // Strips of 4 to 7 vertices, without the first two of each where a strip ends behind them.
    const uint64_t whole = 2 + 3 + 4 + 5, cut = 0 + 1 + 2 + 3;
    EXPECT_EQ(render(pass, makePipeline(pass.pass, desc), {3}, queries, 4),
              (std::vector<uint64_t>{3, 12, 2 * whole + cut, 2 * whole + cut}));
}

TEST_F(GeometryTest, asLargeAsTheLimits) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physicalDevice, &properties);
    const VkPhysicalDeviceLimits& limits = properties.limits;
    EXPECT_GE(limits.maxGeometryShaderInvocations, 32u);
    EXPECT_GE(limits.maxGeometryOutputVertices, 256u);
    EXPECT_GE(limits.maxGeometryTotalOutputComponents, 1024u);
    EXPECT_GE(limits.maxGeometryInputComponents, 64u);
    EXPECT_GE(limits.maxGeometryOutputComponents, 64u);
    // As many vertices of as many components as there may be together, by as many invocations: a pixel for each.
    const uint32_t vertices = limits.maxGeometryOutputVertices;
    const uint32_t components = std::min(limits.maxGeometryTotalOutputComponents / vertices - 5,  // position and size
                                         limits.maxGeometryOutputComponents - 5) /
                                4 * 4;
    const uint32_t invocations = limits.maxGeometryShaderInvocations;
    ASSERT_GE(components, 4u);
    const VkExtent2D extent{vertices, invocations};
    const TestImage image = makeImage(kFormat, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(image);
    PipelineDesc desc = pointsIn();
    desc.extent = extent;
    // Inputs: all that may be there, but for the position and the size.
    const uint32_t inputs = limits.maxGeometryInputComponents / 4 - 2;
    const std::string in = std::to_string(inputs), out = std::to_string(components / 4);
    desc.vertex =
        makeShader(VK_SHADER_STAGE_VERTEX_BIT, "#version 450\nlayout(location = 0) out vec4 values[" + in +
                                                   "];\nvoid main() { gl_Position = vec4(1); gl_PointSize = 1;\n"
                                                   "for (int n = 0; n < " +
                                                   in + "; ++n) values[n] = vec4(n % 2) / 255.0; }");
    desc.geometry = geometry("layout(points, invocations = " + std::to_string(invocations) +
                             ") in;\nlayout(points, max_vertices = " + std::to_string(vertices) +
                             ") out;\nlayout(location = 0) in vec4 values[][" + in +
                             "];\nlayout(location = 0) out vec4 results[" + out +
                             "];\n"
                             "void main() {\n"
                             "    vec4 sum = vec4(0);\n"
                             "    for (int n = 0; n < " +
                             in +
                             "; ++n) sum += values[0][n];\n"
                             "    for (int v = 0; v < " +
                             std::to_string(vertices) +
                             "; ++v) {\n"
                             "        gl_Position = vec4((float(v) + 0.5) * " +
                             std::to_string(2.0 / vertices) + " - 1.0, (float(gl_InvocationID) + 0.5) * " +
                             std::to_string(2.0 / invocations) +
                             " - 1.0, 0.5, 1.0);\n        gl_PointSize = 1.0;\n"
                             "        for (int n = 0; n < " +
                             out +
                             "; ++n) results[n] = sum * float(n + 1);\n"
                             "        EmitVertex();\n    }\n}");
    desc.fragment = fragment("layout(location = 0) in vec4 results[" + out + "]; void main() { color = results[" + out +
                             " - 1]; }");
    render(pass, makePipeline(pass.pass, desc), {1});
    const uint32_t sum = inputs / 2 * (components / 4);
    const std::vector<uint8_t> got = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    EXPECT_EQ(std::count(got.begin(), got.end(), static_cast<uint8_t>(sum)), static_cast<ptrdiff_t>(got.size()));
}

// The topology may come with the draw; the pipeline's own does not fit.
TEST_F(GeometryTest, topologyFromCommands) {
    VERNIER_SKIP_WHEN_VALIDATED();  // the layer does not know dynamicPrimitiveTopologyUnrestricted
    const TestImage image = target();
    const Pass pass = makePass(image);
    PipelineDesc desc;
    desc.extent = kExtent;
    desc.dynamic = {VK_DYNAMIC_STATE_PRIMITIVE_TOPOLOGY};
    desc.vertex = fullScreen();
    desc.geometry = geometry(R"(
layout(lines) in;
layout(triangle_strip, max_vertices = 3) out;
void main() {
    gl_Position = gl_in[0].gl_Position;
    EmitVertex();
    gl_Position = gl_in[1].gl_Position;
    EmitVertex();
    gl_Position = vec4(gl_in[0].gl_Position.x, -gl_in[0].gl_Position.y, 0.5, 1.0);
    EmitVertex();
})");
    desc.fragment = constantColor("1");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const auto setTopology = command<PFN_vkCmdSetPrimitiveTopologyEXT>("vkCmdSetPrimitiveTopologyEXT");
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    setTopology(commands, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP);
    vkCmdDraw(commands, 2, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    // (-1, -1), (3, -1), (-1, 1): half of the target, and a triangle of it.
    EXPECT_GT(drawn(pixels(image)), 48u * 80u);
}

TEST_F(GeometryTest, topologiesThatDoNotFitAreRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestImage image = target();
    PipelineDesc desc;
    desc.extent = kExtent;
    desc.vertex = vertex();
    desc.geometry = geometry("layout(points) in; layout(points, max_vertices = 1) out; void main() {}");
    desc.fragment = constantColor("1");
    makePipeline(makePass(image).pass, desc, VK_ERROR_UNKNOWN);
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages.back().find("it takes points, the topology is of triangles"), std::string::npos)
        << messages.back();
}

}  // namespace
}  // namespace vernier::test
