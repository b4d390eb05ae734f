// A first Vernier program in C++: a turning triangle in a window by SDL2, or one picture with: starter OUT.ppm
#include <SDL.h>
#include <vernier/vernier.h>
#include <vernier/vernier_glsl.h>

#include <cstdint>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr uint32_t kWidth = 640, kHeight = 480;

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { float seconds; };
layout(location = 0) out vec3 color;
void main() {
    float angle = seconds + gl_VertexIndex * 2.0943951;
    color = vec3(gl_VertexIndex == 0, gl_VertexIndex == 1, gl_VertexIndex == 2);
    gl_Position = vec4(0.6 * sin(angle), -0.8 * cos(angle), 0, 1);
})";

constexpr const char* kFragment = R"(#version 450
layout(location = 0) in vec3 color;
layout(location = 0) out vec4 result;
void main() { result = vec4(color, 1); })";

void must(VnResult result) {
    if (result != VN_SUCCESS) throw std::runtime_error("a Vernier call failed");
}

/// All that belongs to one device goes with it.
class Picture {
  public:
    Picture() : pixels_(size_t{kWidth} * kHeight) {
        VnDeviceDesc desc{};
        desc.message = [](void*, VnSeverity, const char* text) { std::cerr << text << "\n"; };
        must(vnCreateDevice(&desc, &device_));
        must(vnCreateContext(device_, nullptr, &context_));
        VnImageDesc imageDesc{};
        imageDesc.width = kWidth;
        imageDesc.height = kHeight;
        must(vnCreateImage(device_, &imageDesc, &image_));
        VnProgramDesc programDesc{};
        programDesc.vertex = compile(VK_SHADER_STAGE_VERTEX_BIT, kVertex);
        programDesc.fragment = compile(VK_SHADER_STAGE_FRAGMENT_BIT, kFragment);
        must(vnCreateProgram(device_, &programDesc, &program_));
    }
    ~Picture() { vnDestroyDevice(device_); }
    Picture(const Picture&) = delete;
    Picture& operator=(const Picture&) = delete;

    /// RGBA8 pixels, row by row from the top.
    std::vector<uint32_t>& draw(float seconds) {
        VnPassDesc pass{};
        must(vnGetImageView(device_, image_, &pass.colors[0].view));
        pass.colors[0].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        must(vnBeginPass(context_, &pass));
        must(vnBindProgram(context_, program_));
        must(vnPushConstants(context_, 0, &seconds, sizeof seconds));
        must(vnDraw(context_, 3, 1, 0, 0));
        must(vnEndPass(context_));
        must(vnReadImage(context_, image_, nullptr, pixels_.data(), pixels_.size() * 4));
        return pixels_;
    }

  private:
    VnShader compile(VkShaderStageFlagBits stage, const char* source) {
        VnGlslDesc glsl{};
        glsl.stage = stage;
        glsl.source = source;
        VnGlslOutput* output = nullptr;
        const VnGlslResult status = vnCompileGlsl(&glsl, &output);
        const std::string log = output ? output->log : "out of memory";
        VnShader shader{};
        if (status == VN_GLSL_SUCCESS) {
            VnShaderDesc desc{};
            desc.stage = stage;
            desc.words = output->words;
            desc.wordCount = output->wordCount;
            vnCreateShader(device_, &desc, &shader);
        }
        vnFreeGlslOutput(output);
        if (!shader.id) throw std::runtime_error("a shader: " + log);
        return shader;
    }

    VnDevice device_ = nullptr;
    VnContext context_ = nullptr;
    VnImage image_{};
    VnProgram program_{};
    std::vector<uint32_t> pixels_;
};

void write(const std::string& path, const std::vector<uint32_t>& pixels) {
    std::ofstream file(path, std::ios::binary);
    file << "P6\n" << kWidth << " " << kHeight << "\n255\n";
    for (const uint32_t pixel : pixels)
        for (int shift = 0; shift < 24; shift += 8) file.put(static_cast<char>(pixel >> shift & 0xFF));
    if (!file.flush()) throw std::runtime_error(path + " could not be written");
}

void show(Picture& picture) {
    if (SDL_Init(SDL_INIT_VIDEO) != 0) throw std::runtime_error(SDL_GetError());
    SDL_Window* window =
        SDL_CreateWindow("Starter", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, kWidth, kHeight, 0);
    if (!window) throw std::runtime_error(SDL_GetError());
    for (bool open = true; open;) {
        std::vector<uint32_t>& pixels = picture.draw(static_cast<float>(SDL_GetTicks()) / 1000);
        SDL_Surface* image =
            SDL_CreateRGBSurfaceWithFormatFrom(pixels.data(), kWidth, kHeight, 32, kWidth * 4, SDL_PIXELFORMAT_RGBA32);
        SDL_BlitSurface(image, nullptr, SDL_GetWindowSurface(window), nullptr);
        SDL_UpdateWindowSurface(window);
        SDL_FreeSurface(image);
        for (SDL_Event event; SDL_PollEvent(&event);) open = open && event.type != SDL_QUIT;
    }
    SDL_DestroyWindow(window);
    SDL_Quit();
}

}  // namespace

int main(int argc, char** argv) {
    try {
        Picture picture;
        if (argc == 2)
            write(argv[1], picture.draw(0));
        else
            show(picture);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
