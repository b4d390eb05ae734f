// The judges are judged: pictures with one deliberate fault each must be called wrong, and the cause named.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>

#include "conformance/hardcases/texture_input.h"
#include "conformance/oracle/filtering.h"
#include "conformance/oracle/oracle.h"
#include "tests/hardcases/faults.h"
#include "tests/oracle/rendered.h"

namespace vernier::conformance::hardcases {
namespace {

// The oracle's own declared rendering, once per case and process.
const Ideal& ideal(std::string_view id) {
    static std::map<std::string_view, Ideal> cache;
    const auto [found, fresh] = cache.try_emplace(id);
    if (!fresh) return found->second;
    const HardCase* hardCase = findCase(id);
    EXPECT_NE(hardCase, nullptr);
    if (hardCase == nullptr) return found->second;
    hardCase->build(found->second.input);
    for (const Scene& scene : found->second.input.scenes()) {
        const auto images = renderOracle(scene);
        EXPECT_TRUE(images.ok()) << id << ": " << (images.ok() ? "" : images.error().message);
        SceneOutcome outcome;
        if (images) {
            for (const OracleImage& image : *images) outcome.images.push_back(renderedFrom(image));
        }
        found->second.drawn.push_back(std::move(outcome));
    }
    return found->second;
}

Verdict verdictOn(std::string_view id, const Fault& fault) {
    return verdictOn(ideal(id), fault);
}

class DeclaredRendering : public testing::TestWithParam<const char*> {};

TEST_P(DeclaredRendering, IsExact) {
    const Verdict verdict = verdictOn(GetParam(), [](auto&) {});
    EXPECT_EQ(verdict.outcome, Outcome::exact) << outcomeName(verdict.outcome) << ": " << verdict.witness;
}

TEST_P(DeclaredRendering, WithAMissingPartIsNot) {
    EXPECT_EQ(verdictOn(GetParam(), [](auto& drawn) { drawn.pop_back(); }).outcome, Outcome::crashed);
    const Verdict cut = verdictOn(GetParam(), [](auto& drawn) { drawn.back().images.back().texels.pop_back(); });
    EXPECT_EQ(cut.outcome, Outcome::wrong);
    const Verdict lacking = verdictOn(GetParam(), [](auto& drawn) {
        drawn[0] = {{}, Outcome::unsupported, "no such feature"};
    });
    EXPECT_GE(lacking.outcome, Outcome::unsupported);
}

INSTANTIATE_TEST_SUITE_P(Judges, DeclaredRendering,
                         testing::Values("E01", "E02", "E06", "E07", "E10", "E11", "E20", "C02", "W06", "I01", "I02",
                                         "D03", "B01", "B02", "B03", "B04"));

void expectWrong(std::string_view id, const Fault& fault, const std::string& cause) {
    const Verdict verdict = verdictOn(id, fault);
    EXPECT_EQ(verdict.outcome, Outcome::wrong) << id;
    EXPECT_NE(verdict.witness.find(cause), std::string::npos) << id << ": " << verdict.witness;
}

/// The first covered pixel of a count image, or the last one.
std::pair<uint32_t, uint32_t> coveredPixel(const RenderedImage& image, bool last) {
    std::pair<uint32_t, uint32_t> result;
    for (uint32_t y = 0; y < image.extent.height; ++y) {
        for (uint32_t x = 0; x < image.extent.width; ++x) {
            if (image.texels[(size_t{y} * image.extent.width + x) * 4] == std::byte{0}) continue;
            result = {x, y};
            if (!last) return result;
        }
    }
    return result;
}

TEST(Fault, ScissorOffByOne) {
    // The seventh scissor begins at (6, 12): the first column inside it is lost.
    expectCaught(
        "E19",
        [](auto& d) {
            for (uint32_t y = 0; y < 64; ++y) byteAt(d[6].images[0], 6, y, 0) = std::byte{0};
        },
        "covered 0 times");
}

TEST(Fault, SwappedProvokingVertex) {
    // Flat colours of the last vertex instead of the first: two further on in a list.
    expectCaught(
        "V08",
        [](auto& d) {
            RenderedImage& image = d[0].images[0];
            for (uint32_t i = 0; i < 64 * 64; ++i) {
                std::byte& green = byteAt(image, i % 64, i / 64, 1);
                if (byteAt(image, i % 64, i / 64, 2) == std::byte{0}) continue;
                green = static_cast<std::byte>(std::to_integer<uint32_t>(green) + 2);
            }
        },
        "exactly");
}

TEST(Fault, MissingSampleOnATie) {
    expectCaught(
        "M01",
        [](auto& d) {
            const auto [x, y] = coveredPixel(d[0].images[0], false);
            byteAt(d[0].images[0], x + 3, y + 3, 0) = std::byte{0};
        },
        "covered 0 times");
}

TEST(Fault, LineShiftedByAPixel) {
    expectCaught(
        "P05",
        [](auto& d) {
            Bytes& texels = d[0].images[0].texels;
            std::rotate(texels.begin(), texels.end() - 4, texels.end());
        },
        "the rectangle of the line's width");
}

TEST(Fault, PointTooLarge) {
    expectCaught(
        "P09", [](auto& d) { byteAt(d[0].images[0], 0, 40, 0) = std::byte{16}; }, "the square of the point's size");
}

TEST(Fault, HalvedDepthBias) {
    expectCaught(
        "D06",
        [](auto& d) {
            for (uint32_t i = 0; i < 64 * 64; ++i) {
                const float without = std::bit_cast<float>(codeAt(d[0].images[0], i % 64, i / 64));
                const float with = std::bit_cast<float>(codeAt(d[1].images[0], i % 64, i / 64));
                setCode(d[1].images[0], i % 64, i / 64, std::bit_cast<uint32_t>(without + (with - without) / 2));
            }
        },
        "the largest exponent in the primitive");
}

TEST(Fault, StencilWrapsInsteadOfClamping) {
    expectCaught(
        "S01", [](auto& d) { byteAt(d[0].images[0], 255, VK_STENCIL_OP_INCREMENT_AND_CLAMP, 0) = std::byte{0}; },
        "exactly 255");
}

TEST(Fault, ValuesBeyondTheirTolerance) {
    expectCaught(
        "X01", [](auto& d) { setCode(d[0].images[0], 126, 0, codeAt(d[0].images[0], 126, 0) + 10); },
        "permitted within");
    expectCaught(
        "X08", [](auto& d) { setCode(d[0].images[0], 3, 0, 0x30000000u); }, "exactly 0x00000000");
    expectCaught(
        "G07", [](auto& d) { setCode(d[1].images[0], 5, 0, codeAt(d[1].images[0], 5, 0) + 1); }, "exactly");
}

TEST(Fault, SevenBitWeights) {
    const Bytes texels = someTexels({8, 4}, 5);
    const auto texel = [&texels](int64_t x, int64_t y) {
        const auto wrapped = static_cast<size_t>(((y % 4 + 4) % 4) * 8 + (x % 8 + 8) % 8);
        return exact::fraction(std::to_integer<int64_t>(texels[wrapped * 4]), 255);
    };
    // Weights cut off, not rounded, to so many bits.
    const auto with = [&texel](int bits) {
        return [&texel, bits](std::vector<SceneOutcome>& d) {
            for (uint32_t i = 0; i < 300; ++i) {
                const auto taps = [bits](float coordinate, int64_t size) {
                    exact::AxisTaps t = exact::linearTaps(exact::rational(coordinate) * exact::fraction(size, 1));
                    t.weight =
                        exact::Rational(exact::floorOf(t.weight * exact::powerOfTwo(bits))) * exact::powerOfTwo(-bits);
                    return t;
                };
                const exact::AxisTaps u = taps(static_cast<float>(i * 37 % 300) / 300.0f, 8);
                const exact::AxisTaps v = taps(static_cast<float>(i) / 300.0f, 4);
                const auto row = [&](int64_t y) {
                    const exact::Rational a = texel(u.first, y), b = texel(u.first + 1, y);
                    return exact::Rational(a + u.weight * (b - a));
                };
                const exact::Rational top = row(v.first), bottom = row(v.first + 1);
                const exact::Rational value = top + v.weight * (bottom - top);
                setFloat(d[0].images[0], i, 0, 0, static_cast<float>(value.get_d()));
            }
        };
    };
    EXPECT_EQ(verdictOn(vernier("T07"), with(8)).outcome, Outcome::allowed);
    EXPECT_EQ(verdictOn(vernier("T07"), with(8), vernierDeclares(8, "standard")).outcome, Outcome::allowed)
        << "not what Vernier declares";
    expectCaught("T07", with(7), "exactly");
}

TEST(OwnBounds, AreNarrowerThanTheSpecification) {
    const auto add = [](size_t scene, float difference) {
        return [=](std::vector<SceneOutcome>& drawn) {
            RenderedImage& results = drawn[scene].images[0];
            const float sine = std::bit_cast<float>(codeAt(results, 0, 0)) + difference;
            setCode(results, 0, 0, std::bit_cast<uint32_t>(sine));
        };
    };
    const Declared standard = vernierDeclares(8, "standard"), fast = vernierDeclares(8, "fast");
    const auto nothing = [](auto&) {};
    for (const char* id : {"T07", "I05", "X04", "X13", "B12"}) {
        EXPECT_EQ(verdictOn(vernier(id), nothing).outcome, Outcome::allowed) << id;
        EXPECT_EQ(verdictOn(vernier(id), nothing, standard).outcome, Outcome::declared) << id;
    }
    EXPECT_EQ(verdictOn(vernier("X04"), add(0, 0x1p-13f), standard).outcome, Outcome::allowed);
    EXPECT_EQ(verdictOn(vernier("X04"), add(0, 0x1p-13f), fast).outcome, Outcome::declared);
    EXPECT_EQ(verdictOn(vernier("X04"), add(0, 0x1p-8f), fast).outcome, Outcome::wrong);
    EXPECT_EQ(verdictOn(vernier("X01"), add(0, 1), standard).outcome, Outcome::wrong);
}

TEST(Fault, BresenhamFragmentsOutOfPlace) {
    // One fragment twice, then one left out of connected segments, then one away from the line.
    expectCaught(
        "P01", [](auto& d) { byteAt(d[2].images[0], 16, 16, 0) = std::byte{32}; }, "condition 4");
    expectCaught(
        "P01",
        [](auto& d) {
            for (uint32_t y = 0; y < 32; ++y) byteAt(d[2].images[0], 10, y, 0) = std::byte{0};
        },
        "condition");
    expectCaught(
        "P03", [](auto& d) { byteAt(d[0].images[0], 30, 5, 0) = std::byte{16}; }, "condition 1");
}

TEST(Fault, StippleRunsBackwards) {
    expectCaught(
        "P07",
        [](auto& d) {
            Bytes& texels = d[2].images[0].texels;
            std::reverse(texels.begin(), texels.end());
            for (size_t i = 0; i < texels.size(); i += 4) std::reverse(texels.begin() + i, texels.begin() + i + 4);
        },
        "mod 16 of the pattern");
}

TEST(Fault, OutlineOfAClippedTriangle) {
    expectCaught(
        "P12", [](auto& d) { byteAt(d[0].images[0], 5, 50, 0) = std::byte{16}; }, "away from all edges");
    expectCaught(
        "P12",
        [](auto& d) {
            for (uint32_t x = 20; x < 50; ++x) {
                for (uint32_t y = 10; y < 22; ++y) byteAt(d[0].images[0], x, y, 0) = std::byte{0};
            }
        },
        "is not drawn");
}

TEST(Fault, FacesAndLayers) {
    expectCaught(
        "T14", [](auto& d) { setFloat(d[0].images[0], 2, 0, 0, 96.0f / 255); }, "neither of the two rules");
    expectCaught(
        "T16", [](auto& d) { setFloat(d[0].images[0], 45, 0, 0, 0); }, "another face than the same vector");
    expectCaught(
        "T17", [](auto& d) { setFloat(d[0].images[0], 0, 0, 0, 1); }, "the average of its 3 texels");
    expectCaught(
        "L13", [](auto& d) { setFloat(d[0].images[0], 30, 4, 0, 96.0f / 255); }, "by the projection on its face");
}

TEST(Fault, BlocksAndFormats) {
    expectCaught(
        "T20", [](auto& d) { setFloat(d[4].images[0], 9, 0, 1, 0.4321f); }, "ETC2, block");
    expectCaught(
        "B05", [](auto& d) { byteAt(d[0].images[0], 600, 0, 0) = std::byte{1}; }, "codes fall");
    expectCaught(
        "B12", [](auto& d) { setCode(d[0].images[0], 5, 0, 31u << 6 | 1); }, "is stored as code");
    expectCaught(
        "B13", [](auto& d) { setFloat(d[0].images[0], 7, 0, 2, 1.5f); }, "exactly");
}

TEST(Fault, ExportsSubgroupsAndViews) {
    expectCaught(
        "S05", [](auto& d) { byteAt(d[0].images[0], 20, 3, 0) = std::byte{191}; }, "each quarter is a sample");
    expectCaught(
        "X15", [](auto& d) { setCode(d[1].images[0], 30, 30, 0xf7); }, "properties");
    expectCaught(
        "X15", [](auto& d) { setCode(d[0].images[0], 31, 30, 0xbf); }, "neighbours in the quad");
    expectCaught(
        "V13", [](auto& d) { byteAt(d[1].images[0], 70, 10, 1) ^= std::byte{4}; }, "views of one draw");
    expectCaught(
        "V10", [](auto& d) { setCode(d[0].images[0], 2, 2, 0x77); }, "one flat value");
    expectCaught(
        "G08", [](auto& d) { setCode(d[0].images[0], 4, 0, 0xdead); }, "exactly 0x00000000");
}

TEST(Fault, HoleAndDoubleOnTheDiagonal) {
    expectWrong(
        "E01", [](auto& d) { byteAt(d[0].images[0], 3, 4, 0) = std::byte{0}; }, "pixel (3, 4) is covered 0 times");
    expectWrong(
        "E01", [](auto& d) { byteAt(d[0].images[0], 3, 4, 0) = std::byte{32}; }, "tie");
}

TEST(Fault, VertexOrderMatters) {
    expectWrong(
        "E02", [](auto& d) { byteAt(d[7].images[0], 3, 4, 0) = std::byte{0}; }, "covered 0 times");
}

TEST(Fault, CracksInTilings) {
    for (const char* id : {"E06", "E07"}) {
        expectWrong(
            id, [](auto& d) { byteAt(d[0].images[0], 31, 30, 0) = std::byte{0}; }, "pixel (31, 30)");
    }
}

TEST(Fault, SliverTakenForEmpty) {
    // Where the sliver's centres are, both neighbours leave a hole.
    expectWrong(
        "E10", [](auto& d) { byteAt(d[0].images[0], 8, 8, 0) = std::byte{0}; }, "pixel (8, 8) is covered 0 times");
}

TEST(Fault, EmptyTriangleDrawsAPixel) {
    expectWrong(
        "E11", [](auto& d) { byteAt(d[0].images[0], 8, 2, 0) = std::byte{16}; }, "no area");
}

TEST(Fault, LeakOutsideTheScissor) {
    expectWrong(
        "E19", [](auto& d) { byteAt(d[2].images[0], 60, 60, 0) = std::byte{16}; }, "outside the scissor");
}

TEST(Fault, OrderOfOverlappingTriangles) {
    expectWrong(
        "E20", [](auto& d) { byteAt(d[0].images[0], 50, 45, 0) ^= std::byte{1}; }, "the last in API order");
}

TEST(Fault, ClippedEdgeDrawnTwice) {
    expectWrong(
        "C02",
        [](auto& d) {
            for (std::byte& b : d[0].images[0].texels) {
                if (b == std::byte{16}) b = std::byte{32};
            }
        },
        "covered 2 times");
}

TEST(Fault, ScalingChangesABit) {
    expectWrong(
        "W06", [](auto& d) { byteAt(d[4].images[0], 20, 20, 1) ^= std::byte{1}; }, "2^120");
}

TEST(Fault, AlmostOne) {
    expectWrong(
        "I01", [](auto& d) { setFloat(d[0].images[0], 30, 30, 0, 0.9999999f); }, "exactly 1");
}

TEST(Fault, OriginPlaneEquation) {
    // The error of a plane anchored at the framebuffer's origin: 0.7 codes at 4000 pixels.
    expectWrong(
        "I02",
        [](auto& d) {
            Bytes& texels = d[0].images[0].texels;
            for (size_t p = 0; p < texels.size(); p += 16) {
                float v;
                std::memcpy(&v, texels.data() + p, 4);
                v += 0.74f / 255;
                std::memcpy(texels.data() + p, &v, 4);
            }
        },
        "of the attribute's range");
}

TEST(Fault, EqualFails) {
    expectWrong(
        "D03",
        [](auto& d) {
            byteAt(d[1].images[0], 30, 30, 0) = std::byte{255};
            byteAt(d[1].images[0], 30, 30, 1) = std::byte{0};
        },
        "failed EQUAL");
}

TEST(Fault, WrongCodes) {
    const auto fill = [](std::byte value) {
        return [value](std::vector<SceneOutcome>& d) {
            for (SceneOutcome& outcome : d) std::ranges::fill(outcome.images[0].texels, value);
        };
    };
    EXPECT_EQ(verdictOn("B01", fill(std::byte{63})).outcome, Outcome::allowed);
    expectWrong("B01", fill(std::byte{65}), "permitted 63 or 64");
    EXPECT_EQ(verdictOn("B02", fill(std::byte{127})).outcome, Outcome::allowed);
    expectWrong("B02", fill(std::byte{126}), "permitted 127 or 128");
    expectWrong(
        "B01", [](auto& d) { byteAt(d[1].images[0], 9, 9, 2) = std::byte{63}; }, "elsewhere");
    for (const char* id : {"B03", "B04"}) {
        expectWrong(
            id, [](auto& d) { byteAt(d[0].images[0], 200, 0, 1) ^= std::byte{1}; }, "came back as");
    }
}

}  // namespace
}  // namespace vernier::conformance::hardcases
