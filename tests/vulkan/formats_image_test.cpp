// Every image format with every feature it has outside render passes: transfers, fetches, filters, stores, blits.
#include <cmath>

#include "tests/vulkan/formats_test.h"

namespace vernier::test {
namespace {

class FormatImages : public FormatsTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_SAMPLER_FILTER_MINMAX_EXTENSION_NAME, VK_EXT_FILTER_CUBIC_EXTENSION_NAME};
    }

    /// One colour per place, by a shader that says how.
    std::vector<VkClearColorValue> shade(const Case& of, const TestImage& image, VkSampler sampler,
                                         const std::string& expression, uint32_t count) {
        const std::string prefix = kPrefix[static_cast<size_t>(of.layout().type)];
        const TestBuffer out = makeStorage(count * 4);
        const Compute compute = computeFor(
            "#version 450\nlayout(local_size_x = 24) in;\n"
            "layout(set = 0, binding = 0) buffer Out { " +
                prefix + "vec4 colors[]; };\nlayout(set = 0, binding = 1) uniform " + prefix +
                "sampler2D image;\nvoid main() { uint i = gl_GlobalInvocationID.x;\n"
                "if (i < colors.length()) colors[i] = " +
                expression + "; }",
            {storageBuffer(out), sampledImage(image.view, sampler)});
        run(compute, (count + 23) / 24);
        std::vector<VkClearColorValue> colors(count);
        std::memcpy(colors.data(), out.data, count * sizeof colors[0]);
        return colors;
    }

    /// The middle of the four texels of the upper left corner.
    VkClearColorValue corner(const Case& of, const TestImage& image, VkSampler sampler) {
        return shade(of, image, sampler, "textureLod(image, vec2(1.0 / 24.0), 0.0)", 1)[0];
    }
    static std::array<VkClearColorValue, 4> cornerTexels(const Case& of, const std::vector<uint8_t>& bytes) {
        return {texelAt(of, bytes, 0, 0), texelAt(of, bytes, 1, 0), texelAt(of, bytes, 0, 1), texelAt(of, bytes, 1, 1)};
    }
    /// Texels of ordinary size; blocks are what they are.
    static std::vector<uint8_t> ordinaryTexels(const Case& of) {
        if (of.isBlock() || of.layout().rgba[0].kind == ComponentKind::unorm) return randomTexels(of, 3);
        std::vector<uint8_t> bytes;
        for (uint32_t i = 0; i < kFormatSize * kFormatSize; ++i) {
            const float a = static_cast<float>(i % 7) / 7, b = static_cast<float>(i % 5) / 5;
            const std::vector<uint8_t> texel = packed(of, {.float32 = {a, b, 1 - a, 1 - b}});
            bytes.insert(bytes.end(), texel.begin(), texel.end());
        }
        return bytes;
    }
};

TEST_F(FormatImages, transfersKeepEveryBit) {
    forEachImageCase(VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT, [&](const Case& of) {
        const TestImage first = makeImage(of, 0), second = makeImage(of, 0);
        const std::vector<uint8_t> bytes = randomTexels(of, 1), other = randomTexels(of, 2);
        upload(first, of, bytes);
        upload(second, of, other);
        ASSERT_EQ(download(first, of), bytes);
        const VkCommandBuffer commands = begin();
        VkImageCopy region{};
        region.srcSubresource = region.dstSubresource = {of.aspect, 0, 0, 1};
        region.extent = {kFormatSize, kFormatSize, 1};
        vkCmdCopyImage(commands, first.image, VK_IMAGE_LAYOUT_GENERAL, second.image, VK_IMAGE_LAYOUT_GENERAL, 1,
                       &region);
        makeVisible(commands);
        submit(commands);
        ASSERT_EQ(download(second, of), bytes);
    });
}

TEST_F(FormatImages, fetchesDecodeEveryTexel) {
    const VkSampler nearest = makeSampler(VK_FILTER_NEAREST, VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE);
    forEachImageCase(VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, [&](const Case& of) {
        const TestImage image = makeImage(of, VK_IMAGE_USAGE_SAMPLED_BIT);
        const std::vector<uint8_t> bytes = randomTexels(of, 4);
        upload(image, of, bytes);
        const auto colors =
            shade(of, image, nearest, "texelFetch(image, ivec2(i % 24, i / 24), 0)", kFormatSize * kFormatSize);
        for (uint32_t i = 0; i < colors.size() && !HasFailure(); ++i)
            expectSameColor(colors[i], texelAt(of, bytes, i % kFormatSize, i / kFormatSize), of.layout().type);
    });
}

TEST_F(FormatImages, linearFiltersAverage) {
    const VkSampler linear = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE);
    forEachImageCase(VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT, [&](const Case& of) {
        if (of.aspect == VK_IMAGE_ASPECT_STENCIL_BIT) return;
        const TestImage image = makeImage(of, VK_IMAGE_USAGE_SAMPLED_BIT);
        const std::vector<uint8_t> bytes = ordinaryTexels(of);
        upload(image, of, bytes);
        const VkClearColorValue found = corner(of, image, linear);
        const auto texels = cornerTexels(of, bytes);
        for (int c = 0; c < 4; ++c) {
            double sum = 0, most = 0;
            for (const VkClearColorValue& texel : texels) {
                sum += double{texel.float32[c]} / 4;
                most = std::max(most, std::abs(double{texel.float32[c]}));
            }
            EXPECT_NEAR(found.float32[c], sum, 1e-6 * std::max(most, 1e-3));
        }
    });
}

TEST_F(FormatImages, minimumAndMaximumFiltersChoose) {
    const VkSampler least = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_REDUCTION_MODE_MIN);
    const VkSampler most = makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_REDUCTION_MODE_MAX);
    forEachImageCase(VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_MINMAX_BIT, [&](const Case& of) {
        if (of.aspect == VK_IMAGE_ASPECT_STENCIL_BIT) return;
        const TestImage image = makeImage(of, VK_IMAGE_USAGE_SAMPLED_BIT);
        const std::vector<uint8_t> bytes = ordinaryTexels(of);
        upload(image, of, bytes);
        const VkClearColorValue low = corner(of, image, least), high = corner(of, image, most);
        const auto texels = cornerTexels(of, bytes);
        for (int c = 0; c < 4; ++c) {
            const auto [lowest, highest] =
                std::minmax({texels[0].float32[c], texels[1].float32[c], texels[2].float32[c], texels[3].float32[c]});
            EXPECT_FLOAT_EQ(low.float32[c], lowest);
            EXPECT_FLOAT_EQ(high.float32[c], highest);
        }
    });
}

TEST_F(FormatImages, cubicFiltersKeepConstants) {
    if (validated()) GTEST_SKIP() << "the validation layer 1.3.239 crashes where compute shaders use cubic filters";
    const VkSampler cubic = makeSampler(VK_FILTER_CUBIC_EXT, VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE);
    forEachImageCase(VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_CUBIC_BIT_EXT, [&](const Case& of) {
        if (of.aspect == VK_IMAGE_ASPECT_STENCIL_BIT) return;
        const TestImage image = makeImage(of, VK_IMAGE_USAGE_SAMPLED_BIT);
        // Blocks of zeros are of one colour in every format.
        std::vector<uint8_t> bytes(randomTexels(of, 0).size());
        if (!of.isBlock()) {
            const std::vector<uint8_t> texel = packed(of, plainColor(of.layout()));
            for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = texel[i % texel.size()];
        }
        upload(image, of, bytes);
        const VkClearColorValue found = corner(of, image, cubic), wanted = texelAt(of, bytes, 0, 0);
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(found.float32[c], wanted.float32[c], 2e-6);
    });
}

TEST_F(FormatImages, storesAndLoadsConvert) {
    forEachImageCase(VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, [&](const Case& of) {
        const TestImage image = makeImage(of, VK_IMAGE_USAGE_STORAGE_BIT);
        upload(image, of, randomTexels(of, 5));
        const VkClearColorValue color = plainColor(of.layout());
        const TestBuffer in = makeStorage(4), out = makeStorage(4);
        std::memcpy(in.data, &color, sizeof color);
        const std::string prefix = kPrefix[static_cast<size_t>(of.layout().type)];
        const Compute compute = computeFor(
            "#version 450\n#extension GL_EXT_shader_image_load_formatted : require\n"
            "layout(set = 0, binding = 0) buffer In { " +
                prefix + "vec4 from; };\nlayout(set = 0, binding = 1) buffer Out { " + prefix +
                "vec4 to; };\nlayout(set = 0, binding = 2) uniform " + prefix +
                "image2D image;\nvoid main() { imageStore(image, ivec2(5, 7), from);\n"
                "memoryBarrierImage(); to = imageLoad(image, ivec2(5, 7)); }",
            {storageBuffer(in), storageBuffer(out), storageImage(image)});
        run(compute, 1);
        const std::vector<uint8_t> bytes = download(image, of), wanted = packed(of, color);
        const size_t at = (7 * kFormatSize + 5) * wanted.size();
        EXPECT_EQ(std::vector<uint8_t>(bytes.begin() + static_cast<ptrdiff_t>(at),
                                       bytes.begin() + static_cast<ptrdiff_t>(at + wanted.size())),
                  wanted);
        VkClearColorValue loaded{};
        std::memcpy(&loaded, out.data, sizeof loaded);
        expectSameColor(loaded, texelAt(of, bytes, 5, 7), of.layout().type);
    });
}

TEST_F(FormatImages, atomicsCount) {
    forEachImageCase(VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT, [&](const Case& of) {
        if (of.layout().type == ValueType::floating) return;  // ShaderFeaturesTest.floatAtomicsOnTexels
        const TestImage image = makeImage(of, VK_IMAGE_USAGE_STORAGE_BIT);
        std::vector<uint8_t> bytes(randomTexels(of, 6).size());
        upload(image, of, bytes);
        const std::string prefix = kPrefix[static_cast<size_t>(of.layout().type)];
        const Compute compute = computeFor(
            "#version 450\nlayout(local_size_x = 32) in;\n"
            "layout(set = 0, binding = 0, r32" +
                std::string(prefix == "u" ? "ui" : "i") + ") uniform " + prefix +
                "image2D image;\nvoid main() { imageAtomicAdd(image, ivec2(1, 0), 3); }",
            {storageImage(image)});
        run(compute, 4);
        bytes = download(image, of);
        EXPECT_EQ(texelAt(of, bytes, 1, 0).uint32[0], 384u);
    });
}

/// The format of four 32-bit components of the same kind of value.
constexpr VkFormat kWide[] = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_UINT, VK_FORMAT_R32G32B32A32_SINT};

TEST_F(FormatImages, blitsConvertFromAndTo) {
    const auto blit = [&](const TestImage& from, const TestImage& to, VkImageAspectFlags aspect) {
        const VkCommandBuffer commands = begin();
        const auto extent = static_cast<int32_t>(kFormatSize);
        VkImageBlit region{};
        region.srcSubresource = region.dstSubresource = {aspect, 0, 0, 1};
        region.srcOffsets[1] = region.dstOffsets[1] = {extent, extent, 1};
        vkCmdBlitImage(commands, from.image, VK_IMAGE_LAYOUT_GENERAL, to.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region,
                       VK_FILTER_NEAREST);
        makeVisible(commands);
        submit(commands);
    };
    forEachImageCase(VK_FORMAT_FEATURE_BLIT_SRC_BIT, [&](const Case& of) {
        const TestImage image = makeImage(of, 0);
        const std::vector<uint8_t> bytes = randomTexels(of, 7);
        upload(image, of, bytes);
        const bool depth = of.aspect != VK_IMAGE_ASPECT_COLOR_BIT;
        const Case wide{depth ? of.info : findFormat(kWide[static_cast<size_t>(of.layout().type)]), of.aspect,
                        VK_IMAGE_TILING_OPTIMAL};
        const TestImage target = makeImage(wide, 0);
        upload(target, wide, randomTexels(wide, 8));
        blit(image, target, of.aspect);
        const std::vector<uint8_t> result = download(target, wide);
        for (uint32_t i = 0; i < kFormatSize * kFormatSize && !HasFailure(); ++i) {
            const uint32_t x = i % kFormatSize, y = i / kFormatSize;
            expectSameColor(texelAt(wide, result, x, y), texelAt(of, bytes, x, y), of.layout().type);
        }
    });
    forEachImageCase(VK_FORMAT_FEATURE_BLIT_DST_BIT, [&](const Case& of) {
        if (of.aspect != VK_IMAGE_ASPECT_COLOR_BIT) return;  // depth and stencil, which keep their format, went above
        const Case wide{findFormat(kWide[static_cast<size_t>(of.layout().type)]), of.aspect, VK_IMAGE_TILING_OPTIMAL};
        const TestImage source = makeImage(wide, 0), target = makeImage(of, 0);
        const VkClearColorValue color = plainColor(of.layout());
        std::vector<uint8_t> bytes = randomTexels(wide, 9);
        std::memcpy(bytes.data(), &color, sizeof color);
        upload(source, wide, bytes);
        upload(target, of, randomTexels(of, 10));
        blit(source, target, of.aspect);
        const std::vector<uint8_t> result = download(target, of), wanted = packed(of, color);
        EXPECT_EQ(std::memcmp(result.data(), wanted.data(), wanted.size()), 0);
    });
}

}  // namespace
}  // namespace vernier::test
