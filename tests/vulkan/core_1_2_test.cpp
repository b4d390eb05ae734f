// What Vulkan 1.1 and 1.2 have as features of their cores, used with no extension.
#include <array>

#include "tests/vulkan/test_assembly.h"

namespace vernier::test {
namespace {

class Core12Test : public AssemblyTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_2; }
    void* moreFeatures() override {
        twelve_.samplerMirrorClampToEdge = twelve_.drawIndirectCount = twelve_.samplerFilterMinmax = VK_TRUE;
        twelve_.shaderOutputViewportIndex = twelve_.shaderOutputLayer = twelve_.subgroupBroadcastDynamicId = VK_TRUE;
        twelve_.uniformBufferStandardLayout = twelve_.timelineSemaphore = VK_TRUE;
        eleven_.shaderDrawParameters = VK_TRUE;
        twelve_.pNext = &eleven_;
        return &twelve_;
    }
    VkSampler makeSampler(VkFilter filter, VkSamplerAddressMode mode, const void* chain) {
        auto info = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO, chain);
        info.magFilter = info.minFilter = filter;
        info.addressModeU = info.addressModeV = info.addressModeW = mode;
        VkSampler sampler = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateSampler(device, &info, nullptr, &sampler), VK_SUCCESS);
        defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
        return sampler;
    }

  private:
    VkPhysicalDeviceVulkan12Features twelve_ =
        make<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    VkPhysicalDeviceVulkan11Features eleven_ =
        make<VkPhysicalDeviceVulkan11Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES);
};

TEST_F(Core12Test, samplersMirrorOnceAndTakeTheMost) {
    const TestImage image = makeImage(VK_FORMAT_R8_UNORM, {4, 1}, VK_IMAGE_USAGE_SAMPLED_BIT);
    const TestBuffer texels = makeBuffer(4, VK_BUFFER_USAGE_TRANSFER_SRC_BIT), out = makeStorage(4);
    const std::array<uint8_t, 4> values{10, 20, 30, 40};
    std::memcpy(texels.data, values.data(), values.size());
    auto most = make<VkSamplerReductionModeCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO);
    most.reductionMode = VK_SAMPLER_REDUCTION_MODE_MAX;
    const VkSampler mirrored = makeSampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE, nullptr);
    const VkSampler greatest = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, &most);
    const Compute compute =
        makeCompute(R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D mirrored;
layout(set = 0, binding = 1) uniform sampler2D greatest;
layout(set = 0, binding = 2) buffer Out { uint v[4]; };
uint texel(vec4 color) { return uint(round(color.x * 255.0)); }
void main() {
    v[0] = texel(textureLod(mirrored, vec2(-0.375, 0.5), 0.0));  // the second to the left of 0
    v[1] = texel(textureLod(mirrored, vec2(-1.375, 0.5), 0.0));  // beyond the mirror image
    v[2] = texel(textureLod(mirrored, vec2(0.625, 0.5), 0.0));
    v[3] = texel(textureLod(greatest, vec2(0.5, 0.5), 0.0));     // half way between two texels
})",
                    {sampledImage(image.view, mirrored), sampledImage(image.view, greatest), storageBuffer(out)});
    const VkCommandBuffer commands = begin();
    toGeneral(commands, image);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {4, 1, 1};
    vkCmdCopyBufferToImage(commands, texels.buffer, image.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
    makeVisible(commands);
    dispatch(commands, compute, 1);
    submit(commands);
    EXPECT_EQ(std::vector<uint32_t>(words(out), words(out) + 4), (std::vector<uint32_t>{20, 40, 30, 30}));
}

TEST_F(Core12Test, aBufferCountsTheDraws) {
    const TestImage image = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {4, 1}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(image);
    PipelineDesc desc;
    desc.extent = image.extent;
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 460
void main() {
    gl_Position = vec4((float(gl_DrawID) + 0.5) / 2.0 - 1.0, 0, 0.5, 1);
    gl_PointSize = 1;
})");
    desc.fragment = constantColor("1");
    desc.change = [](const PipelineStates& states) { states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST; };
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const TestBuffer arguments = makeBuffer(128, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    for (uint32_t n = 0; n < 4; ++n) {
        const VkDrawIndirectCommand draw{1, 1, 0, 0};
        std::memcpy(static_cast<std::byte*>(arguments.data) + n * sizeof draw, &draw, sizeof draw);
    }
    constexpr VkDeviceSize kCountAt = 4 * sizeof(VkDrawIndirectCommand);
    const uint32_t count = 3;
    std::memcpy(static_cast<std::byte*>(arguments.data) + kCountAt, &count, sizeof count);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDrawIndirectCount(commands, arguments.buffer, 0, arguments.buffer, kCountAt, 4, sizeof(VkDrawIndirectCommand));
    vkCmdEndRenderPass(commands);
    submit(commands);
    const auto texels = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (uint32_t x = 0; x < 4; ++x) EXPECT_EQ(pixelAt(texels, image, x, 0) != 0, x < count) << x;
}

TEST_F(Core12Test, uniformsNeedNoPadding) {
    TestDescriptor uniform;
    uniform.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const TestBuffer in = makeBuffer(16, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT), out = makeStorage(4);
    uniform.buffer = in.buffer;
    for (uint32_t i = 0; i < 4; ++i) words(in)[i] = 10 + i;
    run(makeCompute(R"(#version 450
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 4) in;
layout(set = 0, binding = 0, std430) uniform In { uint numbers[4]; };
layout(set = 0, binding = 1) buffer Out { uint v[4]; };
void main() { v[gl_LocalInvocationIndex] = numbers[gl_LocalInvocationIndex]; })",
                    {uniform, storageBuffer(out)}),
        1);
    EXPECT_EQ(std::vector<uint32_t>(words(out), words(out) + 4), (std::vector<uint32_t>{10, 11, 12, 13}));
}

// By the capabilities of SPIR-V 1.5: instance n goes to layer n and to viewport 1 - n.
TEST_F(Core12Test, verticesChooseLayersAndViewports) {
    const TestImage image =
        makeImage(VK_FORMAT_R8G8B8A8_UNORM, {8, 4}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_1_BIT, 2);
    const Pass pass = makePass(image, nullptr, nullptr, VK_SAMPLE_COUNT_1_BIT, 2);
    PipelineDesc desc;
    desc.extent = image.extent;
    desc.vertex = makeAssembledShader(R"(
OpCapability Shader
OpCapability ShaderLayer
OpCapability ShaderViewportIndex
OpMemoryModel Logical GLSL450
OpEntryPoint Vertex %main "main" %position %layer %viewport %vertex %instance
OpDecorate %position BuiltIn Position
OpDecorate %layer BuiltIn Layer
OpDecorate %viewport BuiltIn ViewportIndex
OpDecorate %vertex BuiltIn VertexIndex
OpDecorate %instance BuiltIn InstanceIndex
%void = OpTypeVoid
%fn = OpTypeFunction %void
%bool = OpTypeBool
%int = OpTypeInt 32 1
%float = OpTypeFloat 32
%v4 = OpTypeVector %float 4
%pv4 = OpTypePointer Output %v4
%out = OpTypePointer Output %int
%in = OpTypePointer Input %int
%position = OpVariable %pv4 Output
%layer = OpVariable %out Output
%viewport = OpVariable %out Output
%vertex = OpVariable %in Input
%instance = OpVariable %in Input
%c1 = OpConstant %int 1
%c2 = OpConstant %int 2
%near = OpConstant %float -1
%far = OpConstant %float 3
%half = OpConstant %float 0.5
%one = OpConstant %float 1
%main = OpFunction %void None %fn
%entry = OpLabel
%v = OpLoad %int %vertex
%i = OpLoad %int %instance
%isRight = OpIEqual %bool %v %c1
%isLow = OpIEqual %bool %v %c2
%x = OpSelect %float %isRight %far %near
%y = OpSelect %float %isLow %far %near
%p = OpCompositeConstruct %v4 %x %y %half %one
OpStore %position %p
OpStore %layer %i
%other = OpISub %int %c1 %i
OpStore %viewport %other
OpReturn
OpFunctionEnd
)",
                                      SPV_ENV_UNIVERSAL_1_5);
    desc.fragment = constantColor("1");
    const std::array<VkViewport, 2> viewports{{{0, 0, 4, 4, 0, 1}, {4, 0, 4, 4, 0, 1}}};
    const std::array<VkRect2D, 2> scissors{{{{0, 0}, {4, 4}}, {{4, 0}, {4, 4}}}};
    desc.change = [&](const PipelineStates& states) {
        states.viewport.viewportCount = states.viewport.scissorCount = 2;
        states.viewport.pViewports = viewports.data();
        states.viewport.pScissors = scissors.data();
    };
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(commands, 3, 2, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    for (uint32_t layer = 0; layer < 2; ++layer) {
        const auto texels = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4, layer);
        for (uint32_t x = 0; x < 8; ++x)
            EXPECT_EQ(pixelAt(texels, image, x, 2) != 0, (x >= 4) == (layer == 0)) << layer << ", " << x;
    }
}

// From SPIR-V 1.5 on the invocation that broadcasts may be computed (subgroupBroadcastDynamicId).
TEST_F(Core12Test, broadcastsFromAnyInvocation) {
    TwoBufferModule module;
    module.head = R"(
OpCapability GroupNonUniform
OpCapability GroupNonUniformBallot
)";
    module.localSize = 32;
    module.constants = R"(
%c3 = OpConstant %uint 3
%c7 = OpConstant %uint 7
)";
    module.body = R"(
%pa = OpAccessChain %pu %a %c0 %c0
%pb = OpAccessChain %pu %b %c0 %i
%who = OpLoad %uint %pa
%mine = OpIMul %uint %i %c7
%got = OpGroupNonUniformBroadcast %uint %c3 %mine %who
OpStore %pb %got
)";
    const TestBuffer a = makeStorage(1), b = makeStorage(32);
    const Compute compute = makeAssembled(module.text(), SPV_ENV_UNIVERSAL_1_5, {storageBuffer(a), storageBuffer(b)});
    for (const uint32_t who : {0u, 11u, 31u}) {
        *words(a) = who;
        run(compute, 1);
        for (uint32_t n = 0; n < 32; ++n) EXPECT_EQ(words(b)[n], who * 7) << n;
    }
}

}  // namespace
}  // namespace vernier::test
