// The catalogue is in order, and tables say what the verdicts say.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "conformance/hardcases/table.h"

namespace vernier::conformance::hardcases {
namespace {

TEST(Catalogue, EveryCaseHasItsPlaceAndItsRule) {
    std::set<std::string_view> ids;
    for (const CaseGroup& group : caseGroups()) {
        for (const HardCase& each : group.cases) {
            EXPECT_TRUE(ids.insert(each.id).second) << each.id << " appears twice";
            EXPECT_EQ(each.group(), group.letter) << each.id;
            EXPECT_FALSE(each.title.empty() || each.rule.empty() || each.source.empty()) << each.id;
            EXPECT_NE(each.build == nullptr, each.unreachable.empty()) << each.id << " is run, or says why not";
            EXPECT_EQ(findCase(each.id), &each);
        }
    }
    EXPECT_EQ(findCase("Z99"), nullptr);
}

TEST(Table, SaysWhatTheVerdictsSay) {
    Table table;
    table.rows = {findCase("E01"), findCase("E10")};
    table.columns = {{"api", "api", "Vernier", true, {8, 0}, {Verdict{}, Verdict::allowed("a tie")}},
                     {"swiftshader",
                      "swiftshader",
                      "SwiftShader",
                      false,
                      {4, 0},
                      {Verdict::wrong("pixel (1, 2)"), Verdict::wrong("a | hole")}}};
    const std::string markdown = tableMarkdown(table), text = tableText(table);
    EXPECT_NE(markdown.find("| swiftshader | 4 | 0 | 0 | 0 | 2 | 0 | SwiftShader |"), std::string::npos) << markdown;
    EXPECT_NE(markdown.find("a \\| hole"), std::string::npos);
    EXPECT_NE(markdown.find("| confirmed |"), std::string::npos) << "the claim about E10";
    EXPECT_NE(text.find("E01 swiftshader wrong: pixel (1, 2)"), std::string::npos) << text;
    const auto document = nlohmann::json::parse(tableJson(table));
    EXPECT_EQ(document["cases"][1]["verdicts"]["api"]["outcome"], "allowed");
    EXPECT_EQ(document["drivers"][1]["counts"]["wrong"], 2);
}

}  // namespace
}  // namespace vernier::conformance::hardcases
