/* Draws one white pixel with an installed Vernier; exits with 0 if it is white. */
#include <stdio.h>
#include <vernier/vernier.h>
#include <vernier/vernier_accuracy.h>
#include <vernier/vernier_glsl.h>

static VnShader compile(VnDevice device, VkShaderStageFlagBits stage, const char* source) {
    VnGlslDesc glsl = {0};
    VnGlslOutput* output = NULL;
    VnShaderDesc desc = {0};
    VnShader shader = {0};
    glsl.stage = stage;
    glsl.source = source;
    if (vnCompileGlsl(&glsl, &output) == VN_GLSL_SUCCESS) {
        desc.stage = stage;
        desc.words = output->words;
        desc.wordCount = output->wordCount;
        vnCreateShader(device, &desc, &shader);
    }
    vnFreeGlslOutput(output);
    return shader;
}

int main(void) {
    VnDevice device = NULL;
    VnContext context = NULL;
    VnImageDesc imageDesc = {0};
    VnProgramDesc programDesc = {0};
    VnPassDesc pass = {0};
    VnImage image = {0};
    VnProgram program = {0};
    uint32_t pixel = 0;
    vnCreateDevice(NULL, &device);
    vnCreateContext(device, NULL, &context);
    imageDesc.width = imageDesc.height = 1;
    vnCreateImage(device, &imageDesc, &image);
    programDesc.vertex = compile(device, VK_SHADER_STAGE_VERTEX_BIT,
                                 "#version 450\nvoid main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, "
                                 "gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0); }\n");
    programDesc.fragment = compile(device, VK_SHADER_STAGE_FRAGMENT_BIT,
                                   "#version 450\nlayout(location = 0) out vec4 color;\n"
                                   "void main() { color = vec4(1.0); }\n");
    vnCreateProgram(device, &programDesc, &program);
    vnGetImageView(device, image, &pass.colors[0].view);
    vnBeginPass(context, &pass);
    vnBindProgram(context, program);
    vnDraw(context, 3, 1, 0, 0);
    vnEndPass(context);
    vnReadImage(context, image, NULL, &pixel, sizeof pixel);
    vnDestroyDevice(device);
    printf("%08x\n", (unsigned)pixel);
    return pixel != 0xFFFFFFFFu;
}
