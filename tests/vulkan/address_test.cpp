// Memory by its address (VK_KHR_buffer_device_address), the Vulkan memory model, and SPIR-V 1.4 and later.
#include <array>

#include "tests/vulkan/test_assembly.h"

namespace vernier::test {
namespace {

constexpr VkBufferUsageFlags kByAddress =
    VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr const char* kReference =
    "#extension GL_EXT_buffer_reference : require\n#extension GL_EXT_shader_explicit_arithmetic_types_int64 : "
    "require\n";

class AddressTest : public AssemblyTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_2; }
    std::vector<const char*> moreExtensions() override {
        return {VK_GOOGLE_DECORATE_STRING_EXTENSION_NAME, VK_GOOGLE_HLSL_FUNCTIONALITY_1_EXTENSION_NAME,
                VK_GOOGLE_USER_TYPE_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        addresses_.bufferDeviceAddress = model_.vulkanMemoryModel = model_.vulkanMemoryModelDeviceScope = VK_TRUE;
        addresses_.pNext = &model_;
        return &addresses_;
    }
    VkDeviceAddress addressOf(const TestBuffer& buffer) {
        auto info = make<VkBufferDeviceAddressInfo>(VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO);
        info.buffer = buffer.buffer;
        const VkDeviceAddress address = vkGetBufferDeviceAddress(device, &info);
        EXPECT_NE(address, 0u);
        return address;
    }

  private:
    VkPhysicalDeviceBufferDeviceAddressFeatures addresses_ = make<VkPhysicalDeviceBufferDeviceAddressFeatures>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES);
    VkPhysicalDeviceVulkanMemoryModelFeatures model_ =
        make<VkPhysicalDeviceVulkanMemoryModelFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_MEMORY_MODEL_FEATURES);
};

// A list whose nodes lie in several buffers, the address of one in a push constant.
TEST_F(AddressTest, listsThroughBuffers) {
    struct Node {
        VkDeviceAddress next;
        uint32_t value, padding;
    };
    std::vector<TestBuffer> nodes;
    for (uint32_t n = 0; n < 20; ++n) nodes.push_back(makeBuffer(sizeof(Node), kByAddress));
    VkDeviceAddress next = 0;
    for (uint32_t n = 0; n < 20; ++n) {
        *static_cast<Node*>(nodes[n].data) = {next, n + 1, 0};
        next = addressOf(nodes[n]);
    }
    const TestBuffer out = makeStorage(1);
    const Compute compute = makeCompute(std::string("#version 450\n") + kReference + R"(
layout(buffer_reference) buffer Node;
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Node { Node next; uint value; };
layout(push_constant) uniform P { Node list; };
layout(set = 0, binding = 0) buffer Out { uint sum; };
void main() {
    uint total = 0;
    for (Node at = list; uint64_t(at) != 0ul; at = at.next) { total += at.value; at.value += 100; }
    sum = total;
})",
                                        {storageBuffer(out)}, 8);
    const VkCommandBuffer commands = begin();
    vkCmdPushConstants(commands, compute.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 8, &next);
    dispatch(commands, compute, 1);
    submit(commands);
    EXPECT_EQ(*words(out), 210u);
    for (uint32_t n = 0; n < 20; ++n) EXPECT_EQ(static_cast<const Node*>(nodes[n].data)->value, n + 101);
}

// What one dispatch writes by address, others read through a descriptor and a copy, and the other way round: in order.
TEST_F(AddressTest, accessesByAddressStayInOrder) {
    constexpr uint32_t kCount = 4096;
    const TestBuffer data = makeBuffer(kCount * 4, kByAddress | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const TestBuffer copy = makeBuffer(kCount * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkDeviceAddress address = addressOf(data);
    const Compute byAddress = makeCompute(std::string("#version 450\n") + kReference + R"(
layout(local_size_x = 64) in;
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Values { uint v[]; };
layout(push_constant) uniform P { Values values; };
void main() { uint n = gl_GlobalInvocationID.x; values.v[n] = values.v[n] * 3 + n; })",
                                          {}, 8);
    const Compute byDescriptor = makeCompute(R"(#version 450
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Values { uint v[]; };
void main() { v[gl_GlobalInvocationID.x] += 7; })",
                                             {storageBuffer(data)});
    const VkCommandBuffer commands = begin();
    for (int round = 0; round < 10; ++round) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, byAddress.pipeline);
        vkCmdPushConstants(commands, byAddress.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 8, &address);
        vkCmdDispatch(commands, kCount / 64, 1, 1);
        makeVisible(commands);
        dispatch(commands, byDescriptor, kCount / 64);
    }
    const VkBufferCopy region{0, 0, kCount * 4};
    vkCmdPushConstants(commands, byAddress.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 8, &address);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, byAddress.pipeline);
    vkCmdDispatch(commands, kCount / 64, 1, 1);
    makeVisible(commands);
    vkCmdCopyBuffer(commands, data.buffer, copy.buffer, 1, &region);
    makeVisible(commands);
    submit(commands);
    for (uint32_t n = 0; n < kCount; ++n) {
        uint32_t expected = 0;
        for (int round = 0; round < 10; ++round) expected = expected * 3 + n + 7;
        ASSERT_EQ(words(copy)[n], expected * 3 + n) << n;
    }
}

// Vertices by address: the vertex stage of a later pass must not run ahead of what writes them.
TEST_F(AddressTest, verticesByAddress) {
    const TestBuffer corners = makeBuffer(64, kByAddress);
    const VkDeviceAddress address = addressOf(corners);
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {16, 16}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    PipelineDesc desc;
    desc.extent = {16, 16};
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, std::string("#version 450\n") + kReference + R"(
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer Corners { vec2 at[]; };
layout(push_constant) uniform P { Corners corners; };
void main() { gl_Position = vec4(corners.at[gl_VertexIndex], 0.5, 1); })");
    desc.fragment = constantColor("0, 1, 0, 1");
    desc.layout = makeLayout({}, 8);
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const Compute fill = makeCompute(R"(#version 450
layout(set = 0, binding = 0) buffer Out { vec2 at[]; };
void main() {
    for (int wait = 0; wait < 1000; ++wait) at[3] += 1.0;
    for (int n = 0; n < 3; ++n) at[n] = vec2(n == 1 ? 3 : -1, n == 2 ? 3 : -1);
})",
                                     {storageBuffer(corners)});
    const VkCommandBuffer commands = begin();
    dispatch(commands, fill, 1);
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdPushConstants(commands, desc.layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, 8,
                       &address);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    EXPECT_EQ(pixelAt(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4), color, 8, 8), 0xFF00FF00u);
}

// Beside the buffers that have addresses there is nothing: reads give zeros, writes go nowhere.
TEST_F(AddressTest, addressesOfNothing) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestBuffer hidden = makeStorage(4);  // without the usage
    *words(hidden) = 55;
    const TestBuffer shown = makeBuffer(64, kByAddress);
    for (uint32_t n = 0; n < 16; ++n) words(shown)[n] = n + 1;
    const TestBuffer out = makeStorage(4);
    const Compute compute = makeCompute(std::string("#version 450\n") + kReference + R"(
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Values { uint v[]; };
layout(push_constant) uniform P { Values hidden, shown, wild; };
layout(set = 0, binding = 0) buffer Out { uint v[4]; };
void main() {
    hidden.v[0] += 1;
    shown.v[16] = 9;
    wild.v[3] = 4;
    v[0] = hidden.v[0]; v[1] = shown.v[15]; v[2] = shown.v[16]; v[3] = wild.v[0];
})",
                                        {storageBuffer(out)}, 24);
    const std::array<uint64_t, 3> addresses{reinterpret_cast<uintptr_t>(hidden.data), addressOf(shown),
                                            0xDEADBEEF00000000};
    const VkCommandBuffer commands = begin();
    vkCmdPushConstants(commands, compute.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 24, addresses.data());
    dispatch(commands, compute, 1);
    submit(commands);
    EXPECT_EQ(std::vector<uint32_t>(words(out), words(out) + 4), (std::vector<uint32_t>{0, 16, 0, 0}));
    EXPECT_EQ(*words(hidden), 55u);
}

// Buffers over the same memory, one inside the other and one across its end: an access is good if any of them holds it
// ("vkGetBufferDeviceAddress": "a VkBuffer is selected such that valid usage passes, if it exists").
TEST_F(AddressTest, buffersThatOverlap) {
    const TestBuffer outer = makeBuffer(1024, kByAddress);
    for (uint32_t n = 0; n < 256; ++n) words(outer)[n] = n;
    std::vector<VkBuffer> others;
    for (const auto& [offset, size] : {std::pair<VkDeviceSize, VkDeviceSize>{256, 260}, {256, 8}, {768, 256}}) {
        auto info = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
        info.size = size;
        info.usage = kByAddress;
        VkBuffer& buffer = others.emplace_back();
        ASSERT_EQ(vkCreateBuffer(device, &info, nullptr, &buffer), VK_SUCCESS);
        ASSERT_EQ(vkBindBufferMemory(device, buffer, outer.memory, offset), VK_SUCCESS);
        defer([this, buffer] { vkDestroyBuffer(device, buffer, nullptr); });
    }
    const TestBuffer out = makeStorage(6);
    const Compute compute = makeCompute(std::string("#version 450\n") + kReference + R"(
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Words { uint v[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Wide { uint64_t v[]; };
layout(push_constant) uniform P { Words words; };
layout(set = 0, binding = 0) buffer Out { uint v[6]; };
void main() {
    v[0] = words.v[64]; v[1] = words.v[66]; v[2] = words.v[128]; v[3] = words.v[129];
    Wide across = Wide(uint64_t(words) + 512ul);
    v[4] = uint(across.v[0] >> 32);
    words.v[200] = 1000;
    v[5] = words.v[255];
})",
                                        {storageBuffer(out)}, 8);
    const VkDeviceAddress address = addressOf(outer);
    const VkCommandBuffer commands = begin();
    vkCmdPushConstants(commands, compute.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 8, &address);
    dispatch(commands, compute, 1);
    submit(commands);
    EXPECT_EQ(std::vector<uint32_t>(words(out), words(out) + 6), (std::vector<uint32_t>{64, 66, 128, 129, 129, 255}));
    EXPECT_EQ(words(outer)[200], 1000u);
}

// Messages between invocations of a work-group and between work-groups, by the Vulkan memory model's rules.
TEST_F(AddressTest, memoryModel) {
    const TestBuffer out = makeStorage(4 + 64 * 8);
    const Compute compute = makeCompute(R"(#version 450
#extension GL_KHR_memory_scope_semantics : require
#pragma use_vulkan_memory_model
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) queuefamilycoherent buffer Out { uint arrived, last, sum, pad; uint v[]; };
shared uint values[64];
void main() {
    uint n = gl_LocalInvocationIndex;
    values[n] = n + 1;
    controlBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsShared,
                   gl_SemanticsAcquireRelease | gl_SemanticsMakeAvailable | gl_SemanticsMakeVisible);
    v[gl_GlobalInvocationID.x] = values[63 - n];
    memoryBarrier(gl_ScopeQueueFamily, gl_StorageSemanticsBuffer, gl_SemanticsRelease | gl_SemanticsMakeAvailable);
    uint before = atomicAdd(arrived, 1, gl_ScopeDevice, 0, 0);
    // The last invocation of all sees what everybody wrote.
    if (before == 64 * 8 - 1) {
        memoryBarrier(gl_ScopeQueueFamily, gl_StorageSemanticsBuffer, gl_SemanticsAcquire | gl_SemanticsMakeVisible);
        uint total = 0;
        for (uint i = 0; i < 64 * 8; ++i) total += v[i];
        sum = total;
        last = gl_WorkGroupID.x + 1;
    }
})",
                                        {storageBuffer(out)});
    run(compute, 8);
    EXPECT_EQ(words(out)[0], 512u);
    EXPECT_NE(words(out)[1], 0u);
    EXPECT_EQ(words(out)[2], 8u * 64 * 65 / 2);
}

// Modules of SPIR-V 1.4 and 1.5, which name all their variables in the entry point and select whole vectors; with
// decorations for tools (SPV_GOOGLE_*).
TEST_F(AddressTest, newerModules) {
    TwoBufferModule module;
    module.head = R"(
OpExtension "SPV_GOOGLE_decorate_string"
OpExtension "SPV_GOOGLE_hlsl_functionality1"
OpExtension "SPV_GOOGLE_user_type"
)";
    module.localSize = 4;
    module.declarations = R"(
OpDecorateString %a UserSemantic "IN"
OpDecorateString %b UserTypeGOOGLE "rwstructuredbuffer:<uint>"
OpMemberDecorateString %block 0 UserSemantic "VALUES"
)";
    module.constants = R"(
%v2 = OpTypeVector %uint 2
%c2 = OpConstant %uint 2
%c100 = OpConstant %uint 100
%c200 = OpConstant %uint 200
%low = OpConstantComposite %v2 %c100 %c0
%high = OpConstantComposite %v2 %c200 %c2
)";
    module.body = R"(
%pa = OpAccessChain %pu %a %c0 %i
%pb = OpAccessChain %pu %b %c0 %i
%less = OpULessThan %bool %i %c2
%pair = OpSelect %v2 %less %low %high
%x = OpCompositeExtract %uint %pair 0
%va = OpLoad %uint %pa
%sum = OpIAdd %uint %va %x
OpStore %pb %sum
)";
    for (const spv_target_env environment : {SPV_ENV_UNIVERSAL_1_4, SPV_ENV_UNIVERSAL_1_5}) {
        const TestBuffer a = makeStorage(4), b = makeStorage(4);
        for (uint32_t i = 0; i < 4; ++i) words(a)[i] = i;
        run(makeAssembled(module.text(), environment, {storageBuffer(a), storageBuffer(b)}), 1);
        EXPECT_EQ(std::vector<uint32_t>(words(b), words(b) + 4), (std::vector<uint32_t>{100, 101, 202, 203}));
    }
}

}  // namespace
}  // namespace vernier::test
