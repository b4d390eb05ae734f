#include "samples/common/app.h"

#include <SDL.h>
#include <stb/stb_image_write.h>
#include <vernier/vernier_glsl.h>

#include <chrono>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#include <glm/gtc/matrix_transform.hpp>

namespace samples {
namespace {

[[noreturn]] void stop(const std::string& text) {
    std::fprintf(stderr, "%s\n", text.c_str());
    std::exit(1);
}

/// Vernier has already told what was wrong through the message callback.
void must(VnResult result) {
    if (result != VN_SUCCESS) std::exit(1);
}

void printMessage(void*, VnSeverity, const char* text) {
    std::fprintf(stderr, "%s\n", text);
}

VnShader compile(VnDevice device, VkShaderStageFlagBits stage, const std::string& source) {
    VnGlslDesc glsl{};
    glsl.stage = stage;
    glsl.source = source.c_str();
    VnGlslOutput* output = nullptr;
    if (vnCompileGlsl(&glsl, &output) != VN_GLSL_SUCCESS) stop(output ? output->log : "GLSL: out of memory");
    VnShaderDesc desc{};
    desc.stage = stage;
    desc.words = output->words;
    desc.wordCount = output->wordCount;
    VnShader shader{};
    must(vnCreateShader(device, &desc, &shader));
    vnFreeGlslOutput(output);
    return shader;
}

VnImage makeImage(VnDevice device, VkFormat format, uint32_t width, uint32_t height, uint32_t mips) {
    VnImageDesc desc{};
    desc.format = format;
    desc.width = width;
    desc.height = height;
    desc.mipLevels = mips;
    VnImage image{};
    must(vnCreateImage(device, &desc, &image));
    return image;
}

VnView wholeView(VnDevice device, VnImage image) {
    VnView view{};
    must(vnGetImageView(device, image, &view));
    return view;
}

}  // namespace

AppOptions parseOptions(int argc, char** argv, const std::string& title) {
    AppOptions options;
    options.title = title;
    CLI::App cli{title};
    std::string size;
    cli.add_option("--headless", options.headless, "write one picture to this PNG file instead of opening a window");
    cli.add_option("--size", size, "WIDTHxHEIGHT in pixels (800x600)");
    cli.add_option("--time", options.time, "seconds at which the picture is taken (0)");
    try {
        cli.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::exit(cli.exit(error));
    }
    if (!size.empty() && std::sscanf(size.c_str(), "%ux%u", &options.width, &options.height) != 2)
        stop("--size is \"" + size + "\", but must be WIDTHxHEIGHT");
    return options;
}

App::App(const AppOptions& options) : options_(options) {
    VnDeviceDesc desc{};
    desc.message = printMessage;
    must(vnCreateDevice(&desc, &device_));
    must(vnCreateContext(device_, nullptr, &context_));
    color_ = makeImage(device_, VK_FORMAT_R8G8B8A8_SRGB, options.width, options.height, 1);
    depth_ = makeImage(device_, VK_FORMAT_D32_SFLOAT, options.width, options.height, 1);
    pixels_.resize(size_t{options.width} * options.height);
}

App::~App() {
    vnDestroyDevice(device_);
}

void App::drawFrame(const glm::vec4& background, const std::function<void(double)>& frame, double seconds) {
    VnPassDesc pass{};
    pass.colors[0].view = wholeView(device_, color_);
    pass.colors[0].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    for (int i = 0; i < 4; ++i) pass.colors[0].clear.color.float32[i] = background[i];
    pass.depthStencil.view = wholeView(device_, depth_);
    pass.depthStencil.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    pass.depthStencil.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    pass.depthStencil.clear.depthStencil.depth = 1;
    must(vnBeginPass(context_, &pass));
    frame(seconds);
    must(vnEndPass(context_));
    must(vnReadImage(context_, color_, nullptr, pixels_.data(), pixels_.size() * 4));
}

int App::run(const glm::vec4& background, const std::function<void(double)>& frame) {
    return options_.headless.empty() ? runWindow(background, frame) : runHeadless(background, frame);
}

int App::runHeadless(const glm::vec4& background, const std::function<void(double)>& frame) {
    drawFrame(background, frame, options_.time);
    const auto width = static_cast<int>(options_.width), height = static_cast<int>(options_.height);
    if (stbi_write_png(options_.headless.c_str(), width, height, 4, pixels_.data(), 0)) return 0;
    std::fprintf(stderr, "%s could not be written\n", options_.headless.c_str());
    return 1;
}

int App::runWindow(const glm::vec4& background, const std::function<void(double)>& frame) {
    if (SDL_Init(SDL_INIT_VIDEO) != 0) stop(std::string("no window: ") + SDL_GetError() + " (try --headless OUT.png)");
    const auto width = static_cast<int>(options_.width), height = static_cast<int>(options_.height);
    SDL_Window* window =
        SDL_CreateWindow(options_.title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, width, height, 0);
    SDL_Surface* image =
        SDL_CreateRGBSurfaceWithFormatFrom(pixels_.data(), width, height, 32, width * 4, SDL_PIXELFORMAT_RGBA32);
    if (!window || !image) stop(std::string("no window: ") + SDL_GetError());
    const auto start = std::chrono::steady_clock::now();
    for (bool open = true; open;) {
        drawFrame(background, frame, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        SDL_BlitSurface(image, nullptr, SDL_GetWindowSurface(window), nullptr);
        SDL_UpdateWindowSurface(window);
        for (SDL_Event event; SDL_PollEvent(&event);)
            open =
                open && event.type != SDL_QUIT && !(event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE);
    }
    SDL_FreeSurface(image);
    SDL_DestroyWindow(window);
    SDL_Quit();
    return 0;
}

VnProgram App::program(const std::string& vertexGlsl, const std::string& fragmentGlsl) {
    VnProgramDesc desc{};
    desc.vertex = compile(device_, VK_SHADER_STAGE_VERTEX_BIT, vertexGlsl);
    desc.fragment = compile(device_, VK_SHADER_STAGE_FRAGMENT_BIT, fragmentGlsl);
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
    const VnImage image = makeImage(device_, VK_FORMAT_R8G8B8A8_SRGB, width, height, VN_ALL_MIPS);
    must(vnUpdateImage(context_, image, nullptr, texels.data(), texels.size() * 4));
    must(vnGenerateMips(context_, image));
    return wholeView(device_, image);
}

std::vector<uint32_t> checkerTexels(uint32_t size, uint32_t cells, uint32_t first, uint32_t second) {
    std::vector<uint32_t> texels(size_t{size} * size);
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x)
            texels[size_t{y} * size + x] = (x * cells / size + y * cells / size) % 2 ? first : second;
    return texels;
}

glm::mat4 perspective(float fieldOfView, float aspect, float nearPlane, float farPlane) {
    glm::mat4 matrix = glm::perspectiveRH_ZO(fieldOfView, aspect, nearPlane, farPlane);
    matrix[1][1] = -matrix[1][1];
    return matrix;
}

}  // namespace samples
