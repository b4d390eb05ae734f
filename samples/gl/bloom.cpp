// Post-processing: light brighter than white bleeds over its surroundings, and the rest fits into 0..1.
//
//   glTexImage2D(GL_RGBA16F)                  vnCreateImage with VK_FORMAT_R16G16B16A16_SFLOAT
//   glBindFramebuffer for each step           vnBeginPass for each step
//   ping-pong between two textures            the same; each pass clears or covers what it draws to
//   glTexParameteri(GL_CLAMP_TO_EDGE)         VnSamplerDesc::addressU, addressV
//   glUniform2f                               vnPushConstants
//   GL_FRAMEBUFFER_SRGB                       the window's image has an _SRGB format: stores encode
#include "samples/common/app.h"
#include "samples/common/camera.h"
#include "samples/common/trigonometry.h"

namespace {

constexpr const char* kSceneVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; mat4 model; vec4 color; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 worldNormal;
void main() {
    worldNormal = mat3(model) * normal;
    gl_Position = transform * model * vec4(position, 1);
})";

// color.a: how much of the colour shines by itself.
constexpr const char* kSceneFragment = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; mat4 model; vec4 color; };
layout(location = 0) in vec3 worldNormal;
layout(location = 0) out vec4 result;
void main() {
    float light = max(dot(normalize(worldNormal), normalize(vec3(0.3, 0.9, 0.4))), 0) * 0.6 + 0.05;
    result = vec4(color.rgb * mix(light, 1, color.a), 1);
})";

constexpr const char* kBright = R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(max(texture(image, uv).rgb - 1, vec3(0)), 1); })";

// One direction of a Gaussian of sigma 4; each look-up between two texels weighs both.
constexpr const char* kBlur = R"(#version 450
layout(push_constant) uniform Push { vec2 step; };
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
float weight(float x) { return exp(-x * x / 32); }
void main() {
    vec3 sum = texture(image, uv).rgb;
    float total = 1;
    for (int i = 1; i < 12; i += 2) {
        float a = weight(float(i)), b = weight(float(i + 1)), w = a + b;
        vec2 offset = step * (float(i) + b / w);
        sum += (texture(image, uv + offset).rgb + texture(image, uv - offset).rgb) * w;
        total += 2 * w;
    }
    color = vec4(sum / total, 1);
})";

// Reinhard's curve on what the scene and its glow add up to.
constexpr const char* kCombine = R"(#version 450
layout(push_constant) uniform Push { float strength; };
layout(set = 0, binding = 0) uniform sampler2D scene;
layout(set = 0, binding = 1) uniform sampler2D glow;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    vec3 light = texture(scene, uv).rgb + strength * texture(glow, uv).rgb;
    color = vec4(light / (1 + light * 0.6), 1);
})";

}  // namespace

int main(int argc, char** argv) {
    bool bloom = true;
    samples::App app(argc, argv, "Bloom", {{"--bloom", "bright light bleeds", &bloom, 'b'}});
    VnContext context = app.context();
    const samples::Mesh ball = app.mesh(samples::sphereMesh(0.45f)),
                        ring = app.mesh(samples::torusMesh(2.2f, 0.09f, 96, 16)),
                        floor = app.mesh(samples::planeMesh(12)), box = app.mesh(samples::boxMesh());
    const VnProgram scene = app.program(kSceneVertex, kSceneFragment);
    const VnProgram bright = app.program(samples::kFullScreenVertex, kBright);
    const VnProgram blur = app.program(samples::kFullScreenVertex, kBlur);
    const VnProgram combine = app.program(samples::kFullScreenVertex, kCombine);
    const VnVertexLayout layout = app.meshLayout();
    const VnDepthStencilState depth = app.depthState();
    const VkFormat half = VK_FORMAT_R16G16B16A16_SFLOAT;
    const auto halfSize = [](VkExtent2D size) { return VkExtent2D{(size.width + 1) / 2, (size.height + 1) / 2}; };
    const samples::Target& light = app.windowTarget(half);
    const samples::Target& ping = app.windowTarget(half, halfSize);
    const samples::Target& pong = app.windowTarget(half, halfSize);
    const VnSampler linear = app.sampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    samples::OrbitCamera camera({0, 1.2f, 0}, 9, 0.3, -0.25);

    const auto drawScene = [&](double seconds) {
        struct {
            glm::mat4 transform, model;
            glm::vec4 color;
        } push;
        push.transform = samples::perspective(0.8, app.aspect(), 0.1, 60) * camera.view();
        const auto put = [&](const samples::Mesh& mesh, const glm::mat4& model, const glm::vec4& color) {
            push.model = model;
            push.color = color;
            app.push(push);
            app.draw(mesh);
        };
        const auto at = [](float x, float y, float z) { return glm::translate(glm::mat4(1), glm::vec3(x, y, z)); };
        put(floor, glm::mat4(1), {0.25f, 0.27f, 0.3f, 0});
        put(box, at(0, 0.6f, 0) * glm::scale(glm::mat4(1), glm::vec3(0.6f)), {0.5f, 0.5f, 0.55f, 0});
        put(ring, at(0, 1.6f, 0) * samples::rotation(seconds * 0.5 + 0.4, {1, 0, 0.4f}), {0.3f, 2.2f, 6, 1});
        const glm::vec3 colors[] = {{7, 2, 0.4f}, {5, 0.5f, 3}, {0.8f, 5, 1}, {6, 5, 1}, {1, 2, 7}};
        for (int i = 0; i < 5; ++i) {
            const double angle = i * 2 * samples::kPi / 5 + seconds * 0.4;
            put(ball, at(3.4f * samples::cosineF(angle), 0.5f, 3.4f * samples::sineF(angle)), glm::vec4(colors[i], 1));
            put(box,
                at(2.2f * samples::cosineF(angle), 0.3f, 2.2f * samples::sineF(angle)) *
                    glm::scale(glm::mat4(1), glm::vec3(0.3f)),
                {0.4f, 0.38f, 0.36f, 0});
        }
    };
    // Everything of `target` from one program over `source`.
    const auto filter = [&](VnProgram program, const samples::Target& source, const samples::Target& target) {
        app.beginPass({target}, {}, glm::vec4(0));
        vnBindProgram(context, program);
        vnBindTexture(context, 0, 0, 0, source.view, linear);
        vnDraw(context, 3, 1, 0, 0);
        app.endPass();
    };

    return app.run([&](const samples::Frame& frame) {
        camera.update(frame.input);
        vnBindVertexLayout(context, layout);
        vnBindDepthStencilState(context, depth);
        app.beginPass({light}, app.depth(), {0.01f, 0.012f, 0.02f, 1});
        vnBindProgram(context, scene);
        drawScene(frame.seconds);
        app.endPass();

        vnBindVertexLayout(context, VnVertexLayout{});
        vnBindDepthStencilState(context, VnDepthStencilState{});
        filter(bright, light, ping);
        for (int round = 0; round < 2; ++round) {
            app.push(glm::vec2(1 / static_cast<float>(ping.width), 0));
            filter(blur, ping, pong);
            app.push(glm::vec2(0, 1 / static_cast<float>(ping.height)));
            filter(blur, pong, ping);
        }
        vnBindTexture(context, 0, 1, 0, ping.view, linear);
        app.push(bloom ? 1.2f : 0.0f);
        filter(combine, light, app.color());
    });
}
