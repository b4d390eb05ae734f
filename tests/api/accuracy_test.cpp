// The accuracy dial at the public boundary: profiles, and axes alone.
#include <vernier/vernier_accuracy.h>

#include <cmath>
#include <set>
#include <string>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

VnDevice deviceWith(VnProfile profile, const char* axes, std::string* message = nullptr) {
    VnDeviceDesc desc{};
    desc.threads = 1;
    desc.profile = profile;
    desc.axes = axes;
    desc.message = [](void* user, VnSeverity, const char* text) {
        if (user) *static_cast<std::string*>(user) = text;
    };
    desc.messageUser = message;
    VnDevice device = nullptr;
    vnCreateDevice(&desc, &device);
    return device;
}

uint32_t subPixelBits(VnDevice device) {
    VnDeviceInfo info{};
    EXPECT_EQ(vnGetDeviceInfo(device, &info), VN_SUCCESS);
    return info.subPixelBits;
}

TEST(Dial, everyAxisHasPositionsThatRiseAlongTheDial) {
    std::set<std::string> names;
    VnAxisInfo axis{};
    for (uint32_t index = 0; vnGetAxis(index, &axis) == VN_SUCCESS; ++index) {
        EXPECT_TRUE(names.insert(axis.name).second) << axis.name << " is there twice";
        EXPECT_GE(axis.positionCount, 2u) << axis.name << ": nothing to choose";
        EXPECT_LT(axis.lowestForVulkan, axis.positionCount) << axis.name;
        EXPECT_NE(std::string(axis.meaning), "") << axis.name;
        uint32_t before = 0, standard = 0;
        for (int profile = VN_PROFILE_DRAFT; profile <= VN_PROFILE_REFERENCE; ++profile) {
            uint32_t position = ~0u;
            ASSERT_EQ(vnGetAxisPosition(index, static_cast<VnProfile>(profile), &position), VN_SUCCESS);
            ASSERT_LT(position, axis.positionCount) << axis.name;
            EXPECT_GE(position, before) << axis.name << ": profile " << profile << " is less exact than the one before";
            before = position;
            if (profile == VN_PROFILE_STANDARD) standard = position;
        }
        EXPECT_GE(standard, axis.lowestForVulkan) << axis.name << ": standard is below what Vulkan asks for";
        uint32_t byDefault = ~0u;
        ASSERT_EQ(vnGetAxisPosition(index, VN_PROFILE_DEFAULT, &byDefault), VN_SUCCESS);
        EXPECT_EQ(byDefault, standard) << axis.name;
    }
    EXPECT_TRUE(names.contains("subpixel"));
    EXPECT_EQ(vnGetAxis(0, nullptr), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vnGetAxisPosition(0, static_cast<VnProfile>(6), nullptr), VN_ERROR_INVALID_ARGUMENT);
}

TEST(Dial, everyPositionOfEveryAxisMakesADevice) {
    VnAxisInfo axis{};
    for (uint32_t index = 0; vnGetAxis(index, &axis) == VN_SUCCESS; ++index) {
        for (uint32_t position = 0; position < axis.positionCount; ++position) {
            const std::string text = std::string(axis.name) + "=" + axis.positions[position];
            const VnDevice device = deviceWith(VN_PROFILE_STANDARD, text.c_str());
            EXPECT_NE(device, nullptr) << text;
            vnDestroyDevice(device);
        }
    }
}

TEST(Dial, axesChangeTheProfile) {
    for (const char* axes : {"subpixel=12 math=fine", " math=fine,subpixel=12 ", "subpixel=4 subpixel=12"}) {
        const VnDevice device = deviceWith(VN_PROFILE_DRAFT, axes);
        ASSERT_NE(device, nullptr) << axes;
        EXPECT_EQ(subPixelBits(device), 12u) << axes;
        vnDestroyDevice(device);
    }
}

TEST(Dial, whatIsUnknownIsNamed) {
    const std::pair<const char*, const char*> wrong[] = {{"depth=12", "depth"},
                                                         {"subpixel=5", "4, 8, 12, 16"},
                                                         {"subpixel", "axis=position"},
                                                         {"subpixel=8 math=perfect", "perfect"},
                                                         {"=8", "no axis"}};
    for (const auto& [axes, named] : wrong) {
        std::string message;
        EXPECT_EQ(deviceWith(VN_PROFILE_DEFAULT, axes, &message), nullptr) << axes;
        EXPECT_NE(message.find(named), std::string::npos) << axes << " gave: " << message;
    }
}

using ProgramAccuracy = ApiTest;

TEST_F(ProgramAccuracy, aProgramChangesTheAxesOfItsDevice) {
    VnProgramDesc desc{};
    desc.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, "#version 450\nvoid main() { gl_Position = vec4(0); }");
    desc.axes = "math=fine subpixel=16";
    VnProgram made{};
    EXPECT_EQ(vnCreateProgram(device_, &desc, &made), VN_SUCCESS) << lastError();
    desc.axes = "math=perfect";
    EXPECT_EQ(vnCreateProgram(device_, &desc, &made), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(lastError().find("perfect"), std::string::npos) << lastError();
}

/// A renderer on paper: what each profile takes and shows; time passes only while it draws.
struct PaperRenderer {
    double milliseconds[6] = {0, 1, 2, 4, 8, 16};
    double shown[6] = {0, 0.5, 0.9, 0.99, 0.999, 1.0};
    double now = 0;
    VnProfile last = VN_PROFILE_DEFAULT;
    int draws = 0;
    VnProfile failing = VN_PROFILE_DEFAULT;
};

VnBudgetDesc budgetOf(PaperRenderer& renderer) {
    VnBudgetDesc desc{};
    desc.user = &renderer;
    desc.draw = [](void* user, VnProfile profile) {
        auto& paper = *static_cast<PaperRenderer*>(user);
        // Every third frame is late: the median does not mind.
        paper.now += paper.milliseconds[profile] * (++paper.draws % 3 == 0 ? 10 : 1);
        paper.last = profile;
        return profile == paper.failing ? VN_ERROR_DEVICE_LOST : VN_SUCCESS;
    };
    desc.read = [](void* user, double* values, size_t count) {
        const auto& paper = *static_cast<PaperRenderer*>(user);
        for (size_t i = 0; i < count; ++i) values[i] = i == 1 ? paper.shown[paper.last] : 0;
        return VN_SUCCESS;
    };
    desc.valueCount = 3;
    desc.clock = [](void* user) { return static_cast<PaperRenderer*>(user)->now; };
    return desc;
}

TEST(Budget, MostExactWithinTime) {
    PaperRenderer renderer;
    VnBudgetDesc desc = budgetOf(renderer);
    VnBudgetResult result{};
    const std::pair<double, VnProfile> expected[] = {
        {100, VN_PROFILE_REFERENCE}, {16, VN_PROFILE_REFERENCE}, {15, VN_PROFILE_FINE}, {4, VN_PROFILE_STANDARD}};
    for (const auto& [milliseconds, profile] : expected) {
        desc.maxMilliseconds = milliseconds;
        ASSERT_EQ(vnChooseProfile(&desc, &result), VN_SUCCESS) << milliseconds;
        EXPECT_EQ(result.profile, profile) << milliseconds;
        EXPECT_EQ(result.milliseconds, renderer.milliseconds[profile]);
    }
}

TEST(Budget, BelowVulkanOnlyWhenAskedFor) {
    PaperRenderer renderer;
    VnBudgetDesc desc = budgetOf(renderer);
    desc.maxMilliseconds = 2;
    VnBudgetResult result{};
    EXPECT_EQ(vnChooseProfile(&desc, &result), VN_ERROR_UNSUPPORTED);
    EXPECT_EQ(result.profile, VN_PROFILE_STANDARD) << "the fastest that Vulkan allows";
    desc.belowVulkan = 1;
    EXPECT_EQ(vnChooseProfile(&desc, &result), VN_SUCCESS);
    EXPECT_EQ(result.profile, VN_PROFILE_FAST);
}

TEST(Budget, FastestWithinError) {
    PaperRenderer renderer;
    VnBudgetDesc desc = budgetOf(renderer);
    desc.belowVulkan = 1;
    VnBudgetResult result{};
    const std::pair<double, VnProfile> expected[] = {
        {0.6, VN_PROFILE_DRAFT}, {0.2, VN_PROFILE_FAST}, {0.005, VN_PROFILE_FINE}, {1e-9, VN_PROFILE_REFERENCE}};
    for (const auto& [error, profile] : expected) {
        desc.maxError = error;
        ASSERT_EQ(vnChooseProfile(&desc, &result), VN_SUCCESS) << error;
        EXPECT_EQ(result.profile, profile) << error;
        EXPECT_DOUBLE_EQ(result.error, 1.0 - renderer.shown[profile]);
    }
}

TEST(Budget, BothBoundsHold) {
    PaperRenderer renderer;
    VnBudgetDesc desc = budgetOf(renderer);
    desc.maxMilliseconds = 9;
    desc.maxError = 0.0001;
    VnBudgetResult result{};
    EXPECT_EQ(vnChooseProfile(&desc, &result), VN_ERROR_UNSUPPORTED);
    EXPECT_EQ(result.profile, VN_PROFILE_STANDARD) << "the fastest that Vulkan allows";
    desc.maxMilliseconds = 20;
    EXPECT_EQ(vnChooseProfile(&desc, &result), VN_SUCCESS);
    EXPECT_EQ(result.profile, VN_PROFILE_REFERENCE);
}

TEST(Budget, NumbersThatAreNoneAreInfinitelyWrong) {
    PaperRenderer renderer;
    renderer.shown[VN_PROFILE_STANDARD] = std::nan("");
    VnBudgetDesc desc = budgetOf(renderer);
    desc.maxError = 1e6;
    VnBudgetResult result{};
    EXPECT_EQ(vnChooseProfile(&desc, &result), VN_SUCCESS);
    EXPECT_EQ(result.profile, VN_PROFILE_FINE);
}

TEST(Budget, ErrorsOfCallbacksComeBack) {
    PaperRenderer renderer;
    renderer.failing = VN_PROFILE_FINE;
    VnBudgetDesc desc = budgetOf(renderer);
    desc.maxMilliseconds = 10;
    VnBudgetResult result{};
    EXPECT_EQ(vnChooseProfile(&desc, &result), VN_ERROR_DEVICE_LOST);
}

TEST(Budget, IncompleteDescriptionsAreRefused) {
    PaperRenderer renderer;
    VnBudgetResult result{};
    VnBudgetDesc desc = budgetOf(renderer);
    EXPECT_EQ(vnChooseProfile(&desc, &result), VN_ERROR_INVALID_ARGUMENT) << "nothing is bound";
    desc.maxError = 0.1;
    desc.valueCount = 0;
    EXPECT_EQ(vnChooseProfile(&desc, &result), VN_ERROR_INVALID_ARGUMENT) << "no values to compare";
    desc = budgetOf(renderer);
    desc.maxMilliseconds = 5;
    desc.draw = nullptr;
    EXPECT_EQ(vnChooseProfile(&desc, &result), VN_ERROR_INVALID_ARGUMENT);
    desc = budgetOf(renderer);
    desc.maxMilliseconds = 5;
    desc._end = 7;
    EXPECT_EQ(vnChooseProfile(&desc, &result), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vnChooseProfile(nullptr, &result), VN_ERROR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace vernier::test
