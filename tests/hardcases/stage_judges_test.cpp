// The judges of cases about stages, groups of invocations, halves and blocks are judged: see judges_test.cpp.
#include <bit>
#include <cmath>

#include "tests/hardcases/faults.h"

namespace vernier::conformance::hardcases {
namespace {

/// Four words a pixel.
void setWord(RenderedImage& image, uint32_t x, uint32_t y, uint32_t channel, uint32_t word) {
    setFloat(image, x, y, channel, std::bit_cast<float>(word));
}

TEST(StageFault, OtherBlocks) {
    expectCaught(
        "T22", [](auto& d) { setFloat(d[0].images[0], 9, 0, 1, 0.4321f); }, "BC2, block");
    expectCaught(
        "T23",
        [](auto& d) {
            const float texel = std::bit_cast<float>(codeAt(d[0].images[0], 8, 0));
            setFloat(d[0].images[0], 2, 0, 0, std::nextafter(texel, 1.0f));
        },
        "BC6H, block");
    expectCaught(
        "T24", [](auto& d) { setFloat(d[0].images[0], 4, 0, 0, 84.0f / 255); }, "ASTC 4x4, block 0, texel (1, 0)");
    expectCaught(
        "T24", [](auto& d) { setFloat(d[1].images[0], 4, 0, 0, 0.0860f); }, "ASTC 4x4, block 0, texel (1, 0)");
}

TEST(StageFault, StagesAndStrips) {
    // The last vertex of a strip's first triangle, and the first one instead.
    expectCaught(
        "V15", [](auto& d) { setCode(d[3].images[0], 11, 15, 1); }, "the number of the last vertex");
    expectCaught(
        "V16", [](auto& d) { setCode(d[0].images[0], 10, 10, codeAt(d[0].images[0], 10, 10) ^ 1u << 16); },
        "for front faces");
    expectCaught(
        "V17", [](auto& d) { byteAt(d[1].images[0], 70, 10, 1) ^= std::byte{4}; }, "layers that invocations choose");
    expectCaught(
        "V18", [](auto& d) { setCode(d[0].images[0], 11, 10, 2); }, "counted through restarts");
    expectCaught(
        "E21", [](auto& d) { byteAt(d[0].images[0], 30, 30, 0) ^= std::byte{1}; }, "the last in API order");
    expectCaught(
        "C13", [](auto& d) { setFloat(d[1].images[0], 21, 57, 0, 0.5f); }, "exactly");
    EXPECT_EQ(verdictOn(vernier("C13"), [](auto& d) { d[0].images[0].texels[0] ^= std::byte{1}; }).outcome,
              Outcome::allowed);
}

TEST(StageFault, Patches) {
    expectCaught(
        "E22", [](auto& d) { byteAt(d[20].images[0], 33, 40, 0) = std::byte{0}; }, "is covered 0 times");
    // A point that is missing, and one that is out of place.
    expectCaught(
        "V19", [](auto& d) { setFloat(d[1].images[0], 0, 0, 3, 0); }, "has 1 points");
    expectCaught(
        "V19",
        [](auto& d) {
            for (const uint32_t channel : {0u, 1u})
                setFloat(d[0].images[0], 2048, 5, channel, 0.499f + 0.002f * channel);
        },
        "has segments of");
    expectCaught(
        "N09", [](auto& d) { byteAt(d[0].images[0], 10, 2, 0) = std::byte{16}; }, "patch 1 is covered 1 times");
}

TEST(StageFault, HalvesAndGroups) {
    expectCaught(
        "X16", [](auto& d) { setCode(d[0].images[0], 0, 0, std::bit_cast<uint32_t>(2052.0f)); }, "the nearest half");
    expectCaught(
        "X17", [](auto& d) { setCode(d[0].images[0], 1, 0, std::bit_cast<uint32_t>(2.0625f)); }, "the nearest half");
    // A helper invocation that counts; a sum of its own; a fragment that its group does not know of.
    expectCaught(
        "X18", [](auto& d) { setWord(d[0].images[1], 30, 30, 0, 77); }, "sum is 77");
    expectCaught(
        "X18", [](auto& d) { setWord(d[1].images[0], 30, 30, 3, 0); }, "the ballot has");
    expectCaught(
        "X19", [](auto& d) { setWord(d[0].images[1], 30, 30, 0, 30 * 64 + 31); }, "swap 0");
    expectCaught(
        "X19", [](auto& d) { setFloat(d[1].images[2], 30, 30, 0, 1); }, "the fine derivative");
    expectCaught(
        "X20", [](auto& d) { setFloat(d[0].images[1], 30, 30, 0, 1e9f); }, "the sum is");
}

}  // namespace
}  // namespace vernier::conformance::hardcases
