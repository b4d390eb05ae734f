// Every wrong call gets its code and a message that names what was wrong, and the device goes on working.
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class BadInput : public ApiTest {
  protected:
    void TearDown() override {
        // Whatever a test did wrong: a white picture can still be drawn.
        const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 9, 7);
        EXPECT_THAT(drawFullScreen(target, 9, 7, program(kFullScreenVertex, kWhiteFragment)),
                    testing::Each(0xFFFFFFFFu));
        ApiTest::TearDown();
    }
    void expect(VnResult actual, VnResult expected, const std::string& text) {
        EXPECT_EQ(actual, expected);
        EXPECT_THAT(lastError(), HasSubstr(text));
        ASSERT_FALSE(messages_.empty());
        EXPECT_EQ(messages_.back(), lastError());
    }
};

TEST_F(BadInput, UninitialisedDescriptorsAreCaught) {
    VnBufferDesc buffer;
    std::memset(&buffer, 0xCD, sizeof buffer);
    VnBuffer handle{};
    expect(vnCreateBuffer(device_, &buffer, &handle), VN_ERROR_INVALID_ARGUMENT, "not initialised");
    VnPassDesc pass;
    std::memset(&pass, 0xCD, sizeof pass);
    expect(vnBeginPass(context_, &pass), VN_ERROR_INVALID_ARGUMENT, "not initialised");
    VnDeviceDesc device;
    std::memset(&device, 0xCD, sizeof device);
    VnDevice other = nullptr;
    EXPECT_EQ(vnCreateDevice(&device, &other), VN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(other, nullptr);
}

TEST_F(BadInput, NullPointersAndNullHandles) {
    EXPECT_EQ(vnCreateBuffer(nullptr, nullptr, nullptr), VN_ERROR_INVALID_HANDLE);
    EXPECT_EQ(vnDraw(nullptr, 3, 1, 0, 0), VN_ERROR_INVALID_HANDLE);
    EXPECT_EQ(vnGetError(nullptr, nullptr, 0), 0u);
    VnBuffer buffer{};
    expect(vnCreateBuffer(device_, nullptr, &buffer), VN_ERROR_INVALID_ARGUMENT, "desc is NULL");
    const VnBufferDesc desc{0, 4, nullptr, 0};
    expect(vnCreateBuffer(device_, &desc, nullptr), VN_ERROR_INVALID_ARGUMENT, "handle is NULL");
    expect(vnBindProgram(context_, VnProgram{12345}), VN_ERROR_INVALID_HANDLE, "program is null, destroyed");
    expect(vnUpdateBuffer(context_, VnBuffer{}, 0, "", 1), VN_ERROR_INVALID_HANDLE, "buffer is null, destroyed");
    vnDestroyDevice(nullptr);
    vnDestroyContext(nullptr);
}

TEST_F(BadInput, DestroyedAndForeignObjects) {
    const VnBuffer first = buffer(nullptr, 16);
    EXPECT_EQ(vnDestroyBuffer(device_, first), VN_SUCCESS);
    expect(vnDestroyBuffer(device_, first), VN_ERROR_INVALID_HANDLE, "buffer is null, destroyed");
    const VnBuffer second = buffer(nullptr, 16);  // may take the same slot
    EXPECT_NE(first.id, second.id);
    expect(vnFillBuffer(context_, first, 0, 16, 0), VN_ERROR_INVALID_HANDLE, "buffer is null, destroyed");

    VnDevice other = nullptr;
    ASSERT_EQ(vnCreateDevice(nullptr, &other), VN_SUCCESS);
    VnImageDesc desc{};
    desc.width = desc.height = 4;
    VnImage foreign{};
    ASSERT_EQ(vnCreateImage(other, &desc, &foreign), VN_SUCCESS);
    VnView view{};
    expect(vnGetImageView(device_, foreign, &view), VN_ERROR_INVALID_HANDLE, "image is null, destroyed, or of another");
    vnDestroyDevice(other);
}

TEST_F(BadInput, ObjectsDestroyedWhileInUseLiveUntilTheWorkIsDone) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 16, 16);
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    const VnBuffer unused = buffer(nullptr, 64);
    VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    ASSERT_EQ(vnBindVertexBuffer(context_, 0, unused, 0), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, white), VN_SUCCESS);
    ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS);
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_EQ(vnDestroyProgram(device_, white), VN_SUCCESS);
    EXPECT_EQ(vnDestroyBuffer(device_, unused), VN_SUCCESS);
    EXPECT_THAT(read(target, 16, 16), testing::Each(0xFFFFFFFFu));
    EXPECT_EQ(vnDestroyImage(device_, target), VN_SUCCESS);
    EXPECT_EQ(vnFinish(context_), VN_SUCCESS);
}

TEST_F(BadInput, SizesAndFormats) {
    VnBuffer buffer{};
    VnBufferDesc zero{};
    expect(vnCreateBuffer(device_, &zero, &buffer), VN_ERROR_INVALID_ARGUMENT, "size is 0");
    VnBufferDesc huge{};
    huge.size = UINT64_MAX;
    expect(vnCreateBuffer(device_, &huge, &buffer), VN_ERROR_OUT_OF_MEMORY, "18446744073709551615 bytes");
    VnImage made{};
    const auto create = [&](VkFormat format, uint32_t width, uint32_t height, uint32_t mips) {
        VnImageDesc desc{};
        desc.format = format;
        desc.width = width;
        desc.height = height;
        desc.mipLevels = mips;
        return vnCreateImage(device_, &desc, &made);
    };
    expect(create(VK_FORMAT_R8G8B8A8_UNORM, 0, 4, 1), VN_ERROR_INVALID_ARGUMENT, "width is 0");
    expect(create(VK_FORMAT_R8G8B8A8_UNORM, 4, 1u << 20, 1), VN_ERROR_INVALID_ARGUMENT, "height is 1048576");
    expect(create(VK_FORMAT_R8G8B8A8_UNORM, 4, 4, 9), VN_ERROR_INVALID_ARGUMENT, "mip levels is 9");
    expect(create(static_cast<VkFormat>(424242), 4, 4, 1), VN_ERROR_UNSUPPORTED, "format 424242");
    const VnImage color = image(VK_FORMAT_R8G8B8A8_UNORM, 4, 4);
    VnViewDesc desc{};
    desc.image = color;
    desc.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    VnView view{};
    expect(vnCreateView(device_, &desc, &view), VN_ERROR_INVALID_ARGUMENT, "R16G16B16A16_SFLOAT does not fit");
    desc.format = VK_FORMAT_UNDEFINED;
    desc.baseMip = 3;
    expect(vnCreateView(device_, &desc, &view), VN_ERROR_INVALID_ARGUMENT, "mip levels 3 + ");
}

TEST_F(BadInput, RegionsOutsideTheImage) {
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8);
    std::vector<uint32_t> pixels(64);
    VnRegion region{};
    region.x = 4;
    region.width = 5;
    expect(vnReadImage(context_, target, &region, pixels.data(), 256), VN_ERROR_INVALID_ARGUMENT,
           "is not inside the level's 8 x 8");
    region = {};
    region.mip = 1;
    expect(vnUpdateImage(context_, target, &region, pixels.data(), 256), VN_ERROR_INVALID_ARGUMENT, "mip 1, layer 0");
    expect(vnUpdateImage(context_, target, nullptr, pixels.data(), 255), VN_ERROR_INVALID_ARGUMENT,
           "needs 256 bytes, data has 255");
    region = {};
    region.x = region.width = 0xFFFFFFFF;
    expect(vnUpdateImage(context_, target, &region, pixels.data(), 256), VN_ERROR_INVALID_ARGUMENT, "is not inside");
}

TEST_F(BadInput, CommandsInTheWrongOrder) {
    const VnProgram white = program(kFullScreenVertex, kWhiteFragment);
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8);
    expect(vnDraw(context_, 3, 1, 0, 0), VN_ERROR_INVALID_STATE, "no pass is open");
    expect(vnEndPass(context_), VN_ERROR_INVALID_STATE, "no pass is open");
    VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    expect(vnDraw(context_, 3, 1, 0, 0), VN_ERROR_INVALID_STATE, "no program is bound");
    expect(vnBeginPass(context_, &pass), VN_ERROR_INVALID_STATE, "a pass is open already");
    expect(vnFlush(context_), VN_ERROR_INVALID_STATE, "a pass is open");
    expect(vnGenerateMips(context_, target), VN_ERROR_INVALID_STATE, "a pass is open");
    ASSERT_EQ(vnBindProgram(context_, white), VN_SUCCESS);
    expect(vnDrawIndexed(context_, 3, 1, 0, 0, 0), VN_ERROR_INVALID_STATE, "no index buffer");
    EXPECT_EQ(vnEndPass(context_), VN_SUCCESS);
}

TEST_F(BadInput, PassesThatDoNotFit) {
    VnPassDesc none{};
    expect(vnBeginPass(context_, &none), VN_ERROR_INVALID_ARGUMENT, "there is no attachment");
    VnPassDesc pass = passOn(image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8));
    pass.renderArea = {{4, 4}, {8, 2}};
    expect(vnBeginPass(context_, &pass), VN_ERROR_INVALID_ARGUMENT,
           "renderArea is not inside the attachments of 8 x 8");
    pass.renderArea = {};
    pass.depthStencil.view = view(image(VK_FORMAT_D32_SFLOAT, 8, 8, 1, 4));
    expect(vnBeginPass(context_, &pass), VN_ERROR_INVALID_ARGUMENT, "depthStencil has 4 samples, the others have 1");
    pass.depthStencil.view = pass.colors[0].view;
    expect(vnBeginPass(context_, &pass), VN_ERROR_UNSUPPORTED, "R8G8B8A8_UNORM of depthStencil cannot be drawn to");
}

TEST_F(BadInput, NotANumberAndOutOfRangeState) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const VkViewport viewports[] = {
        {nan, 0, 8, 8, 0, 1}, {0, 0, 1e9f, 8, 0, 1}, {0, 0, -1, 8, 0, 1}, {0, 0, 8, 8, nan, 1}, {0, 0, 8, 8, 0, 1.5f}};
    const char* texts[] = {"is nan", "beyond", "width is -1", "depth range nan", "depth range 0.000000 .. 1.5"};
    for (size_t i = 0; i < std::size(viewports); ++i)
        expect(vnSetViewport(context_, &viewports[i]), VN_ERROR_INVALID_ARGUMENT, texts[i]);
    const VkRect2D scissor{{-1, 0}, {4, 4}};
    expect(vnSetScissor(context_, &scissor), VN_ERROR_INVALID_ARGUMENT, "offset is (-1, 0)");
    VnRasterStateDesc raster{};
    raster.lineWidth = nan;
    VnRasterState state{};
    expect(vnCreateRasterState(device_, &raster, &state), VN_ERROR_INVALID_ARGUMENT, "lineWidth is nan");
    raster = {};
    raster.cullMode = 77;
    expect(vnCreateRasterState(device_, &raster, &state), VN_ERROR_INVALID_ARGUMENT, "cullMode is 77");
    VnDepthStencilStateDesc depth{};
    depth.depthWrite = 1;
    VnDepthStencilState depthState{};
    expect(vnCreateDepthStencilState(device_, &depth, &depthState), VN_ERROR_INVALID_ARGUMENT,
           "depthWrite needs depthTest");
    const uint32_t data[80] = {};
    expect(vnPushConstants(context_, 200, data, 60), VN_ERROR_INVALID_ARGUMENT, "offset 200, size 60");
}

TEST_F(BadInput, ShadersThatAreBroken) {
    const std::vector<uint32_t> good = compileGlsl(VK_SHADER_STAGE_FRAGMENT_BIT, kWhiteFragment);
    const auto create = [&](const std::vector<uint32_t>& words, VkShaderStageFlagBits stage, const char* entry) {
        VnShaderDesc desc{};
        desc.stage = stage;
        desc.words = words.data();
        desc.wordCount = words.size();
        desc.entryPoint = entry;
        VnShader shader{};
        const VnResult result = vnCreateShader(device_, &desc, &shader);
        EXPECT_EQ(result == VN_SUCCESS, shader.id != 0);
        return result;
    };
    EXPECT_EQ(create(good, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr), VN_SUCCESS);
    expect(create(good, VK_SHADER_STAGE_FRAGMENT_BIT, "absent"), VN_ERROR_SHADER, "absent");
    EXPECT_EQ(create(good, VK_SHADER_STAGE_VERTEX_BIT, nullptr), VN_ERROR_SHADER);
    expect(create(good, VK_SHADER_STAGE_RAYGEN_BIT_KHR, nullptr), VN_ERROR_UNSUPPORTED, "stage is 256");
    expect(create(good, VK_SHADER_STAGE_GEOMETRY_BIT, nullptr), VN_ERROR_SHADER, "no geometry entry point");
    for (size_t cut = 1; cut < good.size(); ++cut) {
        const std::vector<uint32_t> broken(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(cut));
        EXPECT_EQ(create(broken, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr), VN_ERROR_SHADER) << "cut at word " << cut;
    }
    std::mt19937 random(7);
    for (int round = 0; round < 400; ++round) {
        std::vector<uint32_t> broken = good;
        broken[random() % broken.size()] ^= 1u << random() % 32;
        const VnResult result = create(broken, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr);
        EXPECT_THAT(result, testing::AnyOf(VN_SUCCESS, VN_ERROR_SHADER, VN_ERROR_UNSUPPORTED));
    }
}

TEST_F(BadInput, InterfacesThatDoNotMatch) {
    const VnShader vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) flat out ivec4 value;
void main() { value = ivec4(1); gl_Position = vec4(0); })");
    const VnShader fragment = shader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) in vec4 value;
layout(location = 0) out vec4 color;
void main() { color = value; })");
    VnProgramDesc desc{};
    desc.vertex = vertex;
    desc.fragment = fragment;
    VnProgram made{};
    expect(vnCreateProgram(device_, &desc, &made), VN_ERROR_SHADER, "location 0");
    desc.fragment = vertex;
    expect(vnCreateProgram(device_, &desc, &made), VN_ERROR_INVALID_HANDLE, "fragment shader");
}

TEST_F(BadInput, MissingResourcesAndVertexAttributesAreNamed) {
    const VnProgram reads = program(kFullScreenVertex, R"(#version 450
layout(set = 1, binding = 3) uniform Block { vec4 value; };
layout(location = 0) out vec4 color;
void main() { color = value; })");
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8);
    VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, reads), VN_SUCCESS);
    expect(vnDraw(context_, 3, 1, 0, 0), VN_ERROR_INVALID_STATE, "set 1, binding 3");
    const VnProgram attribute = program(R"(#version 450
layout(location = 5) in vec4 position;
void main() { gl_Position = position; })",
                                        kWhiteFragment);
    ASSERT_EQ(vnBindProgram(context_, attribute), VN_SUCCESS);
    const VnResult result = vnDraw(context_, 3, 1, 0, 0);
    expect(result, VN_ERROR_INVALID_ARGUMENT, "location 5");
    EXPECT_EQ(vnEndPass(context_), VN_SUCCESS);
}

TEST_F(BadInput, IndicesAndFetchesOutOfRangeReadZeros) {
    const VnProgram fetch = program(R"(#version 450
layout(location = 0) in vec2 position;
layout(location = 0) out vec2 seen;
void main() { seen = position; gl_Position = vec4(vec2(gl_VertexIndex & 1, (gl_VertexIndex >> 1) & 1) * 4.0 - 1.0, 0.0, 1.0); })",
                                    R"(#version 450
layout(location = 0) in vec2 seen;
layout(location = 0) out vec4 color;
void main() { color = vec4(seen, 1.0, 1.0); })");
    const VnVertexAttribute attribute{0, 0, VK_FORMAT_R32G32_SFLOAT, 0};
    const VnVertexBinding binding{8, 0};
    VnVertexLayoutDesc desc{};
    desc.attributes = &attribute;
    desc.attributeCount = 1;
    desc.bindings = &binding;
    desc.bindingCount = 1;
    VnVertexLayout layout{};
    ASSERT_EQ(vnCreateVertexLayout(device_, &desc, &layout), VN_SUCCESS);
    const float one[2] = {1, 1};
    const uint32_t indices[] = {0x40000000u, 0x40000001u, 0xFFFFFFFEu};
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8);
    VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, fetch), VN_SUCCESS);
    ASSERT_EQ(vnBindVertexLayout(context_, layout), VN_SUCCESS);
    ASSERT_EQ(vnBindVertexBuffer(context_, 0, buffer(one, sizeof one), 0), VN_SUCCESS);
    ASSERT_EQ(vnBindIndexBuffer(context_, buffer(indices, sizeof indices), 0, VK_INDEX_TYPE_UINT32), VN_SUCCESS);
    EXPECT_EQ(vnDrawIndexed(context_, 3, 1, 0, 0, 0), VN_SUCCESS);
    EXPECT_EQ(vnDrawIndexed(context_, 300, 1, 100, 0, 0), VN_SUCCESS);  // beyond the index buffer
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_THAT(read(target, 8, 8), testing::Each(0xFFFF0000u)) << "fetches outside the buffer gave 0";
}

TEST_F(BadInput, VerticesThatAreNotNumbersDrawNothing) {
    const VnProgram strange = program(R"(#version 450
layout(push_constant) uniform Push { vec4 value; };
void main() { gl_Position = gl_VertexIndex == 1 ? value : vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0); })",
                                      kWhiteFragment);
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const float values[][4] = {{nan, 0, 0, 1}, {0, nan, 0, 1}, {0, 0, nan, 1}, {0, 0, 0, nan}};
    for (const auto& value : values) {
        const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8);
        ASSERT_EQ(vnPushConstants(context_, 0, value, sizeof value), VN_SUCCESS);
        EXPECT_THAT(drawFullScreen(target, 8, 8, strange), testing::Each(0u));
    }
    const float extremes[][4] = {
        {inf, 0, 0, 1}, {3, -1, 0.5f, inf}, {1e38f, -1e38f, 1e38f, 1e-38f}, {3, -1, 0.5f, -0.0f}};
    for (const auto& value : extremes) {
        ASSERT_EQ(vnPushConstants(context_, 0, value, sizeof value), VN_SUCCESS);
        drawFullScreen(image(VK_FORMAT_R8G8B8A8_UNORM, 8, 8), 8, 8, strange);
    }
}

TEST_F(BadInput, LoopsThatNeverEndLoseTheDeviceAndSaySo) {
    VnDevice other = nullptr;
    ASSERT_EQ(vnCreateDevice(nullptr, &other), VN_SUCCESS);
    std::swap(device_, other);
    VnContext saved = context_;
    ASSERT_EQ(vnCreateContext(device_, nullptr, &context_), VN_SUCCESS);
    const VnProgram endless = program(kFullScreenVertex, R"(#version 450
layout(push_constant) uniform Push { int step; };
layout(location = 0) out vec4 color;
void main() { int i = 1; while (i != 0) i += step * 2; color = vec4(i); })");
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 2, 2);
    VnPassDesc pass = passOn(target);
    ASSERT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS);
    ASSERT_EQ(vnBindProgram(context_, endless), VN_SUCCESS);
    ASSERT_EQ(vnDraw(context_, 3, 1, 0, 0), VN_SUCCESS);
    ASSERT_EQ(vnEndPass(context_), VN_SUCCESS);
    EXPECT_EQ(vnFinish(context_), VN_ERROR_DEVICE_LOST);
    EXPECT_THAT(lastError(), HasSubstr("budget"));
    vnDestroyDevice(device_);
    device_ = other;
    context_ = saved;
}

struct FailingAllocator {
    int left = 0;
    static void* allocate(void* user, size_t bytes, size_t alignment) {
        auto* self = static_cast<FailingAllocator*>(user);
        return self->left-- > 0 ? std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment)
                                : nullptr;
    }
    static void release(void*, void* memory, size_t) { std::free(memory); }
};

TEST(OutOfMemory, OfTheCallersAllocatorIsReportedAndLosesNothing) {
    FailingAllocator allocator{2};
    VnDeviceDesc desc{};
    desc.allocator = {&allocator, FailingAllocator::allocate, FailingAllocator::release};
    VnDevice device = nullptr;
    ASSERT_EQ(vnCreateDevice(&desc, &device), VN_SUCCESS);
    VnBufferDesc bufferDesc{};
    bufferDesc.size = 100;
    VnBuffer first{}, second{}, third{};
    EXPECT_EQ(vnCreateBuffer(device, &bufferDesc, &first), VN_SUCCESS);
    VnImageDesc imageDesc{};
    imageDesc.width = imageDesc.height = 8;
    VnImage image{};
    EXPECT_EQ(vnCreateImage(device, &imageDesc, &image), VN_SUCCESS);
    EXPECT_EQ(vnCreateBuffer(device, &bufferDesc, &second), VN_ERROR_OUT_OF_MEMORY);
    EXPECT_EQ(second.id, 0u);
    EXPECT_EQ(vnCreateImage(device, &imageDesc, &image), VN_ERROR_OUT_OF_MEMORY);
    allocator.left = 1;
    EXPECT_EQ(vnCreateBuffer(device, &bufferDesc, &third), VN_SUCCESS);
    vnDestroyDevice(device);
    desc.allocator.release = nullptr;
    EXPECT_EQ(vnCreateDevice(&desc, &device), VN_ERROR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace vernier::test
