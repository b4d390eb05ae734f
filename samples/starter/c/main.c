/* A first Vernier program in C99: draws a triangle and writes it as a picture: starter OUT.ppm */
#include <stdio.h>
#include <vernier/vernier.h>
#include <vernier/vernier_glsl.h>

enum { WIDTH = 320, HEIGHT = 240 };

static const char* vertexSource =
    "#version 450\n"
    "layout(location = 0) out vec3 color;\n"
    "const vec2 corners[3] = vec2[](vec2(0, -0.7), vec2(0.7, 0.7), vec2(-0.7, 0.7));\n"
    "void main() {\n"
    "    color = vec3(gl_VertexIndex == 0, gl_VertexIndex == 1, gl_VertexIndex == 2);\n"
    "    gl_Position = vec4(corners[gl_VertexIndex], 0, 1);\n"
    "}\n";
static const char* fragmentSource =
    "#version 450\n"
    "layout(location = 0) in vec3 color;\n"
    "layout(location = 0) out vec4 result;\n"
    "void main() { result = vec4(color, 1); }\n";

/* Vernier says in words what was wrong with a call. */
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

int main(int argc, char** argv) {
    static unsigned char pixels[WIDTH * HEIGHT * 4];
    VnDeviceDesc deviceDesc = {.message = onMessage};
    VnImageDesc imageDesc = {.width = WIDTH, .height = HEIGHT};
    VnDevice device = NULL;
    VnContext context = NULL;
    VnImage image = {0};
    VnProgram program = {0};
    VnPassDesc pass = {0};
    if (argc != 2) {
        fprintf(stderr, "usage: %s OUT.ppm\n", argv[0]);
        return 2;
    }
    if (vnCreateDevice(&deviceDesc, &device) != VN_SUCCESS) return 1;
    vnCreateContext(device, NULL, &context);
    vnCreateImage(device, &imageDesc, &image);
    VnProgramDesc programDesc = {.vertex = compile(device, VK_SHADER_STAGE_VERTEX_BIT, vertexSource),
                                 .fragment = compile(device, VK_SHADER_STAGE_FRAGMENT_BIT, fragmentSource)};
    vnCreateProgram(device, &programDesc, &program);

    vnGetImageView(device, image, &pass.colors[0].view);
    pass.colors[0].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    vnBeginPass(context, &pass);
    vnBindProgram(context, program);
    vnDraw(context, 3, 1, 0, 0);
    vnEndPass(context);
    VnResult result = vnReadImage(context, image, NULL, pixels, sizeof pixels);
    vnDestroyDevice(device);
    if (result != VN_SUCCESS) return 1;

    FILE* file = fopen(argv[1], "wb");
    if (!file) {
        perror(argv[1]);
        return 1;
    }
    fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
    for (size_t i = 0; i < sizeof pixels; i += 4) fwrite(pixels + i, 1, 3, file);
    return fclose(file) != 0;
}
