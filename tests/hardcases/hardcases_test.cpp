// Every numeric hard case on Vernier, at every position of the accuracy dial and with several numbers of threads: the
// exact answer or the one that the position declares, and the same bytes for every number of threads.
#include <gtest/gtest.h>

#include <map>

#include "conformance/drivers/api_driver.h"
#include "conformance/hardcases/reasons.h"
#include "conformance/hardcases/run.h"

namespace vernier::conformance::hardcases {
namespace {

constexpr std::pair<VnProfile, const char*> kProfiles[] = {{VN_PROFILE_DRAFT, "draft"},
                                                           {VN_PROFILE_FAST, "fast"},
                                                           {VN_PROFILE_STANDARD, "standard"},
                                                           {VN_PROFILE_FINE, "fine"},
                                                           {VN_PROFILE_REFERENCE, "reference"}};

Driver& driverOf(VnProfile profile, uint32_t threads) {
    static std::map<std::pair<VnProfile, uint32_t>, std::unique_ptr<ApiDriver>> drivers;
    auto& driver = drivers[{profile, threads}];
    if (!driver) {
        auto created = ApiDriver::create({profile, threads, nullptr});
        EXPECT_TRUE(created.ok()) << (created ? "" : created.error().message);
        driver = std::move(created).value();
    }
    return *driver;
}

std::vector<SceneOutcome> draw(Driver& driver, const CaseInput& input) {
    std::vector<SceneOutcome> outcomes;
    for (const Scene& scene : input.scenes()) outcomes.push_back(drawScene(driver, scene));
    return outcomes;
}

class HardCases : public testing::TestWithParam<const HardCase*> {};

TEST_P(HardCases, HoldOnVernier) {
    CaseInput input;
    GetParam()->build(input);
    ASSERT_TRUE(input.status().ok()) << input.status().error().message;
    ASSERT_FALSE(input.judges().empty());
    for (const auto& [profile, name] : kProfiles) {
        Driver& driver = driverOf(profile, 2);
        const std::vector<SceneOutcome> drawn = draw(driver, input);
        const Declared declared = vernierDeclares(static_cast<int>(driver.subPixelBits()), name);
        const Verdict verdict = judgeCase(input, drawn, declared);
        EXPECT_LE(verdict.outcome, Outcome::declared)
            << GetParam()->id << " at " << name << ": " << outcomeName(verdict.outcome) << ": " << verdict.witness;
        if (profile != VN_PROFILE_STANDARD) continue;
        EXPECT_EQ(whyDeclared(GetParam()->id) != nullptr, verdict.outcome == Outcome::declared)
            << GetParam()->id << " is " << outcomeName(verdict.outcome)
            << "; declaredReasons() is to have those that are declared, and no others: " << verdict.witness;
        for (const uint32_t threads : {1u, 5u}) {
            const std::vector<SceneOutcome> again = draw(driverOf(profile, threads), input);
            for (size_t i = 0; i < drawn.size(); ++i) {
                ASSERT_EQ(again[i].images.size(), drawn[i].images.size());
                for (size_t k = 0; k < drawn[i].images.size(); ++k) {
                    EXPECT_TRUE(again[i].images[k].texels == drawn[i].images[k].texels)
                        << GetParam()->id << ", scene " << i << ": " << threads << " threads change the image";
                }
            }
        }
    }
}

std::vector<const HardCase*> reachableCases() {
    std::vector<const HardCase*> cases;
    for (const CaseGroup& group : caseGroups()) {
        for (const HardCase& each : group.cases) {
            if (each.build != nullptr) cases.push_back(&each);
        }
    }
    return cases;
}

INSTANTIATE_TEST_SUITE_P(All, HardCases, testing::ValuesIn(reachableCases()),
                         [](const auto& test) { return std::string(test.param->id); });

}  // namespace
}  // namespace vernier::conformance::hardcases
