// A textured floor that runs to the horizon: perspective-correct interpolation, mip levels, trilinear filtering.
#include "samples/common/app.h"
#include "samples/common/trigonometry.h"

namespace {

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; };
layout(location = 0) out vec2 uv;
void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    uv = corner * 40.0;
    gl_Position = transform * vec4((corner - 0.5) * 40.0, 0, 1).xzyw;
})";

constexpr const char* kFragment = R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(image, uv); })";

}  // namespace

int main(int argc, char** argv) {
    samples::App app(argc, argv, "Textured quad");
    const VnProgram program = app.program(kVertex, kFragment);
    const VnView texture = app.texture(64, 64, samples::checkerTexels(64, 2, 0xFF3355AA, 0xFFE8E0D0));
    VnSamplerDesc samplerDesc{};
    samplerDesc.magFilter = samplerDesc.minFilter = VK_FILTER_LINEAR;
    samplerDesc.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    VnSampler sampler{};
    vnCreateSampler(app.device(), &samplerDesc, &sampler);

    return app.run({0.35f, 0.55f, 0.8f, 1}, [&](const samples::Frame& frame) {
        const double angle = frame.seconds * 0.3;
        const glm::mat4 view = glm::lookAt(glm::vec3(samples::sineF(angle) * 6, 1.2f, samples::cosineF(angle) * 6),
                                           glm::vec3(0, 0.6f, 0), glm::vec3(0, 1, 0));
        const glm::mat4 transform = samples::perspective(1.0f, app.aspect(), 0.1f, 100) * view;
        VnContext context = app.context();
        vnBindProgram(context, program);
        vnBindTexture(context, 0, 0, 0, texture, sampler);
        vnPushConstants(context, 0, &transform, sizeof transform);
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, 0);
        vnDraw(context, 4, 1, 0, 0);
    });
}
