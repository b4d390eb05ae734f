// What the driver tells of pipelines: VK_KHR_pipeline_executable_properties and VERNIER_EXPLAIN.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

class ExecutablesTest : public ComputeTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        features_.pipelineExecutableInfo = VK_TRUE;
        return &features_;
    }
    void SetUp() override {
        log_ = std::filesystem::temp_directory_path() / ("vernier_explain_" + std::to_string(::getpid()) + ".json");
        std::filesystem::remove(log_);
        setenv("VERNIER_EXPLAIN", log_.c_str(), 1);
        ComputeTest::SetUp();
        unsetenv("VERNIER_EXPLAIN");
    }
    void TearDown() override {
        ComputeTest::TearDown();
        std::filesystem::remove(log_);
    }
    template <class Function>
    Function command(const char* name) {
        const auto found = reinterpret_cast<Function>(vkGetDeviceProcAddr(device, name));
        EXPECT_NE(found, nullptr) << name;
        return found;
    }
    VkPipeline graphics(const char* fragment = nullptr) {
        const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {8, 8}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        PipelineDesc desc;
        desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, "#version 450\nvoid main() { gl_Position = vec4(0); }");
        desc.fragment = fragment ? makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, fragment) : constantColor("1, 1, 1, 1");
        desc.extent = {8, 8};
        desc.flags =
            VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR | VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
        return makePipeline(makePass(color).pass, desc);
    }
    std::vector<VkPipelineExecutablePropertiesKHR> executables(VkPipeline pipeline) {
        const auto get = command<PFN_vkGetPipelineExecutablePropertiesKHR>("vkGetPipelineExecutablePropertiesKHR");
        auto info = make<VkPipelineInfoKHR>(VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR);
        info.pipeline = pipeline;
        uint32_t count = 0;
        EXPECT_EQ(get(device, &info, &count, nullptr), VK_SUCCESS);
        std::vector<VkPipelineExecutablePropertiesKHR> all(
            count, make<VkPipelineExecutablePropertiesKHR>(VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR));
        EXPECT_EQ(get(device, &info, &count, all.data()), VK_SUCCESS);
        count = 0;
        EXPECT_EQ(get(device, &info, &count, all.data()), VK_INCOMPLETE);
        return all;
    }
    VkPipelineExecutableInfoKHR executable(VkPipeline pipeline, uint32_t index) {
        auto info = make<VkPipelineExecutableInfoKHR>(VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR);
        info.pipeline = pipeline;
        info.executableIndex = index;
        return info;
    }
    std::map<std::string, uint64_t> statistics(VkPipeline pipeline, uint32_t index) {
        const auto get = command<PFN_vkGetPipelineExecutableStatisticsKHR>("vkGetPipelineExecutableStatisticsKHR");
        const auto info = executable(pipeline, index);
        uint32_t count = 0;
        EXPECT_EQ(get(device, &info, &count, nullptr), VK_SUCCESS);
        std::vector<VkPipelineExecutableStatisticKHR> all(
            count, make<VkPipelineExecutableStatisticKHR>(VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR));
        EXPECT_EQ(get(device, &info, &count, all.data()), VK_SUCCESS);
        std::map<std::string, uint64_t> byName;
        for (const auto& each : all) byName[each.name] = each.value.u64;
        EXPECT_EQ(byName.size(), all.size()) << "names are unique";
        return byName;
    }

    std::filesystem::path log_;
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR features_ =
        make<VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR);
};

TEST_F(ExecutablesTest, stagesAreListed) {
    const auto drawn = executables(graphics());
    ASSERT_EQ(drawn.size(), 2u);
    EXPECT_EQ(drawn[0].stages, VkShaderStageFlags{VK_SHADER_STAGE_VERTEX_BIT});
    EXPECT_STREQ(drawn[1].name, "fragment");
    EXPECT_EQ(drawn[1].subgroupSize, 32u);
}

TEST_F(ExecutablesTest, statisticsTellWhatRunsHowOften) {
    const TestBuffer buffer = makeStorage(4);
    const Compute more = makeCompute(
        "#version 450\nlayout(binding = 0) buffer B { float v[]; };\n"
        "void main() { v[gl_GlobalInvocationID.x] = sqrt(v[gl_GlobalInvocationID.x] * 3.0 + 1.0); }",
        {storageBuffer(buffer)}, 0, nullptr, VK_SUCCESS, VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR);
    const auto figures = statistics(more.pipeline, 0);
    EXPECT_GT(figures.at("instructions"), 0u);
    EXPECT_GT(figures.at("registers"), 0u);
    EXPECT_EQ(figures.at("lanes") % 16, 0u);
    EXPECT_GT(figures.at("cost, invocation"), 0u);
    EXPECT_GE(figures.at("operations, invocation"), 4u) << "a load, two operations, a root, a store";
}

TEST_F(ExecutablesTest, colorsWithoutAnAttachmentCostNothing) {
    const auto instructions = [&](const char* more) {
        const std::string fragment = std::string(
                                         "#version 450\nlayout(location = 0) out vec4 color;\n"
                                         "layout(location = 1) out vec4 other;\n"
                                         "void main() { color = gl_FragCoord;") +
                                     more + "}";
        return statistics(graphics(fragment.c_str()), 1).at("instructions");
    };
    EXPECT_EQ(instructions(" other = sin(gl_FragCoord) * gl_FragCoord;"), instructions(""));
}

TEST_F(ExecutablesTest, representationsAreText) {
    const VkPipeline pipeline = graphics();
    const auto get = command<PFN_vkGetPipelineExecutableInternalRepresentationsKHR>(
        "vkGetPipelineExecutableInternalRepresentationsKHR");
    const auto info = executable(pipeline, 0);
    uint32_t count = 0;
    ASSERT_EQ(get(device, &info, &count, nullptr), VK_SUCCESS);
    std::vector<VkPipelineExecutableInternalRepresentationKHR> all(
        count, make<VkPipelineExecutableInternalRepresentationKHR>(
                   VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR));
    ASSERT_EQ(get(device, &info, &count, all.data()), VK_SUCCESS);
    std::vector<std::string> texts;
    for (auto& each : all) {
        EXPECT_EQ(each.isText, VK_TRUE);
        texts.emplace_back(each.dataSize, '?');
    }
    for (size_t i = 0; i < all.size(); ++i) all[i].pData = texts[i].data();
    ASSERT_EQ(get(device, &info, &count, all.data()), VK_SUCCESS);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_STREQ(all[0].name, "plan");
    EXPECT_NE(texts[0].find("left out  depth and stencil tests: there is no depth/stencil attachment"),
              std::string::npos);
    EXPECT_EQ(texts[0].back(), '\0');
    EXPECT_NE(texts[1].find("store"), std::string::npos) << texts[1];
    char little[8] = "1234567";
    all[0].pData = little;
    all[0].dataSize = 5;
    EXPECT_EQ(get(device, &info, &count, all.data()), VK_INCOMPLETE);
    EXPECT_STREQ(little, "runs") << "cut, with its zero";
    EXPECT_EQ(little[5], '6');
}

TEST_F(ExecutablesTest, everyPipelineIsExplainedInTheFile) {
    graphics();
    const TestBuffer buffer = makeStorage(4);
    makeCompute("#version 450\nlayout(binding = 0) buffer B { float v[]; };\nvoid main() { v[0] = 1.0; }",
                {storageBuffer(buffer)});
    std::ifstream file(log_);
    std::vector<nlohmann::json> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(nlohmann::json::parse(line));
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0]["kind"], "graphics");
    EXPECT_EQ(lines[1]["kind"], "compute");
    EXPECT_EQ(lines[1]["pipeline"], 2);
    EXPECT_GT(lines[0]["facts"].size(), 5u);
}

TEST_F(ExecutablesTest, everySubmissionIsExplainedInTheFile) {
    const TestBuffer buffer = makeStorage(64);
    const Compute twice = makeCompute(
        "#version 450\nlayout(local_size_x = 16) in;\nlayout(binding = 0) buffer B { float v[]; };\n"
        "void main() { v[gl_GlobalInvocationID.x] *= 2.0; }",
        {storageBuffer(buffer)});
    run(twice, 4);
    run(twice, 2);
    std::ifstream file(log_);
    std::vector<nlohmann::json> submissions;
    for (std::string line; std::getline(file, line);)
        if (nlohmann::json entry = nlohmann::json::parse(line); entry.contains("submission"))
            submissions.push_back(std::move(entry));
    ASSERT_EQ(submissions.size(), 2u);
    const auto invocations = [](const nlohmann::json& submission) {
        for (const nlohmann::json& fact : submission["facts"])
            if (fact["what"].get<std::string>().starts_with("compute programs")) return fact["count"].get<int>();
        return -1;
    };
    EXPECT_EQ(submissions[1]["submission"], 2);
    EXPECT_EQ(invocations(submissions[0]), 64);
    EXPECT_EQ(invocations(submissions[1]), 32) << "of this submission alone";
}

}  // namespace
}  // namespace vernier::test
