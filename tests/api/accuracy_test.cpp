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
    for (const char* name : {"subpixel", "interpolation", "math", "anisotropy", "shading"})
        EXPECT_TRUE(names.contains(name)) << name;
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

class ProgramAccuracy : public ApiTest {
  protected:
    static constexpr uint32_t kSize = 64;

    /// A floor of stripes to the horizon, through a sampler of so much anisotropy, by a program with `axes`.
    std::vector<uint32_t> floorThrough(float anisotropy, const char* axes) {
        constexpr uint32_t kTexels = 64;
        const VnImage stripes = image(VK_FORMAT_R8G8B8A8_UNORM, kTexels, kTexels, VN_ALL_MIPS);
        std::vector<uint32_t> texels(size_t{kTexels} * kTexels);
        for (uint32_t i = 0; i < texels.size(); ++i) texels[i] = i % kTexels / 4 % 2 ? 0xFFFFFFFFu : 0xFF203040u;
        EXPECT_EQ(vnUpdateImage(context_, stripes, nullptr, texels.data(), texels.size() * 4), VN_SUCCESS)
            << lastError();
        EXPECT_EQ(vnGenerateMips(context_, stripes), VN_SUCCESS) << lastError();
        VnSamplerDesc samplerDesc{};
        samplerDesc.magFilter = samplerDesc.minFilter = VK_FILTER_LINEAR;
        samplerDesc.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
        samplerDesc.maxAnisotropy = anisotropy;
        VnSampler sampler{};
        EXPECT_EQ(vnCreateSampler(device_, &samplerDesc, &sampler), VN_SUCCESS) << lastError();
        const VnProgram floor = programWith(R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    float w = corner.y < 0.5 ? 24.0 : 1.0;
    uv = corner * w * 2.0;
    gl_Position = vec4((corner * 2.0 - 1.0) * w, 0.5 * w, w);
})",
                                            R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(image, uv); })",
                                            axes);
        const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize);
        const VnPassDesc pass = passOn(target);
        EXPECT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnBindProgram(context_, floor), VN_SUCCESS);
        EXPECT_EQ(vnBindTexture(context_, 0, 0, 0, view(stripes), sampler), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnSetTopology(context_, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, 0), VN_SUCCESS);
        EXPECT_EQ(vnDraw(context_, 4, 1, 0, 0), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnEndPass(context_), VN_SUCCESS);
        return read(target, kSize, kSize);
    }

    VnProgram programWith(const char* vertex, const char* fragment, const char* axes) {
        VnProgramDesc desc{};
        desc.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, vertex);
        desc.fragment = shader(VK_SHADER_STAGE_FRAGMENT_BIT, fragment);
        desc.axes = axes;
        VnProgram made{};
        EXPECT_EQ(vnCreateProgram(device_, &desc, &made), VN_SUCCESS) << lastError();
        return made;
    }
};

TEST_F(ProgramAccuracy, AnisotropyIsTheSamplersOrLess) {
    const std::vector<uint32_t> full = floorThrough(16, nullptr), two = floorThrough(2, nullptr);
    EXPECT_NE(full, two);
    EXPECT_EQ(floorThrough(16, "anisotropy=2"), two) << "as a sampler of 2 at most";
    EXPECT_EQ(floorThrough(16, "anisotropy=1"), floorThrough(0, nullptr)) << "as one without";
    EXPECT_EQ(floorThrough(2, "anisotropy=8"), two) << "never more than the sampler asks for";
}

TEST_F(ProgramAccuracy, FragmentsOfFourPixelsWhereAProgramAsks) {
    const auto invocations = [&](const char* axes) {
        const VnProgram made = programWith(kFullScreenVertex, R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = gl_FragCoord / 64.0; })",
                                           axes);
        const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, kSize, kSize);
        const VnPassDesc pass = passOn(target);
        EXPECT_EQ(vnResetStatistics(context_), VN_SUCCESS);
        EXPECT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnBindProgram(context_, made), VN_SUCCESS);
        EXPECT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnEndPass(context_), VN_SUCCESS);
        VnStatistics statistics{};
        EXPECT_EQ(vnGetStatistics(context_, &statistics), VN_SUCCESS);
        return statistics.fragmentInvocations;
    };
    EXPECT_EQ(invocations(nullptr), uint64_t{kSize} * kSize);
    EXPECT_EQ(invocations("shading=2x2"), uint64_t{kSize} * kSize / 4);
}

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
