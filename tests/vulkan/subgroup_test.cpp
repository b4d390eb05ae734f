// Subgroups as VkPhysicalDeviceSubgroupProperties reports them: every operation in compute, and what it means in the
// other stages. The arithmetic itself is proved where the engine is (tests/spirv_interp/subgroup_test.cpp,
// tests/proof).
#include <algorithm>
#include <map>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

constexpr uint32_t kSize = 32;

// How invocations share subgroups is the device's business: what those of one must agree on is not. Each takes a
// number, and tells what it sees of the others.
constexpr const char* kProbe = R"(#version 450
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_clustered : require
#extension GL_KHR_shader_subgroup_quad : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
layout(set = 0, binding = 0) buffer Results { uint count; uint seen[]; };
void probe() {
    uint me = atomicAdd(count, 1u), at = gl_SubgroupInvocationID, base = me * 10u;
    seen[base] = at;
    seen[base + 1u] = subgroupBroadcastFirst(me);
    seen[base + 2u] = subgroupBallot(true).x;
    seen[base + 3u] = subgroupAdd(me);
    seen[base + 4u] = subgroupExclusiveAdd(me);
    seen[base + 5u] = subgroupBallot((me & 1u) != 0u).x;
    seen[base + 6u] = subgroupShuffle(me, at ^ 5u);
    seen[base + 7u] = subgroupQuadSwapDiagonal(me);
    seen[base + 8u] = subgroupClusteredMax(me, 4u);
    seen[base + 9u] = (subgroupElect() ? 1u : 0u) | (subgroupAll(me < 4096u) ? 2u : 0u) |
                      (subgroupAny(me == 0u) ? 4u : 0u) | (subgroupAllEqual(me) ? 8u : 0u) | gl_SubgroupSize << 4;
}
)";
constexpr uint32_t kMostProbes = 1024;
struct Probe {
    uint32_t at, leader, here, sum, before, odd, fifth, diagonal, cluster, votes;
};

/// What one subgroup has seen; by place.
void checkSubgroup(const std::map<uint32_t, std::pair<uint32_t, Probe>>& members) {
    uint32_t here = 0, odd = 0, sum = 0, before = 0;
    bool zero = false;
    for (const auto& [at, member] : members) {
        here |= 1u << at;
        zero |= member.first == 0;
        odd |= (member.first & 1) << at;
        sum += member.first;
    }
    const auto numberAt = [&](uint32_t at, uint32_t otherwise) {
        const auto found = members.find(at);
        return found == members.end() ? otherwise : found->second.first;
    };
    for (const auto& [at, member] : members) {
        const auto& [number, probe] = member;
        EXPECT_EQ(probe.here, here) << number;
        EXPECT_EQ(probe.odd, odd) << number;
        EXPECT_EQ(probe.sum, sum) << number;
        EXPECT_EQ(probe.before, before) << number;
        before += number;
        EXPECT_EQ(probe.leader, members.begin()->second.first) << number;
        // Of a place where nobody is, anything may come.
        EXPECT_EQ(probe.fifth, numberAt(at ^ 5, probe.fifth)) << number;
        EXPECT_EQ(probe.diagonal, numberAt(at ^ 3, probe.diagonal)) << number;
        uint32_t cluster = 0;
        for (uint32_t k = 0; k < 4; ++k) cluster = std::max(cluster, numberAt((at & ~3u) + k, 0));
        EXPECT_EQ(probe.cluster, cluster) << number;
        const bool first = at == members.begin()->first;
        EXPECT_EQ(probe.votes, (first ? 1u : 0u) | 2u | (zero ? 4u : 0u) | (members.size() == 1 ? 8u : 0u) | kSize << 4)
            << number;
    }
}

class SubgroupTest : public ComputeTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
    std::vector<const char*> moreExtensions() override {
        return {VK_KHR_SHADER_SUBGROUP_EXTENDED_TYPES_EXTENSION_NAME, VK_KHR_SHADER_FLOAT16_INT8_EXTENSION_NAME,
                VK_KHR_16BIT_STORAGE_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        extended_.shaderSubgroupExtendedTypes = VK_TRUE;
        narrow_.shaderFloat16 = narrow_.shaderInt8 = VK_TRUE;
        extended_.pNext = &narrow_;
        return &extended_;
    }
    VkPhysicalDeviceSubgroupProperties subgroups() const {
        return properties<VkPhysicalDeviceSubgroupProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES);
    }
    /// Runs two subgroups, each invocation of which stores the value of an expression over `i`, its place among 64.
    std::vector<uint32_t> evaluate(const std::string& expression) {
        const TestBuffer results = makeStorage(2 * kSize);
        const Compute compute = makeCompute(R"(#version 450
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_shuffle_relative : require
#extension GL_KHR_shader_subgroup_clustered : require
#extension GL_KHR_shader_subgroup_quad : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_shader_subgroup_extended_types_int8 : require
#extension GL_EXT_shader_subgroup_extended_types_int16 : require
#extension GL_EXT_shader_subgroup_extended_types_int64 : require
#extension GL_EXT_shader_subgroup_extended_types_float16 : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Results { uint results[]; };
void main() {
    uint i = gl_LocalInvocationIndex;
    results[i] = uint()" + expression + R"();
})",
                                            {storageBuffer(results)});
        run(compute, 1);
        return {words(results), words(results) + 2 * kSize};
    }
    /// The expression gives what `expected` says for every place in the work-group.
    void expect(const std::string& expression, const std::function<uint32_t(uint32_t)>& expected) {
        const std::vector<uint32_t> got = evaluate(expression);
        for (uint32_t i = 0; i < got.size(); ++i) ASSERT_EQ(got[i], expected(i)) << expression << " at " << i;
    }

    VkShaderModule probing(VkShaderStageFlagBits stage, const std::string& glsl) {
        return makeShader(stage, kProbe + glsl);
    }
    VkShaderModule plainVertex() {
        return makeShader(VK_SHADER_STAGE_VERTEX_BIT,
                          "#version 450\nvoid main() { gl_Position = vec4(0, 0, 0, 1); gl_PointSize = 1; }");
    }
    /// Patches of four points, each a square of 16.
    PipelineDesc tessellated() {
        PipelineDesc desc;
        desc.patchControlPoints = 4;
        desc.vertex = plainVertex();
        desc.control = makeShader(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, R"(#version 450
layout(vertices = 1) out;
void main() {
    for (int n = 0; n < 4; ++n) gl_TessLevelOuter[n] = 3;
    gl_TessLevelInner[0] = gl_TessLevelInner[1] = 3;
})");
        desc.evaluation = makeShader(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, R"(#version 450
layout(quads, point_mode) in;
void main() { gl_Position = vec4(0, 0, 0, 1); gl_PointSize = 1; })");
        return desc;
    }
    /// Draws with the stage that probes, and checks what its invocations have seen. Returns how many there were.
    uint32_t probes(PipelineDesc desc, VkPrimitiveTopology topology, uint32_t vertices) {
        const TestBuffer results = makeStorage(1 + kMostProbes * sizeof(Probe) / 4);
        std::memset(results.data, 0, results.size);
        VkDescriptorSetLayout layout = VK_NULL_HANDLE;
        const VkDescriptorSet set = makeSet({storageBuffer(results)}, &layout);
        const TestImage image = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {8, 8}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        const Pass pass = makePass(image);
        desc.layout = makeLayout({layout}, 0);
        desc.extent = {8, 8};
        desc.change = [topology](const PipelineStates& states) {
            states.assembly.topology = topology;
            states.raster.rasterizerDiscardEnable = VK_TRUE;
        };
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
        vkCmdDraw(commands, vertices, 1, 0, 0);
        vkCmdEndRenderPass(commands);
        makeVisible(commands);
        submit(commands);
        const uint32_t count = std::min(*words(results), kMostProbes);
        std::vector<Probe> seen(count);
        std::memcpy(seen.data(), words(results) + 1, count * sizeof(Probe));
        std::map<uint32_t, std::map<uint32_t, std::pair<uint32_t, Probe>>> groups;
        size_t most = 0;
        for (uint32_t n = 0; n < count; ++n) {
            auto& members = groups[seen[n].leader];
            EXPECT_TRUE(members.try_emplace(seen[n].at, n, seen[n]).second) << "two at one place";
            most = std::max(most, members.size());
        }
        EXPECT_GE(most, 4u) << "subgroups of next to nobody show nothing";
        for (const auto& [leader, members] : groups) checkSubgroup(members);
        return count;
    }

  private:
    VkPhysicalDeviceShaderSubgroupExtendedTypesFeatures extended_ =
        make<VkPhysicalDeviceShaderSubgroupExtendedTypesFeatures>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_SUBGROUP_EXTENDED_TYPES_FEATURES);
    VkPhysicalDeviceShaderFloat16Int8Features narrow_ =
        make<VkPhysicalDeviceShaderFloat16Int8Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES);
};

/// The sum of a subgroup's places, of those up to i, of those before it.
uint32_t sumOf(uint32_t first, uint32_t last) {
    uint32_t sum = 0;
    for (uint32_t n = first; n < last; ++n) sum += n;
    return sum;
}
uint32_t firstOf(uint32_t i) {
    return i / kSize * kSize;
}

TEST_F(SubgroupTest, reportsWhatTheOtherTestsUse) {
    const VkPhysicalDeviceSubgroupProperties reported = subgroups();
    EXPECT_EQ(reported.subgroupSize, kSize);
    EXPECT_EQ(reported.supportedStages, VkFlags{VK_SHADER_STAGE_ALL_GRAPHICS | VK_SHADER_STAGE_COMPUTE_BIT});
    EXPECT_EQ(reported.supportedOperations,
              VkFlags{VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
                      VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT |
                      VK_SUBGROUP_FEATURE_SHUFFLE_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT |
                      VK_SUBGROUP_FEATURE_CLUSTERED_BIT | VK_SUBGROUP_FEATURE_QUAD_BIT});
    EXPECT_TRUE(reported.quadOperationsInAllStages);
}

TEST_F(SubgroupTest, basicAndVote) {
    expect("gl_SubgroupSize", [](uint32_t) { return kSize; });
    expect("gl_SubgroupID", [](uint32_t i) { return i / kSize; });
    expect("gl_NumSubgroups", [](uint32_t) { return 2; });
    expect("gl_SubgroupInvocationID", [](uint32_t i) { return i % kSize; });
    expect("subgroupElect()", [](uint32_t i) { return i % kSize == 0; });
    expect("subgroupAll(i < 40)", [](uint32_t i) { return i < kSize; });
    expect("subgroupAny(i == 40)", [](uint32_t i) { return i >= kSize; });
    expect("subgroupAllEqual(i / 32)", [](uint32_t) { return 1; });
    expect("subgroupAllEqual(i / 48)", [](uint32_t i) { return i < kSize; });
}

TEST_F(SubgroupTest, arithmeticAndClusters) {
    expect("subgroupAdd(i)", [](uint32_t i) { return sumOf(firstOf(i), firstOf(i) + kSize); });
    expect("subgroupInclusiveAdd(i)", [](uint32_t i) { return sumOf(firstOf(i), i + 1); });
    expect("subgroupExclusiveAdd(i)", [](uint32_t i) { return sumOf(firstOf(i), i); });
    expect("subgroupMin(i + 7)", [](uint32_t i) { return firstOf(i) + 7; });
    expect("subgroupMax(i)", [](uint32_t i) { return firstOf(i) + kSize - 1; });
    expect("subgroupXor(1u << (i % 32u))", [](uint32_t) { return ~0u; });
    expect("subgroupClusteredAdd(i, 4)", [](uint32_t i) { return sumOf(i / 4 * 4, i / 4 * 4 + 4); });
    expect("subgroupClusteredMax(i, 8)", [](uint32_t i) { return i / 8 * 8 + 7; });
}

TEST_F(SubgroupTest, ballotsAndShuffles) {
    expect("subgroupBallot(i % 3 == 0).x", [](uint32_t i) {
        uint32_t bits = 0;
        for (uint32_t n = 0; n < kSize; ++n) bits |= ((firstOf(i) + n) % 3 == 0 ? 1u : 0u) << n;
        return bits;
    });
    expect("subgroupBallotBitCount(subgroupBallot(i % 2 == 0))", [](uint32_t) { return kSize / 2; });
    expect("subgroupBroadcast(i, 5)", [](uint32_t i) { return firstOf(i) + 5; });
    expect("subgroupBroadcastFirst(i)", [](uint32_t i) { return firstOf(i); });
    expect("subgroupShuffle(i, (i * 7u) % 32u)", [](uint32_t i) { return firstOf(i) + i * 7 % kSize; });
    expect("subgroupShuffleXor(i, 3)", [](uint32_t i) { return i ^ 3; });
    expect("subgroupShuffleUp(i, 2) * uint(i % 32u >= 2u)", [](uint32_t i) { return i % kSize >= 2 ? i - 2 : 0; });
    expect("subgroupShuffleDown(i, 2) * uint(i % 32u < 30u)", [](uint32_t i) { return i % kSize < 30 ? i + 2 : 0; });
}

TEST_F(SubgroupTest, quads) {
    expect("subgroupQuadBroadcast(i, 2)", [](uint32_t i) { return i / 4 * 4 + 2; });
    expect("subgroupQuadSwapHorizontal(i)", [](uint32_t i) { return i ^ 1; });
    expect("subgroupQuadSwapVertical(i)", [](uint32_t i) { return i ^ 2; });
    expect("subgroupQuadSwapDiagonal(i)", [](uint32_t i) { return i ^ 3; });
}

TEST_F(SubgroupTest, extendedTypes) {
    expect("subgroupAdd(uint64_t(i) << 40) >> 40", [](uint32_t i) { return sumOf(firstOf(i), firstOf(i) + kSize); });
    expect("subgroupMax(int16_t(i) - 100s) + 100s", [](uint32_t i) { return firstOf(i) + kSize - 1; });
    expect("subgroupShuffleXor(uint8_t(i), 1)", [](uint32_t i) { return i ^ 1; });
    expect("subgroupAdd(float16_t(0.5))", [](uint32_t) { return kSize / 2; });
}

TEST_F(SubgroupTest, inVertexShaders) {
    PipelineDesc desc;
    desc.vertex = probing(VK_SHADER_STAGE_VERTEX_BIT,
                          "void main() { probe(); gl_Position = vec4(0, 0, 0, 1); gl_PointSize = 1; }");
    EXPECT_EQ(probes(desc, VK_PRIMITIVE_TOPOLOGY_POINT_LIST, 100), 100u);
}

TEST_F(SubgroupTest, inTessellationControlShaders) {
    PipelineDesc desc = tessellated();
    desc.control = probing(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, R"(
layout(vertices = 5) out;
void main() {
    probe();
    for (int n = 0; n < 4; ++n) gl_TessLevelOuter[n] = 1;
    gl_TessLevelInner[0] = gl_TessLevelInner[1] = 1;
})");
    EXPECT_EQ(probes(desc, VK_PRIMITIVE_TOPOLOGY_PATCH_LIST, 4 * 9), 5u * 9);
}

TEST_F(SubgroupTest, inTessellationEvaluationShaders) {
    PipelineDesc desc = tessellated();
    desc.evaluation = probing(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, R"(
layout(quads, point_mode) in;
void main() { probe(); gl_Position = vec4(0, 0, 0, 1); gl_PointSize = 1; })");
    // Points may be evaluated more than once.
    EXPECT_GE(probes(desc, VK_PRIMITIVE_TOPOLOGY_PATCH_LIST, 4 * 9), 9u * 16);
}

TEST_F(SubgroupTest, inGeometryShaders) {
    PipelineDesc desc;
    desc.vertex = plainVertex();
    desc.geometry = probing(VK_SHADER_STAGE_GEOMETRY_BIT, R"(
layout(points, invocations = 3) in;
layout(points, max_vertices = 1) out;
void main() {
    probe();
    gl_Position = vec4(0, 0, 0, 1);
    gl_PointSize = 1;
    EmitVertex();
})");
    EXPECT_EQ(probes(desc, VK_PRIMITIVE_TOPOLOGY_POINT_LIST, 40), 3u * 40);
}

TEST_F(SubgroupTest, inFragmentShaders) {
    // A quad is a square of four pixels, at even coordinates.
    constexpr VkExtent2D kExtent{34, 18};
    const TestImage image = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(image);
    PipelineDesc desc;
    desc.vertex = fullScreen();
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
#extension GL_KHR_shader_subgroup_quad : require
#extension GL_KHR_shader_subgroup_vote : require
layout(location = 0) out vec4 color;
void main() {
    float x = subgroupQuadSwapHorizontal(gl_FragCoord.x), y = subgroupQuadSwapVertical(gl_FragCoord.y);
    color = vec4(floor(x), floor(y), gl_SubgroupSize, subgroupAllEqual(gl_FragCoord.z) ? 255 : 0) / 255;
})");
    desc.extent = kExtent;
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    drawTriangle(pass, pipeline);
    const std::vector<uint8_t> texels = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (uint32_t y = 0; y < kExtent.height; ++y)
        for (uint32_t x = 0; x < kExtent.width; ++x)
            ASSERT_EQ(pixelAt(texels, image, x, y), 0xFF000000u | kSize << 16 | (y ^ 1) << 8 | (x ^ 1))
                << x << "," << y;
}

}  // namespace
}  // namespace vernier::test
