// A device with its messages, and short words for the tests of the public API.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vernier/vernier.h>
#include <vernier/vernier_glsl.h>

#include <string>
#include <vector>

namespace vernier::test {

inline constexpr const char* kFullScreenVertex = R"(#version 450
void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0); })";

inline constexpr const char* kWhiteFragment = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); })";

inline std::vector<uint32_t> compileGlsl(VkShaderStageFlagBits stage, const std::string& source) {
    VnGlslDesc desc{};
    desc.stage = stage;
    desc.source = source.c_str();
    VnGlslOutput* output = nullptr;
    EXPECT_EQ(vnCompileGlsl(&desc, &output), VN_GLSL_SUCCESS) << (output ? output->log : "");
    std::vector<uint32_t> words;
    if (output && output->words) words.assign(output->words, output->words + output->wordCount);
    vnFreeGlslOutput(output);
    return words;
}

class ApiTest : public testing::Test {
  protected:
    // Otherwise every shader would set the compiler up anew.
    static void SetUpTestSuite() { vnRetainGlslCompiler(); }
    static void TearDownTestSuite() { vnReleaseGlslCompiler(); }

    void SetUp() override {
        VnDeviceDesc desc{};
        desc.threads = 2;
        desc.message = [](void* user, VnSeverity, const char* text) {
            static_cast<ApiTest*>(user)->messages_.emplace_back(text);
        };
        desc.messageUser = this;
        ASSERT_EQ(vnCreateDevice(&desc, &device_), VN_SUCCESS);
        ASSERT_EQ(vnCreateContext(device_, nullptr, &context_), VN_SUCCESS);
    }
    void TearDown() override { vnDestroyDevice(device_); }

    std::string lastError() const {
        std::string text(vnGetError(device_, nullptr, 0), '\0');
        vnGetError(device_, text.data(), text.size() + 1);
        return text;
    }

    VnShader shader(VkShaderStageFlagBits stage, const std::string& source,
                    const std::vector<VnSpecialization>& specializations = {}) {
        const std::vector<uint32_t> words = compileGlsl(stage, source);
        VnShaderDesc desc{};
        desc.stage = stage;
        desc.words = words.data();
        desc.wordCount = words.size();
        desc.specializations = specializations.data();
        desc.specializationCount = static_cast<uint32_t>(specializations.size());
        VnShader result{};
        EXPECT_EQ(vnCreateShader(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }

    VnProgram program(const std::string& vertex, const std::string& fragment) {
        VnProgramDesc desc{};
        desc.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, vertex);
        if (!fragment.empty()) desc.fragment = shader(VK_SHADER_STAGE_FRAGMENT_BIT, fragment);
        VnProgram result{};
        EXPECT_EQ(vnCreateProgram(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }

    VnImage image(VkFormat format, uint32_t width, uint32_t height, uint32_t mips = 1, uint32_t samples = 1) {
        VnImageDesc desc{};
        desc.format = format;
        desc.width = width;
        desc.height = height;
        desc.mipLevels = mips;
        desc.samples = samples;
        VnImage result{};
        EXPECT_EQ(vnCreateImage(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }

    VnView view(VnImage of) {
        VnView result{};
        EXPECT_EQ(vnGetImageView(device_, of, &result), VN_SUCCESS) << lastError();
        return result;
    }

    VnBuffer buffer(const void* data, uint64_t size) {
        VnBufferDesc desc{};
        desc.size = size;
        desc.data = data;
        VnBuffer result{};
        EXPECT_EQ(vnCreateBuffer(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }

    /// A pass that clears `color` to black.
    VnPassDesc passOn(VnImage color) {
        VnPassDesc pass{};
        pass.colors[0].view = view(color);
        pass.colors[0].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        return pass;
    }

    /// One full-screen triangle with `fragment` over a cleared image; returns the RGBA8 texels.
    std::vector<uint32_t> drawFullScreen(VnImage target, uint32_t width, uint32_t height, VnProgram with) {
        VnPassDesc pass = passOn(target);
        EXPECT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnBindProgram(context_, with), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS) << lastError();
        EXPECT_EQ(vnEndPass(context_), VN_SUCCESS) << lastError();
        return read(target, width, height);
    }

    std::vector<uint32_t> read(VnImage from, uint32_t width, uint32_t height) {
        std::vector<uint32_t> pixels(size_t{width} * height);
        EXPECT_EQ(vnReadImage(context_, from, nullptr, pixels.data(), pixels.size() * 4), VN_SUCCESS) << lastError();
        return pixels;
    }

    VnDevice device_ = nullptr;
    VnContext context_ = nullptr;
    std::vector<std::string> messages_;
};

}  // namespace vernier::test
