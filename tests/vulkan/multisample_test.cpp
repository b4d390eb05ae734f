// Every sample count at the standard and at programmed positions, resolved; interpolation where it is asked for.
#include <algorithm>
#include <cmath>

#include "runtime/plan/sample_positions.h"
#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{16, 16};

class SampleCountTest : public DrawTest {
  protected:
    std::vector<const char*> moreExtensions() override { return {VK_EXT_SAMPLE_LOCATIONS_EXTENSION_NAME}; }

    struct Locations {
        std::vector<VkSampleLocationEXT> places;  // empty: the standard ones
        bool dynamic;
    };
    VkSampleLocationsInfoEXT infoOf(const Locations& locations) const {
        auto info = make<VkSampleLocationsInfoEXT>(VK_STRUCTURE_TYPE_SAMPLE_LOCATIONS_INFO_EXT);
        info.sampleLocationsPerPixel = static_cast<VkSampleCountFlagBits>(locations.places.size());
        info.sampleLocationGridSize = {1, 1};
        info.sampleLocationsCount = static_cast<uint32_t>(locations.places.size());
        info.pSampleLocations = locations.places.data();
        return info;
    }

    /// The red channel of pixel (3, 3) after white was drawn left of x = `edge` (in pixels) and resolved.
    uint32_t resolvedLeftOf(float edge, uint32_t samples, const Locations& locations) {
        const auto count = static_cast<VkSampleCountFlagBits>(samples);
        const TestImage color =
            makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, count);
        const TestImage resolved = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        const Pass pass = makePass(color, nullptr, samples > 1 ? &resolved : nullptr, count);
        auto state = make<VkPipelineSampleLocationsStateCreateInfoEXT>(
            VK_STRUCTURE_TYPE_PIPELINE_SAMPLE_LOCATIONS_STATE_CREATE_INFO_EXT);
        const VkSampleLocationsInfoEXT info = infoOf(locations);
        state.sampleLocationsEnable = VK_TRUE;
        state.sampleLocationsInfo =
            locations.dynamic ? infoOf({std::vector<VkSampleLocationEXT>(samples), false}) : info;
        std::vector<VkSampleLocationEXT> zeros(samples);
        state.sampleLocationsInfo.pSampleLocations = locations.dynamic ? zeros.data() : info.pSampleLocations;
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.samples = count;
        if (!locations.places.empty())
            desc.change = [&](const PipelineStates& states) { states.multisample.pNext = &state; };
        if (locations.dynamic) desc.dynamic = {VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_EXT};
        desc.layout = makeLayout({}, 4);
        if (vertex_ == VK_NULL_HANDLE)
            vertex_ = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(push_constant) uniform P { float edge; };
void main() {
    vec2 p[6] = vec2[](vec2(-1, -1), vec2(edge, -1), vec2(-1, 1), vec2(-1, 1), vec2(edge, -1), vec2(edge, 1));
    gl_Position = vec4(p[gl_VertexIndex], 0.5, 1);
})");
        if (fragment_ == VK_NULL_HANDLE) fragment_ = constantColor("1");
        desc.vertex = vertex_;
        desc.fragment = fragment_;
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        const float clip = edge / static_cast<float>(kExtent.width) * 2 - 1;
        vkCmdPushConstants(commands, desc.layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, 4,
                           &clip);
        if (locations.dynamic) {
            command<PFN_vkCmdSetSampleLocationsEXT>("vkCmdSetSampleLocationsEXT")(commands, &info);
        }
        vkCmdDraw(commands, 6, 1, 0, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        return pixelAt(readImage(samples > 1 ? resolved : color, VK_IMAGE_ASPECT_COLOR_BIT, 4), color, 3, 3) & 0xFF;
    }

    static uint32_t code(uint32_t covered, uint32_t samples) {
        return static_cast<uint32_t>(std::nearbyint(255.0 * covered / samples));
    }

  private:
    VkShaderModule vertex_ = VK_NULL_HANDLE, fragment_ = VK_NULL_HANDLE;
};

TEST_F(SampleCountTest, standardPositions) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physicalDevice, &properties);
    EXPECT_EQ(properties.limits.framebufferColorSampleCounts, 31u);
    for (const uint32_t samples : {2u, 4u, 8u, 16u}) {
        for (uint32_t sixteenth = 0; sixteenth < 16; sixteenth += 3) {
            uint32_t covered = 0;
            for (uint32_t s = 0; s < samples; ++s) covered += samplePositions(samples)[s].x16 < sixteenth;
            EXPECT_EQ(resolvedLeftOf(3 + static_cast<float>(sixteenth) / 16, samples, {{}, false}),
                      code(covered, samples))
                << samples << " samples, edge at " << sixteenth;
        }
    }
}

TEST_F(SampleCountTest, programmedPositions) {
    auto properties = make<VkPhysicalDeviceSampleLocationsPropertiesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SAMPLE_LOCATIONS_PROPERTIES_EXT);
    auto all = make<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    all.pNext = &properties;
    const auto get = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2KHR>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceProperties2KHR"));
    get(physicalDevice, &all);
    EXPECT_EQ(properties.sampleLocationSampleCounts, 31u);
    EXPECT_EQ(properties.sampleLocationCoordinateRange[1], 0.9375f);
    // Three of four samples in the left half.
    const std::vector<VkSampleLocationEXT> places{{0, 0}, {0.25f, 0.5f}, {0.4375f, 0.9375f}, {0.5f, 0.125f}};
    for (const bool dynamic : {false, true}) {
        EXPECT_EQ(resolvedLeftOf(3.5f, 4, {places, dynamic}), code(3, 4)) << dynamic;
        EXPECT_EQ(resolvedLeftOf(3.125f, 4, {places, dynamic}), code(1, 4)) << dynamic;
        EXPECT_EQ(resolvedLeftOf(3.0f, 4, {places, dynamic}), 0u) << dynamic;
    }
    EXPECT_EQ(resolvedLeftOf(3.25f, 1, {{{0.1875f, 0.5f}}, false}), 255u);
    EXPECT_EQ(resolvedLeftOf(3.25f, 1, {{{0.25f, 0.5f}}, false}), 0u);
}

// Its sampler does not count: the image is fetched from.
TEST_F(SampleCountTest, combinedDescriptorOfAMultisampledImage) {
    const auto usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const TestImage samples = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, usage, VK_SAMPLE_COUNT_4_BIT);
    const TestImage resolved = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    Pass clearing = makePass(samples, nullptr, &resolved, VK_SAMPLE_COUNT_4_BIT);
    clearing.clears[0].color = {{0.2f, 0.4f, 0.6f, 1}};
    const Pass pass = makePass(color);

    auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    samplerInfo.magFilter = samplerInfo.minFilter = VK_FILTER_LINEAR;
    VkSampler sampler = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
    defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
    const VkDescriptorSetLayout layout =
        makeSetLayout({{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}});
    const VkDescriptorSet set = makeEmptySet(layout, {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1}});
    const VkDescriptorImageInfo image{sampler, samples.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);

    PipelineDesc desc;
    desc.extent = kExtent;
    desc.layout = makeLayout({layout}, 0);
    desc.vertex = fullScreen();
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(set = 0, binding = 0) uniform sampler2DMS image;
layout(location = 0) out vec4 color;
void main() { color = texelFetch(image, ivec2(gl_FragCoord.xy), 3); })");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    beginPass(commands, clearing);
    vkCmdEndRenderPass(commands);
    changeLayout(commands, samples.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    EXPECT_EQ(pixelAt(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4), color, 5, 9), 0xFF996633u);
    EXPECT_TRUE(messages.empty()) << messages.front();
}

// What a shader asks to be interpolated at the place where an input is anyway has the input's bits.
TEST_F(SampleCountTest, askedPlacesOfInputs) {
    const std::string names[] = {"atPixel", "atPlane", "atCentroid", "atSample"};
    const std::string qualifiers[] = {"", "noperspective ", "centroid ", "sample "};
    std::string vertex = R"(#version 450
        const vec2 kPlaces[9] = {{-1, -0.9}, {0.97, -0.31}, {-0.7, 1}, {0.1, 0.2}, {0.83, 0.21}, {0.3, 0.95},
                                 {-0.31, 0.03}, {-0.11, 0.07}, {-0.23, 0.41}};
    )";
    std::string fragment = "#version 450\nlayout(location = 0) out vec4 color;\n", main;
    for (uint32_t n = 0; n < 4; ++n) {
        const std::string location = "layout(location = " + std::to_string(n) + ") ";
        vertex += location + qualifiers[n] + "out vec3 " + names[n] + ";\n";
        fragment += location + qualifiers[n] + "in vec3 " + names[n] + ";\n";
        main += names[n] + " = vec3(p * vec2(3.7, 0.3), 1.1 * w);\n";
    }
    vertex +=
        "void main() { vec2 p = kPlaces[gl_VertexIndex]; float w = 1 + 0.37 * (gl_VertexIndex * 5 % 9);\n"
        "gl_Position = vec4(p * w, 0.5 * w, w);\n" +
        main + "}";
    PipelineDesc desc;
    desc.extent = {64, 64};
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, vertex);
    for (const bool perSample : {false, true}) {
        const std::string last = perSample ? "1, atSample == interpolateAtSample(atSample, gl_SampleID)"
                                           : "atCentroid == interpolateAtCentroid(atCentroid), 1";
        const std::string equal =
            "atPixel == interpolateAtOffset(atPixel, vec2(0)), atPlane == interpolateAtOffset(atPlane, vec2(0)), ";
        desc.fragment =
            makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, fragment + "void main() { color = vec4(" + equal + last + "); }");
        for (const auto samples : {VK_SAMPLE_COUNT_1_BIT, VK_SAMPLE_COUNT_4_BIT}) {
            const auto usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
            const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, desc.extent, usage, samples);
            const TestImage resolved = makeImage(VK_FORMAT_R8G8B8A8_UNORM, desc.extent, usage);
            const bool resolves = samples != VK_SAMPLE_COUNT_1_BIT;
            Pass pass = makePass(color, nullptr, resolves ? &resolved : nullptr, samples);
            pass.clears[0].color = {{1, 1, 1, 1}};
            desc.samples = samples;
            const VkPipeline pipeline = makePipeline(pass.pass, desc);
            const VkCommandBuffer commands = begin();
            beginPass(commands, pass);
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
            vkCmdDraw(commands, 9, 1, 0, 0);
            vkCmdEndRenderPass(commands);
            submit(commands);
            const std::vector<uint8_t> bytes = readImage(resolves ? resolved : color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
            EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 255), static_cast<ptrdiff_t>(bytes.size()))
                << samples << " samples, per sample: " << perSample;
        }
    }
}

}  // namespace
}  // namespace vernier::test
