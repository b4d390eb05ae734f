#include "conformance/hardcases/subgroup_cases.h"

#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/value_input.h"
#include "conformance/scenes/recorder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{64, 64};

const std::string kExtensionsGlsl = R"(#version 450
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_quad : require
)";

/// Triangles that do not overlap, of a few pixels each: vertices move by less than a quarter of a cell.
std::vector<ClipPosition> smallTriangles() {
    return clipAt(jitteredTiling(15, 3.75, 0.9, 256, 15), viewportOf(kTarget));
}

/// Triangles in one draw into targets of one format.
Result<Scene> fragmentScene(std::string_view name, const std::string& glsl, const std::vector<ClipPosition>& positions,
                            VkExtent2D extent, VkFormat format, uint32_t targets) {
    SceneRecorder record(name, "What fragments of one draw learn of each other.");
    std::vector<uint32_t> images;
    for (uint32_t i = 0; i < targets; ++i)
        images.push_back(record.colorTarget("results " + std::to_string(i), format, extent));
    const uint32_t pipeline =
        record.pipeline(record.vertex(kPositionVertexGlsl), record.fragment(glsl, VN_GLSL_TARGET_VULKAN_1_1))
            .binding(sizeof(ClipPosition))
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
            .targets(targets);
    PassRecorder pass = record.pass(extent);
    for (const uint32_t image : images) pass.color(image, {0, 0, 0, 0});
    record.draw(pipeline, static_cast<uint32_t>(positions.size()))
        .vertices(record.vertexBuffer("positions", positions))
        .viewport(0, 0, static_cast<float>(kTarget.width), static_cast<float>(kTarget.height));
    for (const uint32_t image : images) record.output(image);
    return record.finish();
}

// ---- X15: properties ----

// One bit per property that holds for the invocation.
const char* const kPropertiesGlsl = R"(
layout(location = 0) out uint result;
void main() {
    uint seen = 0x80u;
    uvec4 all = subgroupBallot(true);
    uint active_ = subgroupBallotBitCount(all), own = gl_SubgroupInvocationID;
    uint workers = subgroupAdd(gl_HelperInvocation ? 0u : 1u);
    if (subgroupAll(true) && !subgroupAny(false)) seen |= 1u;
    if (subgroupInverseBallot(all) && own < gl_SubgroupSize) seen |= 2u;
    if (active_ >= 1u && active_ <= gl_SubgroupSize) seen |= 4u;
    if (workers >= 1u && workers <= active_) seen |= 8u;
    if (subgroupMin(own) <= own && subgroupMax(own) >= own) seen |= 16u;
    if (subgroupBroadcastFirst(own) == subgroupMin(own)) seen |= 32u;
    float across = subgroupQuadSwapHorizontal(gl_FragCoord.x), down = subgroupQuadSwapVertical(gl_FragCoord.y);
    if (abs(across - gl_FragCoord.x) == 1.0 && abs(down - gl_FragCoord.y) == 1.0) seen |= 64u;
    result = seen;
}
)";

void addProperties(CaseInput& input, const std::vector<ClipPosition>& positions) {
    const size_t scene =
        input.scene(fragmentScene("X15", kExtensionsGlsl + kPropertiesGlsl, positions, kTarget, VK_FORMAT_R32_UINT, 1));
    judgePixels(input, scene, 0, kTarget, [](const PixelReader& pixels, const Declared&) -> Verdict {
        constexpr uint64_t kDrawn = 0x80, kGroupBits = 0x3f, kQuadBit = 0x40;
        size_t covered = 0;
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                const uint64_t seen = pixels.code(x, y, 0);
                if ((seen & kDrawn) == 0) continue;
                ++covered;
                if ((seen & kGroupBits) != kGroupBits) {
                    return Verdict::wrong(pixelText(x, y) + ": only properties " + std::to_string(seen & kGroupBits) +
                                          " of 63 hold");
                }
                // Fragment shaders with quad operations launch the helper invocations that these need.
                if ((seen & kQuadBit) == 0)
                    return Verdict::wrong(pixelText(x, y) + ": the neighbours in the quad are not one pixel away");
            }
        }
        return covered < 1000 ? Verdict::wrong("only " + std::to_string(covered) + " pixels are covered") : Verdict{};
    });
}

// ---- X18, X20: groups, made again from what their invocations tell ----

/// `who`: the least pixel number of the group, the invocation, the ballot's first word, its bits counted below 65536
/// and the bits before this one above. The swap makes helper invocations be launched; it changes nothing.
std::string groupGlsl(bool branch, const std::string& results) {
    return kExtensionsGlsl + R"(
layout(location = 0) out uvec4 who;
layout(location = 1) out uvec4 sums;
layout(location = 2) out uvec4 rest;
void main() {
    uint pixel = uint(gl_FragCoord.y) * 64u + uint(gl_FragCoord.x);
    uint value = subgroupQuadSwapHorizontal(pixel) == (pixel ^ 1u) ? pixel * 2654435761u : 0u;
    bool counts = !gl_HelperInvocation;
    who = sums = rest = uvec4(0u);
    )" + (branch ? "if (counts) " : "") +
           R"({
        uvec4 ballot = subgroupBallot(counts);
        uint bits = subgroupBallotBitCount(ballot), before = subgroupBallotExclusiveBitCount(ballot);
        who = uvec4(subgroupMin(counts ? pixel : ~0u), gl_SubgroupInvocationID, ballot.x, bits | before << 16);
)" + results +
           "    }\n}\n";
}

using Words = std::array<uint32_t, 4>;

struct Member {
    uint32_t pixel = 0, value = 0;
    Words who{}, sums{}, rest{};
};
using Group = std::vector<Member>;  // in the order of invocations

std::string memberText(const Member& member) {
    return pixelText(member.pixel % 64, member.pixel / 64) + ", invocation " + std::to_string(member.who[1]) + ": ";
}

Words wordsAt(const PixelReader& pixels, uint32_t x, uint32_t y) {
    Words words{};
    for (uint8_t c = 0; c < 4; ++c) words[c] = static_cast<uint32_t>(pixels.code(x, y, c));
    return words;
}

/// Asks `check` about every group, having made sure that invocations, ballots and counts agree with its members.
Verdict judgeGroups(const Drawn& drawn, const std::function<Verdict(const Group& group)>& check) {
    if (drawn.size() != 3) return Verdict::wrong("an image is missing");
    const PixelReader who(drawn[0]), sums(drawn[1]), rest(drawn[2]);
    if (!who.valid() || !sums.valid() || !rest.valid()) return Verdict::wrong("an image has the wrong size");
    std::map<uint32_t, Group> groups;
    size_t covered = 0;
    for (uint32_t y = 0; y < kTarget.height; ++y) {
        for (uint32_t x = 0; x < kTarget.width; ++x) {
            const uint32_t pixel = y * 64 + x;
            const Member member{pixel, pixel * 2654435761u, wordsAt(who, x, y), wordsAt(sums, x, y),
                                wordsAt(rest, x, y)};
            if (member.who[3] == 0) continue;
            groups[member.who[0]].push_back(member);
            ++covered;
        }
    }
    if (covered < 1000) return Verdict::wrong("only " + std::to_string(covered) + " pixels are covered");
    Verdict worst;
    for (auto& [least, group] : groups) {
        std::ranges::sort(group, {}, [](const Member& member) { return member.who[1]; });
        uint32_t ballot = 0, before = 0, first = ~0u;
        for (const Member& member : group) {
            ballot |= member.who[1] < 32 ? 1u << member.who[1] : 0;
            first = std::min(first, member.pixel);
        }
        for (const Member& member : group) {
            const Words expected{first, member.who[1], ballot, static_cast<uint32_t>(group.size()) | before++ << 16};
            if (member.who != expected) {
                return Verdict::wrong(memberText(member) + "the ballot has " + std::to_string(member.who[3] & 0xffff) +
                                      " bits and is " + std::to_string(member.who[2]) + ", " +
                                      std::to_string(group.size()) + " fragments are of this group, their ballot is " +
                                      std::to_string(ballot));
            }
        }
        worst = worst.worse(check(group));
    }
    return worst;
}

/// Reductions and scans of unsigned integers: exact in any order.
Verdict checkIntegers(const Group& group) {
    uint32_t sum = 0, least = ~0u, most = 0, all = ~0u, any = 0;
    for (const Member& member : group) {
        sum += member.value;
        least = std::min(least, member.value);
        most = std::max(most, member.value);
        all &= member.value;
        any |= member.value;
    }
    uint32_t before = 0, parity = 0;
    for (const Member& member : group) {
        parity ^= member.value;
        const Words sums{sum, before, least, most}, rest{all, any, parity, group.front().pixel};
        before += member.value;
        for (size_t k = 0; k < 4; ++k) {
            constexpr const char* kSums[] = {"sum", "sum before", "minimum", "maximum"};
            constexpr const char* kRest[] = {"and", "or", "xor up to here", "first"};
            const bool inSums = member.sums[k] != sums[k];
            if (!inSums && member.rest[k] == rest[k]) continue;
            return Verdict::wrong(memberText(member) + (inSums ? kSums[k] : kRest[k]) + " is " +
                                  std::to_string(inSums ? member.sums[k] : member.rest[k]) + ", exactly " +
                                  std::to_string(inSums ? sums[k] : rest[k]));
        }
    }
    return {};
}

// What cancels, and factors that products round.
float termOf(uint32_t value) {
    const uint32_t kind = value >> 8 & 3;
    return kind == 0 ? 1e8f : kind == 1 ? -1e8f : static_cast<float>(value >> 12 & 1023) / 1024;
}
float factorOf(uint32_t value) {
    return 1 + static_cast<float>(value >> 12 & 255) / 512;
}

/// Reductions and scans of floats: permitted within what steps in any order, each correctly rounded, may be off; our
/// own answer is that of the order of invocations with every step rounded.
Verdict checkFloats(const Group& group, const Declared& declared) {
    struct Running {
        float inOrder;
        double exactly, magnitude;
    };
    Verdict worst;
    const auto check = [&](const Member& member, const char* what, uint32_t bits, const Running& expected) {
        const float seen = std::bit_cast<float>(bits);
        if (seen == static_cast<float>(expected.exactly)) return;
        const double error = std::abs(static_cast<double>(seen) - expected.exactly);
        const bool legal = error <= static_cast<double>(group.size()) * 0x1p-23 * expected.magnitude;
        char text[160];
        std::snprintf(text, sizeof text, "%s is %.9g, in the order of invocations %.9g, exactly %.17g", what,
                      static_cast<double>(seen), static_cast<double>(expected.inOrder), expected.exactly);
        const std::string where = memberText(member) + text;
        const bool own = declared.own && seen == expected.inOrder;
        worst = worst.worse(own ? Verdict::declared(where) : Verdict::inexact(legal, where));
    };
    Running sum{0, 0, 0}, product{1, 1, 1};
    for (const Member& member : group) {
        check(member, "the sum before", member.sums[2], sum);
        check(member, "the product before", member.rest[2], product);
        const float term = termOf(member.value), factor = factorOf(member.value);
        sum = {sum.inOrder + term, sum.exactly + static_cast<double>(term),
               sum.magnitude + std::abs(static_cast<double>(term))};
        const double exactly = product.exactly * static_cast<double>(factor);
        product = {product.inOrder * factor, exactly, exactly};
        check(member, "the sum up to here", member.sums[1], sum);
        check(member, "the product up to here", member.rest[1], product);
    }
    for (const Member& member : group) {
        check(member, "the sum", member.sums[0], sum);
        check(member, "the product", member.rest[0], product);
    }
    return worst;
}

// ---- X19: quads ----

const char* const kQuadsGlsl = R"(
#extension GL_KHR_shader_subgroup_quad : require
layout(location = 0) out uvec4 corners;
layout(location = 1) out uvec4 swaps;
layout(location = 2) out uvec4 differences;
void main() {
    uvec2 place = uvec2(gl_FragCoord.xy);
    uint pixel = place.y * 64u + place.x + 1u;
    corners = uvec4(subgroupQuadBroadcast(pixel, 0u), subgroupQuadBroadcast(pixel, 1u),
                    subgroupQuadBroadcast(pixel, 2u), subgroupQuadBroadcast(pixel, 3u));
    swaps = uvec4(subgroupQuadSwapHorizontal(pixel), subgroupQuadSwapVertical(pixel), subgroupQuadSwapDiagonal(pixel),
                  pixel);
    precise float v = gl_FragCoord.x * gl_FragCoord.x * 0.37 + gl_FragCoord.y * gl_FragCoord.x * 1.7;
    float across = subgroupQuadSwapHorizontal(v), down = subgroupQuadSwapVertical(v);
    precise float x = (place.x & 1u) == 0u ? across - v : v - across, y = (place.y & 1u) == 0u ? down - v : v - down;
    differences = uvec4(floatBitsToUint(dFdxFine(v)), floatBitsToUint(x), floatBitsToUint(dFdyFine(v)),
                        floatBitsToUint(y));
}
)";

Verdict judgeQuads(const Drawn& drawn, VkExtent2D extent) {
    if (drawn.size() != 3) return Verdict::wrong("an image is missing");
    const PixelReader corners(drawn[0]), swaps(drawn[1]), differences(drawn[2]);
    if (!corners.valid() || !swaps.valid() || !differences.valid())
        return Verdict::wrong("an image has the wrong size");
    Verdict worst;
    size_t covered = 0;
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const Words corner = wordsAt(corners, x, y), swap = wordsAt(swaps, x, y);
            if (swap[3] == 0) continue;
            ++covered;
            const auto at = [](uint32_t px, uint32_t py) { return py * 64 + px + 1; };
            const uint32_t left = x & ~1u, top = y & ~1u;
            const Words allCorners{at(left, top), at(left + 1, top), at(left, top + 1), at(left + 1, top + 1)};
            const Words allSwaps{at(x ^ 1, y), at(x, y ^ 1), at(x ^ 1, y ^ 1), at(x, y)};
            for (size_t k = 0; k < 4; ++k) {
                const bool broadcast = corner[k] != allCorners[k];
                if (!broadcast && swap[k] == allSwaps[k]) continue;
                return Verdict::wrong(pixelText(x, y) + (broadcast ? ": broadcast " : ": swap ") + std::to_string(k) +
                                      " gives pixel number " + std::to_string(broadcast ? corner[k] : swap[k]) +
                                      ", exactly " + std::to_string(broadcast ? allCorners[k] : allSwaps[k]));
            }
            const Words difference = wordsAt(differences, x, y);
            for (const size_t k : {0, 2}) {
                if (difference[k] == difference[k + 1]) continue;
                const double derivative = std::bit_cast<float>(difference[k]),
                             swapped = std::bit_cast<float>(difference[k + 1]);
                char text[120];
                std::snprintf(text, sizeof text, ": the fine derivative is %.9g, the difference of the swap %.9g",
                              derivative, swapped);
                worst = worst.worse(
                    Verdict::inexact(std::abs(derivative - swapped) <= ulpOf(swapped), pixelText(x, y) + text));
            }
        }
    }
    return covered < 1000 ? Verdict::wrong("only " + std::to_string(covered) + " pixels are covered") : worst;
}

}  // namespace

void x15(CaseInput& input) {
    addProperties(input, {{-1, -1, 0.5f, 1}, {3, -1, 0.5f, 1}, {-1, 3, 0.5f, 1}});
    addProperties(input, smallTriangles());
}

void x18(CaseInput& input) {
    // With a branch around the helper invocations, and with the neutral element of each operation for them.
    for (const bool branch : {true, false}) {
        const std::string first =
            branch ? "subgroupBroadcastFirst(pixel)"
                   : "subgroupAdd(gl_SubgroupInvocationID == subgroupBallotFindLSB(ballot) ? pixel : 0u)";
        const std::string glsl = groupGlsl(branch, R"(
        sums = uvec4(subgroupAdd(counts ? value : 0u), subgroupExclusiveAdd(counts ? value : 0u),
                     subgroupMin(counts ? value : ~0u), subgroupMax(counts ? value : 0u));
        rest = uvec4(subgroupAnd(counts ? value : ~0u), subgroupOr(counts ? value : 0u),
                     subgroupInclusiveXor(counts ? value : 0u), )" +
                                                       first + ");\n");
        const size_t scene =
            input.scene(fragmentScene("X18", glsl, smallTriangles(), kTarget, VK_FORMAT_R32G32B32A32_UINT, 3));
        input.judge({scene}, [](std::span<const Drawn* const> images, const Declared&) {
            return judgeGroups(*images[0], checkIntegers);
        });
    }
}

void x19(CaseInput& input) {
    // The second target ends within quads.
    for (const VkExtent2D extent : {kTarget, VkExtent2D{55, 57}}) {
        const size_t scene = input.scene(fragmentScene("X19", std::string("#version 450\n") + kQuadsGlsl,
                                                       smallTriangles(), extent, VK_FORMAT_R32G32B32A32_UINT, 3));
        input.judge({scene}, [extent](std::span<const Drawn* const> images, const Declared&) {
            return judgeQuads(*images[0], extent);
        });
    }
}

void x20(CaseInput& input) {
    const std::string glsl = groupGlsl(true, R"(
        uint kind = value >> 8 & 3u;
        float term = kind == 0u ? 1e8 : kind == 1u ? -1e8 : float(value >> 12 & 1023u) / 1024.0;
        float factor = 1.0 + float(value >> 12 & 255u) / 512.0;
        sums = uvec4(floatBitsToUint(subgroupAdd(term)), floatBitsToUint(subgroupInclusiveAdd(term)),
                     floatBitsToUint(subgroupExclusiveAdd(term)), 0u);
        rest = uvec4(floatBitsToUint(subgroupMul(factor)), floatBitsToUint(subgroupInclusiveMul(factor)),
                     floatBitsToUint(subgroupExclusiveMul(factor)), 0u);
)");
    const size_t scene =
        input.scene(fragmentScene("X20", glsl, smallTriangles(), kTarget, VK_FORMAT_R32G32B32A32_UINT, 3));
    input.judge({scene}, [](std::span<const Drawn* const> images, const Declared& declared) {
        return judgeGroups(*images[0], [&declared](const Group& group) { return checkFloats(group, declared); });
    });
}

}  // namespace vernier::conformance::hardcases
