// Queries, and what the counters tell of work that was left out.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <random>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

class Query : public ApiTest {
  protected:
    VnQuery query(VnQueryType type) {
        VnQuery result{};
        EXPECT_EQ(vnCreateQuery(device_, type, &result), VN_SUCCESS) << lastError();
        return result;
    }
    VnQueryResult result(VnQuery of) {
        VnQueryResult values{};
        EXPECT_EQ(vnGetQueryResult(context_, of, &values), VN_SUCCESS) << lastError();
        return values;
    }
    void begin(VnImage target) {
        const VnPassDesc pass = passOn(target);
        EXPECT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    }
    VnStatistics statistics() {
        VnStatistics values{};
        EXPECT_EQ(vnGetStatistics(context_, &values), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnResetStatistics(context_), VN_SUCCESS);
        return values;
    }
};

TEST_F(Query, OcclusionCountsSamplesInsideAPassAndAroundPasses) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 20, 10);
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    const VnQuery all = query(VN_QUERY_OCCLUSION), part = query(VN_QUERY_OCCLUSION), none = query(VN_QUERY_OCCLUSION);
    ASSERT_EQ(vnBindProgram(context_, white), VN_SUCCESS);
    ASSERT_EQ(vnBeginQuery(context_, all), VN_SUCCESS);
    begin(target);
    ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
    const VkRect2D scissor{{3, 2}, {5, 4}};
    ASSERT_EQ(vnSetScissor(context_, &scissor), VN_SUCCESS);
    ASSERT_EQ(vnBeginQuery(context_, part), VN_SUCCESS);
    // The second hides the first, which is counted all the same.
    ASSERT_EQ(vnDraw(context_, 3, 2, 0, 0), VN_SUCCESS);
    ASSERT_EQ(vnEndQuery(context_, part), VN_SUCCESS);
    ASSERT_EQ(vnBeginQuery(context_, none), VN_SUCCESS);
    ASSERT_EQ(vnEndQuery(context_, none), VN_SUCCESS);
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    ASSERT_EQ(vnEndQuery(context_, all), VN_SUCCESS);
    EXPECT_EQ(result(all).value, 200u + 40u);
    EXPECT_EQ(result(part).value, 40u);
    EXPECT_EQ(result(none).value, 0u);
    EXPECT_EQ(result(none).fragmentInvocations, 0u);
}

TEST_F(Query, StatisticsCountWhatTheStagesDo) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 20, 10);
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    VnProgramDesc desc{};
    desc.compute = shader(VK_SHADER_STAGE_COMPUTE_BIT, "#version 450\nlayout(local_size_x = 8) in;\nvoid main() {}");
    VnProgram compute{};
    ASSERT_EQ(vnCreateProgram(device_, &desc, &compute), VN_SUCCESS) << lastError();
    const VnQuery counts = query(VN_QUERY_STATISTICS);
    for (uint32_t instances = 1; instances < 4; ++instances) {  // a query is used again
        ASSERT_EQ(vnBeginQuery(context_, counts), VN_SUCCESS);
        begin(target);
        ASSERT_EQ(vnBindProgram(context_, white), VN_SUCCESS);
        ASSERT_EQ(vnDraw(context_, 3, instances, 0, 0), VN_SUCCESS) << lastError();
        ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
        ASSERT_EQ(vnBindProgram(context_, compute), VN_SUCCESS);
        ASSERT_EQ(vnDispatch(context_, 5, 2, 1), VN_SUCCESS) << lastError();
        ASSERT_EQ(vnEndQuery(context_, counts), VN_SUCCESS);
        const VnQueryResult values = result(counts);
        EXPECT_EQ(values.inputVertices, 3u * instances);
        EXPECT_EQ(values.inputPrimitives, instances);
        EXPECT_EQ(values.vertexInvocations, 3u * instances);
        EXPECT_EQ(values.clippingInvocations, instances);
        EXPECT_EQ(values.clippingPrimitives, instances);
        EXPECT_EQ(values.fragmentInvocations, 200u * instances);
        EXPECT_EQ(values.computeInvocations, 80u);
        EXPECT_EQ(values.value, 0u);
    }
}

TEST_F(Query, AnyNumberOfThemInOnePassCountApart) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 150, 90);
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    std::mt19937 random(7);
    const auto below = [&](uint32_t bound) { return static_cast<uint32_t>(random() % bound); };
    struct Expected {
        VnQuery query;
        bool statistics;
        uint64_t samples = 0, draws = 0;
    };
    std::vector<Expected> all;
    for (uint32_t n = 0; n < 60; ++n)
        all.push_back({query(n % 2 == 0 ? VN_QUERY_OCCLUSION : VN_QUERY_STATISTICS), n % 2 != 0});
    ASSERT_EQ(vnBindProgram(context_, white), VN_SUCCESS);
    // Some around passes, the others inside; they overlap as they like, of each kind one at a time.
    size_t next = 0;
    for (uint32_t round = 0; round < 12; ++round) {
        std::vector<Expected*> around, open;
        for (const bool kind : {false, true})
            if (below(2) != 0 && next < all.size() && all[next].statistics == kind) around.push_back(&all[next++]);
        for (Expected* of : around) ASSERT_EQ(vnBeginQuery(context_, of->query), VN_SUCCESS) << lastError();
        begin(target);
        for (uint32_t step = 0; step < 40; ++step) {
            const auto isOpen = [&](bool kind) {
                const auto same = [&](const Expected* of) { return of->statistics == kind; };
                return std::any_of(open.begin(), open.end(), same) || std::any_of(around.begin(), around.end(), same);
            };
            if (below(3) == 0 && next < all.size() && !isOpen(all[next].statistics)) {
                open.push_back(&all[next++]);
                ASSERT_EQ(vnBeginQuery(context_, open.back()->query), VN_SUCCESS) << lastError();
            }
            const VkRect2D scissor{{static_cast<int32_t>(below(149)), static_cast<int32_t>(below(89))},
                                   {1 + below(60), 1 + below(60)}};
            ASSERT_EQ(vnSetScissor(context_, &scissor), VN_SUCCESS);
            ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
            const uint64_t covered =
                uint64_t{std::min(scissor.extent.width, 150u - static_cast<uint32_t>(scissor.offset.x))} *
                std::min(scissor.extent.height, 90u - static_cast<uint32_t>(scissor.offset.y));
            for (const auto& list : {around, open}) {
                for (Expected* of : list) {
                    of->samples += covered;
                    ++of->draws;
                }
            }
            if (below(3) == 0 && !open.empty()) {
                ASSERT_EQ(vnEndQuery(context_, open.front()->query), VN_SUCCESS) << lastError();
                open.erase(open.begin());
            }
        }
        for (Expected* of : open) ASSERT_EQ(vnEndQuery(context_, of->query), VN_SUCCESS) << lastError();
        ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
        for (Expected* of : around) ASSERT_EQ(vnEndQuery(context_, of->query), VN_SUCCESS) << lastError();
    }
    ASSERT_GE(next, 40u);
    for (size_t n = 0; n < next; ++n) {
        const VnQueryResult values = result(all[n].query);
        if (!all[n].statistics) {
            EXPECT_EQ(values.value, all[n].samples) << n;
            continue;
        }
        EXPECT_EQ(values.fragmentInvocations, all[n].samples) << n;
        EXPECT_EQ(values.inputVertices, 3 * all[n].draws) << n;
        EXPECT_EQ(values.clippingInvocations, all[n].draws) << n;
    }
}

TEST_F(Query, TimestampsGrowAlongTheCommands) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 64, 64);
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    const std::array<VnQuery, 3> times{query(VN_QUERY_TIMESTAMP), query(VN_QUERY_TIMESTAMP), query(VN_QUERY_TIMESTAMP)};
    ASSERT_EQ(vnBindProgram(context_, white), VN_SUCCESS);
    ASSERT_EQ(vnWriteTimestamp(context_, times[0]), VN_SUCCESS);
    begin(target);
    ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnWriteTimestamp(context_, times[1]), VN_SUCCESS);
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    ASSERT_EQ(vnWriteTimestamp(context_, times[2]), VN_SUCCESS);
    EXPECT_LT(result(times[0]).value, result(times[1]).value);
    EXPECT_LE(result(times[1]).value, result(times[2]).value);
}

TEST_F(Query, WrongUseIsRefused) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8);
    const VnQuery samples = query(VN_QUERY_OCCLUSION), time = query(VN_QUERY_TIMESTAMP);
    VnQueryResult values{};
    VnQuery made{};
    EXPECT_EQ(vnCreateQuery(device_, static_cast<VnQueryType>(3), &made), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vnCreateQuery(device_, VN_QUERY_OCCLUSION, nullptr), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vnGetQueryResult(context_, samples, &values), VN_ERROR_INVALID_STATE);
    EXPECT_EQ(vnGetQueryResult(context_, samples, nullptr), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vnEndQuery(context_, samples), VN_ERROR_INVALID_STATE);
    EXPECT_EQ(vnBeginQuery(context_, time), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vnWriteTimestamp(context_, samples), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vnBeginQuery(context_, VnQuery{}), VN_ERROR_INVALID_HANDLE);
    EXPECT_EQ(vnPassBarrier(context_), VN_ERROR_INVALID_STATE);

    ASSERT_EQ(vnBeginQuery(context_, samples), VN_SUCCESS);
    EXPECT_EQ(vnBeginQuery(context_, samples), VN_ERROR_INVALID_STATE);
    EXPECT_EQ(vnFlush(context_), VN_ERROR_INVALID_STATE) << "a query would lie in two submissions";
    begin(target);
    EXPECT_EQ(vnEndQuery(context_, samples), VN_ERROR_INVALID_STATE) << "it has begun outside the pass";
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    ASSERT_EQ(vnEndQuery(context_, samples), VN_SUCCESS);

    begin(target);
    ASSERT_EQ(vnBeginQuery(context_, samples), VN_SUCCESS);
    EXPECT_EQ(vnEndPass(context_), VN_ERROR_INVALID_STATE);
    ASSERT_EQ(vnEndQuery(context_, samples), VN_SUCCESS);
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_EQ(vnGetQueryResult(context_, samples, &values), VN_SUCCESS) << lastError();
    EXPECT_EQ(vnDestroyQuery(device_, samples), VN_SUCCESS);
    EXPECT_EQ(vnDestroyQuery(device_, samples), VN_ERROR_INVALID_HANDLE);
    EXPECT_EQ(vnGetQueryResult(context_, samples, &values), VN_ERROR_INVALID_HANDLE);
}

TEST_F(Query, ClearsOfWhatIsDrawnOverTouchNoPixel) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 192, 128);
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    for (const uint32_t texel : drawFullScreen(target, 192, 128, white)) ASSERT_EQ(texel, 0xFFFFFFFFu);
    EXPECT_EQ(statistics().clearedPixels, 0u);

    begin(target);
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_EQ(statistics().clearedPixels, 192u * 128);

    // The left half of the image, which ends inside a tile of 64 x 64.
    VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    const VkRect2D scissor{{0, 0}, {100, 128}};
    ASSERT_EQ(vnSetScissor(context_, &scissor), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, white), VN_SUCCESS);
    ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS);
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_EQ(statistics().clearedPixels, (192u - 64) * 128) << "the first column of tiles is drawn over";

    pass.colors[0].loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_EQ(statistics().clearedPixels, 0u);
    EXPECT_EQ(read(target, 192, 128)[0], 0xFFFFFFFFu) << "an attachment nobody touches";
}

TEST_F(Query, InstancesAndDrawsShareFragmentBatches) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 64, 64);
    // A pixel each, all over one tile.
    const VnProgram dots = program(R"(#version 450
void main() {
    gl_PointSize = 1.0;
    gl_Position = vec4(vec2(gl_InstanceIndex % 16, gl_InstanceIndex / 16) / 8.0 - 0.96, 0.5, 1.0);
})",
                                   kWhiteFragment);
    ASSERT_EQ(vnBindProgram(context_, dots), VN_SUCCESS);
    ASSERT_EQ(vnSetTopology(context_, VK_PRIMITIVE_TOPOLOGY_POINT_LIST, 0), VN_SUCCESS);
    begin(target);
    ASSERT_EQ(vnDraw(context_, 1, 256, 0, 0), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    const VnStatistics instanced = statistics();
    EXPECT_EQ(instanced.draws, 1u);
    EXPECT_EQ(instanced.fragmentInvocations, 256u);
    EXPECT_LE(instanced.fragmentBatches, 256u / 16);
    begin(target);
    for (uint32_t n = 0; n < 256; ++n) ASSERT_EQ(vnDraw(context_, 1, 1, 0, n), VN_SUCCESS);
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_EQ(statistics().fragmentBatches, instanced.fragmentBatches);
}

/// Bytes of memory that the process has touched.
size_t residentBytes() {
    size_t total = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return resident * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

TEST_F(Query, LargeBuffersTakeMemoryOnlyWhereTheyAreTouched) {
    constexpr uint64_t kBytes = uint64_t{1} << 30;
    const size_t before = residentBytes();
    const VnBuffer large = buffer(nullptr, kBytes);
    uint32_t word = 1;
    ASSERT_EQ(vnReadBuffer(context_, large, kBytes - 4, &word, 4), VN_SUCCESS) << lastError();
    EXPECT_EQ(word, 0u);
    EXPECT_LT(residentBytes() - before, kBytes / 16);
}

TEST_F(Query, InputAttachmentsReadWhatThePassHasDrawn) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 100, 70), other = image(VK_FORMAT_R8G8B8A8_UNORM, 100, 70);
    const VnProgram gradient = program(kFullScreenVertex, R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(floor(gl_FragCoord.xy) / 255.0, 0.0, 1.0); })");
    const VnProgram swap = program(kFullScreenVertex, R"(#version 450
layout(input_attachment_index = 0, set = 0, binding = 0) uniform subpassInput before;
layout(location = 1) out vec4 color;
void main() { color = subpassLoad(before).grba; })");
    VnPassDesc pass = passOn(target);
    pass.colors[1] = passOn(other).colors[0];
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    VnBlendStateDesc blend{};
    blend.independent = 1;
    blend.attachments[0].writeMaskOff = 0xF;
    VnBlendState second{};
    ASSERT_EQ(vnCreateBlendState(device_, &blend, &second), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindProgram(context_, gradient), VN_SUCCESS);
    ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnPassBarrier(context_), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, swap), VN_SUCCESS);
    ASSERT_EQ(vnBindBlendState(context_, second), VN_SUCCESS);
    ASSERT_EQ(vnBindTexture(context_, 0, 0, 0, view(target), {}), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    const std::vector<uint32_t> texels = read(other, 100, 70);
    for (uint32_t y = 0; y < 70; ++y)
        for (uint32_t x = 0; x < 100; ++x) ASSERT_EQ(texels[y * 100 + x], 0xFF000000u | x << 8 | y) << x << ", " << y;
}

TEST_F(Query, BlitsMirror) {
    constexpr uint32_t kWidth = 5, kHeight = 3;
    const VnImage from = image(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight);
    const VnImage to = image(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight);
    std::array<uint32_t, kWidth * kHeight> texels{};
    for (uint32_t n = 0; n < texels.size(); ++n) texels[n] = n * 0x01030507u;
    ASSERT_EQ(vnUpdateImage(context_, from, nullptr, texels.data(), sizeof texels), VN_SUCCESS);
    for (uint32_t mirror = 0; mirror < 4; ++mirror) {
        VnRegion region{};
        region.mirror = mirror;
        ASSERT_EQ(vnBlitImage(context_, from, nullptr, to, &region, VK_FILTER_NEAREST), VN_SUCCESS) << lastError();
        const std::vector<uint32_t> result = read(to, kWidth, kHeight);
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
                const uint32_t sourceX = (mirror & 1) != 0 ? kWidth - 1 - x : x;
                const uint32_t sourceY = (mirror & 2) != 0 ? kHeight - 1 - y : y;
                EXPECT_EQ(result[y * kWidth + x], texels[sourceY * kWidth + sourceX]) << mirror;
            }
        EXPECT_EQ(vnCopyImage(context_, from, nullptr, to, &region),
                  mirror == 0 ? VN_SUCCESS : VN_ERROR_INVALID_ARGUMENT);
    }
    VnRegion region{};
    region.mirror = 8;
    EXPECT_EQ(vnBlitImage(context_, from, nullptr, to, &region, VK_FILTER_NEAREST), VN_ERROR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace vernier::test
