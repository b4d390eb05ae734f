// Pipelines cut into libraries (VK_EXT_graphics_pipeline_library) and linked again, and what they draw.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {

using Parts = VkGraphicsPipelineLibraryFlagsEXT;
inline constexpr Parts kInput = VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT,
                       kBefore = VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT,
                       kFragment = VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT,
                       kOutput = VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT;

/// A way to cut a pipeline: the parts of each of its libraries.
using Cut = std::vector<Parts>;
/// All fifteen. The layer takes no library of all parts (VUID-VkGraphicsPipelineCreateInfo-flags-06608).
inline std::vector<Cut> allCuts() {
    std::vector<Cut> cuts{{}};
    for (const Parts part : {kInput, kBefore, kFragment, kOutput}) {
        std::vector<Cut> longer;
        for (const Cut& cut : cuts) {
            for (size_t n = 0; n < cut.size(); ++n) {
                longer.push_back(cut);
                longer.back()[n] |= part;
            }
            longer.push_back(cut);
            longer.back().push_back(part);
        }
        cuts = std::move(longer);
    }
    if (validated()) cuts.erase(cuts.begin());
    return cuts;
}

/// How the libraries of a cut come together.
enum class Joining {
    plain,      // all at once
    optimised,  // likewise, with VK_PIPELINE_CREATE_LINK_TIME_OPTIMIZATION_BIT_EXT
    nested,     // the first two make a library, to which the others come, if there are any
    ownPart,    // the last one is no library: the pipeline describes those parts itself
};
inline constexpr Joining kJoinings[] = {Joining::plain, Joining::optimised, Joining::nested, Joining::ownPart};

class PipelineLibraryTest : public DrawTest {
  protected:
    static constexpr VkExtent2D kExtent{96, 80};  // more than one tile of the rasteriser
    static constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_UNORM, kDepth = VK_FORMAT_D32_SFLOAT_S8_UINT;
    using Texels = std::vector<uint8_t>;

    uint32_t apiVersion() override { return VK_API_VERSION_1_3; }
    std::vector<const char*> moreExtensions() override {
        return {VK_KHR_PIPELINE_LIBRARY_EXTENSION_NAME, VK_EXT_GRAPHICS_PIPELINE_LIBRARY_EXTENSION_NAME,
                VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        libraries_.graphicsPipelineLibrary = rendering_.dynamicRendering = multiview_.multiview = VK_TRUE;
        executables_.pipelineExecutableInfo = control_.pipelineCreationCacheControl = VK_TRUE;
        libraries_.pNext = &rendering_;
        rendering_.pNext = &multiview_;
        multiview_.pNext = &executables_;
        executables_.pNext = &control_;
        return &libraries_;
    }
    void SetUp() override {
        DrawTest::SetUp();
        color = makeImage(kColor, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        depth = makeImage(kDepth, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        const TestImage four = makeImage(kColor, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_4_BIT);
        const TestImage fourDepth =
            makeImage(kDepth, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_SAMPLE_COUNT_4_BIT);
        pass = makePass(color, &depth);
        samplesPass = makePass(four, &fourDepth, &color);
        vertices = makeBuffer(sizeof(float) * kTriangles.size(), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
        std::memcpy(vertices.data, kTriangles.data(), vertices.size);
        layout = makeLayout({}, 16);
    }

    /// As `cut` and `joining` say; whole without a cut. The libraries are gone when this returns.
    VkResult createPipeline(const VkGraphicsPipelineCreateInfo& whole, VkPipeline* pipeline) override {
        if (cut.empty()) return makeParts(whole, kInput | kBefore | kFragment | kOutput, {}, whole.flags, pipeline);
        const bool optimised = joining == Joining::optimised;
        const VkPipelineCreateFlags library =
            whole.flags | VK_PIPELINE_CREATE_LIBRARY_BIT_KHR |
            (optimised ? VK_PIPELINE_CREATE_RETAIN_LINK_TIME_OPTIMIZATION_INFO_BIT_EXT : 0);
        const size_t own = joining == Joining::ownPart && cut.size() > 1 ? 1 : 0;
        std::vector<VkPipeline> libraries(cut.size() - own);
        for (size_t n = 0; n < libraries.size(); ++n) {
            EXPECT_EQ(makeParts(whole, cut[n], {}, library, &libraries[n]), VK_SUCCESS) << cut[n];
        }
        if (joining == Joining::nested && libraries.size() > 2) {
            VkPipeline joined = VK_NULL_HANDLE;
            EXPECT_EQ(makeParts(whole, 0, {libraries[0], libraries[1]}, library, &joined), VK_SUCCESS);
            for (const size_t n : {0, 1}) destroyLibrary(libraries[n]);
            libraries.erase(libraries.begin());
            libraries[0] = joined;
        }
        const VkPipelineCreateFlags flags =
            whole.flags | linkFlags | (optimised ? VK_PIPELINE_CREATE_LINK_TIME_OPTIMIZATION_BIT_EXT : 0);
        const VkResult result = makeParts(whole, own != 0 ? cut.back() : 0, libraries, flags, pipeline);
        for (const VkPipeline made : libraries) destroyLibrary(made);
        return result;
    }
    /// At once; but the layer looks at libraries as long as there are pipelines of them.
    void destroyLibrary(VkPipeline library) {
        if (!validated()) return vkDestroyPipeline(device, library, nullptr);
        defer([this, library] { vkDestroyPipeline(device, library, nullptr); });
    }
    /// The pipeline or library of these parts and of libraries. Of the other parts nothing is told.
    VkResult makeParts(const VkGraphicsPipelineCreateInfo& whole, Parts parts, const std::vector<VkPipeline>& libraries,
                       VkPipelineCreateFlags flags, VkPipeline* pipeline) {
        VkGraphicsPipelineCreateInfo info = whole;
        info.flags = flags;
        const auto has = [parts](Parts part) { return (parts & part) != 0; };
        std::vector<VkPipelineShaderStageCreateInfo> stages;
        for (uint32_t n = 0; n < whole.stageCount; ++n)
            if (has(whole.pStages[n].stage == VK_SHADER_STAGE_FRAGMENT_BIT ? kFragment : kBefore))
                stages.push_back(whole.pStages[n]);
        std::vector<VkShaderModuleCreateInfo> code(stages.size());
        for (size_t n = 0; inlined && n < stages.size(); ++n) {
            code[n] = codeOf(stages[n].module);
            stages[n].module = VK_NULL_HANDLE;
            stages[n].pNext = &code[n];
        }
        info.stageCount = static_cast<uint32_t>(stages.size());
        info.pStages = stages.data();
        if (!has(kInput)) {
            info.pVertexInputState = nullptr;
            info.pInputAssemblyState = nullptr;
        }
        if (!has(kBefore)) {
            info.pTessellationState = nullptr;
            info.pViewportState = nullptr;
            info.pRasterizationState = nullptr;
        }
        // The layer (1.3.239) looks for these beside the libraries that have them.
        if (!validated() || libraries.empty()) {
            if (!has(kFragment)) info.pDepthStencilState = nullptr;
            if (!has(kFragment | kOutput)) info.pMultisampleState = nullptr;
            if (!has(kOutput)) info.pColorBlendState = nullptr;
        }
        if (dynamicOnlyIn != 0 && !has(dynamicOnlyIn)) info.pDynamicState = nullptr;
        if (has(kBefore) && !has(kFragment) && beforeLayout != VK_NULL_HANDLE) info.layout = beforeLayout;
        if (has(kFragment) && !has(kBefore) && behindLayout != VK_NULL_HANDLE) info.layout = behindLayout;
        if (nextWithoutOutput != nullptr && !has(kOutput)) info.pNext = nextWithoutOutput;
        auto named = make<VkGraphicsPipelineLibraryCreateInfoEXT>(
            VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_LIBRARY_CREATE_INFO_EXT, info.pNext);
        named.flags = parts;
        if (parts != 0 && !cut.empty()) info.pNext = &named;
        auto linked =
            make<VkPipelineLibraryCreateInfoKHR>(VK_STRUCTURE_TYPE_PIPELINE_LIBRARY_CREATE_INFO_KHR, info.pNext);
        linked.libraryCount = static_cast<uint32_t>(libraries.size());
        linked.pLibraries = libraries.data();
        if (!libraries.empty()) info.pNext = &linked;
        return vkCreateGraphicsPipelines(device, cache, 1, &info, nullptr, pipeline);
    }

    VkShaderModule shader(VkShaderStageFlagBits stage, const std::string& glsl) {
        const VkShaderModule module = makeShader(stage, glsl);
        words_[module] = compileGlsl(stage, glsl);
        return module;
    }
    VkShaderModuleCreateInfo codeOf(VkShaderModule module) {
        const std::vector<uint32_t>& words = words_.at(module);
        auto info = make<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
        info.codeSize = words.size() * sizeof(uint32_t);
        info.pCode = words.data();
        return info;
    }

    /// Four triangles over each other at several depths, coloured by their vertices and by their first one's colour.
    PipelineDesc triangles() {
        PipelineDesc desc;
        desc.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, kVertex);
        desc.fragment = shader(VK_SHADER_STAGE_FRAGMENT_BIT, kFragmentCode);
        desc.layout = layout;
        desc.bindings = {{0, 6 * sizeof(float), VK_VERTEX_INPUT_RATE_VERTEX}};
        desc.attributes = {{0, 0, VK_FORMAT_R32G32_SFLOAT, 0},
                           {1, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 2 * sizeof(float)}};
        desc.depthTest = true;
        desc.extent = kExtent;
        return desc;
    }
    void drawAll(VkCommandBuffer commands, VkPipeline pipeline) {
        const VkDeviceSize offset = 0;
        const float moved[4] = {0.15f, -0.1f, 0.25f, 1};
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdBindVertexBuffers(commands, 0, 1, &vertices.buffer, &offset);
        vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof moved,
                           moved);
        vkCmdDraw(commands, 12, 2, 0, 0);
    }
    /// The instructions of a pipeline's vertex program, and checks that there is a fragment program, too.
    uint64_t instructionsOfVertices(VkPipeline pipeline) {
        auto info = make<VkPipelineInfoKHR>(VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR);
        info.pipeline = pipeline;
        std::array<VkPipelineExecutablePropertiesKHR, 4> stages;
        stages.fill(make<VkPipelineExecutablePropertiesKHR>(VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR));
        uint32_t count = 4;
        EXPECT_EQ(command<PFN_vkGetPipelineExecutablePropertiesKHR>("vkGetPipelineExecutablePropertiesKHR")(
                      device, &info, &count, stages.data()),
                  VK_SUCCESS);
        EXPECT_EQ(count, 2u);
        EXPECT_EQ(stages[0].stages, VkShaderStageFlags{VK_SHADER_STAGE_VERTEX_BIT});
        EXPECT_EQ(stages[1].stages, VkShaderStageFlags{VK_SHADER_STAGE_FRAGMENT_BIT});
        auto first = make<VkPipelineExecutableInfoKHR>(VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR);
        first.pipeline = pipeline;
        std::array<VkPipelineExecutableStatisticKHR, 16> all;
        all.fill(make<VkPipelineExecutableStatisticKHR>(VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR));
        count = 16;
        EXPECT_EQ(command<PFN_vkGetPipelineExecutableStatisticsKHR>("vkGetPipelineExecutableStatisticsKHR")(
                      device, &first, &count, all.data()),
                  VK_SUCCESS);
        for (uint32_t n = 0; n < count; ++n)
            if (std::string(all[n].name) == "instructions") return all[n].value.u64;
        ADD_FAILURE() << "no number of instructions";
        return 0;
    }
    Texels draw(VkPipeline pipeline, const Pass& in, const std::function<void(VkCommandBuffer)>& first = {}) {
        const VkCommandBuffer commands = begin();
        beginPass(commands, in);
        const VkClearAttachment stencil{VK_IMAGE_ASPECT_STENCIL_BIT, 0, {}};
        const VkClearRect everywhere{{{}, kExtent}, 0, 1};
        vkCmdClearAttachments(commands, 1, &stencil, 1, &everywhere);
        if (first) first(commands);
        drawAll(commands, pipeline);
        vkCmdEndRenderPass(commands);
        submit(commands);
        return readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    }
    /// The picture of a description made whole, with all cuts and all ways to join them giving the same.
    Texels sameForAllCuts(const PipelineDesc& desc, const Pass& in,
                          const std::function<void(VkCommandBuffer)>& first = {}) {
        cut = {};
        const Texels expected = draw(makePipeline(in.pass, desc), in, first);
        for (const Cut& each : allCuts())
            for (const Joining way : kJoinings) {
                cut = each;
                joining = way;
                EXPECT_TRUE(draw(makePipeline(in.pass, desc), in, first) == expected)
                    << testing::PrintToString(each) << " joined by " << static_cast<int>(way);
            }
        cut = {};
        return expected;
    }

    static constexpr const char* kVertex = R"(#version 450
layout(location = 0) in vec2 place;
layout(location = 1) in vec4 tint;
layout(push_constant) uniform Block { vec4 moved; };
layout(location = 0) out vec4 smoothTint;
layout(location = 1) flat out vec4 flatTint;
layout(location = 2) out vec4 nobodyReads;
void main() {
    float z = 0.2 + 0.15 * float(gl_VertexIndex / 3) + 0.05 * float(gl_InstanceIndex);
    gl_Position = vec4(place + moved.xy * float(gl_InstanceIndex), z, 1);
    smoothTint = tint;
    flatTint = tint.wzyx;
    nobodyReads = sqrt(tint);
})";
    static constexpr const char* kFragmentCode = R"(#version 450
layout(location = 0) in vec4 smoothTint;
layout(location = 1) flat in vec4 flatTint;
layout(push_constant) uniform Block { vec4 moved; };
layout(location = 0) out vec4 color;
void main() {
    vec4 perPrimitive = sqrt(flatTint * moved.w + 0.5) * flatTint.yzwx - flatTint * flatTint * 0.125;
    color = mix(smoothTint, perPrimitive, moved.z);
})";
    static constexpr std::array<float, 12 * 6> kTriangles = {
        -0.9f, -0.8f, 1, 0, 0, 1,    0.7f,  -0.6f, 1, 1, 0, 0.5f, -0.3f, 0.9f,  0, 1, 0, 1,     //
        -0.5f, 0.8f,  0, 0, 1, 0.5f, -0.8f, -0.2f, 0, 1, 1, 1,    0.9f,  0.1f,  1, 0, 1, 0.2f,  //
        0.1f,  -0.9f, 1, 1, 1, 1,    0.9f,  0.8f,  0, 0, 0, 0.7f, -0.1f, 0.3f,  1, 0, 0, 1,     //
        -0.9f, 0.5f,  0, 1, 0, 0.3f, 0.2f,  -0.5f, 0, 0, 1, 1,    0.6f,  0.95f, 1, 1, 0, 1};

    Cut cut;
    Joining joining = Joining::plain;
    VkPipelineCreateFlags linkFlags = 0;
    bool inlined = false;
    Parts dynamicOnlyIn = 0;  // not 0: libraries of other parts name no dynamic states
    VkPipelineLayout beforeLayout = VK_NULL_HANDLE, behindLayout = VK_NULL_HANDLE;  // of libraries with that side alone
    const void* nextWithoutOutput = nullptr;  // not nullptr: the chain of descriptions without fragment output
    VkPipelineCache cache = VK_NULL_HANDLE;
    TestImage color, depth;
    TestBuffer vertices;
    Pass pass, samplesPass;
    VkPipelineLayout layout = VK_NULL_HANDLE;

  private:
    std::map<VkShaderModule, std::vector<uint32_t>> words_;
    VkPhysicalDeviceGraphicsPipelineLibraryFeaturesEXT libraries_ =
        make<VkPhysicalDeviceGraphicsPipelineLibraryFeaturesEXT>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_GRAPHICS_PIPELINE_LIBRARY_FEATURES_EXT);
    VkPhysicalDeviceDynamicRenderingFeatures rendering_ =
        make<VkPhysicalDeviceDynamicRenderingFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES);
    VkPhysicalDeviceMultiviewFeatures multiview_ =
        make<VkPhysicalDeviceMultiviewFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES);
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR executables_ =
        make<VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR);
    VkPhysicalDevicePipelineCreationCacheControlFeatures control_ =
        make<VkPhysicalDevicePipelineCreationCacheControlFeatures>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_CREATION_CACHE_CONTROL_FEATURES);
};

}  // namespace vernier::test
