// Shadows from a depth image drawn where the light stands (Williams 1978), with 2x2 comparisons per look-up and 9 of
// those.
//
//   glFramebufferTexture2D(GL_DEPTH_ATTACHMENT)   VnPassDesc::depthStencil, no colours
//   glDrawBuffer(GL_NONE)                         a program without a fragment shader
//   glPolygonOffset                               VnRasterStateDesc::depthBias*
//   glTexParameteri(GL_TEXTURE_COMPARE_MODE)      VnSamplerDesc::compareEnable
//   sampler2DShadow, texture()                    the same; x, y from 0 to 1 and the depth as it is (no * 0.5 + 0.5)
//   glTexParameterfv(GL_TEXTURE_BORDER_COLOR)     VnSamplerDesc::borderColor
//   glViewport                                    set by vnBeginPass to the attachments
#include "samples/common/app.h"
#include "samples/common/camera.h"

namespace {

constexpr const char* kShadowVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 lightTransform; };
layout(location = 0) in vec3 position;
void main() { gl_Position = lightTransform * vec4(position, 1); })";

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; mat4 light; vec4 toLight; vec4 material; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec3 worldNormal;
layout(location = 1) out vec4 inLight;
layout(location = 2) out vec2 texel;
void main() {
    worldNormal = normal;
    inLight = light * vec4(position, 1);
    texel = uv;
    gl_Position = transform * vec4(position, 1);
})";

constexpr const char* kFragment = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; mat4 light; vec4 toLight; vec4 material; };
layout(set = 0, binding = 0) uniform sampler2DShadow shadowMap;
layout(location = 0) in vec3 worldNormal;
layout(location = 1) in vec4 inLight;
layout(location = 2) in vec2 texel;
layout(location = 0) out vec4 color;
void main() {
    vec3 place = vec3(inLight.xy * 0.5 + 0.5, inLight.z);
    vec2 step = 1.0 / vec2(textureSize(shadowMap, 0));
    float lit = 0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) lit += texture(shadowMap, place + vec3(vec2(x, y) * step, 0));
    float diffuse = max(dot(normalize(worldNormal), toLight.xyz), 0) * lit / 9;
    vec3 albedo = material.rgb;
    if (material.a > 0) {
        vec2 cell = floor(texel);
        albedo *= mod(cell.x + cell.y, 2) > 0.5 ? 0.75 : 1.0;
    }
    color = vec4(albedo * (diffuse + 0.09), 1);
})";

}  // namespace

int main(int argc, char** argv) {
    int side = 1024;
    samples::App app(argc, argv, "Shadow map", {{"--map", "texels on a side of the shadow map (1024)", &side}});
    VnContext context = app.context();
    samples::MeshData solids;
    const auto place = [](float x, float y, float z) { return glm::translate(glm::mat4(1), glm::vec3(x, y, z)); };
    samples::append(solids, samples::boxMesh(), place(-2.4f, 1, -1) * samples::rotation(0.5, {0, 1, 0}));
    samples::append(
        solids, samples::boxMesh(),
        place(-2.3f, 2.6f, -1) * samples::rotation(0.9, {0, 1, 0}) * glm::scale(glm::mat4(1), glm::vec3(0.6f)));
    samples::append(solids, samples::sphereMesh(1.1f), place(0.4f, 1.1f, 1.6f));
    samples::append(solids, samples::torusMesh(1, 0.35f),
                    place(2.4f, 1.4f, -0.8f) * samples::rotation(1.2, {1, 0, 0.3f}));
    for (int i = 0; i < 5; ++i)
        samples::append(
            solids, samples::boxMesh(),
            place(static_cast<float>(i) * 1.6f - 3.2f, 1.2f, -4) * glm::scale(glm::mat4(1), {0.18f, 1.2f, 0.18f}));
    const samples::Mesh objects = app.mesh(solids), floor = app.mesh(samples::planeMesh(9, 18));

    const VnProgram shadowProgram = app.program(kShadowVertex, ""), program = app.program(kVertex, kFragment);
    const VnVertexLayout layout = app.meshLayout();
    const VnVertexLayout positions =
        app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(samples::MeshVertex, position)}},
                   {{sizeof(samples::MeshVertex), 0}});
    const VnDepthStencilState depth = app.depthState();
    const auto texels = static_cast<uint32_t>(glm::clamp(side, 16, 8192));
    const samples::Target shadowMap = app.target(VK_FORMAT_D32_SFLOAT, texels, texels);
    VnRasterStateDesc biased{};
    biased.depthBias = 1;
    biased.depthBiasConstant = 2;
    biased.depthBiasSlope = 3;
    VnRasterState offset{};
    vnCreateRasterState(app.device(), &biased, &offset);
    VnSamplerDesc samplerDesc{};
    samplerDesc.magFilter = samplerDesc.minFilter = VK_FILTER_LINEAR;
    samplerDesc.compareEnable = 1;
    samplerDesc.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    samplerDesc.addressU = samplerDesc.addressV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    samplerDesc.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    VnSampler shadowSampler{};
    vnCreateSampler(app.device(), &samplerDesc, &shadowSampler);
    samples::OrbitCamera camera({0, 0.8f, -0.5f}, 11, 0.35, -0.45);

    return app.run([&](const samples::Frame& frame) {
        camera.update(frame.input);
        const glm::vec3 toLight = glm::normalize(
            glm::vec3(samples::rotation(frame.seconds * 0.4, {0, 1, 0}) * glm::vec4(-0.6f, 0.9f, 0.55f, 0)));
        struct {
            glm::mat4 transform, light;
            glm::vec4 toLight, material;
        } push;
        push.light =
            samples::orthographic(-8, 8, -8, 8, 1, 30) * glm::lookAt(toLight * 15.0f, glm::vec3(0), glm::vec3(0, 1, 0));
        push.transform = samples::perspective(0.8, app.aspect(), 0.5, 60) * camera.view();
        push.toLight = glm::vec4(toLight, 0);

        app.beginPass({}, shadowMap, {});
        vnBindProgram(context, shadowProgram);
        vnBindVertexLayout(context, positions);
        vnBindDepthStencilState(context, depth);
        vnBindRasterState(context, offset);
        app.push(push.light);
        app.draw(objects);
        app.endPass();

        app.beginPass({0.25f, 0.4f, 0.6f, 1});
        vnBindProgram(context, program);
        vnBindVertexLayout(context, layout);
        vnBindRasterState(context, VnRasterState{});
        vnBindTexture(context, 0, 0, 0, shadowMap.view, shadowSampler);
        push.material = {0.85f, 0.45f, 0.2f, 0};
        app.push(push);
        app.draw(objects);
        push.material = {0.6f, 0.62f, 0.58f, 1};
        app.push(push);
        app.draw(floor);
        app.endPass();
    });
}
