// Every property on random soups, at every position of the accuracy dial. VERNIER_STABILITY_SEEDS is the number of
// seeds for each kind of soup. What fails is made small and printed as a literal for kept_cases.h.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <ostream>

#include "tests/stability/kept_cases.h"
#include "tests/stability/properties.h"
#include "tests/stability/shrink.h"

namespace vernier::stability {
namespace {

constexpr std::pair<VnProfile, const char*> kProfiles[] = {{VN_PROFILE_DRAFT, "Draft"},
                                                           {VN_PROFILE_FAST, "Fast"},
                                                           {VN_PROFILE_STANDARD, "Standard"},
                                                           {VN_PROFILE_FINE, "Fine"},
                                                           {VN_PROFILE_REFERENCE, "Reference"}};

uint64_t seedCount() {
    const char* text = std::getenv("VERNIER_STABILITY_SEEDS");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : 6;
}

Canvases canvasesAt(VnProfile profile) {
    struct Pair {
        Canvas one, several;
        explicit Pair(VnProfile profile) : one(profile, 1), several(profile, 3) {}
    };
    static std::map<VnProfile, std::unique_ptr<Pair>> pairs;
    std::unique_ptr<Pair>& pair = pairs[profile];
    if (!pair) pair = std::make_unique<Pair>(profile);
    return {pair->one, pair->several};
}

/// One of the table, by its name in messages.
struct Named {
    const Property* property;
    const Property* operator->() const { return property; }
};
void PrintTo(const Named& named, std::ostream* out) {
    *out << named->name;
}
std::vector<Named> named() {
    std::vector<Named> result;
    for (const Property& property : allProperties()) result.push_back({&property});
    return result;
}

using Parameter = std::tuple<Named, std::pair<VnProfile, const char*>>;
class Stability : public testing::TestWithParam<Parameter> {
  protected:
    /// Checks one soup; a failure is shrunk and told.
    void expectHolds(const Soup& soup, const std::string& where) {
        const Named property = std::get<0>(GetParam());
        const Canvases canvases = canvasesAt(std::get<1>(GetParam()).first);
        const std::string wrong = property->check(soup, canvases);
        ASSERT_EQ(canvases.one.error() + canvases.several.error(), "");
        if (wrong.empty()) return;
        const Soup small = shrink(soup, [&](const Soup& each) { return !property->check(each, canvases).empty(); });
        FAIL() << where << ": " << property->law << ", but " << wrong << "\nThe smallest soup that fails ("
               << property->check(small, canvases) << "):\n"
               << literal(small);
    }
};

TEST_P(Stability, HoldsForRandomSoups) {
    const Named property = std::get<0>(GetParam());
    for (size_t kind = 0; kind < property->soups.size(); ++kind) {
        for (uint64_t seed = 0; seed < seedCount(); ++seed) {
            expectHolds(property->soups[kind](seed), "kind " + std::to_string(kind) + ", seed " + std::to_string(seed));
            if (HasFatalFailure()) return;
        }
    }
}

TEST_P(Stability, HoldsForKeptCases) {
    const Named property = std::get<0>(GetParam());
    // Flat meshes, sheets and soups with NaN are asked for different things.
    const bool anything = property->name != "Partition" && property->name != "Clipped";
    for (const KeptCase& kept : keptCases()) {
        const bool special = kept.name == "NanInW" || kept.name == "InfiniteX";
        const bool flat = kept.name == "DiagonalBesideCentres" || kept.name == "SliverOfNoFloatArea";
        if (property->name == "Partition" ? !flat
                                          : special && !(property->name == "Poison" || property->name == "Order"))
            continue;
        if (anything || !special) expectHolds(kept.soup, std::string(kept.name));
    }
}

INSTANTIATE_TEST_SUITE_P(All, Stability, testing::Combine(testing::ValuesIn(named()), testing::ValuesIn(kProfiles)),
                         [](const auto& test) {
                             return std::string(std::get<0>(test.param)->name) + std::get<1>(test.param).second;
                         });

}  // namespace
}  // namespace vernier::stability
