// Sampling features on Vernier's driver and on lavapipe: the same lookups, with what the specification fixes compared
// closely and what it leaves open (8-bit weights, levels of detail) with room.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/peers/texture_lab.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kArea{64, 48};

/// Coordinates for every pixel of kArea; at least `clear` texels away from the borders between texels of `extent`.
std::vector<Vec4> randomCoordinates(VkExtent3D extent, float low, float high, float clear = 0, uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(low, high);
    const float sizes[3] = {static_cast<float>(extent.width), static_cast<float>(extent.height),
                            static_cast<float>(extent.depth)};
    std::vector<Vec4> result(size_t{kArea.width} * kArea.height);
    for (Vec4& v : result) {
        for (size_t c = 0; c < 4; ++c) {
            do {
                v[c] = uniform(random);
            } while (c < 3 && std::fabs(v[c] * sizes[c] - std::round(v[c] * sizes[c])) < clear);
        }
    }
    return result;
}

LabImage noise(VkFormat format, uint32_t bytesPerTexel, VkExtent3D extent, uint32_t levels = 1, uint32_t layers = 1) {
    LabImage image;
    image.format = format;
    image.extent = extent;
    image.levels = levels;
    image.layers = layers;
    for (uint32_t level = 0; level < levels; ++level) {
        const size_t texels = size_t{std::max(1u, extent.width >> level)} * std::max(1u, extent.height >> level) *
                              std::max(1u, extent.depth >> level);
        image.data.push_back(randomBytes(texels * layers * bytesPerTexel, 77 + level));
    }
    return image;
}

LabSampler linear(VkSamplerAddressMode mode = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE) {
    LabSampler sampler;
    sampler.info.magFilter = sampler.info.minFilter = VK_FILTER_LINEAR;
    sampler.info.addressModeU = sampler.info.addressModeV = sampler.info.addressModeW = mode;
    return sampler;
}

std::unique_ptr<TextureLab> vernier() {
    std::unique_ptr<TextureLab> lab = TextureLab::open(VERNIER_ICD_JSON);
    EXPECT_NE(lab, nullptr);
    return lab;
}

/// The same question to both: no component of more than `outliers` of the pixels differs by more than `tolerance`.
void expectAsLavapipe(const LabImage& image, const LabSampler& sampler, const std::string& type,
                      const std::string& glsl, const std::vector<Vec4>& inputs, float tolerance, double outliers = 0,
                      const char* extension = nullptr) {
    const std::vector<Vec4> mine = vernier()->look(image, sampler, type, glsl, inputs, kArea);
    const std::unique_ptr<TextureLab> peer = TextureLab::open(VERNIER_LAVAPIPE_JSON);
    if (peer == nullptr || (extension != nullptr && !peer->has(extension))) GTEST_SKIP() << "lavapipe has it not";
    const std::vector<Vec4> theirs = peer->look(image, sampler, type, glsl, inputs, kArea);
    size_t wrong = 0, first = 0;
    for (size_t i = 0; i < mine.size(); ++i) {
        bool differs = false;
        for (size_t c = 0; c < 4; ++c) differs = differs || !(std::fabs(mine[i][c] - theirs[i][c]) <= tolerance);
        if (differs && wrong++ == 0) first = i;
    }
    EXPECT_LE(wrong, outliers * static_cast<double>(mine.size()))
        << "the first at pixel " << first << ": " << testing::PrintToString(mine[first]) << " instead of "
        << testing::PrintToString(theirs[first]) << (inputs.empty() ? "" : testing::PrintToString(inputs[first]));
}

constexpr float kWeight = 1.5f / 128;  // 8-bit weights in three directions

TEST(Anisotropy, isTheMeanOfSamplesAlongTheLongerAxis) {
    const LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {64, 64, 1}, 7);
    LabSampler sampler = linear(VK_SAMPLER_ADDRESS_MODE_REPEAT);
    sampler.info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    const std::vector<Vec4> inputs = randomCoordinates(image.extent, 0, 1);
    const auto lab = vernier();
    // A footprint of 2^(k + 2) x 2^k texels, turned by 90 degrees every other pixel: four samples at level k.
    const std::string footprint =
        "vec4 v = in_(i); float k = float(i % 4); bool turned = i % 3 == 0; vec2 one = vec2(exp2(k + 2.0) / 64.0, 0), "
        "two = vec2(0, exp2(k) / 64.0); vec2 longer = turned ? one.yx : one, shorter = turned ? two.yx : two; ";
    const std::vector<Vec4> expected =
        lab->look(image, sampler, "sampler2D",
                  footprint +
                      "vec4 sum = vec4(0); for (int n = 1; n <= 4; ++n) sum += textureLod(tex, v.xy + longer * "
                      "(float(n) / 5.0 - 0.5), k); return sum / 4.0;",
                  inputs, kArea);
    sampler.info.anisotropyEnable = VK_TRUE;
    for (const float most : {4.0f, 16.0f}) {
        sampler.info.maxAnisotropy = most;
        for (const char* order : {"longer, shorter", "shorter, longer"}) {
            const std::vector<Vec4> actual =
                lab->look(image, sampler, "sampler2D", footprint + "return textureGrad(tex, v.xy, " + order + ");",
                          inputs, kArea);
            for (size_t i = 0; i < actual.size(); ++i) {
                for (size_t c = 0; c < 4; ++c) ASSERT_NEAR(actual[i][c], expected[i][c], 2e-6f) << i << " " << order;
            }
        }
    }
}

TEST(Anisotropy, changesNothingWhereItHasNoSay) {
    const LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {32, 32, 1}, 6);
    LabSampler sampler = linear(VK_SAMPLER_ADDRESS_MODE_REPEAT);
    sampler.info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    const std::vector<Vec4> inputs = randomCoordinates(image.extent, -1, 2);
    const auto lab = vernier();
    LabSampler anisotropic = sampler;
    anisotropic.info.anisotropyEnable = VK_TRUE;
    anisotropic.info.maxAnisotropy = 16;
    // Equal gradients, magnification, explicit levels.
    for (const char* glsl : {"vec4 v = in_(i); return textureGrad(tex, v.xy, vec2(v.z, 0), vec2(0, v.z));",
                             "vec4 v = in_(i); return textureGrad(tex, v.xy, vec2(0.01, 0), vec2(0, 0.0001));",
                             "vec4 v = in_(i); return textureLod(tex, v.xy, v.z * 3.0);"}) {
        EXPECT_EQ(lab->look(image, sampler, "sampler2D", glsl, inputs, kArea),
                  lab->look(image, anisotropic, "sampler2D", glsl, inputs, kArea))
            << glsl;
    }
    // Equal texels stay what they are.
    LabImage flat = image;
    for (auto& level : flat.data) std::fill(level.begin(), level.end(), uint8_t{0x55});
    for (const Vec4& v :
         lab->look(flat, anisotropic, "sampler2D", "vec4 v = in_(i); return textureGrad(tex, v.xy, v.zw, v.yx * 0.03);",
                   inputs, kArea)) {
        EXPECT_EQ(v, (Vec4{1.0f / 3, 1.0f / 3, 1.0f / 3, 1.0f / 3}));
    }
}

TEST(Anisotropy, keepsWhatIsotropicFiltersLose) {
    // Stripes along t, seen under 8 : 1 with the long side along the stripes: they stay, while the isotropic filter's
    // level of detail turns them grey.
    LabImage stripes;
    stripes.extent = {64, 64, 1};
    stripes.levels = 7;
    for (uint32_t level = 0; level < 7; ++level) {
        const uint32_t size = 64u >> level;
        std::vector<uint8_t> texels;
        for (uint32_t i = 0; i < size * size; ++i) {
            const uint8_t value = level > 1 ? 128 : (i % size << level & 2) != 0 ? 255 : 0;
            texels.insert(texels.end(), {value, value, value, 255});
        }
        stripes.data.push_back(texels);
    }
    LabSampler sampler = linear(VK_SAMPLER_ADDRESS_MODE_REPEAT);
    sampler.info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    const std::string glsl = "return texture(tex, (vec2(at) + 0.5) * vec2(1.0 / 64.0, 8.0 / 64.0));";
    const auto lab = vernier();
    const auto contrast = [](const std::vector<Vec4>& values) {
        double sum = 0;
        for (const Vec4& v : values) sum += std::fabs(v[0] - 128.0 / 255);
        return sum / static_cast<double>(values.size());
    };
    EXPECT_LT(contrast(lab->look(stripes, sampler, "sampler2D", glsl, {}, kArea)), 0.01);
    sampler.info.anisotropyEnable = VK_TRUE;
    sampler.info.maxAnisotropy = 16;
    EXPECT_GT(contrast(lab->look(stripes, sampler, "sampler2D", glsl, {}, kArea)), 0.45);
}

TEST(Border, customColorsReplaceTexels) {
    LabSampler sampler = linear(VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER);
    sampler.info.borderColor = VK_BORDER_COLOR_FLOAT_CUSTOM_EXT;
    sampler.border = {.float32 = {0.25f, 0.5f, 0.875f, 0.125f}};
    LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {5, 7, 1});
    const char* glsl = "return textureLod(tex, in_(i).xy, 0.0);";
    const std::vector<Vec4> inputs = randomCoordinates(image.extent, -1, 2);
    expectAsLavapipe(image, sampler, "sampler2D", glsl, inputs, kWeight, 0, VK_EXT_CUSTOM_BORDER_COLOR_EXTENSION_NAME);
    // Far outside: the colour itself, after the view's swizzle; components that the format lacks are substituted.
    const std::vector<Vec4> outside(inputs.size(), Vec4{5, 5, 0, 0});
    EXPECT_EQ(vernier()->look(image, sampler, "sampler2D", glsl, outside, {2, 1})[0],
              (Vec4{0.25f, 0.5f, 0.875f, 0.125f}));
    image.swizzle = {VK_COMPONENT_SWIZZLE_B, VK_COMPONENT_SWIZZLE_ONE, VK_COMPONENT_SWIZZLE_A, VK_COMPONENT_SWIZZLE_R};
    EXPECT_EQ(vernier()->look(image, sampler, "sampler2D", glsl, outside, {2, 1})[0], (Vec4{0.875f, 1, 0.125f, 0.25f}));
    LabImage two = noise(VK_FORMAT_R8G8_UNORM, 2, {4, 4, 1});
    EXPECT_EQ(vernier()->look(two, sampler, "sampler2D", glsl, outside, {2, 1})[0], (Vec4{0.25f, 0.5f, 0, 1}));
}

TEST(Border, customIntegers) {
    LabSampler sampler;
    sampler.info.addressModeU = sampler.info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    sampler.info.borderColor = VK_BORDER_COLOR_INT_CUSTOM_EXT;
    sampler.border = {.uint32 = {7, 200, 65535, 3}};
    const LabImage image = noise(VK_FORMAT_R16G16B16A16_UINT, 8, {4, 4, 1});
    expectAsLavapipe(image, sampler, "usampler2D", "return vec4(textureLod(tex, in_(i).xy, 0.0));",
                     randomCoordinates(image.extent, -1, 2, 0.01f), 0, 0, VK_EXT_CUSTOM_BORDER_COLOR_EXTENSION_NAME);
}

TEST(Reduction, takesTheExtremesOfTheFootprint) {
    for (const VkSamplerReductionMode mode : {VK_SAMPLER_REDUCTION_MODE_MIN, VK_SAMPLER_REDUCTION_MODE_MAX}) {
        LabSampler sampler = linear(VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT);
        sampler.reduction = mode;
        const LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {9, 6, 1});
        const std::vector<Vec4> inputs = randomCoordinates({18, 12, 1}, -1, 2, 0.02f);
        const auto lab = vernier();
        const char* op = mode == VK_SAMPLER_REDUCTION_MODE_MIN ? "min" : "max";
        const std::string gather = std::string(
                                       "vec2 uv = in_(i).xy; vec4 r; for (int c = 0; c < 4; ++c) { vec4 t = c == 0 ? "
                                       "textureGather(tex, uv, 0) : c == 1 ? textureGather(tex, uv, 1) : c == 2 ? "
                                       "textureGather(tex, uv, 2) : textureGather(tex, uv, 3); r[c] = ") +
                                   op + "(" + op + "(t.x, t.y), " + op + "(t.z, t.w)); } return r;";
        EXPECT_EQ(lab->look(image, sampler, "sampler2D", "return textureLod(tex, in_(i).xy, 0.0);", inputs, kArea),
                  lab->look(image, linear(VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT), "sampler2D", gather, inputs, kArea))
            << op;
        expectAsLavapipe(image, sampler, "sampler2D", "return textureLod(tex, in_(i).xy, 0.0);", inputs, 1e-6f, 0,
                         VK_EXT_SAMPLER_FILTER_MINMAX_EXTENSION_NAME);
    }
}

LabImage cube(uint32_t size, uint32_t levels = 1) {
    LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {size, size, 1}, levels, 6);
    image.viewType = VK_IMAGE_VIEW_TYPE_CUBE;
    image.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
    return image;
}

TEST(Cube, facesMeetWithoutSeams) {
    expectAsLavapipe(cube(8), linear(), "samplerCube", "return textureLod(tex, in_(i).xyz, 0.0);",
                     randomCoordinates({1, 1, 1}, -1, 1), kWeight, 0.005);
    // Along an edge and at the corners, where neighbouring texels of two and three faces mix.
    expectAsLavapipe(cube(4), linear(), "samplerCube",
                     "vec4 v = in_(i); return textureLod(tex, vec3(1.0, 1.0 + v.x * 0.2, v.y), 0.0);",
                     randomCoordinates({1, 1, 1}, -1, 1), kWeight, 0.01);
}

TEST(Cube, seamsOnRequest) {
    LabSampler sampler = linear();
    sampler.info.flags = VK_SAMPLER_CREATE_NON_SEAMLESS_CUBE_MAP_BIT_EXT;
    expectAsLavapipe(cube(4), sampler, "samplerCube", "return textureLod(tex, in_(i).xyz, 0.0);",
                     randomCoordinates({1, 1, 1}, -1, 1), kWeight, 0.005, VK_EXT_NON_SEAMLESS_CUBE_MAP_EXTENSION_NAME);
    // A face by itself is a 2D image that is clamped to its edge.
    LabImage faces = cube(4);
    const auto lab = vernier();
    const std::vector<Vec4> inputs = randomCoordinates({1, 1, 1}, -1, 1);
    const std::vector<Vec4> a = lab->look(
        faces, sampler, "samplerCube", "vec4 v = in_(i); return textureLod(tex, vec3(1.0, v.xy), 0.0);", inputs, kArea);
    faces.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    EXPECT_EQ(a,
              lab->look(faces, linear(), "sampler2DArray",
                        "vec4 v = in_(i); return textureLod(tex, vec3(-v.y * 0.5 + 0.5, -v.x * 0.5 + 0.5, 0.0), 0.0);",
                        inputs, kArea));
}

TEST(Cube, arrays) {
    LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {8, 8, 1}, 1, 18);
    image.viewType = VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
    image.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
    expectAsLavapipe(image, linear(), "samplerCubeArray",
                     "vec4 v = in_(i); return textureLod(tex, vec4(v.xyz, v.w * 1.4 + 1.0), 0.0);",
                     randomCoordinates({1, 1, 1}, -1, 1), kWeight, 0.01);
}

TEST(Dimensions, one) {
    LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {19, 1, 1}, 5);
    image.type = VK_IMAGE_TYPE_1D;
    image.viewType = VK_IMAGE_VIEW_TYPE_1D;
    LabSampler sampler = linear(VK_SAMPLER_ADDRESS_MODE_REPEAT);
    sampler.info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    expectAsLavapipe(image, sampler, "sampler1D", "vec4 v = in_(i); return textureLod(tex, v.x, v.y * 2.0);",
                     randomCoordinates({19, 1, 1}, -1, 2), 2 * kWeight);
    image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {19, 1, 1}, 1, 5);
    image.type = VK_IMAGE_TYPE_1D;
    image.viewType = VK_IMAGE_VIEW_TYPE_1D_ARRAY;
    expectAsLavapipe(
        image, sampler, "sampler1DArray",
        "vec4 v = in_(i); return textureLod(tex, vec2(v.x, floor(v.y * 8.0)), 0.0) + vec4(textureSize(tex, 0), 0, 0);",
        randomCoordinates({19, 1, 1}, -1, 2), kWeight);
}

TEST(Dimensions, three) {
    LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {9, 6, 5}, 3);
    image.type = VK_IMAGE_TYPE_3D;
    image.viewType = VK_IMAGE_VIEW_TYPE_3D;
    LabSampler sampler = linear(VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT);
    sampler.info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    sampler.info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    sampler.info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    expectAsLavapipe(image, sampler, "sampler3D", "vec4 v = in_(i); return textureLod(tex, v.xyz, v.w);",
                     randomCoordinates(image.extent, -1, 2), 2 * kWeight);
    expectAsLavapipe(image, sampler, "sampler3D",
                     "vec4 v = in_(i); return texelFetch(tex, ivec3(abs(v.xyz) * vec3(4, 2.4, 2)), 0) + "
                     "vec4(textureSize(tex, 1), 0);",
                     randomCoordinates(image.extent, -1, 2), 1e-6f);
    image.flags = VK_IMAGE_CREATE_2D_VIEW_COMPATIBLE_BIT_EXT;
    image.viewType = VK_IMAGE_VIEW_TYPE_2D;
    image.levels = 1;
    expectAsLavapipe(image, linear(), "sampler2D", "return textureLod(tex, in_(i).xy, 0.0);",
                     randomCoordinates(image.extent, -1, 2), kWeight, 0, VK_EXT_IMAGE_2D_VIEW_OF_3D_EXTENSION_NAME);
}

TEST(Compare, percentageCloserAndGather) {
    LabImage image = noise(VK_FORMAT_D16_UNORM, 2, {8, 8, 1});
    image.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    LabSampler sampler = linear(VK_SAMPLER_ADDRESS_MODE_REPEAT);
    sampler.info.compareEnable = VK_TRUE;
    for (int op = VK_COMPARE_OP_NEVER; op <= VK_COMPARE_OP_ALWAYS; ++op) {
        sampler.info.compareOp = static_cast<VkCompareOp>(op);
        const std::vector<Vec4> inputs = randomCoordinates(image.extent, -1, 2, 0.01f);
        expectAsLavapipe(image, sampler, "sampler2DShadow",
                         "vec4 v = in_(i); return vec4(textureLod(tex, v.xyz, 0.0), textureProjLod(tex, vec4(v.xy * "
                         "2.0, v.z * 2.0, 2.0), 0.0), 0, 1);",
                         inputs, kWeight, 0.005);
        expectAsLavapipe(image, sampler, "sampler2DShadow",
                         "vec4 v = in_(i); return textureGatherOffset(tex, v.xy, v.z, ivec2(-3, 2));",
                         randomCoordinates({16, 16, 1}, -1, 2, 0.02f), 0, 0.005);
    }
}

TEST(Gather, componentsAndOffsets) {
    const LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {8, 8, 1});
    const std::vector<Vec4> inputs = randomCoordinates({16, 16, 1}, -1, 2, 0.02f);
    expectAsLavapipe(
        image, linear(VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT), "sampler2D",
        "vec4 v = in_(i); return textureGather(tex, v.xy, 2) + 2.0 * textureGatherOffset(tex, v.xy, ivec2(5, -8), 3);",
        inputs, 1e-5f);
    expectAsLavapipe(
        image, linear(VK_SAMPLER_ADDRESS_MODE_REPEAT), "sampler2D",
        "vec4 v = in_(i); const ivec2 o[4] = ivec2[](ivec2(1, 0), ivec2(-2, 3), ivec2(0, -5), ivec2(7, 7)); "
        "return textureGatherOffsets(tex, v.xy, o, 1);",
        inputs, 1e-6f);
}

TEST(Gather, oneTexelOfTheFour) {
    const LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {8, 8, 1});
    const std::vector<Vec4> inputs = randomCoordinates({16, 16, 1}, -1, 2, 0.02f);
    expectAsLavapipe(image, linear(), "sampler2D", "return vec4(textureGather(tex, in_(i).xy, 1).z);", inputs, 1e-6f);
}

TEST(Gradients, bothDirectionsCount) {
    const LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {64, 64, 1}, 7);
    LabSampler sampler = linear(VK_SAMPLER_ADDRESS_MODE_REPEAT);
    sampler.info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    const std::vector<Vec4> inputs = randomCoordinates(image.extent, 0, 1);
    const auto lab = vernier();
    const auto along = [&](const char* gradients) {
        return lab->look(image, sampler, "sampler2D",
                         std::string("vec4 v = in_(i); return textureGrad(tex, v.xy, ") + gradients + ");", inputs,
                         kArea);
    };
    const auto expected = along("vec2(0.25, 0.0), vec2(0.0)");
    EXPECT_EQ(along("vec2(0.0), vec2(0.25, 0.0)"), expected);
    EXPECT_EQ(along("vec2(0.0), vec2(0.0, 0.25)"), expected);
    EXPECT_EQ(along("vec2(0.0, 0.25), vec2(0.01, 0.0)"), expected);
}

TEST(Coordinates, unnormalized) {
    LabSampler sampler = linear();
    sampler.info.unnormalizedCoordinates = VK_TRUE;
    sampler.info.maxLod = 0;
    const LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {12, 9, 1});
    expectAsLavapipe(image, sampler, "sampler2D", "return textureLod(tex, in_(i).xy * 12.0, 0.0);",
                     randomCoordinates(image.extent, -0.5f, 1.5f), kWeight);
}

TEST(Coordinates, mirroredOnce) {
    const LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {12, 9, 1});
    expectAsLavapipe(image, linear(VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE), "sampler2D",
                     "return textureLod(tex, in_(i).xy, 0.0);", randomCoordinates(image.extent, -3, 3), kWeight, 0,
                     VK_KHR_SAMPLER_MIRROR_CLAMP_TO_EDGE_EXTENSION_NAME);
}

TEST(Aspects, depthAndStencilOfOneImage) {
    for (const VkFormat format : {VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT}) {
        LabImage image = noise(format, 1, {8, 8, 1});
        image.aspect = VK_IMAGE_ASPECT_STENCIL_BIT;
        LabSampler sampler;
        expectAsLavapipe(image, sampler, "usampler2D", "return vec4(textureLod(tex, in_(i).xy, 0.0));",
                         randomCoordinates(image.extent, 0, 1, 0.01f), 0);
    }
}

TEST(Formats, packedFourBits) {
    for (const VkFormat format : {VK_FORMAT_A4R4G4B4_UNORM_PACK16, VK_FORMAT_A4B4G4R4_UNORM_PACK16}) {
        LabImage image;
        image.format = format;
        image.extent = {16, 1, 1};
        image.data.emplace_back();
        for (int i = 0; i < 16; ++i) {
            const uint16_t texel = static_cast<uint16_t>(i << 12 | (15 - i) << 8 | (i ^ 5) << 4 | (i ^ 10));
            image.data[0].push_back(static_cast<uint8_t>(texel));
            image.data[0].push_back(static_cast<uint8_t>(texel >> 8));
        }
        const std::vector<Vec4> texels =
            vernier()->look(image, LabSampler(), "sampler2D", "return texelFetch(tex, at, 0);", {}, {16, 1});
        for (int i = 0; i < 16; ++i) {
            const auto unorm = [](int code) { return static_cast<float>(code) / 15; };
            const bool rgb = format == VK_FORMAT_A4R4G4B4_UNORM_PACK16;
            EXPECT_EQ(texels[static_cast<size_t>(i)],
                      (Vec4{unorm(rgb ? 15 - i : i ^ 10), unorm(i ^ 5), unorm(rgb ? i ^ 10 : 15 - i), unorm(i)}));
        }
        expectAsLavapipe(image, LabSampler(), "sampler2D", "return texelFetch(tex, ivec2(at.x % 16, 0), 0);", {}, 1e-6f,
                         0, VK_EXT_4444_FORMATS_EXTENSION_NAME);
    }
}

TEST(Levels, lowestLevelOfAView) {
    LabImage image;
    image.extent = {16, 16, 1};
    image.levels = 5;
    for (uint32_t level = 0; level < 5; ++level) {
        image.data.emplace_back(size_t{16u >> level} * (16u >> level) * 4, static_cast<uint8_t>(level * 51));
    }
    image.minLod = 1.5f;
    LabSampler sampler = linear();
    sampler.info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    const auto lab = vernier();
    const auto at = [&](const char* glsl) {
        return lab->look(image, sampler, "sampler2D", glsl, {}, {2, 2})[0][0] * 5;
    };
    EXPECT_FLOAT_EQ(at("return textureLod(tex, vec2(0.5), 0.0);"), 1.5f);
    EXPECT_FLOAT_EQ(at("return textureLod(tex, vec2(0.5), 3.25);"), 3.25f);
    EXPECT_FLOAT_EQ(at("return texelFetch(tex, ivec2(0), 1);"), 1);
    EXPECT_FLOAT_EQ(at("return texelFetch(tex, ivec2(0), 0);"), 0);
    sampler.info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
    EXPECT_FLOAT_EQ(at("return textureLod(tex, vec2(0.5), 0.0);"), 1);
}

TEST(Levels, queryTellsTheLevel) {
    const LabImage image = noise(VK_FORMAT_R8G8B8A8_UNORM, 4, {64, 64, 1}, 7);
    LabSampler sampler = linear(VK_SAMPLER_ADDRESS_MODE_REPEAT);
    sampler.info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    sampler.info.mipLodBias = 0.5f;
    const std::string glsl = "return vec4(textureQueryLod(tex, (vec2(at) + 0.5) * vec2(4.0, 1.0) / 64.0), 0, 0);";
    const auto lab = vernier();
    for (const Vec4& v : lab->look(image, sampler, "sampler2D", glsl, {}, kArea)) {
        EXPECT_NEAR(v[0], 2.5f, 1e-4f);
        EXPECT_NEAR(v[1], 2.5f, 1e-4f);
    }
    sampler.info.anisotropyEnable = VK_TRUE;
    sampler.info.maxAnisotropy = 2;
    for (const Vec4& v : lab->look(image, sampler, "sampler2D", glsl, {}, kArea)) EXPECT_NEAR(v[0], 1.5f, 1e-4f);
    sampler.info.maxAnisotropy = 16;
    for (const Vec4& v : lab->look(image, sampler, "sampler2D", glsl, {}, kArea)) EXPECT_NEAR(v[0], 0.5f, 1e-4f);
}

TEST(Views, blocksAsTexels) {
    // The blocks of a compressed image, seen as texels of two 32-bit words.
    LabImage image;
    image.format = VK_FORMAT_BC1_RGBA_UNORM_BLOCK;
    image.viewFormat = VK_FORMAT_R32G32_UINT;
    image.extent = {22, 13, 1};
    image.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_BLOCK_TEXEL_VIEW_COMPATIBLE_BIT;
    image.data.push_back(randomBytes(6 * 4 * 8, 5));
    const std::vector<Vec4> texels = vernier()->look(
        image, LabSampler(), "usampler2D",
        "uvec4 t = texelFetch(tex, at, 0); return vec4(t.xy & 0xffffu, textureSize(tex, 0));", {}, {6, 4});
    for (size_t i = 0; i < texels.size(); ++i) {
        const uint8_t* const block = &image.data[0][i * 8];
        EXPECT_EQ(texels[i], (Vec4{static_cast<float>(block[0] | block[1] << 8),
                                   static_cast<float>(block[4] | block[5] << 8), 6, 4}));
    }
}

TEST(Views, compressedCubesArraysAndLevels) {
    // Texels across blocks, faces, layers and levels, filtered: as lavapipe's within its 8-bit decoding.
    LabImage image = noise(VK_FORMAT_BC7_UNORM_BLOCK, 1, {4, 4, 1});
    image.extent = {24, 24, 1};
    image.levels = 5;
    image.layers = 12;
    image.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
    image.data.clear();
    for (uint32_t level = 0; level < 5; ++level) {
        const size_t blocks = std::max(1u, ((24u >> level) + 3) / 4);
        image.data.push_back(randomBytes(blocks * blocks * 12 * 16, level));
    }
    LabSampler sampler = linear(VK_SAMPLER_ADDRESS_MODE_REPEAT);
    sampler.info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    image.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    const std::vector<Vec4> inputs = randomCoordinates({1, 1, 1}, -1, 2);
    expectAsLavapipe(image, sampler, "sampler2DArray",
                     "vec4 v = in_(i); return textureLod(tex, vec3(v.xy, floor(v.z * 6.0)), v.w * 2.0);", inputs,
                     2 * kWeight);
    expectAsLavapipe(image, sampler, "sampler2DArray",
                     "vec4 v = in_(i); return textureGather(tex, vec3(v.xy, floor(v.z * 6.0)), 1);",
                     randomCoordinates({48, 48, 1}, -1, 2, 0.02f), 1e-6f);
    image.viewType = VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
    expectAsLavapipe(image, sampler, "samplerCubeArray",
                     "vec4 v = in_(i); return textureLod(tex, vec4(v.xyz, floor(v.w)), v.x);", inputs, 2 * kWeight,
                     0.01);
}

}  // namespace
}  // namespace vernier::test
