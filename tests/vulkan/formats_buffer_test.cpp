// Every format that buffers can have: as vertex attributes, and as texels that are read, written and counted.
#include "tests/vulkan/formats_test.h"

namespace vernier::test {
namespace {

class FormatBuffers : public FormatsTest {
  protected:
    static constexpr uint32_t kTexels = 16;

    /// Calls run(case, random texels) for every format with the feature.
    template <class Run>
    void forEachBufferCase(VkFormatFeatureFlags feature, Run run) {
        uint32_t count = 0;
        for (const FormatInfo& info : allFormats()) {
            VkFormatProperties properties{};
            vkGetPhysicalDeviceFormatProperties(physicalDevice, info.format, &properties);
            if ((properties.bufferFeatures & feature) == 0) continue;
            SCOPED_TRACE(info.name);
            const Case of{&info, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_TILING_LINEAR};
            run(of, randomTexels(of, ++count, kTexels));
            if (HasFailure()) return;
        }
        EXPECT_GT(count, 0u);
    }
    /// What a shader sees of the first texels.
    static void expectTexels(const Case& of, const std::vector<uint8_t>& bytes, const void* found) {
        const auto* colors = static_cast<const VkClearColorValue*>(found);
        for (uint32_t i = 0; i < kTexels; ++i)
            expectSameColor(colors[i], texelAt(of, bytes, i, 0, kTexels), of.layout().type);
    }
    static std::string prefixOf(const Case& of) { return kPrefix[static_cast<size_t>(of.layout().type)]; }
};

TEST_F(FormatBuffers, texelsAreFetched) {
    forEachBufferCase(VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT,
                      [&](const Case& of, const std::vector<uint8_t>& bytes) {
                          const TestBuffer in = makeBuffer(bytes.size(), VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
                          std::memcpy(in.data, bytes.data(), bytes.size());
                          const TestBuffer out = makeStorage(kTexels * 4);
                          const Compute compute = computeFor(
                              "#version 450\nlayout(local_size_x = 16) in;\n"
                              "layout(set = 0, binding = 0) buffer Out { " +
                                  prefixOf(of) + "vec4 to[]; };\nlayout(set = 0, binding = 1) uniform " + prefixOf(of) +
                                  "samplerBuffer from;\nvoid main() { int i = int(gl_LocalInvocationID.x);\n"
                                  "to[i] = texelFetch(from, i); }",
                              {storageBuffer(out), texelBuffer(makeTexels(in, of.info->format), false)});
                          run(compute, 1);
                          expectTexels(of, bytes, out.data);
                      });
}

TEST_F(FormatBuffers, texelsAreLoadedAndStored) {
    forEachBufferCase(
        VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT, [&](const Case& of, const std::vector<uint8_t>& bytes) {
            const TestBuffer texels = makeBuffer(bytes.size(), VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
            std::memcpy(texels.data, bytes.data(), bytes.size());
            const VkClearColorValue color = plainColor(of.layout());
            const TestBuffer in = makeStorage(4), out = makeStorage(kTexels * 4);
            std::memcpy(in.data, &color, sizeof color);
            const Compute compute = computeFor(
                "#version 450\n#extension GL_EXT_shader_image_load_formatted : require\nlayout(local_size_x = 16) in;\n"
                "layout(set = 0, binding = 0) buffer In { " +
                    prefixOf(of) + "vec4 from; };\nlayout(set = 0, binding = 1) buffer Out { " + prefixOf(of) +
                    "vec4 to[]; };\nlayout(set = 0, binding = 2) uniform " + prefixOf(of) +
                    "imageBuffer texels;\nvoid main() { int i = int(gl_LocalInvocationID.x);\n"
                    "to[i] = imageLoad(texels, i); imageStore(texels, 16 + i, from); }",
                {storageBuffer(in), storageBuffer(out), texelBuffer(makeTexels(texels, of.info->format), true)});
            run(compute, 1);
            expectTexels(of, bytes, out.data);
            const std::vector<uint8_t> wanted = packed(of, color);
            EXPECT_EQ(std::memcmp(static_cast<uint8_t*>(texels.data) + (16 + 3) * wanted.size(), wanted.data(),
                                  wanted.size()),
                      0);
        });
}

TEST_F(FormatBuffers, texelsCount) {
    forEachBufferCase(
        VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_ATOMIC_BIT, [&](const Case& of, const std::vector<uint8_t>& bytes) {
            if (of.layout().type == ValueType::floating) return;  // ShaderFeaturesTest.floatAtomicsOnTexels
            const TestBuffer texels = makeBuffer(bytes.size(), VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
            std::memset(texels.data, 0, bytes.size());
            const Compute compute =
                computeFor("#version 450\nlayout(local_size_x = 32) in;\nlayout(set = 0, binding = 0, r32" +
                               std::string(of.layout().type == ValueType::uint ? "ui" : "i") + ") uniform " +
                               prefixOf(of) + "imageBuffer texels;\nvoid main() { imageAtomicAdd(texels, 2, 5); }",
                           {texelBuffer(makeTexels(texels, of.info->format), true)});
            run(compute, 2);
            EXPECT_EQ(words(texels)[2], 320u);
        });
}

TEST_F(FormatBuffers, verticesAreFetched) {
    const TestImage image =
        VulkanTest::makeImage(VK_FORMAT_R8G8B8A8_UNORM, {4, 4}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(image);
    const VkShaderModule fragment = constantColor("1");
    std::map<std::string, VkShaderModule> vertexShaders;
    forEachBufferCase(VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT, [&](const Case& of, const std::vector<uint8_t>& bytes) {
        const TestBuffer in = makeBuffer(bytes.size(), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
        std::memcpy(in.data, bytes.data(), bytes.size());
        const TestBuffer out = makeStorage(kTexels * 4);
        VkShaderModule& vertex = vertexShaders[prefixOf(of)];
        if (vertex == VK_NULL_HANDLE) {
            vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT,
                                "#version 450\nlayout(location = 0) in " + prefixOf(of) +
                                    "vec4 value;\nlayout(set = 0, binding = 0) buffer Out { " + prefixOf(of) +
                                    "vec4 to[]; };\nvoid main() { to[gl_VertexIndex] = value;"
                                    " gl_Position = vec4(0); gl_PointSize = 1; }");
        }
        VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
        const VkDescriptorSet set = makeSet({storageBuffer(out)}, &setLayout);
        PipelineDesc desc;
        desc.vertex = vertex;
        desc.fragment = fragment;
        desc.layout = makeLayout({setLayout}, 0);
        desc.extent = image.extent;
        desc.bindings = {{0, of.info->bytesPerTexel, VK_VERTEX_INPUT_RATE_VERTEX}};
        desc.attributes = {{0, 0, of.info->format, 0}};
        desc.change = [](const PipelineStates& states) { states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST; };
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
        const VkDeviceSize none = 0;
        vkCmdBindVertexBuffers(commands, 0, 1, &in.buffer, &none);
        vkCmdDraw(commands, kTexels, 1, 0, 0);
        vkCmdEndRenderPass(commands);
        makeVisible(commands);
        submit(commands);
        expectTexels(of, bytes, out.data);
    });
}

}  // namespace
}  // namespace vernier::test
