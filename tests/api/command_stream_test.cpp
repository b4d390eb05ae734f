// Random streams of commands: what runs side by side gives what the commands give one after the other, with any number
// of threads, in memory and in what is counted.
#include <algorithm>
#include <array>
#include <random>

#include "tests/api/fixture.h"

namespace vernier::test {
namespace {

constexpr uint32_t kWidth = 80, kHeight = 72, kMips = 3, kImages = 4, kLayers = 2, kBuffers = 4, kWords = 1024,
                   kSlot = 256;

constexpr const char* kTriangles = R"(#version 450
layout(push_constant) uniform Push { vec4 place; vec4 tint; };
layout(location = 0) flat out vec4 color;
void main() {
    int triangle = gl_VertexIndex / 3, corner = gl_VertexIndex % 3;
    vec2 at = place.xy + vec2(triangle % 5, triangle / 5) * 0.3 + vec2(corner & 1, corner >> 1) * place.zw;
    gl_Position = vec4(at, fract(float(triangle) * 0.37 + tint.x), 1.0);
    color = tint;
})";

/// Colours from a buffer: something for the vertex stage to wait for.
constexpr const char* kBufferTriangles = R"(#version 450
layout(push_constant) uniform Push { vec4 place; vec4 tint; };
layout(set = 0, binding = 0) readonly buffer Words { uint words[]; };
layout(location = 0) flat out vec4 color;
void main() {
    int triangle = gl_VertexIndex / 3, corner = gl_VertexIndex % 3;
    uint word = words[triangle * 7];
    vec2 at = place.xy + vec2(word & 15u, word >> 4 & 15u) * 0.08 + vec2(corner & 1, corner >> 1) * place.zw;
    gl_Position = vec4(at, 0.5, 1.0);
    color = unpackUnorm4x8(word * 2654435761u);
})";

constexpr const char* kFlat = R"(#version 450
layout(location = 0) flat in vec4 color;
layout(location = 0) out vec4 result;
void main() { result = color; })";

constexpr const char* kTextured = R"(#version 450
#extension GL_EXT_samplerless_texture_functions : require
layout(set = 0, binding = 1) uniform texture2D image;
layout(location = 0) flat in vec4 color;
layout(location = 0) out vec4 result;
void main() {
    ivec2 size = textureSize(image, 0);
    result = texelFetch(image, ivec2(gl_FragCoord.xy) % size, 0) * 0.5 + color * 0.5;
})";

/// Counts its fragments in a buffer.
constexpr const char* kCounting = R"(#version 450
layout(set = 0, binding = 2) buffer Counts { uint counts[]; };
layout(location = 0) flat in vec4 color;
layout(location = 0) out vec4 result;
void main() {
    atomicAdd(counts[uint(gl_FragCoord.x) & 63u], 3u);
    result = color;
})";

constexpr const char* kMix = R"(#version 450
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer From { uint from[]; };
layout(set = 0, binding = 2) buffer To { uint to[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    to[i] = to[i] * 1664525u + from[(i * 5u) % 1024u] + 1013904223u;
})";

constexpr const char* kPaint = R"(#version 450
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) readonly buffer From { uint from[]; };
layout(set = 0, binding = 1, rgba8) uniform image2D image;
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    vec4 old = imageLoad(image, at);
    imageStore(image, at, fract(old + unpackUnorm4x8(from[(at.x + at.y * 31) % 1024])));
})";

/// Arguments of indirect draws and dispatches, depending on what is in the buffer.
constexpr const char* kArguments = R"(#version 450
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) readonly buffer From { uint from[]; };
layout(set = 0, binding = 2) buffer To { uint to[]; };
void main() {
    to[0] = 3u + from[9] % 5u * 3u;
    to[1] = to[2] = 1u;
    to[3] = 0u;
})";

/// All that is left after a stream.
struct Outcome {
    std::vector<std::vector<uint32_t>> memory;
    VnStatistics statistics{};
};

struct Spirv {
    std::vector<uint32_t> vertex[2], fragment[3], compute[3];
};

class Stream {
  public:
    Stream(const Spirv& spirv, uint32_t threads) {
        VnDeviceDesc desc{};
        desc.threads = threads;
        EXPECT_EQ(vnCreateDevice(&desc, &device_), VN_SUCCESS);
        EXPECT_EQ(vnCreateContext(device_, nullptr, &context_), VN_SUCCESS);
        for (const auto& vertex : spirv.vertex)
            for (const auto& fragment : spirv.fragment) {
                VnProgramDesc program{};
                program.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, vertex);
                program.fragment = shader(VK_SHADER_STAGE_FRAGMENT_BIT, fragment);
                expect(vnCreateProgram(device_, &program, &draws_.emplace_back()));
            }
        for (const auto& compute : spirv.compute) {
            VnProgramDesc program{};
            program.compute = shader(VK_SHADER_STAGE_COMPUTE_BIT, compute);
            expect(vnCreateProgram(device_, &program, &computes_.emplace_back()));
        }
        for (VnImage& image : images_) image = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kMips, kLayers, 1);
        samples_ = makeImage(VK_FORMAT_R8G8B8A8_UNORM, 1, 1, 4);
        depth_ = makeImage(VK_FORMAT_D32_SFLOAT, 1, 1, 1);
        std::vector<uint32_t> words(kWords);
        for (uint32_t n = 0; n < kBuffers; ++n) {
            for (uint32_t i = 0; i < kWords; ++i) words[i] = (i + 1) * (n * 2 + 3) * 2654435761u;
            VnBufferDesc buffer{};
            buffer.size = kWords * 4;
            buffer.data = words.data();
            expect(vnCreateBuffer(device_, &buffer, &buffers_[n]));
        }
        VnBufferDesc arguments{};
        arguments.size = kSlot * 4;
        expect(vnCreateBuffer(device_, &arguments, &arguments_));
        VnDepthStencilStateDesc state{};
        state.depthTest = state.depthWrite = 1;
        expect(vnCreateDepthStencilState(device_, &state, &depthState_));
    }
    ~Stream() { vnDestroyDevice(device_); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    /// `oneByOne`: each command is done before the next is handed over.
    Outcome run(uint32_t seed, uint32_t commands, bool oneByOne) {
        random_.seed(seed);
        for (uint32_t n = 0; n < commands; ++n) {
            command(pick(11));
            if (oneByOne) expect(vnFinish(context_));
        }
        Outcome outcome;
        expect(vnGetStatistics(context_, &outcome.statistics));
        for (const VnBuffer buffer : buffers_)
            expect(vnReadBuffer(context_, buffer, 0, outcome.memory.emplace_back(kWords).data(), kWords * 4));
        for (const VnImage image : images_)
            for (uint32_t mip = 0; mip < kMips; ++mip)
                for (uint32_t layer = 0; layer < kLayers; ++layer) {
                    const VnRegion region = whole({mip, layer});
                    auto& texels = outcome.memory.emplace_back((kWidth >> mip) * (kHeight >> mip));
                    expect(vnReadImage(context_, image, &region, texels.data(), texels.size() * 4));
                }
        return outcome;
    }

  private:
    struct Place {
        uint32_t mip, layer;
        bool operator==(const Place&) const = default;
    };
    void expect(VnResult result) {
        char text[200] = "";
        if (result != VN_SUCCESS) vnGetError(device_, text, sizeof text);
        EXPECT_EQ(result, VN_SUCCESS) << text;
    }
    uint32_t pick(uint32_t count) { return random_() % count; }
    float unit() { return static_cast<float>(pick(1000)) / 1000.0f; }
    static VnRegion whole(const Place& place) {
        VnRegion region{};
        region.mip = place.mip;
        region.layer = place.layer;
        return region;
    }
    Place place() { return {pick(kMips), pick(kLayers)}; }

    VnShader shader(VkShaderStageFlagBits stage, const std::vector<uint32_t>& words) {
        VnShaderDesc desc{};
        desc.stage = stage;
        desc.words = words.data();
        desc.wordCount = words.size();
        VnShader result{};
        expect(vnCreateShader(device_, &desc, &result));
        return result;
    }
    VnImage makeImage(VkFormat format, uint32_t mips, uint32_t layers, uint32_t samples) {
        VnImageDesc desc{};
        desc.format = format;
        desc.width = kWidth;
        desc.height = kHeight;
        desc.mipLevels = mips;
        desc.layers = layers;
        desc.samples = samples;
        VnImage result{};
        expect(vnCreateImage(device_, &desc, &result));
        return result;
    }
    VnView viewOf(VnImage image, const Place& place) {
        VnViewDesc desc{};
        desc.image = image;
        desc.baseMip = place.mip;
        desc.mipCount = 1;
        desc.baseLayer = place.layer;
        desc.layerCount = 1;
        VnView result{};
        expect(vnCreateView(device_, &desc, &result));
        return result;
    }

    /// What a command reads, at binding 0, and what it writes, at binding 2. Draws of one pass share what they write.
    void bindWords(uint32_t written) {
        const uint32_t read = (written + 1 + pick(kBuffers - 1)) % kBuffers;
        expect(vnBindBuffer(context_, 0, 0, 0, buffers_[read], 0, 0));
        expect(vnBindBuffer(context_, 0, 2, 0, buffers_[written], 0, 0));
    }

    void draw(uint32_t image, const Place& target, uint32_t counts) {
        expect(vnBindProgram(context_, draws_[pick(static_cast<uint32_t>(draws_.size()))]));
        bindWords(counts);
        uint32_t from = pick(kImages);
        Place sampled = place();
        if (from == image && sampled == target) sampled.layer ^= 1;
        const VnView view = viewOf(images_[from], sampled);
        expect(vnBindTexture(context_, 0, 1, 0, view, {}));
        const std::array<float, 8> push{
            unit() * 1.5f - 1, unit() * 1.5f - 1, unit(), unit(), unit(), unit(), unit(), unit()};
        expect(vnPushConstants(context_, 0, push.data(), sizeof push));
        if (pick(4) == 0) {
            expect(vnDrawIndirect(context_, arguments_, kSlot * pick(4), 1, 0));
        } else {
            expect(vnDraw(context_, 3 * (1 + pick(20)), 1, 0, 0));
        }
        expect(vnDestroyView(device_, view));
    }

    void pass() {
        const uint32_t image = pick(kImages);
        Place target = place();
        const bool multisampled = pick(4) == 0, withDepth = !multisampled && pick(2) == 0;
        if (multisampled || withDepth) target.mip = 0;
        const VnView view = viewOf(images_[image], target);
        VnPassDesc desc{};
        desc.colors[0].view = view;
        if (multisampled) {
            expect(vnGetImageView(device_, samples_, &desc.colors[0].view));
            desc.colors[0].resolve = view;
        }
        desc.colors[0].loadOp = pick(2) == 0 ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
        desc.colors[0].clear.color = {{unit(), unit(), unit(), unit()}};
        if (withDepth) {
            expect(vnGetImageView(device_, depth_, &desc.depthStencil.view));
            desc.depthStencil.loadOp = pick(2) == 0 ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
            desc.depthStencil.clear.depthStencil.depth = unit();
        }
        expect(vnBindDepthStencilState(context_, withDepth ? depthState_ : VnDepthStencilState{}));
        expect(vnBeginPass(context_, &desc));
        const uint32_t counts = pick(kBuffers);
        for (uint32_t n = pick(4); n != 0; --n) draw(image, target, counts);
        expect(vnEndPass(context_));
        expect(vnDestroyView(device_, view));
    }

    void dispatch(uint32_t which) {
        expect(vnBindProgram(context_, computes_[which]));
        bindWords(pick(kBuffers));
        if (which == 1) {
            const VnView view = viewOf(images_[pick(kImages)], place());
            expect(vnBindTexture(context_, 0, 1, 0, view, {}));
            expect(vnDispatch(context_, kWidth / 8, kHeight / 8, 1));
            return expect(vnDestroyView(device_, view));
        }
        if (which == 2) {
            expect(vnBindBuffer(context_, 0, 2, 0, arguments_, kSlot * pick(4), kSlot));
            return expect(vnDispatch(context_, 1, 1, 1));
        }
        if (pick(3) == 0) return expect(vnDispatchIndirect(context_, arguments_, kSlot * pick(4)));
        expect(vnDispatch(context_, kWords / 64, 1, 1));
    }

    void command(uint32_t which) {
        const VnBuffer a = buffers_[pick(kBuffers)], b = buffers_[pick(kBuffers)];
        const VnImage image = images_[pick(kImages)];
        const uint32_t offset = pick(kWords / 2) * 4;
        switch (which) {
            case 0:
            case 1:
            case 2:
                return pass();
            case 3:
            case 4:
                return dispatch(pick(3));
            case 5:
                return expect(
                    vnCopyBuffer(context_, a, pick(kWords / 4) * 4, b, kWords * 2 + pick(kWords / 4) * 4, kWords));
            case 6:
                return expect(vnFillBuffer(context_, a, offset, 4 + pick(kWords / 4) * 4, random_()));
            case 7: {
                const std::array<uint32_t, 4> words{3 * (1 + pick(9)), 1, 1, 0};
                return expect(vnUpdateBuffer(context_, arguments_, kSlot * pick(4), words.data(), 16));
            }
            case 8: {
                const uint32_t other = pick(kImages);
                const VnImage to = images_[other];
                Place from = place(), target = {from.mip, pick(kLayers)};
                if (to.id == image.id && target == from) target.layer ^= 1;
                const VnRegion source = whole(from), destination = whole(target);
                return expect(vnCopyImage(context_, image, &source, to, &destination));
            }
            case 9: {
                const Place from = place();
                Place target = place();
                const VnImage to = images_[pick(kImages)];
                if (to.id == image.id && target == from) target.layer ^= 1;
                const VnRegion source = whole(from), destination = whole(target);
                return expect(vnBlitImage(context_, image, &source, to, &destination, VK_FILTER_LINEAR));
            }
            default:
                return expect(vnGenerateMips(context_, image));
        }
    }

    VnDevice device_ = nullptr;
    VnContext context_ = nullptr;
    std::vector<VnProgram> draws_, computes_;
    std::array<VnImage, kImages> images_{};
    VnImage samples_{}, depth_{};
    std::array<VnBuffer, kBuffers> buffers_{};
    VnBuffer arguments_{};  // of indirect commands, a set per slot
    VnDepthStencilState depthState_{};
    std::mt19937 random_;
};

class CommandStream : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        vnRetainGlslCompiler();
        const char *const vertex[] = {kTriangles, kBufferTriangles}, *const fragment[] = {kFlat, kTextured, kCounting},
                          *const compute[] = {kMix, kPaint, kArguments};
        for (int n = 0; n < 2; ++n) spirv_.vertex[n] = compileGlsl(VK_SHADER_STAGE_VERTEX_BIT, vertex[n]);
        for (int n = 0; n < 3; ++n) spirv_.fragment[n] = compileGlsl(VK_SHADER_STAGE_FRAGMENT_BIT, fragment[n]);
        for (int n = 0; n < 3; ++n) spirv_.compute[n] = compileGlsl(VK_SHADER_STAGE_COMPUTE_BIT, compute[n]);
        vnReleaseGlslCompiler();
    }
    static void TearDownTestSuite() { spirv_ = {}; }
    static inline Spirv spirv_;
};

TEST_F(CommandStream, GivesWhatTheCommandsGiveOneByOne) {
    constexpr uint32_t kStreams = 12, kCommands = 150;
    for (uint32_t seed = 0; seed < kStreams; ++seed) {
        const Outcome expected = Stream(spirv_, 1).run(seed, kCommands, true);
        const bool drawn = expected.statistics.fragmentInvocations > 0 && expected.statistics.computeInvocations > 0;
        EXPECT_TRUE(drawn) << "the stream of seed " << seed << " does nothing";
        for (const uint32_t threads : {1u, 2u, 5u}) {
            const Outcome outcome = Stream(spirv_, threads).run(seed, kCommands, false);
            ASSERT_EQ(outcome.memory.size(), expected.memory.size());
            for (size_t n = 0; n < expected.memory.size(); ++n)
                EXPECT_TRUE(outcome.memory[n] == expected.memory[n])
                    << "seed " << seed << ", " << threads << " threads, resource " << n;
            EXPECT_EQ(outcome.statistics.fragmentInvocations, expected.statistics.fragmentInvocations);
            EXPECT_EQ(outcome.statistics.vertexInvocations, expected.statistics.vertexInvocations);
            EXPECT_EQ(outcome.statistics.samplesPassed, expected.statistics.samplesPassed);
            EXPECT_EQ(outcome.statistics.computeInvocations, expected.statistics.computeInvocations);
        }
    }
}

}  // namespace
}  // namespace vernier::test
