// Memory runs out at every allocation of a small program, one after the other, once for a moment and once for good:
// each time the call says so, nothing is lost, and the device can still be destroyed. This program replaces operator
// new, so that it is one of its own.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <functional>
#include <new>

#include "tests/api/fixture.h"

namespace {

std::atomic<bool> armed{false};
std::atomic<bool> forGood{false};
std::atomic<int64_t> countdown{0};  // allocations that still succeed
std::atomic<int64_t> live{0};       // blocks taken and not given back, armed or not
std::atomic<int64_t> taken{0};      // bytes, given back or not

bool mayAllocate() {
    if (!armed.load()) return true;
    const int64_t left = countdown.fetch_sub(1);
    return forGood.load() ? left > 0 : left != 0;
}

void* take(size_t bytes, size_t alignment) {
    if (!mayAllocate()) return nullptr;
    void* memory = std::aligned_alloc(alignment, (std::max<size_t>(bytes, 1) + alignment - 1) / alignment * alignment);
    if (memory) {
        ++live;
        taken += static_cast<int64_t>(bytes);
    }
    return memory;
}

void give(void* memory) {
    if (!memory) return;
    --live;
    std::free(memory);
}

void* takeOrThrow(size_t bytes, size_t alignment) {
    if (void* memory = take(bytes, alignment)) return memory;
    throw std::bad_alloc();
}

constexpr size_t kDefault = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

}  // namespace

void* operator new(size_t bytes) {
    return takeOrThrow(bytes, kDefault);
}
void* operator new[](size_t bytes) {
    return takeOrThrow(bytes, kDefault);
}
void* operator new(size_t bytes, std::align_val_t alignment) {
    return takeOrThrow(bytes, static_cast<size_t>(alignment));
}
void* operator new[](size_t bytes, std::align_val_t alignment) {
    return takeOrThrow(bytes, static_cast<size_t>(alignment));
}
void* operator new(size_t bytes, const std::nothrow_t&) noexcept {
    return take(bytes, kDefault);
}
void* operator new[](size_t bytes, const std::nothrow_t&) noexcept {
    return take(bytes, kDefault);
}
void* operator new(size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
    return take(bytes, static_cast<size_t>(alignment));
}
void* operator new[](size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
    return take(bytes, static_cast<size_t>(alignment));
}
void operator delete(void* memory) noexcept {
    give(memory);
}
void operator delete[](void* memory) noexcept {
    give(memory);
}
void operator delete(void* memory, size_t) noexcept {
    give(memory);
}
void operator delete[](void* memory, size_t) noexcept {
    give(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    give(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
    give(memory);
}
void operator delete(void* memory, size_t, std::align_val_t) noexcept {
    give(memory);
}
void operator delete[](void* memory, size_t, std::align_val_t) noexcept {
    give(memory);
}

namespace vernier::test {
namespace {

constexpr int64_t kStride = 7;  // so that the test takes a second
constexpr uint32_t kSize = 70;  // more than one tile

/// What the program under test is made of, prepared while memory is plenty.
struct Parts {
    std::vector<uint32_t> vertex = compileGlsl(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) in vec2 position;
layout(location = 0) out vec2 where;
void main() { where = position; gl_Position = vec4(position, 0.5, 1.0); })");
    std::vector<uint32_t> fragment = compileGlsl(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) in vec2 where;
layout(set = 0, binding = 0) uniform sampler2D picture;
layout(set = 0, binding = 1) uniform Block { vec4 tint; };
layout(location = 0) out vec4 color;
void main() { color = texture(picture, where) * tint; })");
    std::vector<uint32_t> compute = compileGlsl(VK_SHADER_STAGE_COMPUTE_BIT, R"(#version 450
layout(local_size_x = 64) in;
layout(set = 0, binding = 1, std430) buffer Block { vec4 tint[]; };
shared float sum[64];
void main() {
    sum[gl_LocalInvocationIndex] = 0.25;
    barrier();
    if (gl_GlobalInvocationID.x < 4u) tint[gl_GlobalInvocationID.x] = vec4(sum[63u - gl_LocalInvocationIndex] * 4.0);
})");
    std::vector<uint32_t> texels = std::vector<uint32_t>(16 * 16, 0xFFFFFFFFu);
    std::vector<uint32_t> pixels = std::vector<uint32_t>(kSize * kSize);
};

/// The outcome of the run: the first result that was no success, and whether what was drawn is right.
struct Outcome {
    VnResult result = VN_SUCCESS;
    bool drawn = false;
    bool inShader = false;  // it failed in vnCreateShader
};

class SmallProgram {
  public:
    explicit SmallProgram(Parts& parts) : parts_(parts) {}

    Outcome operator()() {
        Outcome outcome;
        outcome.result = all();
        if (device_) {
            // The text of an error is there even when memory was not.
            char text[256];
            const size_t length = vnGetError(device_, text, sizeof text);
            EXPECT_EQ(length > 0, outcome.result != VN_SUCCESS);
        }
        vnDestroyDevice(device_);
        outcome.inShader = inShader_;
        outcome.drawn = outcome.result == VN_SUCCESS;
        for (const uint32_t pixel : parts_.pixels) outcome.drawn = outcome.drawn && pixel == 0xFFFFFFFFu;
        return outcome;
    }

  private:
#define TRY(call) \
    if (const VnResult tried = (call); tried != VN_SUCCESS) return tried
    VnResult all() {
        VnDeviceDesc deviceDesc{};
        deviceDesc.threads = 3;
        TRY(vnCreateDevice(&deviceDesc, &device_));
        TRY(vnCreateContext(device_, nullptr, &context_));
        TRY(makePrograms());
        TRY(draw());
        return VN_SUCCESS;
    }

    VnResult makeShader(VkShaderStageFlagBits stage, const std::vector<uint32_t>& words, VnShader* shader) {
        VnShaderDesc desc{};
        desc.stage = stage;
        desc.words = words.data();
        desc.wordCount = words.size();
        const VnResult result = vnCreateShader(device_, &desc, shader);
        inShader_ = result != VN_SUCCESS;
        return result;
    }

    VnResult makePrograms() {
        VnProgramDesc desc{};
        TRY(makeShader(VK_SHADER_STAGE_VERTEX_BIT, parts_.vertex, &desc.vertex));
        TRY(makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, parts_.fragment, &desc.fragment));
        TRY(vnCreateProgram(device_, &desc, &program_));
        desc = {};
        TRY(makeShader(VK_SHADER_STAGE_COMPUTE_BIT, parts_.compute, &desc.compute));
        return vnCreateProgram(device_, &desc, &compute_);
    }

    VnResult draw() {
        static const float corners[] = {-1, -1, 3, -1, -1, 3};
        const VnBufferDesc cornerDesc{0, sizeof corners, corners, 0}, tintDesc{0, 64, nullptr, 0};
        VnBuffer vertices{}, tint{};
        TRY(vnCreateBuffer(device_, &cornerDesc, &vertices));
        TRY(vnCreateBuffer(device_, &tintDesc, &tint));
        VnImageDesc imageDesc{};
        imageDesc.width = imageDesc.height = 16;
        imageDesc.mipLevels = VN_ALL_MIPS;
        VnImage picture{}, target{};
        TRY(vnCreateImage(device_, &imageDesc, &picture));
        imageDesc.width = imageDesc.height = kSize;
        imageDesc.mipLevels = 1;
        TRY(vnCreateImage(device_, &imageDesc, &target));
        const VnVertexAttribute attribute{0, 0, VK_FORMAT_R32G32_SFLOAT, 0};
        const VnVertexBinding binding{8, 0};
        const VnVertexLayoutDesc layoutDesc{0, &attribute, 1, &binding, 1, 0};
        VnVertexLayout layout{};
        TRY(vnCreateVertexLayout(device_, &layoutDesc, &layout));
        const VnSamplerDesc samplerDesc{};
        VnSampler sampler{};
        TRY(vnCreateSampler(device_, &samplerDesc, &sampler));
        VnView view{};
        VnPassDesc pass{};
        TRY(vnGetImageView(device_, picture, &view));
        TRY(vnGetImageView(device_, target, &pass.colors[0].view));
        TRY(vnUpdateImage(context_, picture, nullptr, parts_.texels.data(), parts_.texels.size() * 4));
        TRY(vnGenerateMips(context_, picture));
        TRY(vnBindBuffer(context_, 0, 1, 0, tint, 0, 0));
        TRY(vnBindTexture(context_, 0, 0, 0, view, sampler));
        TRY(vnBindProgram(context_, compute_));
        TRY(vnDispatch(context_, 40, 1, 1));
        TRY(vnFlush(context_));
        TRY(vnBeginPass(context_, &pass));
        TRY(vnBindProgram(context_, program_));
        TRY(vnBindVertexLayout(context_, layout));
        TRY(vnBindVertexBuffer(context_, 0, vertices, 0));
        TRY(vnDraw(context_, 3, 1, 0, 0));
        TRY(vnEndPass(context_));
        return vnReadImage(context_, target, nullptr, parts_.pixels.data(), parts_.pixels.size() * 4);
    }
#undef TRY

    Parts& parts_;
    VnDevice device_ = nullptr;
    VnContext context_ = nullptr;
    VnProgram program_{}, compute_{};
    bool inShader_ = false;
};

class MemoryFailure : public testing::TestWithParam<bool> {};

TEST_P(MemoryFailure, AtEveryAllocation) {
    Parts parts;
    EXPECT_TRUE(SmallProgram(parts)().drawn);  // what is made once for the process is made now
    forGood = GetParam();
    constexpr int64_t kMost = int64_t{1} << 40;
    countdown = kMost;
    armed = true;
    const bool drawn = SmallProgram(parts)().drawn;
    armed = false;
    EXPECT_TRUE(drawn);
    const int64_t total = kMost - countdown.load();
    ASSERT_GT(total, 500);
    int64_t failures = 0;
    for (int64_t n = 0; n < total; n += kStride) {
        std::fill(parts.pixels.begin(), parts.pixels.end(), 0u);
        const int64_t before = live.load();
        countdown = n;
        armed = true;
        const Outcome outcome = SmallProgram(parts)();
        armed = false;
        // SPIRV-Tools is built without exceptions: what it holds while one passes through it is lost.
        if (!outcome.inShader) {
            ASSERT_EQ(live.load(), before) << "allocation " << n << " of " << total << " left blocks behind";
        }
        failures += outcome.result != VN_SUCCESS;
        // Work that other threads had taken over is lost with the device. Code that can do without its memory (a larger
        // buffer of the C++ library, for one) goes on, and then the picture is right.
        if (outcome.result == VN_SUCCESS) {
            ASSERT_TRUE(outcome.drawn) << "allocation " << n << " of " << total;
        } else {
            ASSERT_THAT(outcome.result, testing::AnyOf(VN_ERROR_OUT_OF_MEMORY, VN_ERROR_DEVICE_LOST))
                << "allocation " << n << " of " << total;
        }
    }
    EXPECT_GT(failures, total / kStride * 9 / 10);
}

class FrameMemory : public ApiTest {};

TEST_F(FrameMemory, IsKeptBetweenFrames) {
    constexpr uint32_t kTriangles = 20000;
    const VnImage target = image(VK_FORMAT_R8G8B8A8_UNORM, 256, 256);
    const VnProgram many = program(R"(#version 450
layout(location = 0) out vec4 shade;
void main() {
    int n = gl_VertexIndex / 3, corner = gl_VertexIndex % 3;
    shade = vec4(n % 7, n % 5, n % 3, 1.0) / 7.0;
    gl_Position = vec4(vec2(n % 141, n / 141) / 71.0 - 1.0 + vec2(corner & 1, corner >> 1) * 0.02, 0.5, 1.0);
})",
                                   R"(#version 450
layout(location = 0) in vec4 shade;
layout(location = 0) out vec4 color;
void main() { color = shade; })");
    const auto frame = [&] {
        const int64_t before = taken.load();
        const VnPassDesc pass = passOn(target);
        for (int passes = 0; passes < 2; ++passes) {
            EXPECT_EQ(vnBeginPass(context_, &pass), VN_SUCCESS) << lastError();
            EXPECT_EQ(vnBindProgram(context_, many), VN_SUCCESS);
            EXPECT_EQ(vnDraw(context_, kTriangles * 3, 1, 0, 0), VN_SUCCESS) << lastError();
            EXPECT_EQ(vnEndPass(context_), VN_SUCCESS);
        }
        EXPECT_EQ(vnFinish(context_), VN_SUCCESS);
        return taken.load() - before;
    };
    // Triangles alone take megabytes; what threads and passes keep grows until each has met its largest share.
    constexpr int64_t kMegabyte = 1 << 20;
    EXPECT_GT(frame(), 2 * kMegabyte);
    for (int n = 0; n < 20; ++n) frame();
    int64_t least = INT64_MAX;
    for (int n = 0; n < 10; ++n) least = std::min(least, frame());
    EXPECT_LT(least, kMegabyte / 4) << "only what is recorded is new";
}

INSTANTIATE_TEST_SUITE_P(Memory, MemoryFailure, testing::Values(false, true),
                         [](const auto& param) { return param.param ? "ForGood" : "ForAMoment"; });

}  // namespace
}  // namespace vernier::test
