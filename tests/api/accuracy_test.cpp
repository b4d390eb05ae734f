// The accuracy dial at the public boundary: profiles, and axes alone.
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

}  // namespace
}  // namespace vernier::test
