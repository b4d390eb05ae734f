// Compute pipelines and dispatches.
#include "tests/vulkan/test_compute.h"

#include <array>
#include <numeric>

#include <gmock/gmock.h>

namespace vernier::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST_F(ComputeTest, everyInvocationKnowsItsPlace) {
    constexpr uint32_t kGroups[3] = {3, 2, 4}, kLocal[3] = {5, 2, 3}, kTotal = 3 * 2 * 4 * 5 * 2 * 3;
    const TestBuffer out = makeStorage(kTotal * 4);
    run(makeCompute(R"(#version 450
layout(local_size_x = 5, local_size_y = 2, local_size_z = 3) in;
layout(set = 0, binding = 0) buffer Out { uvec4 places[]; };
void main() {
    uvec3 size = gl_NumWorkGroups * gl_WorkGroupSize, at = gl_GlobalInvocationID;
    places[(at.z * size.y + at.y) * size.x + at.x] =
        uvec4(gl_WorkGroupID.x + 16 * gl_WorkGroupID.y + 256 * gl_WorkGroupID.z,
              gl_LocalInvocationID.x + 16 * gl_LocalInvocationID.y + 256 * gl_LocalInvocationID.z,
              gl_LocalInvocationIndex, 1);
})",
                    {storageBuffer(out)}),
        kGroups[0], kGroups[1], kGroups[2]);
    const uint32_t width = kGroups[0] * kLocal[0], height = kGroups[1] * kLocal[1];
    for (uint32_t i = 0; i < kTotal; ++i) {
        const uint32_t at[3] = {i % width, i / width % height, i / width / height};
        const auto pack = [](uint32_t x, uint32_t y, uint32_t z) { return x + 16 * y + 256 * z; };
        const uint32_t local[3] = {at[0] % kLocal[0], at[1] % kLocal[1], at[2] % kLocal[2]};
        const uint32_t* found = words(out) + 4 * size_t{i};
        ASSERT_EQ(found[0], pack(at[0] / kLocal[0], at[1] / kLocal[1], at[2] / kLocal[2])) << i;
        ASSERT_EQ(found[1], pack(local[0], local[1], local[2])) << i;
        ASSERT_EQ(found[2], (local[2] * kLocal[1] + local[1]) * kLocal[0] + local[0]) << i;
        ASSERT_EQ(found[3], 1u) << i;
    }
}

TEST_F(ComputeTest, invocationsShareMemoryAcrossBarriers) {
    constexpr uint32_t kGroups = 37, kLocal = 256;
    const TestBuffer in = makeStorage(kGroups * kLocal), out = makeStorage(kGroups * kLocal);
    for (uint32_t i = 0; i < kGroups * kLocal; ++i) words(in)[i] = i * 2654435761u >> 20;
    run(makeCompute(R"(#version 450
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer In { uint numbers[]; };
layout(set = 0, binding = 1) writeonly buffer Out { uint sums[]; };
shared uint partial[256];
void main() {
    uint me = gl_LocalInvocationIndex;
    partial[me] = numbers[gl_GlobalInvocationID.x];
    barrier();
    for (uint step = 1; step < 256; step *= 2) {
        uint before = me >= step ? partial[me - step] : 0;
        barrier();
        partial[me] += before;
        barrier();
    }
    sums[gl_GlobalInvocationID.x] = partial[me];
})",
                    {storageBuffer(in), storageBuffer(out)}),
        kGroups);
    for (uint32_t group = 0; group < kGroups; ++group) {
        uint32_t sum = 0;
        for (uint32_t i = group * kLocal; i < (group + 1) * kLocal; ++i)
            ASSERT_EQ(words(out)[i], sum += words(in)[i]) << i;
    }
}

TEST_F(ComputeTest, sizesAndConstantsAreSpecialized) {
    const TestBuffer out = makeStorage(1024);
    const std::array<uint32_t, 3> values{8, 4, 1000};
    const VkSpecializationMapEntry entries[] = {{0, 0, 4}, {1, 4, 4}, {7, 8, 4}};
    const VkSpecializationInfo special{3, entries, sizeof values, values.data()};
    const Compute compute = makeCompute(R"(#version 450
layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 7) const uint kBase = 5;
layout(set = 0, binding = 0) buffer Out { uint count; uint size; uint values[]; };
void main() {
    atomicAdd(count, 1);
    size = gl_WorkGroupSize.x * 100 + gl_WorkGroupSize.y;
    values[gl_LocalInvocationIndex] = kBase + gl_LocalInvocationIndex;
})",
                                        {storageBuffer(out)}, 0, &special);
    run(compute, 1);
    EXPECT_EQ(words(out)[0], 32u);
    EXPECT_EQ(words(out)[1], 804u);
    for (uint32_t i = 0; i < 32; ++i) EXPECT_EQ(words(out)[2 + i], 1000 + i);
    EXPECT_EQ(words(out)[2 + 32], 0u);
}

constexpr const char* kAddPushed = R"(#version 450
layout(local_size_x = 4) in;
layout(push_constant) uniform Push { uint base; uint step; };
layout(set = 0, binding = 0) buffer Out { uint values[]; };
void main() { values[gl_GlobalInvocationID.x] += base + step * gl_GlobalInvocationID.x; })";

TEST_F(ComputeTest, dispatchesRunInOrderWithTheirPushConstants) {
    const TestBuffer out = makeStorage(8);
    const Compute compute = makeCompute(kAddPushed, {storageBuffer(out)}, 8);
    const VkCommandBuffer commands = begin();
    for (uint32_t i = 1; i <= 3; ++i) {
        const uint32_t pushed[2] = {i, 10 * i};
        vkCmdPushConstants(commands, compute.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 8, pushed);
        dispatch(commands, compute, 2);
    }
    submit(commands);
    for (uint32_t i = 0; i < 8; ++i) EXPECT_EQ(words(out)[i], 6 + 60 * i);
}

TEST_F(ComputeTest, countsComeFromABufferThatADispatchWrote) {
    const TestBuffer arguments = makeStorage(8, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT), out = makeStorage(64);
    const Compute writer = makeCompute(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uint arguments[]; };
void main() { arguments[1] = 3; arguments[2] = 2; arguments[3] = 5; })",
                                       {storageBuffer(arguments)});
    const Compute counter = makeCompute(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uint counts[]; };
void main() { atomicAdd(counts[gl_NumWorkGroups.x * 16 + gl_NumWorkGroups.y * 4 + gl_NumWorkGroups.z % 4], 1); })",
                                        {storageBuffer(out)});
    const VkCommandBuffer commands = begin();
    dispatch(commands, writer, 1);
    bind(commands, counter);
    vkCmdDispatchIndirect(commands, arguments.buffer, 4);
    makeVisible(commands);
    submit(commands);
    for (uint32_t i = 0; i < 64; ++i) EXPECT_EQ(words(out)[i], i == 3 * 16 + 2 * 4 + 1 ? 30u : 0u) << i;
}

TEST_F(ComputeTest, groupsMayStartElsewhere) {
    const auto dispatchBase =
        reinterpret_cast<PFN_vkCmdDispatchBaseKHR>(vkGetDeviceProcAddr(device, "vkCmdDispatchBaseKHR"));
    const auto setMask =
        reinterpret_cast<PFN_vkCmdSetDeviceMaskKHR>(vkGetDeviceProcAddr(device, "vkCmdSetDeviceMaskKHR"));
    ASSERT_NE(dispatchBase, nullptr);
    ASSERT_NE(setMask, nullptr);
    const TestBuffer out = makeStorage(256);
    const Compute compute = makeCompute(R"(#version 450
#extension GL_EXT_device_group : require
layout(local_size_x = 2) in;
layout(set = 0, binding = 0) buffer Out { uint values[]; };
void main() {
    uint at = gl_WorkGroupID.x + 4 * gl_WorkGroupID.y + 16 * gl_WorkGroupID.z;
    values[2 * at + gl_LocalInvocationIndex] = 100 * gl_NumWorkGroups.x + gl_GlobalInvocationID.x + gl_DeviceIndex;
})",
                                        {storageBuffer(out)}, 0, nullptr, VK_SUCCESS, VK_PIPELINE_CREATE_DISPATCH_BASE);
    const VkCommandBuffer commands = begin();
    setMask(commands, 1);
    bind(commands, compute);
    dispatchBase(commands, 1, 2, 3, 3, 1, 2);
    makeVisible(commands);
    submit(commands);
    for (uint32_t at = 0; at < 128; ++at) {
        const uint32_t x = at % 4, y = at / 4 % 4, z = at / 16;
        const bool inside = x >= 1 && y == 2 && (z == 3 || z == 4);
        for (uint32_t i = 0; i < 2; ++i) ASSERT_EQ(words(out)[2 * at + i], inside ? 300 + 2 * x + i : 0u) << at;
    }
}

TEST_F(ComputeTest, zeroGroupsRunNothing) {
    const TestBuffer out = makeStorage(8);
    const Compute compute = makeCompute(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uint values[]; };
void main() { values[0] = 1; })",
                                        {storageBuffer(out)});
    run(compute, 0);
    run(compute, 3, 0, 2);
    EXPECT_EQ(words(out)[0], 0u);
}

TEST_F(ComputeTest, drawsSeeWhatDispatchesWroteAndTheReverse) {
    const VkExtent2D extent{16, 16};
    const TestImage color =
        makeImage(VK_FORMAT_R8G8B8A8_UNORM, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT);
    const TestBuffer shade = makeStorage(4), seen = makeStorage(4);
    const Compute before = makeCompute(R"(#version 450
layout(set = 0, binding = 0) buffer Shade { vec4 shade; };
void main() { shade = vec4(0.0, 1.0, 0.0, 1.0); })",
                                       {storageBuffer(shade)});
    const Compute after = makeCompute(R"(#version 450
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) buffer Seen { uint green; };
layout(set = 0, binding = 1, rgba8) uniform readonly image2D picture;
void main() { if (imageLoad(picture, ivec2(gl_LocalInvocationID.xy)) == vec4(0, 1, 0, 1)) atomicAdd(green, 1); })",
                                      {storageBuffer(seen), storageImage(color)});
    const Pass pass = makePass(color);
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    const VkDescriptorSet set = makeSet({storageBuffer(shade)}, &setLayout);
    PipelineDesc desc;
    desc.extent = extent;
    desc.vertex = fullScreen();
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(set = 0, binding = 0) readonly buffer Shade { vec4 shade; };
layout(location = 0) out vec4 color;
void main() { color = shade; })");
    desc.layout = makeLayout({setLayout}, 0);
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    dispatch(commands, before, 1);
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    toGeneral(commands, color, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    dispatch(commands, after, 1);
    submit(commands);
    EXPECT_EQ(words(seen)[0], 256u);
}

TEST_F(ComputeTest, dispatchesReadAndWriteImages) {
    const VkExtent2D extent{8, 4};
    const TestImage source = makeImage(VK_FORMAT_R32_UINT, extent, VK_IMAGE_USAGE_STORAGE_BIT);
    const TestImage target = makeImage(VK_FORMAT_R8G8B8A8_UNORM, extent, VK_IMAGE_USAGE_STORAGE_BIT);
    const TestBuffer total = makeStorage(4);
    const Compute fill = makeCompute(R"(#version 450
layout(local_size_x = 8, local_size_y = 4) in;
layout(set = 0, binding = 0, r32ui) uniform uimage2D source;
void main() {
    ivec2 at = ivec2(gl_LocalInvocationID.xy);
    imageStore(source, at, uvec4(at.x + 10 * at.y));
    imageAtomicAdd(source, at, 100u);
    imageStore(source, at + imageSize(source), uvec4(7));
})",
                                     {storageImage(source)});
    const Compute convert = makeCompute(R"(#version 450
layout(local_size_x = 8, local_size_y = 4) in;
layout(set = 0, binding = 0, r32ui) uniform readonly uimage2D source;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D target;
layout(set = 0, binding = 2) buffer Total { uint total; uint outside; };
void main() {
    ivec2 at = ivec2(gl_LocalInvocationID.xy);
    uint value = imageLoad(source, at).r;
    atomicAdd(total, value);
    atomicAdd(outside, imageLoad(source, at + ivec2(8, 0)).r);
    imageStore(target, at, vec4(float(value) / 255.0, 0.0, 0.0, 1.0));
})",
                                        {storageImage(source), storageImage(target), storageBuffer(total)});
    const VkCommandBuffer commands = begin();
    toGeneral(commands, source);
    toGeneral(commands, target);
    dispatch(commands, fill, 1);
    dispatch(commands, convert, 1);
    changeLayout(commands, target.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    submit(commands);
    const auto texels = readImage(target, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    uint32_t sum = 0;
    for (uint32_t y = 0; y < 4; ++y)
        for (uint32_t x = 0; x < 8; ++x) {
            const uint32_t value = 100 + x + 10 * y;
            sum += value;
            EXPECT_EQ(pixelAt(texels, target, x, y), value | 0xFF000000u) << x << ", " << y;
        }
    EXPECT_EQ(words(total)[0], sum);
    EXPECT_EQ(words(total)[1], 0u) << "outside the image";
}

TEST_F(ComputeTest, invocationsAreCounted) {
    const VkQueryPool queries = makeQueries(VK_QUERY_TYPE_PIPELINE_STATISTICS, 1,
                                            VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT |
                                                VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT);
    const TestBuffer out = makeStorage(64);
    const Compute compute = makeCompute(kAddPushed, {storageBuffer(out)}, 8);
    const uint32_t pushed[2] = {};
    const VkCommandBuffer commands = begin();
    vkCmdResetQueryPool(commands, queries, 0, 1);
    vkCmdPushConstants(commands, compute.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 8, pushed);
    vkCmdBeginQuery(commands, queries, 0, 0);
    dispatch(commands, compute, 3, 2);
    vkCmdEndQuery(commands, queries, 0);
    dispatch(commands, compute, 5);
    submit(commands);
    uint64_t counts[2] = {};
    ASSERT_EQ(
        vkGetQueryPoolResults(device, queries, 0, 1, sizeof counts, counts, sizeof counts, VK_QUERY_RESULT_64_BIT),
        VK_SUCCESS);
    EXPECT_EQ(counts[0], 0u);
    EXPECT_EQ(counts[1], 24u);
}

TEST_F(ComputeTest, endlessLoopLosesTheDevice) {
    VERNIER_SKIP_WHEN_VALIDATED();  // the layer takes what was lost to run for ever
    const TestBuffer out = makeStorage(4);
    const Compute compute = makeCompute(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uint value; };
void main() {
    uint i = value | 1;
    while (i != 0) i += 2;
    value = i;
})",
                                        {storageBuffer(out)});
    const VkCommandBuffer commands = begin();
    dispatch(commands, compute, 1);
    ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
    auto info = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    ASSERT_EQ(vkQueueSubmit(queue, 1, &info, VK_NULL_HANDLE), VK_SUCCESS);
    EXPECT_EQ(vkQueueWaitIdle(queue), VK_ERROR_DEVICE_LOST);
}

TEST_F(ComputeTest, limitsAreThoseOfTheSpecificationOrBetter) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physicalDevice, &properties);
    const VkPhysicalDeviceLimits& limits = properties.limits;
    EXPECT_GE(limits.maxComputeSharedMemorySize, 16384u);
    EXPECT_GE(limits.maxComputeWorkGroupInvocations, 128u);
    for (int i = 0; i < 3; ++i) {
        EXPECT_GE(limits.maxComputeWorkGroupCount[i], 65535u);
        EXPECT_GE(limits.maxComputeWorkGroupSize[i], i < 2 ? 128u : 64u);
    }
    // The largest work-group with all its memory runs.
    const TestBuffer out = makeStorage(4);
    run(makeCompute(R"(#version 450
layout(local_size_x = 1024) in;
layout(set = 0, binding = 0) buffer Out { uint sum; };
shared uint memory[8192];
void main() {
    for (uint i = gl_LocalInvocationIndex; i < 8192; i += 1024) memory[8191 - i] = i;
    barrier();
    uint mine = 0;
    for (uint i = 0; i < 8; ++i) mine += memory[gl_LocalInvocationIndex * 8 + i];
    atomicAdd(sum, mine);
})",
                    {storageBuffer(out)}),
        1);
    EXPECT_EQ(words(out)[0], 8191u * 8192 / 2);
}

TEST_F(ComputeTest, tooLargeWorkGroupsAreRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestBuffer out = makeStorage(4);
    const auto refused = [&](const std::array<uint32_t, 3>& size, VkResult result, const char* message) {
        const VkSpecializationMapEntry entries[] = {{0, 0, 4}, {1, 4, 4}, {2, 8, 4}};
        const VkSpecializationInfo special{3, entries, sizeof size, size.data()};
        makeCompute(R"(#version 450
layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z_id = 2) in;
layout(set = 0, binding = 0) buffer Out { uint value; };
void main() { value = 1; })",
                    {storageBuffer(out)}, 0, &special, result);
        EXPECT_THAT(messages, Contains(HasSubstr(message)));
    };
    refused({64, 32, 1}, VK_ERROR_FEATURE_NOT_PRESENT, "64 x 32 x 1");
    refused({1, 1, 128}, VK_ERROR_UNKNOWN, "size in z is 128");
    makeCompute(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uint value; };
shared uint memory[8193];
void main() { memory[gl_WorkGroupID.x] = 1; barrier(); value = memory[8192]; })",
                {storageBuffer(out)}, 0, nullptr, VK_ERROR_FEATURE_NOT_PRESENT);
    EXPECT_THAT(messages, Contains(HasSubstr("32772 bytes")));
}

TEST_F(ComputeTest, invalidRecordingIsToldAtTheEnd) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestBuffer out = makeStorage(16, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    const Compute compute = makeCompute(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uint value; };
void main() { value = 1; })",
                                        {storageBuffer(out)});
    const auto fails = [&](auto recordCommands, const char* message) {
        const VkCommandBuffer commands = begin();
        recordCommands(commands);
        EXPECT_EQ(vkEndCommandBuffer(commands), VK_ERROR_UNKNOWN);
        EXPECT_THAT(messages, Contains(HasSubstr(message)));
    };
    fails([](VkCommandBuffer c) { vkCmdDispatch(c, 1, 1, 1); }, "no compute pipeline is bound");
    fails(
        [&](VkCommandBuffer c) {
            bind(c, compute);
            vkCmdDispatch(c, 1, 65536, 1);
        },
        "work-groups in y is 65536");
    fails(
        [&](VkCommandBuffer c) {
            bind(c, compute);
            vkCmdDispatchIndirect(c, out.buffer, 2);
        },
        "multiple of 4");
    fails([&](VkCommandBuffer c) { vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_GRAPHICS, compute.pipeline); },
          "not that of the pipeline");
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {8, 8}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    fails(
        [&](VkCommandBuffer c) {
            bind(c, compute);
            beginPass(c, pass);
            vkCmdDispatch(c, 1, 1, 1);
            vkCmdEndRenderPass(c);
        },
        "inside a render pass");
}

TEST_F(ComputeTest, absurdIndirectCountsRunNothing) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestBuffer arguments = makeStorage(4, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT), out = makeStorage(4);
    words(arguments)[0] = 0xFFFFFFFF;
    words(arguments)[1] = words(arguments)[2] = 0xFFFFFFFF;
    const Compute compute = makeCompute(R"(#version 450
layout(set = 0, binding = 0) buffer Out { uint value; };
void main() { value = 1; })",
                                        {storageBuffer(out)});
    const VkCommandBuffer commands = begin();
    bind(commands, compute);
    vkCmdDispatchIndirect(commands, arguments.buffer, 0);
    vkCmdDispatchIndirect(commands, arguments.buffer, 8);
    submit(commands);
    EXPECT_EQ(words(out)[0], 0u);
}

}  // namespace
}  // namespace vernier::test
