// Multi-planar images and samplers that convert from Y'CbCr: every format, model, range, place of the chroma samples
// and filter against the equations of the specification.
#include <array>
#include <cmath>
#include <random>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

constexpr uint32_t kWidth = 10, kHeight = 6;

struct Planar {
    VkFormat format;
    uint32_t planes, widthDivisor, heightDivisor, bits;
};
constexpr Planar kFormats[] = {
    {VK_FORMAT_G8_B8_R8_3PLANE_420_UNORM, 3, 2, 2, 8},    {VK_FORMAT_G8_B8R8_2PLANE_420_UNORM, 2, 2, 2, 8},
    {VK_FORMAT_G8_B8_R8_3PLANE_422_UNORM, 3, 2, 1, 8},    {VK_FORMAT_G8_B8R8_2PLANE_422_UNORM, 2, 2, 1, 8},
    {VK_FORMAT_G8_B8_R8_3PLANE_444_UNORM, 3, 1, 1, 8},    {VK_FORMAT_G16_B16_R16_3PLANE_420_UNORM, 3, 2, 2, 16},
    {VK_FORMAT_G16_B16R16_2PLANE_420_UNORM, 2, 2, 2, 16}, {VK_FORMAT_G16_B16_R16_3PLANE_422_UNORM, 3, 2, 1, 16},
    {VK_FORMAT_G16_B16R16_2PLANE_422_UNORM, 2, 2, 1, 16}, {VK_FORMAT_G16_B16_R16_3PLANE_444_UNORM, 3, 1, 1, 16},
};
constexpr VkImageAspectFlagBits kAspects[] = {VK_IMAGE_ASPECT_PLANE_0_BIT, VK_IMAGE_ASPECT_PLANE_1_BIT,
                                              VK_IMAGE_ASPECT_PLANE_2_BIT};

/// The codes of the components, each at its own resolution.
struct Picture {
    Planar format;
    std::vector<uint32_t> luma, blue, red;
    uint32_t chromaWidth() const { return kWidth / format.widthDivisor; }
    uint32_t chromaHeight() const { return kHeight / format.heightDivisor; }
};

Picture randomPicture(const Planar& format, uint32_t seed) {
    std::mt19937 random(seed);
    Picture picture{format, {}, {}, {}};
    const auto codes = [&](size_t count) {
        std::vector<uint32_t> result(count);
        for (uint32_t& code : result) code = static_cast<uint32_t>(random()) >> (32 - format.bits);
        return result;
    };
    picture.luma = codes(kWidth * kHeight);
    picture.blue = codes(picture.chromaWidth() * picture.chromaHeight());
    picture.red = codes(picture.chromaWidth() * picture.chromaHeight());
    return picture;
}

/// Planes as they lie in memory, rows without gaps.
std::vector<uint8_t> bytesOf(const Picture& picture, uint32_t plane) {
    std::vector<uint8_t> bytes;
    const auto put = [&](uint32_t code) {
        for (uint32_t byte = 0; byte < picture.format.bits / 8; ++byte)
            bytes.push_back(static_cast<uint8_t>(code >> (8 * byte)));
    };
    if (plane == 0) {
        for (const uint32_t code : picture.luma) put(code);
        return bytes;
    }
    for (size_t i = 0; i < picture.blue.size(); ++i) {
        if (picture.format.planes == 2 || plane == 1) put(picture.blue[i]);
        if (picture.format.planes == 2 || plane == 2) put(picture.red[i]);
    }
    return bytes;
}

using Color = std::array<double, 4>;

/// The equations of the chapters "Chroma Reconstruction", "Range Expansion" and "Model Conversion", as they stand
/// there.
class Model {
  public:
    Model(const Picture& picture, const VkSamplerYcbcrConversionCreateInfo& info) : picture_(picture), info_(info) {}

    Color sample(double s, double t, VkFilter filter) const {
        const double u = s * kWidth, v = t * kHeight;
        if (filter == VK_FILTER_NEAREST) return texel(std::floor(u), std::floor(v));
        const double i = std::floor(u - 0.5), j = std::floor(v - 0.5), a = u - 0.5 - i, b = v - 0.5 - j;
        const Color c[] = {texel(i, j), texel(i + 1, j), texel(i, j + 1), texel(i + 1, j + 1)};
        Color result{};
        for (size_t k = 0; k < 4; ++k)
            result[k] = (1 - a) * (1 - b) * c[0][k] + a * (1 - b) * c[1][k] + (1 - a) * b * c[2][k] + a * b * c[3][k];
        return result;
    }

  private:
    double at(const std::vector<uint32_t>& codes, double i, double j) const {
        const auto x = static_cast<size_t>(std::clamp(i, 0.0, picture_.chromaWidth() - 1.0));
        const auto y = static_cast<size_t>(std::clamp(j, 0.0, picture_.chromaHeight() - 1.0));
        return codes[y * picture_.chromaWidth() + x] / most();
    }
    double most() const { return std::exp2(picture_.format.bits) - 1; }

    /// Along x at row `j` of chroma.
    double across(const std::vector<uint32_t>& codes, double i, double j) const {
        if (picture_.format.widthDivisor == 1) return at(codes, i, j);
        return along(i, info_.xChromaOffset, [&](double k) { return at(codes, k, j); });
    }
    double chroma(const std::vector<uint32_t>& codes, double i, double j) const {
        if (picture_.format.heightDivisor == 1) return across(codes, i, j);
        return along(j, info_.yChromaOffset, [&](double k) { return across(codes, i, k); });
    }
    template <class At>
    double along(double i, VkChromaLocation location, At at) const {
        const double half = std::floor(i * 0.5);
        const bool even = half == i * 0.5;
        if (info_.chromaFilter == VK_FILTER_NEAREST) return at(half);
        if (location == VK_CHROMA_LOCATION_COSITED_EVEN) return even ? at(half) : 0.5 * at(half) + 0.5 * at(half + 1);
        return even ? 0.25 * at(half - 1) + 0.75 * at(half) : 0.75 * at(half) + 0.25 * at(half + 1);
    }

    Color texel(double i, double j) const {
        i = std::clamp(i, 0.0, kWidth - 1.0);
        j = std::clamp(j, 0.0, kHeight - 1.0);
        const double green = picture_.luma[static_cast<size_t>(j * kWidth + i)] / most();
        const double raw[] = {chroma(picture_.red, i, j), green, chroma(picture_.blue, i, j), 1.0};
        const auto pick = [&](VkComponentSwizzle swizzle, size_t self) {
            if (swizzle == VK_COMPONENT_SWIZZLE_ZERO) return 0.0;
            if (swizzle == VK_COMPONENT_SWIZZLE_ONE) return 1.0;
            return raw[swizzle == VK_COMPONENT_SWIZZLE_IDENTITY ? self : swizzle - VK_COMPONENT_SWIZZLE_R];
        };
        const Color c = {pick(info_.components.r, 0), pick(info_.components.g, 1), pick(info_.components.b, 2),
                         pick(info_.components.a, 3)};
        if (info_.ycbcrModel == VK_SAMPLER_YCBCR_MODEL_CONVERSION_RGB_IDENTITY) return c;
        const double scale = std::exp2(picture_.format.bits - 8.0);
        const bool narrow = info_.ycbcrRange == VK_SAMPLER_YCBCR_RANGE_ITU_NARROW;
        const double y = narrow ? (c[1] * most() - 16 * scale) / (219 * scale) : c[1];
        const auto signedChroma = [&](double value) {
            return narrow ? (value * most() - 128 * scale) / (224 * scale)
                          : value - std::exp2(picture_.format.bits - 1.0) / most();
        };
        const double cb = signedChroma(c[2]), cr = signedChroma(c[0]);
        switch (info_.ycbcrModel) {
            case VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_IDENTITY:
                return {cr, y, cb, c[3]};
            case VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_709:
                return {y + 1.5748 * cr, y - 0.13397432 / 0.7152 * cb - 0.33480248 / 0.7152 * cr, y + 1.8556 * cb,
                        c[3]};
            case VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_2020:
                return {y + 1.4746 * cr, y - 0.11156702 / 0.6780 * cb - 0.38737742 / 0.6780 * cr, y + 1.8814 * cb,
                        c[3]};
            default:
                return {y + 1.402 * cr, y - 0.202008 / 0.587 * cb - 0.419198 / 0.587 * cr, y + 1.772 * cb, c[3]};
        }
    }

    const Picture& picture_;
    const VkSamplerYcbcrConversionCreateInfo& info_;
};

class YcbcrTest : public ComputeTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
    void* moreFeatures() override {
        features_ = make<VkPhysicalDeviceSamplerYcbcrConversionFeatures>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SAMPLER_YCBCR_CONVERSION_FEATURES);
        features_.samplerYcbcrConversion = VK_TRUE;
        return &features_;
    }

    VkImage makePlanar(const Planar& format, VkImageTiling tiling, VkImageCreateFlags flags) {
        auto info =
            flatImage(format.format, {kWidth, kHeight},
                      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        info.flags = flags;
        info.tiling = tiling;
        VkImage image = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateImage(device, &info, nullptr, &image), VK_SUCCESS);
        defer([this, image] { vkDestroyImage(device, image, nullptr); });
        return image;
    }
    VkDeviceMemory bindWhole(VkImage image) {
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(device, image, &needs);
        const VkDeviceMemory memory = allocate(needs.size);
        EXPECT_EQ(vkBindImageMemory(device, image, memory, 0), VK_SUCCESS);
        return memory;
    }
    /// Each plane to an allocation of its own, all in one call.
    void bindPlanes(VkImage image, uint32_t planes) {
        VkBindImagePlaneMemoryInfo bindPlanes[3];
        VkBindImageMemoryInfo binds[3];
        for (uint32_t plane = 0; plane < planes; ++plane) {
            auto which =
                make<VkImagePlaneMemoryRequirementsInfo>(VK_STRUCTURE_TYPE_IMAGE_PLANE_MEMORY_REQUIREMENTS_INFO);
            which.planeAspect = kAspects[plane];
            auto info = make<VkImageMemoryRequirementsInfo2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_REQUIREMENTS_INFO_2);
            info.pNext = &which;
            info.image = image;
            auto needs = make<VkMemoryRequirements2>(VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2);
            vkGetImageMemoryRequirements2(device, &info, &needs);
            bindPlanes[plane] = make<VkBindImagePlaneMemoryInfo>(VK_STRUCTURE_TYPE_BIND_IMAGE_PLANE_MEMORY_INFO);
            bindPlanes[plane].planeAspect = kAspects[plane];
            binds[plane] = make<VkBindImageMemoryInfo>(VK_STRUCTURE_TYPE_BIND_IMAGE_MEMORY_INFO);
            binds[plane].pNext = &bindPlanes[plane];
            binds[plane].image = image;
            binds[plane].memory = allocate(needs.memoryRequirements.size);
        }
        ASSERT_EQ(vkBindImageMemory2(device, planes, binds), VK_SUCCESS);
    }

    static VkBufferImageCopy regionOf(const Planar& format, uint32_t plane) {
        VkBufferImageCopy region{};
        region.imageSubresource = {kAspects[plane], 0, 0, 1};
        region.imageExtent = {plane == 0 ? kWidth : kWidth / format.widthDivisor,
                              plane == 0 ? kHeight : kHeight / format.heightDivisor, 1};
        return region;
    }
    void upload(VkImage image, const Picture& picture) {
        TestImage whole;
        whole.image = image;
        const VkCommandBuffer commands = begin();
        toGeneral(commands, whole);
        for (uint32_t plane = 0; plane < picture.format.planes; ++plane) {
            const std::vector<uint8_t> bytes = bytesOf(picture, plane);
            const TestBuffer buffer = makeBuffer(bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
            std::memcpy(buffer.data, bytes.data(), bytes.size());
            const VkBufferImageCopy region = regionOf(picture.format, plane);
            vkCmdCopyBufferToImage(commands, buffer.buffer, image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
        }
        makeVisible(commands);
        submit(commands);
    }

    VkSamplerYcbcrConversion makeConversion(const VkSamplerYcbcrConversionCreateInfo& info) {
        VkSamplerYcbcrConversion conversion = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateSamplerYcbcrConversion(device, &info, nullptr, &conversion), VK_SUCCESS);
        defer([this, conversion] { vkDestroySamplerYcbcrConversion(device, conversion, nullptr); });
        return conversion;
    }
    VkSampler makeSampler(VkSamplerYcbcrConversion conversion, VkFilter mag, VkFilter min) {
        auto with = make<VkSamplerYcbcrConversionInfo>(VK_STRUCTURE_TYPE_SAMPLER_YCBCR_CONVERSION_INFO);
        with.conversion = conversion;
        auto info = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
        info.pNext = &with;
        info.magFilter = mag;
        info.minFilter = min;
        info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        info.maxLod = 10;
        VkSampler sampler = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateSampler(device, &info, nullptr, &sampler), VK_SUCCESS);
        defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
        return sampler;
    }
    VkImageView makeView(VkImage image, VkFormat format, VkImageAspectFlags aspect, const void* chain) {
        return ComputeTest::makeView(image, VK_IMAGE_VIEW_TYPE_2D, format, {aspect, 0, 1, 0, 1}, chain);
    }
    VkImageView makeView(VkImage image, const Planar& format, VkSamplerYcbcrConversion conversion) {
        auto with = make<VkSamplerYcbcrConversionInfo>(VK_STRUCTURE_TYPE_SAMPLER_YCBCR_CONVERSION_INFO);
        with.conversion = conversion;
        return makeView(image, format.format, VK_IMAGE_ASPECT_COLOR_BIT, &with);
    }

    /// Places all over the picture and a little beyond; x, y and the level of detail of each.
    static std::vector<std::array<float, 4>> places() {
        std::vector<std::array<float, 4>> result;
        for (int j = -1; j <= 13; ++j)
            for (int i = -1; i <= 21; ++i)
                result.push_back({(static_cast<float>(i) * 0.5f + 0.21f) / kWidth,
                                  (static_cast<float>(j) * 0.5f + 0.27f) / kHeight, (i + j) % 2 == 0 ? -1.0f : 1.0f});
        return result;
    }
    std::vector<std::array<float, 4>> sample(VkImageView view, VkSampler sampler,
                                             const std::vector<std::array<float, 4>>& at) {
        const auto words = static_cast<uint32_t>(at.size() * 4);
        const TestBuffer in = makeStorage(words), out = makeStorage(words);
        std::memcpy(in.data, at.data(), words * 4);
        const Compute compute = makeCompute(R"(#version 450
            layout(local_size_x = 1) in;
            layout(set = 0, binding = 0) buffer In { vec4 at[]; };
            layout(set = 0, binding = 1) buffer Out { vec4 color[]; };
            layout(set = 0, binding = 2) uniform sampler2D picture;
            void main() {
                uint i = gl_GlobalInvocationID.x;
                color[i] = textureLod(picture, at[i].xy, at[i].z);
            })",
                                            {storageBuffer(in), storageBuffer(out), sampledImage(view, sampler)});
        run(compute, static_cast<uint32_t>(at.size()));
        std::vector<std::array<float, 4>> result(at.size());
        std::memcpy(result.data(), out.data, words * 4);
        return result;
    }

    static VkSamplerYcbcrConversionCreateInfo conversionInfo(VkFormat format) {
        auto info = make<VkSamplerYcbcrConversionCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_YCBCR_CONVERSION_CREATE_INFO);
        info.format = format;
        info.ycbcrModel = VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_601;
        info.ycbcrRange = VK_SAMPLER_YCBCR_RANGE_ITU_NARROW;
        return info;
    }

    /// Samples everywhere with the conversion and compares with the equations.
    void check(VkImage image, const Picture& picture, const VkSamplerYcbcrConversionCreateInfo& info, VkFilter mag,
               VkFilter min) {
        const VkSamplerYcbcrConversion conversion = makeConversion(info);
        const std::vector<std::array<float, 4>> at = places();
        const auto colors = sample(makeView(image, picture.format, conversion), makeSampler(conversion, mag, min), at);
        const Model model(picture, info);
        for (size_t i = 0; i < at.size(); ++i) {
            const Color wanted = model.sample(at[i][0], at[i][1], at[i][2] <= 0 ? mag : min);
            for (size_t c = 0; c < 4; ++c) {
                ASSERT_NEAR(colors[i][c], wanted[c], 2e-7 * std::max(1.0, std::abs(wanted[c])))
                    << "format " << info.format << " model " << info.ycbcrModel << " range " << info.ycbcrRange
                    << " at " << at[i][0] << ", " << at[i][1] << " component " << c;
            }
        }
    }

  private:
    VkPhysicalDeviceSamplerYcbcrConversionFeatures features_{};
};

TEST_F(YcbcrTest, formatsTellWhatTheyCanDo) {
    for (const Planar& format : kFormats) {
        VkFormatProperties properties{};
        vkGetPhysicalDeviceFormatProperties(physicalDevice, format.format, &properties);
        constexpr VkFormatFeatureFlags kMandatory = VK_FORMAT_FEATURE_TRANSFER_SRC_BIT |
                                                    VK_FORMAT_FEATURE_TRANSFER_DST_BIT |
                                                    VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
        EXPECT_EQ(properties.optimalTilingFeatures & kMandatory, kMandatory);
        EXPECT_NE(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COSITED_CHROMA_SAMPLES_BIT, 0u);
        EXPECT_NE(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_MIDPOINT_CHROMA_SAMPLES_BIT, 0u);
        EXPECT_EQ(properties.bufferFeatures, 0u);
        VkImageFormatProperties image{};
        EXPECT_EQ(vkGetPhysicalDeviceImageFormatProperties(physicalDevice, format.format, VK_IMAGE_TYPE_2D,
                                                           VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT,
                                                           VK_IMAGE_CREATE_DISJOINT_BIT, &image),
                  VK_SUCCESS);
        EXPECT_EQ(image.maxMipLevels, 1u);
        EXPECT_EQ(vkGetPhysicalDeviceImageFormatProperties(physicalDevice, format.format, VK_IMAGE_TYPE_2D,
                                                           VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                                           0, &image),
                  VK_ERROR_FORMAT_NOT_SUPPORTED);
    }
}

TEST_F(YcbcrTest, everyModelAndRangeOfEveryFormat) {
    for (const Planar& format : kFormats) {
        const Picture picture = randomPicture(format, 7);
        const VkImage image = makePlanar(format, VK_IMAGE_TILING_OPTIMAL, 0);
        bindWhole(image);
        upload(image, picture);
        for (int model = VK_SAMPLER_YCBCR_MODEL_CONVERSION_RGB_IDENTITY;
             model <= VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_2020; ++model) {
            for (const VkSamplerYcbcrRange range :
                 {VK_SAMPLER_YCBCR_RANGE_ITU_FULL, VK_SAMPLER_YCBCR_RANGE_ITU_NARROW}) {
                auto info = conversionInfo(format.format);
                info.ycbcrModel = static_cast<VkSamplerYcbcrModelConversion>(model);
                info.ycbcrRange = range;
                check(image, picture, info, VK_FILTER_NEAREST, VK_FILTER_NEAREST);
                if (HasFatalFailure()) return;
            }
        }
    }
}

TEST_F(YcbcrTest, everyPlaceOfChromaAndFilter) {
    for (const Planar& format : kFormats) {
        if (format.bits != 8) continue;
        const Picture picture = randomPicture(format, 8);
        const VkImage image = makePlanar(format, VK_IMAGE_TILING_OPTIMAL, 0);
        bindWhole(image);
        upload(image, picture);
        for (uint32_t n = 0; n < 32; ++n) {
            auto info = conversionInfo(format.format);
            info.xChromaOffset = (n & 1) != 0 ? VK_CHROMA_LOCATION_MIDPOINT : VK_CHROMA_LOCATION_COSITED_EVEN;
            info.yChromaOffset = (n & 2) != 0 ? VK_CHROMA_LOCATION_MIDPOINT : VK_CHROMA_LOCATION_COSITED_EVEN;
            info.chromaFilter = (n & 4) != 0 ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
            check(image, picture, info, (n & 8) != 0 ? VK_FILTER_LINEAR : VK_FILTER_NEAREST,
                  (n & 16) != 0 ? VK_FILTER_LINEAR : VK_FILTER_NEAREST);
            if (HasFatalFailure()) return;
        }
    }
}

TEST_F(YcbcrTest, componentsCanBeSwapped) {
    const Planar format = kFormats[0];
    const Picture picture = randomPicture(format, 9);
    const VkImage image = makePlanar(format, VK_IMAGE_TILING_OPTIMAL, 0);
    bindWhole(image);
    upload(image, picture);
    auto info = conversionInfo(format.format);
    info.components = {VK_COMPONENT_SWIZZLE_B, VK_COMPONENT_SWIZZLE_IDENTITY, VK_COMPONENT_SWIZZLE_R,
                       VK_COMPONENT_SWIZZLE_ZERO};
    check(image, picture, info, VK_FILTER_LINEAR, VK_FILTER_LINEAR);
}

// Numbers of ITU-R BT.601: the bars of 75 % and the ends of the range.
TEST_F(YcbcrTest, knownColours) {
    const Planar format = kFormats[1];
    constexpr struct {
        uint32_t y, cb, cr;
        double red, green, blue;
    } kKnown[] = {{235, 128, 128, 1, 1, 1},
                  {16, 128, 128, 0, 0, 0},
                  {162, 44, 142, 0.7544, 0.7497, 0.0023},
                  {65, 100, 212, 0.7486, 0.0025, 0.0023},
                  {35, 212, 114, -0.0009, 0.0029, 0.7513}};
    for (const auto& known : kKnown) {
        Picture picture = randomPicture(format, 1);
        std::fill(picture.luma.begin(), picture.luma.end(), known.y);
        std::fill(picture.blue.begin(), picture.blue.end(), known.cb);
        std::fill(picture.red.begin(), picture.red.end(), known.cr);
        const VkImage image = makePlanar(format, VK_IMAGE_TILING_OPTIMAL, 0);
        bindWhole(image);
        upload(image, picture);
        const VkSamplerYcbcrConversion conversion = makeConversion(conversionInfo(format.format));
        const auto colors = sample(makeView(image, format, conversion),
                                   makeSampler(conversion, VK_FILTER_LINEAR, VK_FILTER_LINEAR), {{0.5f, 0.5f}});
        EXPECT_NEAR(colors[0][0], known.red, 5e-3);
        EXPECT_NEAR(colors[0][1], known.green, 5e-3);
        EXPECT_NEAR(colors[0][2], known.blue, 5e-3);
        EXPECT_EQ(colors[0][3], 1.0f);
    }
}

TEST_F(YcbcrTest, planesMayLieInMemoriesOfTheirOwn) {
    for (const Planar& format : {kFormats[0], kFormats[1]}) {
        const Picture picture = randomPicture(format, 10);
        const VkImage image = makePlanar(format, VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_CREATE_DISJOINT_BIT);
        bindPlanes(image, format.planes);
        upload(image, picture);
        check(image, picture, conversionInfo(format.format), VK_FILTER_LINEAR, VK_FILTER_NEAREST);
        if (HasFatalFailure()) return;
    }
}

TEST_F(YcbcrTest, planesAreCopiedViewedAndLaidOut) {
    const Planar format = kFormats[1];
    const Picture picture = randomPicture(format, 11);
    const VkImage image = makePlanar(format, VK_IMAGE_TILING_LINEAR, VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT);
    const VkDeviceMemory memory = bindWhole(image);
    upload(image, picture);
    const std::vector<uint8_t> chroma = bytesOf(picture, 1);
    const VkExtent2D extent{kWidth / 2, kHeight / 2};

    // A plane as an image of its own: copied from, and sampled.
    const TestImage copy = makeImage(VK_FORMAT_R8G8_UNORM, extent, VK_IMAGE_USAGE_SAMPLED_BIT);
    const TestBuffer back = makeBuffer(chroma.size(), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkCommandBuffer commands = begin();
    toGeneral(commands, copy);
    VkImageCopy region{};
    region.srcSubresource = {VK_IMAGE_ASPECT_PLANE_1_BIT, 0, 0, 1};
    region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.extent = {extent.width, extent.height, 1};
    vkCmdCopyImage(commands, image, VK_IMAGE_LAYOUT_GENERAL, copy.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
    makeVisible(commands);
    VkBufferImageCopy out = regionOf(format, 1);
    out.imageSubresource.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    vkCmdCopyImageToBuffer(commands, copy.image, VK_IMAGE_LAYOUT_GENERAL, back.buffer, 1, &out);
    makeVisible(commands);
    submit(commands);
    EXPECT_EQ(std::memcmp(back.data, chroma.data(), chroma.size()), 0);

    auto nearest = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    VkSampler sampler = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSampler(device, &nearest, nullptr, &sampler), VK_SUCCESS);
    defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
    const VkImageView view = makeView(image, VK_FORMAT_R8G8_UNORM, VK_IMAGE_ASPECT_PLANE_1_BIT, nullptr);
    const auto colors = sample(view, sampler, {{0.5f / extent.width, 1.5f / extent.height}});
    EXPECT_FLOAT_EQ(colors[0][0], static_cast<float>(picture.blue[extent.width]) / 255);
    EXPECT_FLOAT_EQ(colors[0][1], static_cast<float>(picture.red[extent.width]) / 255);

    // The bytes of a plane where its layout says.
    const VkImageSubresource which{VK_IMAGE_ASPECT_PLANE_1_BIT, 0, 0};
    VkSubresourceLayout layout{};
    vkGetImageSubresourceLayout(device, image, &which, &layout);
    void* data = nullptr;
    ASSERT_EQ(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    const auto* row = static_cast<const uint8_t*>(data) + layout.offset + layout.rowPitch;
    EXPECT_EQ(std::memcmp(row, chroma.data() + 2 * extent.width, 2 * extent.width), 0);
}

}  // namespace
}  // namespace vernier::test
