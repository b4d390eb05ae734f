// Storage buffers of graphics stages in the whole-scene oracle: answers known by hand, and renderers with a fault.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "conformance/oracle/word_writes.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"
#include "tests/oracle/small_scene.h"

namespace vernier::conformance {
namespace {

using namespace small_scene;
using exact::Interval;
using exact::WordKind;
using exact::WordWrite;

constexpr const char* kNumbers = "layout(std430, binding = 0) buffer Numbers { uint numbers[256]; };\n";

struct Drawn {
    std::vector<Vertex> vertices;
    std::string body;                   // of the fragment shader that writes
    std::string shown = "numbers[at]";  // by the one that shows
    std::string declaration = kNumbers;
    std::string input;
};

Drawn drawn(std::vector<Vertex> vertices, std::string body) {
    Drawn result;
    result.vertices = std::move(vertices);
    result.body = std::move(body);
    return result;
}

/// Fragments of 16 x 16 pixels write; a second pass stores what is in the buffer as an image of numbers.
Scene writing(const Drawn& how) {
    SceneRecorder record("words", "");
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kExtent);
    const uint32_t shown = record.colorTarget("shown", VK_FORMAT_R32_UINT, kExtent);
    const uint32_t numbers =
        record.buffer("numbers", VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, std::vector<uint32_t>(256, 100));
    const uint32_t buffer = record.vertexBuffer("vertices", how.vertices);
    const uint32_t write =
        record
            .pipeline(record.vertex(kVertex), record.fragment("#version 450\n" + how.declaration + how.input + R"(
layout(location = 1) flat in vec4 flatColor;
layout(location = 0) out vec4 color;
void main() {
    uint at = uint(gl_FragCoord.y) * 16u + uint(gl_FragCoord.x);
    color = flatColor;
)" + how.body + "}\n"))
            .binding(sizeof(Vertex))
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 16);
    const uint32_t show =
        record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment("#version 450\n" + how.declaration + R"(
layout(location = 0) out uint color;
void main() {
    uint at = uint(gl_FragCoord.y) * 16u + uint(gl_FragCoord.x);
    color = )" + how.shown + ";\n}\n"));
    record.pass(kExtent).color(target, {0, 0, 0, 0});
    record.draw(write, static_cast<uint32_t>(how.vertices.size())).vertices(buffer).storageBuffer(0, numbers);
    record.pass(kExtent).color(shown, {0, 0, 0, 0});
    record.draw(show, 3).storageBuffer(0, numbers);
    record.output(shown);
    auto scene = record.finish();
    EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
    return *scene;
}

/// One triangle that covers all pixels.
std::vector<Vertex> everything() {
    return {vertex(-8, -8, kRed), vertex(56, -8, kRed), vertex(-8, 56, kRed)};
}

void expectExactly(const OraclePixel& pixel, double value) {
    EXPECT_EQ(pixel.value[0], value);
    EXPECT_EQ(pixel.low[0], value);
    EXPECT_EQ(pixel.high[0], value);
    EXPECT_EQ(pixel.flags & kOracleUnknown, 0);
}

void expectRefused(const Scene& scene, const std::string& why) {
    const auto images = renderOracle(scene);
    ASSERT_FALSE(images.ok());
    EXPECT_EQ(images.error().code, ErrorCode::unsupported);
    EXPECT_NE(images.error().message.find(why), std::string::npos) << images.error().message;
}

TEST(Words, AreStoredByCoveredFragmentsAlone) {
    const OracleImage image = render(writing(drawn(leftOf(8.501f), "numbers[at] = at;")));
    expectExactly(at(image, 7, 5), 5 * 16 + 7);
    expectExactly(at(image, 9, 5), 100);
    EXPECT_EQ(at(image, 8, 5).low[0], 5 * 16 + 8) << "snapping decides whether the fragment is there";
    EXPECT_EQ(at(image, 8, 5).high[0], 100);
    EXPECT_NE(at(image, 8, 5).flags & kOracleSnap, 0);
}

TEST(Words, AreCountedInAnyOrder) {
    const Scene scene =
        writing(drawn(everything(), "atomicAdd(numbers[at % 3u], 2u); atomicAdd(numbers[9], at % 5u);"));
    const OracleImage image = render(scene);
    expectExactly(at(image, 0, 0), 100 + 2 * 86);
    expectExactly(at(image, 2, 0), 100 + 2 * 85);
    uint32_t sum = 100;
    for (uint32_t i = 0; i < 256; ++i) sum += i % 5;
    expectExactly(at(image, 9, 0), sum);
}

TEST(Words, CountsHaveRoomForUncertainFragments) {
    const OracleImage image = render(writing(drawn(leftOf(8.501f), "atomicAdd(numbers[0], 1u);")));
    EXPECT_EQ(at(image, 0, 0).low[0], 100 + 8 * 16);
    EXPECT_EQ(at(image, 0, 0).high[0], 100 + 9 * 16);
    EXPECT_EQ(at(image, 0, 0).value[0], 100 + 8 * 16) << "8.501 is snapped to 8.5, and right edges are out";
}

TEST(Words, OfSeveralFragmentsHoldWhatAnyLeft) {
    const OracleImage image = render(writing(drawn(everything(), "numbers[at / 32u] = at % 32u;")));
    EXPECT_EQ(at(image, 3, 0).low[0], 0);
    EXPECT_EQ(at(image, 3, 0).high[0], 31);
    EXPECT_NE(at(image, 3, 0).flags & kOracleSequence, 0);
    expectExactly(at(image, 8, 0), 100);
}

TEST(Words, KeepTheRangeOfNumbers) {
    Drawn numbers{everything(), "numbers[at] = smoothColor.r * 10000.0 - 0.5;", "uint(numbers[at])",
                  "layout(std430, binding = 0) buffer Numbers { float numbers[256]; };\n",
                  "layout(location = 0) in vec4 smoothColor;\n"};
    for (Vertex& v : numbers.vertices) v.color[0] = (v.position[0] + 2) / 8;
    const OracleImage image = render(writing(numbers));
    // (x / 8 + 1) / 8 at the centre of column 3.
    const double value = (3.5 / 8 + 1) / 8 * 10000 - 0.5;
    EXPECT_EQ(at(image, 3, 3).value[0], std::floor(value));
    EXPECT_LE(at(image, 3, 3).low[0], std::floor(value - 0.01));
    EXPECT_GE(at(image, 3, 3).high[0], std::floor(value + 0.01));
}

TEST(Words, RefuseWhatDependsOnOrder) {
    expectRefused(writing(drawn(everything(), "color.r = float(atomicAdd(numbers[0], 1u));")), "return");
    expectRefused(writing(drawn(everything(), "atomicExchange(numbers[0], at);")), "order");
    expectRefused(writing(drawn(everything(), "numbers[at] = numbers[255u - at];")), "loads words");
    expectRefused(writing(drawn(everything(), "atomicAdd(numbers[0], 1u); atomicOr(numbers[0], 1u);")), "several");
}

TEST(Words, OfTheOwnInvocationAreRead) {
    expectExactly(at(render(writing(drawn(everything(), "numbers[at] = 7u; numbers[at] = numbers[at] * 3u;"))), 4, 4),
                  21);
}

TEST(Words, OutsideDoNothing) {
    const OracleImage image = render(writing(drawn(everything(), "numbers[at + 256u] = 7u;")));
    for (const OraclePixel& pixel : image.pixels) expectExactly(pixel, 100);
}

// A faulty rendering is the nominal rendering of a changed scene.
TEST(WordsMutation, FaultsAreCaught) {
    const Scene right =
        writing(drawn(everything(), "atomicAdd(numbers[at % 16u], 1u); numbers[16u + at % 200u] = 9u;"));
    EXPECT_EQ(judge(right, right).outside, 0u);
    const Scene helpers =
        writing(drawn(leftOf(15), "atomicAdd(numbers[at % 16u], 1u); numbers[16u + at % 200u] = 9u;"));
    EXPECT_EQ(judge(right, helpers).outside, 10u) << "a column is lost: a count, and nine words that it alone stores";
    const Scene twice = writing(
        drawn(everything(), "atomicAdd(numbers[at % 16u], at < 16u ? 2u : 1u); numbers[16u + at % 200u] = 9u;"));
    EXPECT_EQ(judge(right, twice).outside, 16u) << "a row runs twice";
    const Scene shifted =
        writing(drawn(everything(), "atomicAdd(numbers[at % 16u], 1u); numbers[17u + at % 200u] = 9u;"));
    EXPECT_EQ(judge(right, shifted).outside, 2u) << "stores a word further on";
}

WordWrite combining(spv::Op op, WordKind kind, Interval value, bool open = false, bool nominal = true) {
    return {0, 0, kind, op, value, 0, open, nominal};
}

exact::StoredBuffer after(const std::vector<WordWrite>& writes, uint32_t before = 12) {
    Scene scene;
    scene.buffers.push_back({"words", 0, bytesOf(std::array{before})});
    exact::Memory memory;
    const Status applied = exact::applyWords(scene, writes, memory);
    EXPECT_TRUE(applied.ok()) << (applied.ok() ? "" : applied.error().message);
    return memory.buffers[0];
}

TEST(Words, OperationsByHand) {
    const auto word = [](const exact::StoredBuffer& buffer) {
        std::array<uint32_t, 1> bits{};
        std::memcpy(bits.data(), buffer.bytes.data(), 4);
        return bits[0];
    };
    constexpr WordKind kUnsigned = WordKind::unsignedInteger, kSigned = WordKind::signedInteger;
    EXPECT_EQ(word(after({combining(spv::OpAtomicIAdd, kUnsigned, 4294967295.0)})), 11u) << "modulo 2^32";
    EXPECT_EQ(word(after({combining(spv::OpAtomicISub, kSigned, 20)})), static_cast<uint32_t>(-8));
    EXPECT_EQ(word(after({combining(spv::OpAtomicSMin, kSigned, -3)})), static_cast<uint32_t>(-3));
    EXPECT_EQ(word(after({combining(spv::OpAtomicUMax, kUnsigned, 4294967290.0)})), 4294967290u);
    EXPECT_EQ(word(after({combining(spv::OpAtomicAnd, kUnsigned, 10)})), 8u);
    EXPECT_EQ(word(after({combining(spv::OpAtomicXor, kUnsigned, 10), combining(spv::OpAtomicXor, kUnsigned, 3)})), 5u);
    const exact::StoredBuffer open =
        after({combining(spv::OpAtomicOr, kUnsigned, 3, true, false), combining(spv::OpAtomicOr, kUnsigned, 16)});
    EXPECT_EQ(word(open), 28u);
    EXPECT_EQ(open.open.at(0).value, Interval(28, 28, 31));
}

TEST(Words, TheSceneWithStorageBuffers) {
    const auto scene = findScene("storage_buffers")->build();
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const OracleImage image = render(*scene);
    ASSERT_EQ(image.pixels.size(), 128u * 128u);
    std::array<uint32_t, 8> histogram{};
    int least = 1000, sum = 0;
    uint32_t most = 0, odd = 0;
    for (uint32_t y = 0; y < 128; ++y) {
        for (uint32_t x = 0; x < 128; ++x) {
            histogram[(x * 3 + y) % 8] += 1 + x % 2;
            least = std::min(least, static_cast<int>(x) - static_cast<int>(y));
            most = std::max(most, x * y);
            sum += static_cast<int>(y % 3) - 1;
            odd ^= (x * 2654435761u) ^ y;
        }
    }
    histogram[7] += 5 * 57 * 40;
    const auto expectWord = [&](uint32_t x, uint32_t y, uint32_t word) {
        for (uint32_t c = 0; c < 4; ++c) {
            EXPECT_EQ(at(image, x, y).value[c] * 255, word >> 8 * c & 255) << x << ", " << y << ", " << c;
            EXPECT_EQ(at(image, x, y).low[c], at(image, x, y).high[c]);
        }
    };
    for (uint32_t i = 0; i < 8; ++i) expectWord(i * 16 + 3, 5, histogram[i]);
    expectWord(3, 20, static_cast<uint32_t>(least + 200));
    expectWord(25, 20, most);
    expectWord(50, 20, static_cast<uint32_t>(sum + 30000));
    expectWord(70, 20, 0x7ffu);
    expectWord(95, 20, 0xffffffffu << 17);
    expectWord(120, 20, odd);
    for (uint32_t i = 0; i < 3; ++i) EXPECT_NEAR(at(image, i * 43, 40).value[2], i * 0.25, 0.5 / 255);
    EXPECT_NEAR(at(image, 10, 100).value[0], 100.5 * 0.0049 + 10.5 * 0.0028, 0.5 / 255 + 1e-9);
    EXPECT_EQ(compareWithOracle(image, renderedFrom(image)).unknown, 0u);
}

}  // namespace
}  // namespace vernier::conformance
