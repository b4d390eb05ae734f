// The numeric hard cases on Vernier, to its own declared promise, and on lavapipe for the record: what lavapipe gets
// wrong is printed and decides nothing.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "conformance/drivers/api_driver.h"
#include "conformance/drivers/vulkan_driver.h"
#include "conformance/oracle/cases.h"

namespace vernier::conformance {
namespace {

constexpr const char* kLavapipe = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json";

Status runCase(const NumericCase& numericCase, Driver& driver, Strictness strictness) {
    Result<std::vector<Scene>> scenes = numericCase.build();
    if (!scenes) return scenes.error();
    CaseImages images;
    for (const Scene& scene : *scenes) {
        Result<std::vector<RenderedImage>> rendered = driver.render(scene, nullptr);
        if (!rendered) return rendered.error();
        images.push_back(std::move(rendered).value());
    }
    return numericCase.check(images, strictness);
}

class NumericCases : public testing::TestWithParam<std::string_view> {};

TEST_P(NumericCases, HoldOnVernierAsDeclared) {
    auto driver = ApiDriver::create({});
    ASSERT_TRUE(driver.ok());
    const Status status = runCase(*findNumericCase(GetParam()), *driver.value(), Strictness::declared);
    EXPECT_TRUE(status.ok()) << (status ? "" : status.error().message);
}

std::vector<std::string_view> caseNames() {
    std::vector<std::string_view> names;
    for (const NumericCase& numericCase : numericCases()) names.push_back(numericCase.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(All, NumericCases, testing::ValuesIn(caseNames()), [](const auto& test) {
    std::string name;
    for (const char c : test.param) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return name;
});

TEST(NumericCasesRecord, OfLavapipe) {
    if (!std::filesystem::exists(kLavapipe)) GTEST_SKIP() << "lavapipe is not here";
    ::setenv("VK_DRIVER_FILES", kLavapipe, 1);
    ::setenv("VK_ICD_FILENAMES", kLavapipe, 1);
    auto driver = VulkanDriver::create({});
    ASSERT_TRUE(driver.ok()) << driver.error().message;
    for (const NumericCase& numericCase : numericCases()) {
        const Status status = runCase(numericCase, *driver.value(), Strictness::legal);
        std::printf("lavapipe %-6s %s\n", std::string(numericCase.name).c_str(),
                    status ? "within the specification" : status.error().message.c_str());
    }
}

}  // namespace
}  // namespace vernier::conformance
