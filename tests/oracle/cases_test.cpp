// The numeric cases pass on the oracle's own declared rendering, and fail on every deliberate fault.
#include "conformance/oracle/cases.h"
#include "conformance/oracle/oracle.h"
#include "tests/oracle/rendered.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <map>

namespace vernier::conformance {
namespace {

// Rendered once per case and process.
const CaseImages& ideal(const NumericCase& entry) {
    static std::map<std::string_view, CaseImages> cache;
    const auto [found, fresh] = cache.try_emplace(entry.name);
    if (!fresh) return found->second;
    const auto scenes = entry.build();
    EXPECT_TRUE(scenes.ok()) << (scenes.ok() ? "" : scenes.error().message);
    if (!scenes) return found->second;
    for (const Scene& scene : *scenes) {
        const auto images = renderOracle(scene);
        EXPECT_TRUE(images.ok()) << entry.name << ": " << (images.ok() ? "" : images.error().message);
        if (!images) break;
        found->second.emplace_back();
        for (const OracleImage& image : *images) found->second.back().push_back(renderedFrom(image));
    }
    return found->second;
}

class EveryCase : public testing::TestWithParam<NumericCase> {};

TEST_P(EveryCase, DeclaredRenderingPasses) {
    const CaseImages& images = ideal(GetParam());
    for (const Strictness strictness : {Strictness::legal, Strictness::declared}) {
        const Status status = GetParam().check(images, strictness);
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
    }
}

TEST_P(EveryCase, MissingOrMisshapenImagesAreRefused) {
    EXPECT_FALSE(GetParam().check({}, Strictness::legal).ok());
    CaseImages images = ideal(GetParam());
    ASSERT_FALSE(images.empty());
    images.back().back().texels.pop_back();
    EXPECT_FALSE(GetParam().check(images, Strictness::legal).ok());
}

INSTANTIATE_TEST_SUITE_P(All, EveryCase, testing::ValuesIn(numericCases().begin(), numericCases().end()),
                         [](const auto& tested) { return std::string(tested.param.name); });

std::string failure(std::string_view name, const std::function<void(CaseImages&)>& fault,
                    Strictness strictness = Strictness::legal) {
    const NumericCase* entry = findNumericCase(name);
    if (!entry) return "no such case";
    CaseImages images = ideal(*entry);
    fault(images);
    const Status status = entry->check(images, strictness);
    return status.ok() ? "" : status.error().message;
}

std::byte& byteAt(RenderedImage& image, uint32_t x, uint32_t y, uint32_t channel) {
    return image.texels[(size_t{y} * image.extent.width + x) * 4 + channel];
}

TEST(Fault, HoleAndDoubleOnTheDiagonal) {
    const std::string hole = failure("E01", [](CaseImages& i) { byteAt(i[0][0], 3, 4, 0) = std::byte{0}; });
    EXPECT_NE(hole.find("pixel (3, 4) is covered 0 times"), std::string::npos) << hole;
    EXPECT_NE(hole.find("tie"), std::string::npos) << hole;
    const std::string twice = failure("E01", [](CaseImages& i) { byteAt(i[0][0], 3, 4, 0) = std::byte{32}; });
    EXPECT_NE(twice.find("covered 2 times"), std::string::npos) << twice;
}

TEST(Fault, VertexOrderMatters) {
    const std::string wrong = failure("E02", [](CaseImages& i) { byteAt(i[7][0], 3, 4, 0) = std::byte{0}; });
    EXPECT_NE(wrong, "");
}

TEST(Fault, CracksInTilings) {
    for (const char* name : {"E06", "E07"}) {
        const std::string wrong = failure(name, [](CaseImages& i) {
            for (auto& list : i) byteAt(list[0], 31, 30, 0) = std::byte{0};
        });
        EXPECT_NE(wrong.find("pixel (31, 30)"), std::string::npos) << wrong;
    }
}

TEST(Fault, SliverTakenForEmpty) {
    // Where the sliver's centres are, both neighbours leave a hole.
    const std::string wrong = failure("E10", [](CaseImages& i) { byteAt(i[0][0], 8, 8, 0) = std::byte{0}; });
    EXPECT_NE(wrong.find("pixel (8, 8) is covered 0 times"), std::string::npos) << wrong;
}

TEST(Fault, EmptyTriangleDrawsAPixel) {
    const std::string wrong = failure("E11", [](CaseImages& i) { byteAt(i[0][0], 8, 2, 0) = std::byte{16}; });
    EXPECT_NE(wrong.find("without area"), std::string::npos) << wrong;
}

TEST(Fault, ClippedEdgeDrawnTwice) {
    const std::string wrong = failure("C02", [](CaseImages& i) {
        for (std::byte& b : i[0][0].texels) {
            if (b == std::byte{16}) b = std::byte{32};
        }
    });
    EXPECT_NE(wrong.find("covered 2 times"), std::string::npos) << wrong;
}

TEST(Fault, ScalingChangesABit) {
    const std::string wrong = failure("W06", [](CaseImages& i) { byteAt(i[3][0], 20, 20, 1) ^= std::byte{1}; });
    EXPECT_NE(wrong.find("scaled by 2^120, pixel (20, 20) channel G"), std::string::npos) << wrong;
}

// The bits of one float of an RGBA32F image.
void setFloat(RenderedImage& image, uint32_t x, uint32_t y, uint32_t channel, float value) {
    std::memcpy(image.texels.data() + (size_t{y} * image.extent.width + x) * 16 + channel * 4, &value, 4);
}

TEST(Fault, AlmostOne) {
    const std::string wrong = failure("I01", [](CaseImages& i) { setFloat(i[0][0], 30, 30, 0, 0.9999999f); });
    EXPECT_NE(wrong.find("exactly 1"), std::string::npos) << wrong;
}

TEST(Fault, OriginPlaneEquation) {
    // The error of a plane anchored at the framebuffer's origin: 0.7 codes at 4000 pixels.
    const std::string wrong = failure("I02", [](CaseImages& i) {
        for (size_t p = 0; p < i[0][0].texels.size(); p += 16) {
            float v;
            std::memcpy(&v, i[0][0].texels.data() + p, 4);
            v += 0.74f / 255;
            std::memcpy(i[0][0].texels.data() + p, &v, 4);
        }
    });
    EXPECT_NE(wrong.find("of the attribute's range"), std::string::npos) << wrong;
}

TEST(Fault, EqualFails) {
    const std::string wrong = failure("D03", [](CaseImages& i) {
        byteAt(i[1][0], 30, 30, 0) = std::byte{255};
        byteAt(i[1][0], 30, 30, 1) = std::byte{0};
    });
    EXPECT_NE(wrong.find("D16_UNORM"), std::string::npos) << wrong;
}

TEST(Fault, WrongCodes) {
    const auto fill = [](std::byte value) {
        return [value](CaseImages& i) {
            for (auto& list : i) std::ranges::fill(list[0].texels, value);
        };
    };
    EXPECT_EQ(failure("B01", fill(std::byte{63})), "");
    EXPECT_NE(failure("B01", fill(std::byte{63}), Strictness::declared), "");
    EXPECT_NE(failure("B01", fill(std::byte{65})), "");
    EXPECT_EQ(failure("B02", fill(std::byte{127})), "");
    EXPECT_NE(failure("B02", fill(std::byte{126})), "");
    EXPECT_NE(failure("B01", [](CaseImages& i) { byteAt(i[1][0], 9, 9, 2) = std::byte{63}; }), "")
        << "not the same everywhere";
    for (const char* name : {"B03", "B04"}) {
        EXPECT_NE(failure(name, [](CaseImages& i) { byteAt(i[0][0], 200, 0, 1) ^= std::byte{1}; }).find("came back as"),
                  std::string::npos);
    }
}

}  // namespace
}  // namespace vernier::conformance
