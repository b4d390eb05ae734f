#include "tests/stability/canvas.h"

#include <vernier/vernier_glsl.h>

#include <bit>

namespace vernier::stability {
namespace {

const char* const kVertexGlsl = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 value;
layout(location = 0) out vec4 vAttribute;
void main() {
    gl_Position = position;
    vAttribute = value;
}
)";
const char* const kCountGlsl = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); }
)";
const char* const kPaintGlsl = R"(#version 450
layout(location = 0) in vec4 vAttribute;
layout(location = 0) out vec4 color;
void main() { color = vAttribute; }
)";

struct Vertex {
    Position position;
    std::array<float, 4> attribute;
};

/// Four numbers between 0 and 1 from a triangle's number and a position's bits.
std::array<float, 4> attributeOf(size_t triangle, const Position& position) {
    uint64_t state = triangle + 1;
    for (const float c : position) state = (state ^ std::bit_cast<uint32_t>(c)) * 0x9E3779B97F4A7C15u;
    std::array<float, 4> result;
    for (float& value : result) {
        state = (state ^ state >> 29) * 0xBF58476D1CE4E5B9u;
        value = static_cast<float>(state >> 40) * 0x1p-24f;
    }
    return result;
}

}  // namespace

Canvas::Canvas(VnProfile profile, uint32_t threads) {
    VnDeviceDesc desc{};
    desc.profile = profile;
    desc.threads = threads;
    check(vnCreateDevice(&desc, &device_), "vnCreateDevice");
    if (device_ == nullptr) return;
    check(vnCreateContext(device_, nullptr, &context_), "vnCreateContext");
    VnDeviceInfo info{};
    check(vnGetDeviceInfo(device_, &info), "vnGetDeviceInfo");
    subPixelBits_ = static_cast<int>(info.subPixelBits);
    count_ = makeProgram(kCountGlsl);
    paint_ = makeProgram(kPaintGlsl);
    const VnVertexAttribute attributes[] = {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, position)},
                                            {1, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, attribute)}};
    const VnVertexBinding binding{sizeof(Vertex), 0};
    VnVertexLayoutDesc layout{};
    layout.attributes = attributes;
    layout.attributeCount = 2;
    layout.bindings = &binding;
    layout.bindingCount = 1;
    check(vnCreateVertexLayout(device_, &layout, &layout_), "vnCreateVertexLayout");
    VnBlendStateDesc blend{};
    VnBlendAttachment& add = blend.attachments[0];
    add.enable = 1;
    add.srcColor = add.dstColor = add.srcAlpha = add.dstAlpha = VK_BLEND_FACTOR_ONE;
    check(vnCreateBlendState(device_, &blend, &add_), "vnCreateBlendState");
    less_ = makeDepth(VK_COMPARE_OP_LESS, true);
    equal_ = makeDepth(VK_COMPARE_OP_EQUAL, false);
    counts_ = makeImage(VK_FORMAT_R32_SFLOAT);
    colors_ = makeImage(VK_FORMAT_R32G32B32A32_SFLOAT);
    depth_ = makeImage(VK_FORMAT_D32_SFLOAT);
}

Canvas::~Canvas() {
    if (device_ != nullptr) vnDestroyDevice(device_);
}

void Canvas::check(VnResult result, const char* call) {
    if (result == VN_SUCCESS || !error_.empty()) return;
    char text[256] = "";
    if (device_ != nullptr) vnGetError(device_, text, sizeof text);
    error_ = std::string(call) + ": " + text;
}

VnImage Canvas::makeImage(VkFormat format) {
    VnImageDesc desc{};
    desc.format = format;
    desc.width = desc.height = kSize;
    VnImage image{};
    check(vnCreateImage(device_, &desc, &image), "vnCreateImage");
    return image;
}

VnProgram Canvas::makeProgram(const char* fragment) {
    VnProgramDesc program{};
    const struct {
        VkShaderStageFlagBits stage;
        const char* glsl;
        VnShader* shader;
    } stages[] = {{VK_SHADER_STAGE_VERTEX_BIT, kVertexGlsl, &program.vertex},
                  {VK_SHADER_STAGE_FRAGMENT_BIT, fragment, &program.fragment}};
    for (const auto& each : stages) {
        VnGlslDesc glsl{};
        glsl.stage = each.stage;
        glsl.source = each.glsl;
        VnGlslOutput* output = nullptr;
        if (vnCompileGlsl(&glsl, &output) != VN_GLSL_SUCCESS)
            error_ = std::string("a shader does not compile: ") + (output != nullptr ? output->log : "");
        VnShaderDesc desc{};
        desc.stage = each.stage;
        if (output != nullptr) {
            desc.words = output->words;
            desc.wordCount = output->wordCount;
        }
        check(vnCreateShader(device_, &desc, each.shader), "vnCreateShader");
        vnFreeGlslOutput(output);
    }
    VnProgram result{};
    check(vnCreateProgram(device_, &program, &result), "vnCreateProgram");
    return result;
}

VnDepthStencilState Canvas::makeDepth(VkCompareOp compare, bool write) {
    VnDepthStencilStateDesc desc{};
    desc.depthTest = 1;
    desc.depthWrite = write;
    desc.depthCompare = compare;
    VnDepthStencilState state{};
    check(vnCreateDepthStencilState(device_, &desc, &state), "vnCreateDepthStencilState");
    return state;
}

VnBuffer Canvas::upload(const Soup& soup, Attributes attributes) {
    std::vector<Vertex> vertices;
    for (size_t i = 0; i < soup.size(); ++i) {
        for (const Position& p : soup[i])
            vertices.push_back({p, attributes == Attributes::constant ? kConstant : attributeOf(i, p)});
    }
    // An empty soup is a buffer all the same.
    if (vertices.empty()) vertices.emplace_back();
    VnBufferDesc desc{};
    desc.size = vertices.size() * sizeof(Vertex);
    desc.data = vertices.data();
    VnBuffer buffer{};
    check(vnCreateBuffer(device_, &desc, &buffer), "vnCreateBuffer");
    check(vnBindVertexBuffer(context_, 0, buffer, 0), "vnBindVertexBuffer");
    return buffer;
}

void Canvas::begin(VnImage color, const std::array<float, 4>& clear) {
    VnPassDesc pass{};
    check(vnGetImageView(device_, color, &pass.colors[0].view), "vnGetImageView");
    pass.colors[0].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    std::copy(clear.begin(), clear.end(), pass.colors[0].clear.color.float32);
    check(vnGetImageView(device_, depth_, &pass.depthStencil.view), "vnGetImageView");
    pass.depthStencil.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    pass.depthStencil.clear.depthStencil.depth = 1;
    check(vnBeginPass(context_, &pass), "vnBeginPass");
    check(vnBindVertexLayout(context_, layout_), "vnBindVertexLayout");
    check(vnBindDepthStencilState(context_, {}), "vnBindDepthStencilState");
}

void Canvas::read(VnImage image, void* data, size_t bytes) {
    check(vnReadImage(context_, image, nullptr, data, bytes), "vnReadImage");
}

Counts Canvas::count(const Soup& soup) {
    const VnBuffer buffer = upload(soup, Attributes::constant);
    begin(counts_, {});
    check(vnBindProgram(context_, count_), "vnBindProgram");
    check(vnBindBlendState(context_, add_), "vnBindBlendState");
    check(vnDraw(context_, static_cast<uint32_t>(soup.size() * 3), 1, 0, 0), "vnDraw");
    check(vnEndPass(context_), "vnEndPass");
    Counts counts(kSize * kSize);
    read(counts_, counts.data(), counts.size() * sizeof(float));
    check(vnDestroyBuffer(device_, buffer), "vnDestroyBuffer");
    return counts;
}

Image Canvas::paint(const Soup& soup, Attributes attributes, bool drawEach) {
    const VnBuffer buffer = upload(soup, attributes);
    begin(colors_, {-1, -1, -1, -1});
    check(vnBindProgram(context_, paint_), "vnBindProgram");
    check(vnBindBlendState(context_, {}), "vnBindBlendState");
    if (drawEach) {
        for (uint32_t i = 0; i < soup.size(); ++i) check(vnDraw(context_, 3, 1, i * 3, 0), "vnDraw");
    } else {
        check(vnDraw(context_, static_cast<uint32_t>(soup.size() * 3), 1, 0, 0), "vnDraw");
    }
    check(vnEndPass(context_), "vnEndPass");
    Image image(kSize * kSize * 4);
    read(colors_, image.data(), image.size() * sizeof(uint32_t));
    check(vnDestroyBuffer(device_, buffer), "vnDestroyBuffer");
    return image;
}

Counts Canvas::countEqual(const Soup& soup) {
    const VnBuffer buffer = upload(soup, Attributes::constant);
    begin(counts_, {});
    check(vnBindProgram(context_, count_), "vnBindProgram");
    check(vnBindBlendState(context_, add_), "vnBindBlendState");
    const auto vertices = static_cast<uint32_t>(soup.size() * 3);
    check(vnBindDepthStencilState(context_, less_), "vnBindDepthStencilState");
    check(vnDraw(context_, vertices, 1, 0, 0), "vnDraw");
    const VkClearColorValue none{};
    check(vnClearColor(context_, 0, &none, nullptr), "vnClearColor");
    check(vnBindDepthStencilState(context_, equal_), "vnBindDepthStencilState");
    check(vnDraw(context_, vertices, 1, 0, 0), "vnDraw");
    check(vnEndPass(context_), "vnEndPass");
    Counts counts(kSize * kSize);
    read(counts_, counts.data(), counts.size() * sizeof(float));
    check(vnDestroyBuffer(device_, buffer), "vnDestroyBuffer");
    return counts;
}

}  // namespace vernier::stability
