// What libraries of pipelines are made of, what linking them costs, and what is no pipeline.
#include <cstdlib>

#include "tests/vulkan/test_library.h"

namespace vernier::test {
namespace {

TEST_F(PipelineLibraryTest, isReported) {
    const auto reported = properties<VkPhysicalDeviceGraphicsPipelineLibraryPropertiesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_GRAPHICS_PIPELINE_LIBRARY_PROPERTIES_EXT);
    EXPECT_TRUE(reported.graphicsPipelineLibraryFastLinking);
    EXPECT_TRUE(reported.graphicsPipelineLibraryIndependentInterpolationDecoration);
}

TEST_F(PipelineLibraryTest, layoutsOfIndependentSets) {
    constexpr VkShaderStageFlags kBoth = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const auto setFor = [&](VkShaderStageFlags stages) {
        return makeSetLayout({{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, stages, nullptr}});
    };
    const VkDescriptorSetLayout before = setFor(VK_SHADER_STAGE_VERTEX_BIT),
                                behind = setFor(VK_SHADER_STAGE_FRAGMENT_BIT);
    const auto independent = [&](const std::vector<VkDescriptorSetLayout>& all) {
        const VkPushConstantRange range{kBoth, 0, 16};
        auto info = make<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
        info.flags = VK_PIPELINE_LAYOUT_CREATE_INDEPENDENT_SETS_BIT_EXT;
        info.setLayoutCount = static_cast<uint32_t>(all.size());
        info.pSetLayouts = all.data();
        info.pushConstantRangeCount = 1;
        info.pPushConstantRanges = &range;
        VkPipelineLayout made = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreatePipelineLayout(device, &info, nullptr, &made), VK_SUCCESS);
        defer([this, made] { vkDestroyPipelineLayout(device, made, nullptr); });
        return made;
    };
    // The stages before the rasteriser know sets 0 and 2, the fragment shader knows set 1.
    beforeLayout = independent({before, VK_NULL_HANDLE, before});
    behindLayout = independent({VK_NULL_HANDLE, behind, VK_NULL_HANDLE});
    layout = independent({before, behind, before});
    std::array<VkDescriptorSet, 3> bound{};
    for (uint32_t n = 0; n < 3; ++n) {
        const TestBuffer buffer = makeBuffer(16, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
        const float values[4] = {n == 0 ? 0.8f : 0.3f, n == 1 ? 0.9f : 0.2f, n == 2 ? 0.7f : 0.1f, 0};
        std::memcpy(buffer.data, values, sizeof values);
        bound[n] = makeEmptySet(n == 1 ? behind : before, {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1}});
        const VkDescriptorBufferInfo info{buffer.buffer, 0, VK_WHOLE_SIZE};
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = bound[n];
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        write.pBufferInfo = &info;
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    }
    std::string vertex = kVertex, fragment = kFragmentCode;
    vertex.replace(vertex.find("void main"), 0,
                   "layout(set = 0, binding = 0) uniform A { vec4 a; };\n"
                   "layout(set = 2, binding = 0) uniform C { vec4 c; };\n");
    vertex.replace(vertex.find("smoothTint = tint"), 17, "smoothTint = tint * a.x + c");
    fragment.replace(fragment.find("void main"), 0, "layout(set = 1, binding = 0) uniform B { vec4 b; };\n");
    fragment.replace(fragment.find("moved.z)"), 8, "b.y) + b");
    PipelineDesc desc = triangles();
    desc.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, vertex);
    desc.fragment = shader(VK_SHADER_STAGE_FRAGMENT_BIT, fragment);
    const Texels picture = sameForAllCuts(desc, pass, [&](VkCommandBuffer commands) {
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 3, bound.data(), 0, nullptr);
    });
    EXPECT_NE(picture, draw(makePipeline(pass.pass, triangles()), pass));
}

TEST_F(PipelineLibraryTest, modulesInStages) {
    const PipelineDesc desc = triangles();
    const Texels expected = draw(makePipeline(pass.pass, desc), pass);
    inlined = true;
    EXPECT_EQ(sameForAllCuts(desc, pass), expected);
    const VkShaderModuleCreateInfo code = codeOf(shader(VK_SHADER_STAGE_COMPUTE_BIT, "#version 450\nvoid main() {}"));
    auto info = make<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage = make<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, &code);
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.pName = "main";
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
    vkDestroyPipeline(device, pipeline, nullptr);
}

TEST_F(PipelineLibraryTest, nothingIsMissedThatIsGone) {
    // Libraries, modules, layouts and render passes may all be gone before a pipeline that came of them is used.
    const Texels expected = draw(makePipeline(pass.pass, triangles()), pass);
    for (const Cut& each : allCuts()) {
        cut = each;
        const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, 16};
        auto layoutInfo = make<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
        layoutInfo.pushConstantRangeCount = 1;
        layoutInfo.pPushConstantRanges = &range;
        PipelineDesc desc = triangles();
        ASSERT_EQ(vkCreatePipelineLayout(device, &layoutInfo, nullptr, &desc.layout), VK_SUCCESS);
        const auto module = [&](VkShaderModule of) {
            const VkShaderModuleCreateInfo info = codeOf(of);
            VkShaderModule made = VK_NULL_HANDLE;
            EXPECT_EQ(vkCreateShaderModule(device, &info, nullptr, &made), VK_SUCCESS);
            return made;
        };
        desc.vertex = module(desc.vertex);
        desc.fragment = module(desc.fragment);
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        vkDestroyPipelineLayout(device, desc.layout, nullptr);
        vkDestroyShaderModule(device, desc.vertex, nullptr);
        vkDestroyShaderModule(device, desc.fragment, nullptr);
        EXPECT_EQ(draw(pipeline, pass), expected) << testing::PrintToString(each);
    }
}

TEST_F(PipelineLibraryTest, linkingCompilesNothingUnlessAskedTo) {
    auto cacheInfo = make<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
    ASSERT_EQ(vkCreatePipelineCache(device, &cacheInfo, nullptr, &cache), VK_SUCCESS);
    defer([this, made = cache] { vkDestroyPipelineCache(device, made, nullptr); });
    VkPipelineCreationFeedback making{};
    auto feedback =
        make<VkPipelineCreationFeedbackCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CREATION_FEEDBACK_CREATE_INFO);
    feedback.pPipelineCreationFeedback = &making;
    PipelineDesc desc = triangles();
    desc.next = &feedback;
    desc.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    const uint64_t whole = instructionsOfVertices(makePipeline(pass.pass, desc));
    for (const Cut& each : allCuts())
        for (const Joining way : {Joining::plain, Joining::nested, Joining::optimised}) {
            SCOPED_TRACE(testing::PrintToString(each) + " joined by " + std::to_string(static_cast<int>(way)));
            cut = each;
            joining = way;
            linkFlags = way == Joining::optimised ? 0 : VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT;
            making = {};
            const uint64_t linked = instructionsOfVertices(makePipeline(pass.pass, desc));
            EXPECT_EQ(making.flags, VkPipelineCreationFeedbackFlags{VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT});
            // A library with both sides of the rasteriser leaves out what is not read between them, too.
            const bool together = std::any_of(cut.begin(), cut.end(),
                                              [](Parts parts) { return (parts & kBefore) && (parts & kFragment); });
            EXPECT_EQ(linked == whole, together || way == Joining::optimised) << linked << " and " << whole;
        }
    linkFlags = VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT;
    joining = Joining::optimised;
    makePipeline(pass.pass, desc, VK_PIPELINE_COMPILE_REQUIRED);
    joining = Joining::ownPart;
    cut = {kInput, kFragment | kOutput, kBefore};
    makePipeline(pass.pass, desc, VK_PIPELINE_COMPILE_REQUIRED);
    cut = {};
    desc.flags |= linkFlags;
    makePipeline(pass.pass, desc, VK_PIPELINE_COMPILE_REQUIRED);
}

TEST_F(PipelineLibraryTest, whatIsNoPipelineIsRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    PipelineDesc desc = triangles();
    for (const Cut& each :
         {Cut{kInput}, Cut{kBefore, kInput}, Cut{kFragment, kOutput}, Cut{kInput, kBefore, kFragment}}) {
        cut = each;
        makePipeline(pass.pass, desc, VK_ERROR_UNKNOWN);
        EXPECT_NE(messages.back().find("missing"), std::string::npos) << messages.back();
    }
    cut = {};
    const VkPipeline whole = makePipeline(pass.pass, desc);
    auto linked = make<VkPipelineLibraryCreateInfoKHR>(VK_STRUCTURE_TYPE_PIPELINE_LIBRARY_CREATE_INFO_KHR);
    linked.libraryCount = 1;
    linked.pLibraries = &whole;
    auto info = make<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &linked);
    VkPipeline none = whole;
    EXPECT_EQ(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &none), VK_ERROR_UNKNOWN);
    EXPECT_EQ(none, VkPipeline{VK_NULL_HANDLE});
    EXPECT_NE(messages.back().find("no library"), std::string::npos) << messages.back();
}

TEST_F(PipelineLibraryTest, librariesAreNotBound) {
    VERNIER_SKIP_WHEN_VALIDATED();
    PipelineDesc desc = triangles();
    desc.flags = VK_PIPELINE_CREATE_LIBRARY_BIT_KHR;
    cut = {kInput | kBefore | kFragment | kOutput};
    const VkPipeline library = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    drawAll(commands, library);
    vkCmdEndRenderPass(commands);
    EXPECT_EQ(vkEndCommandBuffer(commands), VK_ERROR_UNKNOWN);
    EXPECT_NE(messages.back().find("library"), std::string::npos) << messages.back();
}

TEST_F(PipelineLibraryTest, inputsThatNobodyWritesAreZero) {
    VERNIER_SKIP_WHEN_VALIDATED();
    // Such stages cannot run as they were compiled by themselves.
    std::string vertex = kVertex;
    vertex.replace(vertex.find("    flatTint = tint.wzyx;"), 25, "");
    vertex.replace(vertex.find("layout(location = 1) flat out vec4 flatTint;"), 44, "");
    const PipelineDesc desc = triangles();
    PipelineDesc less = desc;
    less.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, vertex);
    EXPECT_NE(sameForAllCuts(less, pass), draw(makePipeline(pass.pass, desc), pass));
}

/// On a device with fast mathematics, which moves work between shaders and rounds otherwise then.
class DraftLibraryTest : public PipelineLibraryTest {
  protected:
    void SetUp() override {
        setenv("VERNIER_PROFILE", "draft", 1);
        PipelineLibraryTest::SetUp();
        unsetenv("VERNIER_PROFILE");
    }
};

TEST_F(DraftLibraryTest, workIsMovedWhenLinkingToo) {
    (void)sameForAllCuts(triangles(), pass);
    EXPECT_FALSE(properties<VkPhysicalDeviceGraphicsPipelineLibraryPropertiesEXT>(
                     VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_GRAPHICS_PIPELINE_LIBRARY_PROPERTIES_EXT)
                     .graphicsPipelineLibraryFastLinking);
    cut = {kInput, kBefore, kFragment, kOutput};
    joining = Joining::plain;
    linkFlags = VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT;
    makePipeline(pass.pass, triangles(), VK_PIPELINE_COMPILE_REQUIRED);
}

}  // namespace
}  // namespace vernier::test
