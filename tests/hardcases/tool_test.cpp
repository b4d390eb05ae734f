// The catalogue is in order, and tables say what the verdicts say.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "conformance/hardcases/page.h"

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
    table.columns = {{"api", "api", "Vernier", true, {8}, {Verdict{}, Verdict::allowed("a tie")}},
                     {"swiftshader",
                      "swiftshader",
                      "SwiftShader",
                      false,
                      {4},
                      {Verdict::wrong("pixel (1, 2)"), Verdict::wrong("a | hole")}}};
    const std::string markdown = tableMarkdown(table), text = tableText(table);
    EXPECT_NE(markdown.find("| swiftshader | 4 | 0 | 0 | 0 | 0 | 2 | 0 | SwiftShader |"), std::string::npos)
        << markdown;
    EXPECT_NE(markdown.find("a \\| hole"), std::string::npos);
    EXPECT_NE(markdown.find("| confirmed |"), std::string::npos) << "the claim about E10";
    EXPECT_NE(text.find("E01 swiftshader wrong: pixel (1, 2)"), std::string::npos) << text;
    RenderedImage picture{VK_FORMAT_R8G8B8A8_UNORM, {2, 2}, Bytes(16)};
    table.columns[0].pictures[0] = table.columns[1].pictures[0] = {picture};
    const std::string html = tablePage(table);
    EXPECT_NE(html.find("<a href=\"#E01-swiftshader\"><b>wrong</b></a>"), std::string::npos);
    EXPECT_NE(html.find("<b>pixel (1, 2)</b>"), std::string::npos);
    size_t pictures = 0;
    for (size_t at = html.find("<img"); at != std::string::npos; at = html.find("<img", at + 1)) ++pictures;
    EXPECT_EQ(pictures, 2u) << "the driver's that is wrong, and ours beside it";
    const auto document = nlohmann::json::parse(tableJson(table));
    EXPECT_EQ(document["cases"][1]["verdicts"]["api"]["outcome"], "allowed");
    EXPECT_EQ(document["drivers"][1]["counts"]["wrong"], 2);
}

}  // namespace
}  // namespace vernier::conformance::hardcases
