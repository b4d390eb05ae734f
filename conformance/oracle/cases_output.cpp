// Depth equality and exact storage: D03, B01, B02, B03, B04.
#include "conformance/oracle/case_list.h"
#include "conformance/oracle/case_support.h"
#include "conformance/oracle/encode.h"

#include "conformance/scenes/recorder.h"

#include <algorithm>
#include <array>
#include <string>

namespace vernier::conformance::cases {

namespace {

constexpr VkExtent2D kTarget{64, 64};

const char* const kCoverVertex = R"(#version 450
void main() {
    gl_Position = vec4(float((gl_VertexIndex & 1) * 4 - 1), float((gl_VertexIndex >> 1) * 4 - 1), 0.0, 1.0);
}
)";

Result<std::vector<Scene>> one(Result<Scene> scene) {
    if (!scene) return scene.error();
    return std::vector<Scene>{std::move(*scene)};
}

// Steep triangles with all kinds of depths and w, far beyond the target and across the near plane.
std::vector<ClipPosition> depthTriangles() {
    const Tiling tiling = jitteredTiling(6, 10.5, 4, 0x1p12, 3);
    std::vector<ClipPosition> result;
    for (const auto& t : tiling.triangles) {
        for (const size_t i : t) {
            const float w = 0.5f + static_cast<float>(i * 7 % 11) * 0.3f;
            const float z = static_cast<float>(i * 5 % 13) / 13.0f * 0.99f + 0.003f;
            result.push_back({(static_cast<float>(tiling.points[i][0]) / 32 - 1) * w,
                              (static_cast<float>(tiling.points[i][1]) / 32 - 1) * w, z * w, w});
        }
    }
    result.push_back({-9, -7, -2, 1.5f});
    result.push_back({11, -3, 4, 5});
    result.push_back({0.5f, 12, 3, 6});
    return result;
}

const char* const kPositionVertex = R"(#version 450
layout(location = 0) in vec4 position;
void main() { gl_Position = position; }
)";
const char* const kFirstFragment = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0, 0.0, 0.0, 1.0); }
)";
const char* const kSecondFragment = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(0.0, 1.0, 0.0, 1.0); }
)";

constexpr std::array<VkFormat, 2> kDepthFormats{VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM};

}  // namespace

Result<std::vector<Scene>> buildD03() {
    std::vector<Scene> scenes;
    for (const VkFormat format : kDepthFormats) {
        SceneRecorder record("D03", "Drawn twice, the second time with an EQUAL depth test.");
        const uint32_t color = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
        const uint32_t depth = record.depthTarget("depth", format, kTarget);
        const std::vector<ClipPosition> data = depthTriangles();
        const uint32_t vertices = record.vertexBuffer("vertices", data);
        const uint32_t vertex = record.vertex(kPositionVertex);
        const auto pipeline = [&](const char* fragment) {
            return record.pipeline(vertex, record.fragment(fragment))
                .binding(sizeof(ClipPosition))
                .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0);
        };
        const uint32_t first = pipeline(kFirstFragment).depth(VK_COMPARE_OP_LESS);
        const uint32_t second = pipeline(kSecondFragment).depth(VK_COMPARE_OP_EQUAL);
        record.pass(kTarget).color(color, {0, 0, 0, 1}).depthStencil(depth);
        record.draw(first, static_cast<uint32_t>(data.size())).vertices(vertices);
        record.draw(second, static_cast<uint32_t>(data.size())).vertices(vertices);
        record.output(color);
        auto scene = record.finish();
        if (!scene) return scene.error();
        scenes.push_back(std::move(*scene));
    }
    return scenes;
}

Status checkD03(const CaseImages& images, Strictness) {
    if (Status s = checkShape(images, kDepthFormats.size(), 1, kTarget); !s) return s;
    for (size_t i = 0; i < images.size(); ++i) {
        const Bytes& texels = images[i][0].texels;
        size_t passed = 0;
        for (uint32_t pixel = 0; pixel < kTarget.width * kTarget.height; ++pixel) {
            passed += texels[pixel * 4 + 1] == std::byte{255};
            if (texels[pixel * 4] == std::byte{0}) continue;
            return verdict("D03", pixelText(pixel % kTarget.width, pixel / kTarget.width) +
                                      ": the second draw of the same triangles failed EQUAL against the first in " +
                                      (i == 0 ? "D32_SFLOAT" : "D16_UNORM"));
        }
        if (passed < 2000) return verdict("D03", "only " + std::to_string(passed) + " pixels are covered");
    }
    return {};
}

namespace {

// One scene clears to the value, the other writes it from a shader.
Result<std::vector<Scene>> storeScenes(std::string_view name, const std::string& glslValue, float value) {
    std::vector<Scene> scenes;
    for (const bool drawn : {false, true}) {
        SceneRecorder record(name, drawn ? "Written by a fragment shader." : "Cleared.");
        const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
        const float background = drawn ? 1.0f : value;
        record.pass(kTarget).color(target, {background, background, background, background});
        if (drawn) {
            const std::string glsl = "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(" +
                                     glslValue + "); }\n";
            record.draw(record.pipeline(record.vertex(kCoverVertex), record.fragment(glsl)), 3);
        }
        record.output(target);
        auto scene = record.finish();
        if (!scene) return scene.error();
        scenes.push_back(std::move(*scene));
    }
    return scenes;
}

Status checkStored(std::string_view name, const CaseImages& images, Strictness strictness, float value) {
    if (Status s = checkShape(images, 2, 1, kTarget); !s) return s;
    const exact::CodeSet codes = exact::encode({0, 0, 8, exact::Encoding::unorm}, exact::rational(value));
    const auto first = std::to_integer<uint64_t>(images[0][0].texels[0]);
    for (const auto& list : images) {
        const Bytes& texels = list[0].texels;
        for (uint32_t i = 0; i < texels.size(); ++i) {
            const auto code = std::to_integer<uint64_t>(texels[i]);
            const bool right = strictness == Strictness::declared ? code == codes.nearest : codes.permits(code);
            if (right && code == first) continue;
            return verdict(name, pixelText(i / 4 % kTarget.width, i / 4 / kTarget.width) + " channel " + "RGBA"[i % 4] +
                                     " has code " + std::to_string(code) + ", permitted " +
                                     std::to_string(codes.below) + " or " + std::to_string(codes.above) + ", nearest " +
                                     std::to_string(codes.nearest) + ", and elsewhere " + std::to_string(first));
        }
    }
    return {};
}

}  // namespace

Result<std::vector<Scene>> buildB01() {
    return storeScenes("B01", "0.25", 0.25f);
}
Status checkB01(const CaseImages& images, Strictness strictness) {
    return checkStored("B01", images, strictness, 0.25f);
}

Result<std::vector<Scene>> buildB02() {
    return storeScenes("B02", "0.5", 0.5f);
}
Status checkB02(const CaseImages& images, Strictness strictness) {
    return checkStored("B02", images, strictness, 0.5f);
}

namespace {

constexpr VkExtent2D kCodes{1024, 1};

const char* const kCopyFragment = R"(#version 450
layout(binding = 0) uniform sampler2D codes;
layout(location = 0) out vec4 color;
void main() { color = texelFetch(codes, ivec2(gl_FragCoord.xy), 0); }
)";

// Texel i holds code i in every channel, modulo the channel's range and different from channel to channel.
Bytes allCodes(const exact::PixelFormat& format) {
    Bytes bytes(size_t{kCodes.width} * format.bytes);
    for (uint32_t i = 0; i < kCodes.width; ++i) {
        for (const exact::Component& c : format.all()) {
            exact::insertBits(bytes.data() + size_t{i} * format.bytes, c.offset, c.bits,
                              (i + c.channel * 37u) & ((1u << c.bits) - 1));
        }
    }
    return bytes;
}

Result<Scene> identityScene(std::string_view name, VkFormat format) {
    SceneRecorder record(name, "Every code fetched from a texture and written to a target of the same format.");
    const uint32_t texture = record.texture("codes", format, kCodes, {allCodes(*exact::findPixelFormat(format))});
    const uint32_t target = record.colorTarget("copy", format, kCodes);
    const uint32_t sampler = record.sampler(VK_FILTER_NEAREST);
    record.pass(kCodes).color(target, {0, 0, 0, 0});
    record.draw(record.pipeline(record.vertex(kCoverVertex), record.fragment(kCopyFragment)), 3)
        .texture(0, texture, sampler);
    record.output(target);
    return record.finish();
}

Status checkIdentity(std::string_view name, const RenderedImage& image) {
    const exact::PixelFormat& format = *exact::findPixelFormat(image.format);
    const Bytes expected = allCodes(format);
    for (uint32_t x = 0; x < kCodes.width; ++x) {
        for (const exact::Component& c : format.all()) {
            const uint64_t written = exact::extractBits(expected.data() + size_t{x} * format.bytes, c.offset, c.bits);
            const uint64_t read = codeAt(image, format, x, 0, c.channel);
            if (read == written) continue;
            return verdict(name, "format " + std::to_string(image.format) + ", channel " + "RGBA"[c.channel] +
                                     ": code " + std::to_string(written) + " came back as " + std::to_string(read) +
                                     "; a value that is exactly a code maps to that code");
        }
    }
    return {};
}

// Formats that every Vulkan implementation samples and renders to.
constexpr std::array<VkFormat, 4> kUnormFormats{VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM,
                                                VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_R5G6B5_UNORM_PACK16};

}  // namespace

Result<std::vector<Scene>> buildB03() {
    std::vector<Scene> scenes;
    for (const VkFormat format : kUnormFormats) {
        auto scene = identityScene("B03", format);
        if (!scene) return scene.error();
        scenes.push_back(std::move(*scene));
    }
    return scenes;
}

Status checkB03(const CaseImages& images, Strictness) {
    if (Status s = checkShape(images, kUnormFormats.size(), 1, kCodes); !s) return s;
    for (const auto& list : images) {
        if (Status s = checkIdentity("B03", list[0]); !s) return s;
    }
    return {};
}

Result<std::vector<Scene>> buildB04() {
    return one(identityScene("B04", VK_FORMAT_R8G8B8A8_SRGB));
}

Status checkB04(const CaseImages& images, Strictness) {
    if (Status s = checkShape(images, 1, 1, kCodes); !s) return s;
    return checkIdentity("B04", images[0][0]);
}

}  // namespace vernier::conformance::cases
