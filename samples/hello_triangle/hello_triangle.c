/* A triangle in a window, or in a file: hello_triangle [--headless OUT.png] */
#include <SDL.h>
#include <stb/stb_image_write.h>
#include <stdio.h>
#include <string.h>
#include <vernier/vernier.h>
#include <vernier/vernier_glsl.h>

enum { WIDTH = 640, HEIGHT = 480 };
static unsigned char pixels[WIDTH * HEIGHT * 4];

static const char* vertexSource =
    "#version 450\n"
    "layout(location = 0) out vec3 color;\n"
    "const vec2 corners[3] = vec2[](vec2(0, -0.7), vec2(0.7, 0.7), vec2(-0.7, 0.7));\n"
    "const vec3 colors[3] = vec3[](vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1));\n"
    "void main() { gl_Position = vec4(corners[gl_VertexIndex], 0, 1); color = colors[gl_VertexIndex]; }\n";
static const char* fragmentSource =
    "#version 450\n"
    "layout(location = 0) in vec3 color;\n"
    "layout(location = 0) out vec4 result;\n"
    "void main() { result = vec4(color, 1); }\n";

static void onMessage(void* user, VnSeverity severity, const char* text) {
    (void)user, (void)severity;
    fprintf(stderr, "%s\n", text);
}

static VnShader compile(VnDevice device, VkShaderStageFlagBits stage, const char* source) {
    VnGlslDesc glsl = {.stage = stage, .source = source};
    VnGlslOutput* output = NULL;
    VnShader shader = {0};
    if (vnCompileGlsl(&glsl, &output) == VN_GLSL_SUCCESS) {
        VnShaderDesc desc = {.stage = stage, .words = output->words, .wordCount = output->wordCount};
        vnCreateShader(device, &desc, &shader);
    } else if (output) {
        fprintf(stderr, "%s\n", output->log);
    }
    vnFreeGlslOutput(output);
    return shader;
}

static int show(void) {
    SDL_Init(SDL_INIT_VIDEO);
    SDL_Window* window = SDL_CreateWindow("Vernier", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, WIDTH, HEIGHT, 0);
    SDL_Surface* image = SDL_CreateRGBSurfaceFrom(pixels, WIDTH, HEIGHT, 32, WIDTH * 4, 0xFF, 0xFF00, 0xFF0000, 0);
    for (SDL_Event event = {0}; event.type != SDL_QUIT && event.type != SDL_KEYDOWN; SDL_WaitEvent(&event)) {
        SDL_BlitSurface(image, NULL, SDL_GetWindowSurface(window), NULL);
        SDL_UpdateWindowSurface(window);
    }
    SDL_Quit();
    return 0;
}

int main(int argc, char** argv) {
    VnDevice device = NULL;
    VnContext context = NULL;
    VnImage image = {0};
    VnProgram program = {0};
    VnPassDesc pass = {0};
    vnCreateDevice(&(VnDeviceDesc){.message = onMessage}, &device);
    vnCreateContext(device, NULL, &context);
    vnCreateImage(device, &(VnImageDesc){.width = WIDTH, .height = HEIGHT}, &image);
    VnShader vertex = compile(device, VK_SHADER_STAGE_VERTEX_BIT, vertexSource);
    VnShader fragment = compile(device, VK_SHADER_STAGE_FRAGMENT_BIT, fragmentSource);
    vnCreateProgram(device, &(VnProgramDesc){.vertex = vertex, .fragment = fragment}, &program);
    vnGetImageView(device, image, &pass.colors[0].view);
    pass.colors[0].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    pass.colors[0].clear.color.float32[3] = 1;
    vnBeginPass(context, &pass);
    vnBindProgram(context, program);
    vnDraw(context, 3, 1, 0, 0);
    vnEndPass(context);
    VnResult result = vnReadImage(context, image, NULL, pixels, sizeof pixels);
    vnDestroyDevice(device);
    if (result != VN_SUCCESS) return 1;
    if (argc == 3 && !strcmp(argv[1], "--headless")) return !stbi_write_png(argv[2], WIDTH, HEIGHT, 4, pixels, 0);
    return show();
}
