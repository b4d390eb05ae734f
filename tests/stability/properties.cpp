#include "tests/stability/properties.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "conformance/hardcases/homogeneous_input.h"
#include "tests/stability/generate.h"

namespace vernier::stability {
namespace {

using conformance::exact::GridTriangle;
using Make = Soup (*)(uint64_t);

std::string pixelText(size_t pixel) {
    return "pixel (" + std::to_string(pixel % kSize) + ", " + std::to_string(pixel / kSize) + ")";
}

std::string firstDifference(const Counts& a, const Counts& b, const char* what) {
    for (size_t i = 0; i < a.size(); ++i) {
        if (a[i] != b[i]) {
            return pixelText(i) + " is covered " + std::to_string(a[i]) + " and, " + what + ", " +
                   std::to_string(b[i]) + " times";
        }
    }
    return {};
}

std::string firstDifference(const Image& a, const Image& b, const char* what) {
    for (size_t i = 0; i < a.size(); ++i) {
        if (a[i] != b[i]) {
            return pixelText(i / 4) + ", component " + std::to_string(i % 4) + ", is " +
                   std::to_string(std::bit_cast<float>(a[i])) + " and, " + what + ", " +
                   std::to_string(std::bit_cast<float>(b[i]));
        }
    }
    return {};
}

// ---- Partition ----

/// The triangles of a flat soup as they are snapped, all clockwise; none if snapping turns one over, which folds the
/// mesh.
std::vector<GridTriangle> snapped(const Soup& soup, int bits) {
    conformance::hardcases::WindowTriangles window;
    for (const Triangle& triangle : soup) {
        auto& points = window.emplace_back();
        for (size_t i = 0; i < 3; ++i) {
            const Position& p = triangle[i];
            if (p[3] != 1 || p[2] < 0 || p[2] > 1 || std::abs(p[0]) > 4 || std::abs(p[1]) > 4) return {};
            points[i] = {(static_cast<double>(p[0]) + 1) * 32, (static_cast<double>(p[1]) + 1) * 32};
        }
    }
    return conformance::hardcases::snapped(window, bits);
}

// Every sample is covered by those triangles that exact integers say. Of a mesh that is one, and the next where two
// meet: the tie rule, and that a vertex is snapped to the same place in all its triangles, are in that.
std::string checkPartition(const Soup& soup, const Canvases& canvases) {
    const int bits = canvases.several.subPixelBits();
    const std::vector<GridTriangle> grid = snapped(soup, bits);
    if (grid.empty()) return {};
    const Counts counts = canvases.several.count(soup);
    const int64_t half = int64_t{1} << (bits - 1);
    const conformance::exact::SampleGrid samples{{kSize, kSize}, bits, {half, half}};
    return conformance::exact::checkDeclaredCoverage(grid, samples, {{0, 0}, {kSize, kSize}},
                                                     std::vector<uint32_t>(counts.begin(), counts.end()));
}

// A sheet in clip space: nowhere twice, and everywhere at least as often as exact homogeneous edges say.
std::string checkClipped(const Soup& soup, const Canvases& canvases) {
    using conformance::hardcases::Side;
    using conformance::hardcases::TriangleSides;
    const Counts counts = canvases.several.count(soup);
    const VkViewport viewport = conformance::hardcases::viewportOf({kSize, kSize});
    std::vector<TriangleSides> sides;
    for (const Triangle& triangle : soup) {
        TriangleSides side(triangle, viewport, canvases.several.subPixelBits());
        if (side.orientation() != 0) sides.push_back(std::move(side));
    }
    for (uint32_t y = 0; y < kSize; ++y) {
        for (uint32_t x = 0; x < kSize; ++x) {
            float least = 0, most = 0;
            for (const TriangleSides& side : sides) {
                const Side worst = side.at(x, y).worst();
                least += worst == Side::inside ? 1.0f : 0.0f;
                most += worst == Side::outside ? 0.0f : 1.0f;
            }
            const float count = counts[size_t{y} * kSize + x];
            if (count >= least && count <= most) continue;
            return pixelText(size_t{y} * kSize + x) + " is covered " + std::to_string(count) + " times, exactly " +
                   std::to_string(least) + " to " + std::to_string(most);
        }
    }
    return {};
}

// ---- Order ----

std::string checkOrder(const Soup& soup, const Canvases& canvases) {
    const Image together = canvases.several.paint(soup);
    std::string wrong = firstDifference(together, canvases.several.paint(soup), "drawn again");
    if (wrong.empty()) wrong = firstDifference(together, canvases.one.paint(soup), "with one thread");
    if (wrong.empty())
        wrong = firstDifference(together, canvases.several.paint(soup, Attributes::own, true), "drawn one by one");
    return wrong;
}

std::string checkRotation(const Soup& soup, const Canvases& canvases) {
    const Image image = canvases.several.paint(soup);
    for (size_t turn = 1; turn < 3; ++turn) {
        Soup turned = soup;
        for (Triangle& triangle : turned)
            std::rotate(triangle.begin(), triangle.begin() + static_cast<ptrdiff_t>(turn), triangle.end());
        const std::string wrong = firstDifference(image, canvases.several.paint(turned), "with vertices rotated");
        if (!wrong.empty()) return wrong;
    }
    return {};
}

std::string checkWinding(const Soup& soup, const Canvases& canvases) {
    Soup turned = soup;
    for (Triangle& triangle : turned) std::swap(triangle[1], triangle[2]);
    return firstDifference(canvases.several.count(soup), canvases.several.count(turned), "wound the other way");
}

// ---- Moving and scaling ----

std::string checkTranslation(const Soup& soup, const Canvases& canvases) {
    // By 3 pixels right and 2 down: soups of flat meshes stay 4 pixels inside.
    constexpr uint32_t kRight = 3, kDown = 2;
    const int bits = canvases.several.subPixelBits();
    Soup moved = soup;
    for (Triangle& triangle : moved) {
        for (Position& p : triangle) {
            for (size_t c = 0; c < 2; ++c) {
                // A promise for vertices on the grid alone.
                const float units = (p[c] + 1) * std::ldexp(32.0f, bits);
                if (p[3] != 1 || units != std::nearbyint(units)) return {};
                p[c] += static_cast<float>(c == 0 ? kRight : kDown) / 32;
            }
        }
    }
    const Counts before = canvases.several.count(soup), after = canvases.several.count(moved);
    for (uint32_t y = 0; y + kDown < kSize; ++y) {
        for (uint32_t x = 0; x + kRight < kSize; ++x) {
            const float a = before[size_t{y} * kSize + x], b = after[size_t{y + kDown} * kSize + x + kRight];
            if (a != b) {
                return pixelText(size_t{y} * kSize + x) + " is covered " + std::to_string(a) +
                       " times and, moved by whole pixels, " + std::to_string(b);
            }
        }
    }
    return {};
}

std::string checkScaling(const Soup& soup, const Canvases& canvases) {
    const Counts counts = canvases.several.count(soup);
    for (const int power : {1, -1, 17, -23, 50, -60}) {
        Soup scaled = soup;
        bool exactly = true;
        for (Triangle& triangle : scaled) {
            for (Position& p : triangle) {
                for (float& c : p) {
                    const float before = c;
                    c = std::ldexp(c, power);
                    exactly = exactly && std::isfinite(c) && std::ldexp(c, -power) == before &&
                              (c == 0 || std::abs(c) >= 0x1p-126f);
                }
            }
        }
        if (!exactly) continue;
        const std::string text = "with clip coordinates times 2^" + std::to_string(power);
        std::string wrong = firstDifference(counts, canvases.several.count(scaled), text.c_str());
        if (wrong.empty() && power == 1) {
            // Attributes follow from positions: the same numbers need the same positions, so constants stand for them.
            wrong = firstDifference(canvases.several.paint(soup, Attributes::constant),
                                    canvases.several.paint(scaled, Attributes::constant), text.c_str());
        }
        if (!wrong.empty()) return wrong;
    }
    return {};
}

// ---- Values ----

std::string checkConstant(const Soup& soup, const Canvases& canvases) {
    const Image image = canvases.several.paint(soup, Attributes::constant);
    const uint32_t none = std::bit_cast<uint32_t>(-1.0f);
    for (size_t i = 0; i < image.size(); ++i) {
        const uint32_t constant = std::bit_cast<uint32_t>(kConstant[i % 4]);
        if (image[i] == constant || image[i] == none) continue;
        char text[120];
        std::snprintf(text, sizeof text, ", component %zu, is %a of the constant %a", i % 4,
                      static_cast<double>(std::bit_cast<float>(image[i])), static_cast<double>(kConstant[i % 4]));
        return pixelText(i / 4) + text;
    }
    return {};
}

std::string checkEqual(const Soup& soup, const Canvases& canvases) {
    const Counts once = canvases.several.count(soup), equal = canvases.several.countEqual(soup);
    for (size_t i = 0; i < once.size(); ++i) {
        // Depths of 1 fail the LESS test against the clear value, and equal it.
        if (once[i] == 0 ? equal[i] == 0 : equal[i] >= 1 && equal[i] <= once[i]) continue;
        return pixelText(i) + " is covered " + std::to_string(once[i]) + " times; drawn again with EQUAL, " +
               std::to_string(equal[i]) + " pass";
    }
    return {};
}

// ---- NaN and infinities ----

std::string checkPoison(const Soup& soup, const Canvases& canvases) {
    const Image image = canvases.several.paint(soup);
    std::string wrong = firstDifference(image, canvases.one.paint(soup), "with one thread");
    if (!wrong.empty()) return wrong;
    // A NaN takes its own triangle away and leaves the others alone.
    Soup numbers = soup;
    std::erase_if(numbers, [](const Triangle& triangle) {
        return std::ranges::any_of(
            triangle, [](const Position& p) { return std::ranges::any_of(p, [](float c) { return std::isnan(c); }); });
    });
    return firstDifference(canvases.several.count(soup), canvases.several.count(numbers),
                           "without triangles that have a NaN");
}

constexpr Make kMeshes[] = {&triangulation, &fan, &slivers, &offGrid};
constexpr Make kGridMeshes[] = {&triangulation, &fan, &slivers};
constexpr Make kSheets[] = {&clippedSheet};
constexpr Make kHeaps[] = {&heap, &clippedSheet, &degenerate, &offGrid};
constexpr Make kPoisoned[] = {&poisoned};

constexpr Property kProperties[] = {
    {"Partition", "flat meshes cover every sample by the triangles that exact integers say", checkPartition, kMeshes},
    {"Clipped", "a sheet through near and eye plane covers what exact homogeneous edges say", checkClipped, kSheets},
    {"Order", "images do not depend on threads, nor on how draws are cut", checkOrder, kHeaps},
    {"Rotation", "the order of a triangle's vertices changes no bit", checkRotation, kHeaps},
    {"Winding", "front and back cover the same", checkWinding, kHeaps},
    {"Translation", "meshes on the grid moved by whole pixels cover the same", checkTranslation, kGridMeshes},
    {"Scaling", "clip coordinates times a power of two cover the same", checkScaling, kHeaps},
    {"Constant", "a constant attribute stays that constant", checkConstant, kHeaps},
    {"Equal", "what is drawn twice has equal depths", checkEqual, kHeaps},
    {"Poison", "NaN takes its own triangle away; infinities give the same image every time", checkPoison, kPoisoned},
};

}  // namespace

std::span<const Property> allProperties() {
    return kProperties;
}

}  // namespace vernier::stability
