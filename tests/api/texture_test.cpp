// Images of all dimensions, compressed images, texel buffers and samplers, through vernier.h.
#include <gmock/gmock.h>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

const char* kFullScreen = R"(#version 450
layout(location = 0) out vec2 uv;
void main() { uv = vec2(gl_VertexIndex == 1 ? 2 : 0, gl_VertexIndex == 2 ? 2 : 0); gl_Position = vec4(uv * 2.0 - 1.0, 0, 1); })";

class TextureTest : public ApiTest {
  protected:
    VnImage make(VnImageDesc desc) {
        VnImage result{};
        EXPECT_EQ(vnCreateImage(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }
    VnSampler sampler(VnSamplerDesc desc) {
        VnSampler result{};
        EXPECT_EQ(vnCreateSampler(device_, &desc, &result), VN_SUCCESS) << lastError();
        return result;
    }
    void update(VnImage image, const VnRegion* region, const void* data, size_t size) {
        EXPECT_EQ(vnUpdateImage(context_, image, region, data, size), VN_SUCCESS) << lastError();
    }
    /// The pixels of a square that the fragment shader `body` ("color = ...") fills, from `tex` of GLSL type `type`.
    std::vector<uint32_t> draw(const std::string& type, const std::string& body, VnView view, VnSampler with,
                               uint32_t side) {
        EXPECT_EQ(vnBindTexture(context_, 0, 0, 0, view, with), VN_SUCCESS) << lastError();
        const VnProgram program_ =
            program(kFullScreen, "#version 450\nlayout(set = 0, binding = 0) uniform " + type +
                                     " tex;\nlayout(location = 0) in vec2 uv;\nlayout(location = 0) "
                                     "out vec4 color;\nvoid main() { " +
                                     body + " }");
        return drawFullScreen(image(VK_FORMAT_R8G8B8A8_UNORM, side, side), side, side, program_);
    }
};

TEST_F(TextureTest, oneDimension) {
    VnImageDesc desc{};
    desc.dimensions = 1;
    desc.width = 4;
    desc.layers = 2;
    const VnImage line = make(desc);
    const uint32_t rows[2][4] = {{1, 2, 3, 4}, {5, 6, 7, 8}};
    for (uint32_t layer = 0; layer < 2; ++layer) {
        VnRegion region{};
        region.layer = layer;
        update(line, &region, rows[layer], sizeof rows[layer]);
    }
    const auto pixels =
        draw("sampler1DArray", "color = texture(tex, vec2(uv.x, uv.y * 2.0 - 0.5));", view(line), sampler({}), 4);
    for (uint32_t i = 0; i < 16; ++i) EXPECT_EQ(pixels[i], rows[i / 8][i % 4]) << i;
}

TEST_F(TextureTest, threeDimensions) {
    VnImageDesc desc{};
    desc.dimensions = 3;
    desc.width = desc.height = 4;
    desc.depth = 3;
    const VnImage box = make(desc);
    std::vector<uint32_t> texels(48);
    for (uint32_t i = 0; i < 48; ++i) texels[i] = i * 0x01020304u;
    update(box, nullptr, texels.data(), 192);
    VnRegion slice{};
    slice.z = 2;
    std::vector<uint32_t> back(16);
    ASSERT_EQ(vnReadImage(context_, box, &slice, back.data(), 64), VN_SUCCESS) << lastError();
    for (uint32_t i = 0; i < 16; ++i) EXPECT_EQ(back[i], texels[32 + i]);
    const auto pixels = draw("sampler3D", "color = texture(tex, vec3(uv, 0.5));", view(box), sampler({}), 4);
    for (uint32_t i = 0; i < 16; ++i) EXPECT_EQ(pixels[i], texels[16 + i]);

    // A slice as a 2D image: drawn to, then copied on.
    VnViewDesc sliceView{};
    sliceView.image = box;
    sliceView.slices = 1;
    sliceView.baseLayer = 1;
    sliceView.layerCount = 1;
    VnView one{};
    ASSERT_EQ(vnCreateView(device_, &sliceView, &one), VN_SUCCESS) << lastError();
    VnPassDesc pass{};
    pass.colors[0].view = one;
    pass.colors[0].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    pass.colors[0].clear.color = {{1, 0, 0, 1}};
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    slice.z = 1;
    VnRegion whole{};
    const VnImage flat = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4);
    whole.depth = slice.depth = 1;
    ASSERT_EQ(vnCopyImage(context_, box, &slice, flat, &whole), VN_SUCCESS) << lastError();
    for (const uint32_t pixel : read(flat, 4, 4)) EXPECT_EQ(pixel, 0xff0000ffu);
    pass.colors[0].view = view(box);
    EXPECT_NE(vnBeginPass(context_, &pass), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("view is 3D"));
    slice.z = 3;
    EXPECT_NE(vnReadImage(context_, box, &slice, back.data(), 64), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("is not inside the level's 4 x 4 x 3"));
}

TEST_F(TextureTest, compressedImages) {
    VnImageDesc desc{};
    desc.format = VK_FORMAT_BC1_RGBA_UNORM_BLOCK;
    desc.width = 10;
    desc.height = 6;
    desc.mipLevels = VN_ALL_MIPS;
    const VnImage blocks = make(desc);
    // Solid colours per block: red 5:6:5 codes count the blocks.
    uint16_t data[6][4] = {};
    for (uint16_t i = 0; i < 6; ++i) data[i][0] = static_cast<uint16_t>((i + 1) << 11);
    update(blocks, nullptr, data, sizeof data);
    const auto pixels = draw("sampler2D", "color = texelFetch(tex, ivec2(uv * vec2(10, 6)), 0) * 31.0 / 255.0;",
                             view(blocks), sampler({}), 60);
    EXPECT_EQ(pixels[0] & 255, 1u);
    EXPECT_EQ(pixels[59] & 255, 3u);
    EXPECT_EQ(pixels[59 * 60] & 255, 4u);
    EXPECT_EQ(pixels[59 * 60 + 30] & 255, 5u);
    // Levels smaller than a block are one block; regions are made of whole ones.
    VnRegion region{};
    region.mip = 3;
    update(blocks, &region, data[3], 8);
    uint16_t back[4] = {};
    ASSERT_EQ(vnReadImage(context_, blocks, &region, back, sizeof back), VN_SUCCESS) << lastError();
    EXPECT_EQ(back[0], data[3][0]);
    region = {};
    region.x = 4;
    region.y = 4;
    ASSERT_EQ(vnReadImage(context_, blocks, &region, data, 16), VN_SUCCESS) << lastError();
    EXPECT_EQ(data[1][0], 6 << 11);
    region.x = 2;
    EXPECT_NE(vnReadImage(context_, blocks, &region, data, 48), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("cuts blocks of 4 x 4 texels"));
    // Blocks to texels of the same size and back.
    const VnImage words = image(VK_FORMAT_R16G16B16A16_UINT, 3, 2);
    ASSERT_EQ(vnCopyImage(context_, blocks, nullptr, words, nullptr), VN_SUCCESS) << lastError();
    uint16_t copied[6][4];
    ASSERT_EQ(vnReadImage(context_, words, nullptr, copied, sizeof copied), VN_SUCCESS);
    for (uint16_t i = 0; i < 6; ++i) EXPECT_EQ(copied[i][0], (i + 1) << 11);
    // Blitted from, never to; not drawn to, cleared or mipmapped.
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 10, 6);
    ASSERT_EQ(vnBlitImage(context_, blocks, nullptr, target, nullptr, VK_FILTER_NEAREST), VN_SUCCESS) << lastError();
    EXPECT_EQ(read(target, 10, 6)[59] & 255, 49u);  // round(6 / 31 * 255)
    EXPECT_NE(vnBlitImage(context_, target, nullptr, blocks, nullptr, VK_FILTER_NEAREST), VN_SUCCESS);
    EXPECT_NE(vnGenerateMips(context_, blocks), VN_SUCCESS);
    const VkClearColorValue black{};
    EXPECT_NE(vnClearImage(context_, blocks, &black), VN_SUCCESS);
    VnPassDesc pass{};
    pass.colors[0].view = view(blocks);
    EXPECT_NE(vnBeginPass(context_, &pass), VN_SUCCESS);
}

TEST_F(TextureTest, texelBuffers) {
    const uint8_t bytes[64] = {255, 0, 0, 255, 0, 255, 0, 255};
    const VnBuffer colors = buffer(bytes, sizeof bytes);
    VnProgramDesc desc{};
    desc.compute = shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(#version 450
layout(local_size_x = 4) in;
layout(set = 0, binding = 0) uniform samplerBuffer from;
layout(set = 0, binding = 1, r32ui) uniform uimageBuffer to;
void main() {
    int i = int(gl_GlobalInvocationID.x);
    imageStore(to, i, uvec4(texelFetch(from, i).rg * 100.0, textureSize(from), 0).rgbr + uvec4(i < 2 ? texelFetch(from, i).g * 50.0 : 7.0));
})");
    VnProgram computing{};
    ASSERT_EQ(vnCreateProgram(device_, &desc, &computing), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindProgram(context_, computing), VN_SUCCESS);
    EXPECT_NE(vnDispatch(context_, 1, 1, 1), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("nothing of its type is bound"));
    const VnBuffer numbers = buffer(nullptr, 64);
    ASSERT_EQ(vnBindTexelBuffer(context_, 0, 0, 0, colors, VK_FORMAT_R8G8B8A8_UNORM, 0, 8), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnBindTexelBuffer(context_, 0, 1, 0, numbers, VK_FORMAT_R32_UINT, 16, 0), VN_SUCCESS) << lastError();
    ASSERT_EQ(vnDispatch(context_, 1, 1, 1), VN_SUCCESS) << lastError();
    uint32_t result[16];
    ASSERT_EQ(vnReadBuffer(context_, numbers, 0, result, sizeof result), VN_SUCCESS);
    EXPECT_THAT(result, testing::ElementsAre(0, 0, 0, 0, 100, 50, 7, 7, 0, 0, 0, 0, 0, 0, 0, 0));
    EXPECT_NE(vnBindTexelBuffer(context_, 0, 0, 0, colors, VK_FORMAT_R32_UINT, 2, 0), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("offset 2"));
    EXPECT_NE(vnBindTexelBuffer(context_, 0, 0, 0, colors, VK_FORMAT_D16_UNORM, 0, 0), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("cannot be that of a texel buffer"));
}

TEST_F(TextureTest, samplers) {
    const VnImage two = image(VK_FORMAT_R8G8B8A8_UNORM, 2, 2);
    const uint32_t texels[4] = {0xff000010, 0xff000050, 0xff000090, 0xff0000d0};
    update(two, nullptr, texels, sizeof texels);
    VnSamplerDesc desc{};
    desc.magFilter = desc.minFilter = VK_FILTER_LINEAR;
    desc.reduction = VK_SAMPLER_REDUCTION_MODE_MAX;
    EXPECT_EQ(draw("sampler2D", "color = textureLod(tex, vec2(0.45, 0.45), 0.0);", view(two), sampler(desc), 1)[0],
              texels[3]);
    desc.reduction = VK_SAMPLER_REDUCTION_MODE_MIN;
    EXPECT_EQ(draw("sampler2D", "color = textureLod(tex, vec2(0.45, 0.45), 0.0);", view(two), sampler(desc), 1)[0],
              texels[0]);
    desc = {};
    desc.addressU = desc.addressV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    desc.borderColor = VK_BORDER_COLOR_FLOAT_CUSTOM_EXT;
    desc.customBorderColor = {.float32 = {0.2f, 0.4f, 0.6f, 0.8f}};
    EXPECT_EQ(draw("sampler2D", "color = textureLod(tex, vec2(2.0, 0.5), 0.0);", view(two), sampler(desc), 1)[0],
              0xcc996633u);
    desc = {};
    desc.unnormalized = 1;
    desc.addressU = desc.addressV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    EXPECT_EQ(draw("sampler2D", "color = textureLod(tex, vec2(1.5, 0.5), 0.0);", view(two), sampler(desc), 1)[0],
              texels[1]);
    // 2 : 1 along x: two samples, at thirds of the two texels.
    desc = {};
    desc.magFilter = desc.minFilter = VK_FILTER_LINEAR;
    desc.maxAnisotropy = 2;
    EXPECT_EQ(draw("sampler2D", "color = textureGrad(tex, vec2(0.5, 0.25), vec2(1.0, 0.0), vec2(0.0, 0.5));", view(two),
                   sampler(desc), 1)[0] &
                  255,
              0x30u);
    desc.maxAnisotropy = 17;
    VnSampler none{};
    EXPECT_NE(vnCreateSampler(device_, &desc, &none), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("maxAnisotropy is 17"));
    desc.maxAnisotropy = 0;
    desc.reduction = static_cast<VkSamplerReductionMode>(3);
    EXPECT_NE(vnCreateSampler(device_, &desc, &none), VN_SUCCESS);
    EXPECT_THAT(lastError(), HasSubstr("reduction is 3"));
}

}  // namespace
}  // namespace vernier::test
