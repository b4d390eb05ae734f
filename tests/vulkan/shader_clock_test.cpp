// VK_KHR_shader_clock: time that shaders read. Nothing is asked of how fast it goes.
#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

class ShaderClockTest : public ComputeTest {
  protected:
    std::vector<const char*> moreExtensions() override { return {VK_KHR_SHADER_CLOCK_EXTENSION_NAME}; }
    void* moreFeatures() override { return &clock_; }

    /// As the time stamps of the device's queue.
    uint64_t timeStamp() {
        const VkQueryPool queries = makeQueries(VK_QUERY_TYPE_TIMESTAMP);
        const VkCommandBuffer commands = begin();
        vkCmdResetQueryPool(commands, queries, 0, 1);
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, 0);
        submit(commands);
        uint64_t time = 0;
        EXPECT_EQ(vkGetQueryPoolResults(device, queries, 0, 1, sizeof time, &time, sizeof time,
                                        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                  VK_SUCCESS);
        return time;
    }

    VkPhysicalDeviceShaderClockFeaturesKHR clock_{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_CLOCK_FEATURES_KHR, nullptr,
                                                  VK_TRUE, VK_TRUE};
};

constexpr const char* kHead =
    "#version 450\n#extension GL_ARB_gpu_shader_int64 : require\n#extension GL_ARB_shader_clock : require\n"
    "#extension GL_EXT_shader_realtime_clock : require\n";

// Every clock, as a number and as two words. A loop that waits for the next tick ends only if it reads in every round.
TEST_F(ShaderClockTest, goesOnWithinAnInvocation) {
    constexpr uint32_t kInvocations = 64, kReadings = 32;
    for (const char* const read :
         {"clockARB()", "clockRealtimeEXT()", "packUint2x32(clock2x32ARB())", "packUint2x32(clockRealtime2x32EXT())"}) {
        SCOPED_TRACE(read);
        const TestBuffer out = makeStorage(kInvocations * kReadings * 2);
        const uint64_t before = timeStamp();
        run(makeCompute(std::string(kHead) +
                            "layout(local_size_x = 64) in;\n"
                            "layout(set = 0, binding = 0) buffer Out { uint64_t o[]; };\n"
                            "void main() {\n"
                            "    uint first = gl_LocalInvocationIndex * 32;\n"
                            "    o[first] = " +
                            read +
                            ";\n"
                            "    for (uint k = 1; k < 32; ++k) {\n"
                            "        uint64_t last = o[first + k - 1], now = last;\n"
                            "        while (now == last) now = " +
                            read +
                            ";\n"
                            "        o[first + k] = now;\n"
                            "    }\n"
                            "}",
                        {storageBuffer(out)}),
            1);
        const uint64_t after = timeStamp();
        const auto* readings = static_cast<const uint64_t*>(out.data);
        for (uint32_t i = 0; i < kInvocations; ++i) {
            const uint64_t* mine = readings + i * kReadings;
            EXPECT_LE(before, mine[0]) << i;
            for (uint32_t k = 1; k < kReadings; ++k) EXPECT_LT(mine[k - 1], mine[k]) << i << ", " << k;
            EXPECT_LE(mine[kReadings - 1], after) << i;
        }
    }
}

// Two readings around work are two values, in stages of graphics as well: what a fragment finds out is its colour.
TEST_F(ShaderClockTest, isReadInEveryStage) {
    constexpr VkExtent2D kExtent{16, 16};
    const std::string wait =
        "bool waits() {\n"
        "    uint64_t first = clockRealtimeEXT(), now = clockARB();\n"
        "    bool inOrder = now >= first;\n"
        "    while (now == first) now = clockRealtimeEXT();\n"
        "    return inOrder && now > first;\n"
        "}\n";
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent,
                                      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    const Pass pass = makePass(color);
    PipelineDesc desc;
    desc.extent = kExtent;
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, kHead + wait +
                                                             R"(layout(location = 0) flat out float ok;
void main() {
    ok = waits() ? 1 : 0;
    gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4 - 1, 0.5, 1);
})");
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, kHead + wait +
                                                                 R"(layout(location = 0) flat in float ok;
layout(location = 0) out vec4 o;
void main() { o = vec4(ok, waits() ? 1 : 0, 0, 1); })");
    drawTriangle(pass, makePipeline(pass.pass, desc));
    const auto texels = readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        for (uint32_t x = 0; x < kExtent.width; ++x) {
            EXPECT_EQ(pixelAt(texels, color, x, y), 0xFF00FFFFu) << x << ", " << y;
        }
    }
}

}  // namespace
}  // namespace vernier::test
