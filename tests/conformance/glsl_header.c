/* The header must be usable from C99 as it is. */
#include <vernier/vernier_glsl.h>

VnGlslResult compileFromC(const char* source, VnGlslOutput** out);

VnGlslResult compileFromC(const char* source, VnGlslOutput** out) {
    VnGlslDesc desc = {0};
    desc.stage = VK_SHADER_STAGE_VERTEX_BIT;
    desc.source = source;
    return vnCompileGlsl(&desc, out);
}
