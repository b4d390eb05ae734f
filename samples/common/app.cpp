#include "samples/common/app.h"

#include <vernier/vernier_glsl.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "samples/common/picture_file.h"
#include "samples/common/window.h"

namespace samples {
namespace {

using Clock = std::chrono::steady_clock;

void printMessage(void*, VnSeverity, const char* text) {
    std::fprintf(stderr, "%s\n", text);
}

double secondsBetween(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

void must(VnResult result) {
    if (result != VN_SUCCESS) std::exit(1);
}

App::App(const AppOptions& options) : options_(options) {
    vnRetainGlslCompiler();  // samples compile several shaders: its tables need not be built for each
    VnDeviceDesc desc{};
    desc.message = printMessage;
    desc.threads = options.threads;
    if (!options.isa.empty()) desc.maxIsa = options.isa.c_str();
    must(vnCreateDevice(&desc, &device_));
    must(vnCreateContext(device_, nullptr, &context_));
    color_ = &windowTarget(VK_FORMAT_R8G8B8A8_SRGB);
    depth_ = &windowTarget(VK_FORMAT_D32_SFLOAT);
}

App::~App() {
    vnDestroyDevice(device_);
    vnReleaseGlslCompiler();
}

int App::run(const std::function<void(const Frame&)>& frame) {
    if (options_.window()) return runWindow(frame);
    return options_.frames ? runFrames(frame) : runHeadless(frame);
}

int App::run(const glm::vec4& background, const std::function<void(const Frame&)>& frame) {
    return run([&](const Frame& now) {
        beginPass(background);
        frame(now);
        endPass();
    });
}

void App::readPixels() {
    pixels_.resize(size_t{options_.width} * options_.height);
    must(vnReadImage(context_, color_->image, nullptr, pixels_.data(), pixels_.size() * 4));
}

bool App::save(const std::string& path) {
    readPixels();
    return writePixels(path);
}

bool App::writePixels(const std::string& path) {
    if (savePicture(path, {options_.width, options_.height, pixels_})) return true;
    std::fprintf(stderr, "%s could not be written\n", path.c_str());
    return false;
}

int App::runHeadless(const std::function<void(const Frame&)>& frame) {
    frame({options_.time, 0, {}});
    readPixels();
    return writePixels(options_.headless) ? 0 : 1;
}

int App::runFrames(const std::function<void(const Frame&)>& frame) {
    const Clock::time_point start = Clock::now();
    for (uint32_t i = 0; i < options_.frames; ++i) {
        frame({options_.time + i / 25.0, i ? 1 / 25.0 : 0.0, {}});
        readPixels();
        char name[16];
        std::snprintf(name, sizeof name, "/%04u.png", i);
        if (!options_.out.empty() && !writePixels(options_.out + name)) return 1;
    }
    if (options_.out.empty())
        std::printf("%.2f ms per frame, %ux%u\n", secondsBetween(start, Clock::now()) * 1000 / options_.frames,
                    options_.width, options_.height);
    return 0;
}

int App::runWindow(const std::function<void(const Frame&)>& frame) {
    Window window(options_.title, options_.width, options_.height);
    std::fputs(keyHelp(options_.options).c_str(), stdout);
    const Clock::time_point start = Clock::now();
    Frame now{0, 0, {}};
    std::string choice;  // what was switched last
    double last = 0, lastTitle = 0;
    uint32_t framesSince = 0;
    while (window.poll(now.input)) {
        for (const int key : now.input.pressed) {
            if (key == kKeyF1) std::fputs(keyHelp(options_.options).c_str(), stdout);
            if (const std::string text = pressKey(options_.options, key); !text.empty())
                choice = " - " + text, lastTitle = 0;
        }
        if (window.width() != options_.width || window.height() != options_.height)
            resize(window.width(), window.height());
        const double seconds = secondsBetween(start, Clock::now());
        now.elapsed = last > 0 ? seconds - last : 0;
        last = seconds;
        now.seconds = options_.time + (options_.still ? 0 : seconds);
        now.pixelRatio = window.pixelRatio();
        frame(now);
        readPixels();
        window.show(pixels_, options_.width, options_.height);
        ++framesSince;
        if (const double since = seconds - lastTitle; lastTitle == 0 || since > 0.5) {
            char rate[32] = "";
            if (lastTitle > 0) std::snprintf(rate, sizeof rate, " - %.0f frames/s", framesSince / since);
            window.setTitle(options_.title + choice + rate);
            lastTitle = seconds;
            framesSince = 0;
        }
    }
    return 0;
}

void App::resize(uint32_t width, uint32_t height) {
    VnDeviceInfo info{};
    must(vnGetDeviceInfo(device_, &info));
    options_.width = std::min(width, info.maxImageSize);
    options_.height = std::min(height, info.maxImageSize);
    for (WindowTarget& target : windowTargets_) make(target);
}

void App::make(WindowTarget& target) {
    if (target.target.image.id) must(vnDestroyImage(device_, target.target.image));
    const VkExtent2D window{options_.width, options_.height}, size = target.sizeOf ? target.sizeOf(window) : window;
    target.target = this->target(target.format, size.width, size.height);
}

void App::beginPass(const glm::vec4& background) {
    beginPass({*color_}, *depth_, background);
}

void App::beginPass(const std::vector<Target>& colors, const Target& depth, const glm::vec4& background) {
    VnPassDesc pass{};
    for (size_t slot = 0; slot < colors.size(); ++slot) {
        VnAttachment& attachment = pass.colors[slot];
        attachment.view = colors[slot].view;
        attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        for (int i = 0; i < 4; ++i) attachment.clear.color.float32[i] = background[i];
    }
    if (depth.view.id) {
        pass.depthStencil.view = depth.view;
        pass.depthStencil.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        pass.depthStencil.clear.depthStencil.depth = 1;
    }
    must(vnBeginPass(context_, &pass));
}

void App::endPass() {
    must(vnEndPass(context_));
}

VnShader App::shader(VkShaderStageFlagBits stage, const std::string& source) {
    VnGlslDesc glsl{};
    glsl.stage = stage;
    glsl.source = source.c_str();
    VnGlslOutput* output = nullptr;
    if (vnCompileGlsl(&glsl, &output) != VN_GLSL_SUCCESS) {
        std::fprintf(stderr, "%s\n", output ? output->log : "GLSL: out of memory");
        std::exit(1);
    }
    VnShaderDesc desc{};
    desc.stage = stage;
    desc.words = output->words;
    desc.wordCount = output->wordCount;
    VnShader shader{};
    must(vnCreateShader(device_, &desc, &shader));
    vnFreeGlslOutput(output);
    return shader;
}

VnProgram App::program(const std::string& vertexGlsl, const std::string& fragmentGlsl) {
    VnProgramDesc desc{};
    desc.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, vertexGlsl);
    if (!fragmentGlsl.empty()) desc.fragment = shader(VK_SHADER_STAGE_FRAGMENT_BIT, fragmentGlsl);
    VnProgram program{};
    must(vnCreateProgram(device_, &desc, &program));
    return program;
}

VnProgram App::computeProgram(const std::string& glsl) {
    VnProgramDesc desc{};
    desc.compute = shader(VK_SHADER_STAGE_COMPUTE_BIT, glsl);
    VnProgram program{};
    must(vnCreateProgram(device_, &desc, &program));
    return program;
}

VnBuffer App::buffer(const void* data, size_t bytes) {
    VnBufferDesc desc{};
    desc.size = bytes;
    desc.data = data;
    VnBuffer buffer{};
    must(vnCreateBuffer(device_, &desc, &buffer));
    return buffer;
}

VnView App::texture(uint32_t width, uint32_t height, const std::vector<uint32_t>& texels) {
    VnImageDesc desc{};
    desc.format = VK_FORMAT_R8G8B8A8_SRGB;
    desc.width = width;
    desc.height = height;
    desc.mipLevels = VN_ALL_MIPS;
    VnImage image{};
    VnView view{};
    must(vnCreateImage(device_, &desc, &image));
    must(vnUpdateImage(context_, image, nullptr, texels.data(), texels.size() * 4));
    must(vnGenerateMips(context_, image));
    must(vnGetImageView(device_, image, &view));
    return view;
}

Target App::target(VkFormat format, uint32_t width, uint32_t height) {
    Target target;
    VnImageDesc desc{};
    desc.format = format;
    target.width = desc.width = width;
    target.height = desc.height = height;
    must(vnCreateImage(device_, &desc, &target.image));
    must(vnGetImageView(device_, target.image, &target.view));
    return target;
}

const Target& App::windowTarget(VkFormat format, std::function<VkExtent2D(VkExtent2D)> sizeOf) {
    windowTargets_.push_back({format, std::move(sizeOf), {}});
    make(windowTargets_.back());
    return windowTargets_.back().target;
}

VnSampler App::sampler(VkFilter filter, VkSamplerAddressMode address) {
    VnSamplerDesc desc{};
    desc.magFilter = desc.minFilter = filter;
    desc.mipmapMode = filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    desc.addressU = desc.addressV = desc.addressW = address;
    VnSampler sampler{};
    must(vnCreateSampler(device_, &desc, &sampler));
    return sampler;
}

VnVertexLayout App::layout(const std::vector<VnVertexAttribute>& attributes,
                           const std::vector<VnVertexBinding>& bindings) {
    VnVertexLayoutDesc desc{};
    desc.attributes = attributes.data();
    desc.attributeCount = static_cast<uint32_t>(attributes.size());
    desc.bindings = bindings.data();
    desc.bindingCount = static_cast<uint32_t>(bindings.size());
    VnVertexLayout layout{};
    must(vnCreateVertexLayout(device_, &desc, &layout));
    return layout;
}

VnDepthStencilState App::depthState(bool write, VkCompareOp compare) {
    VnDepthStencilStateDesc desc{};
    desc.depthTest = 1;
    desc.depthWrite = write;
    desc.depthCompare = compare;
    VnDepthStencilState state{};
    must(vnCreateDepthStencilState(device_, &desc, &state));
    return state;
}

VnRasterState App::rasterState(VkCullModeFlags cull, VkPolygonMode mode) {
    VnRasterStateDesc desc{};
    desc.cullMode = cull;
    desc.polygonMode = mode;
    VnRasterState state{};
    must(vnCreateRasterState(device_, &desc, &state));
    return state;
}

VnBlendState App::blendState(VkBlendFactor source, VkBlendFactor destination) {
    VnBlendStateDesc desc{};
    VnBlendAttachment& blend = desc.attachments[0];
    blend.enable = 1;
    blend.srcColor = blend.srcAlpha = source;
    blend.dstColor = blend.dstAlpha = destination;
    VnBlendState state{};
    must(vnCreateBlendState(device_, &desc, &state));
    return state;
}

Mesh App::mesh(const MeshData& data) {
    return {buffer(data.vertices), buffer(data.indices), static_cast<uint32_t>(data.indices.size())};
}

VnVertexLayout App::meshLayout() {
    return layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(MeshVertex, position)},
                   {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(MeshVertex, normal)},
                   {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(MeshVertex, uv)}},
                  {{sizeof(MeshVertex), 0}});
}

void App::draw(const Mesh& mesh, uint32_t instances) {
    must(vnBindVertexBuffer(context_, 0, mesh.vertices, 0));
    must(vnBindIndexBuffer(context_, mesh.indices, 0, VK_INDEX_TYPE_UINT32));
    must(vnDrawIndexed(context_, mesh.indexCount, instances, 0, 0, 0));
}

std::vector<uint32_t> checkerTexels(uint32_t size, uint32_t cells, uint32_t first, uint32_t second) {
    std::vector<uint32_t> texels(size_t{size} * size);
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x)
            texels[size_t{y} * size + x] = (x * cells / size + y * cells / size) % 2 ? first : second;
    return texels;
}

const char* const kFullScreenVertex = R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2;
    gl_Position = vec4(uv * 2 - 1, 0, 1);
})";

}  // namespace samples
