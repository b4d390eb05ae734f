// What is under the mouse? A second pass writes the number of each object into an integer image; one texel of it is
// read.
//
//   glRenderbufferStorage(GL_R32UI)           vnCreateImage with VK_FORMAT_R32_UINT
//   glClearBufferuiv                          VnAttachment::clear.color.uint32
//   glScissor                                 vnSetScissor: only the pixel under the mouse is drawn
//   glReadPixels(x, y, 1, 1)                  vnReadImage with a VnRegion; y runs down, so no height - 1 - y
//   glReadPixels waits for the GPU            so does vnReadImage, for the work of its context alone
//   glUniform1ui                              vnPushConstants
#include <cstdio>

#include "samples/common/app.h"
#include "samples/common/camera.h"
#include "samples/common/random.h"

namespace {

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; vec4 material; uint object; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 localNormal;
void main() {
    localNormal = normal;
    gl_Position = transform * vec4(position, 1);
})";

constexpr const char* kFragment = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; vec4 material; uint object; };
layout(location = 0) in vec3 localNormal;
layout(location = 0) out vec4 color;
void main() {
    float light = dot(normalize(localNormal), normalize(vec3(0.4, 0.8, 0.5))) * 0.5 + 0.5;
    color = vec4(material.rgb * light + material.a, 1);
})";

constexpr const char* kNumber = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; vec4 material; uint object; };
layout(location = 0) out uint number;
void main() { number = object; })";

struct Object {
    const samples::Mesh* mesh;
    glm::mat4 place;
    glm::vec3 color;
};

struct Push {
    glm::mat4 transform;
    glm::vec4 material;
    uint32_t object;
};

}  // namespace

int main(int argc, char** argv) {
    std::string pointer;
    samples::App app(argc, argv, "Picking",
                     {{"--pointer", "X,Y: where the mouse is, without a window (the middle)", &pointer}});
    VnContext context = app.context();
    const samples::Mesh meshes[] = {app.mesh(samples::boxMesh()), app.mesh(samples::sphereMesh(1.2f)),
                                    app.mesh(samples::torusMesh(1, 0.45f))};
    std::vector<Object> objects;
    samples::Random random(5);
    for (int i = 0; i < 75; ++i) {
        const glm::vec3 place(i % 5 - 2, i / 5 % 5 - 2, i / 25 - 1);
        const uint32_t mesh = random.below(3);
        const float angle = random.between(0, 6);
        const glm::vec3 axis{random.between(-1, 1), 1, random.between(-1, 1)};
        objects.push_back({&meshes[mesh],
                           glm::translate(glm::mat4(1), place * 2.6f) * samples::rotation(angle, axis) *
                               glm::scale(glm::mat4(1), glm::vec3(0.65f)),
                           {random.between(0.2f, 0.9f), random.between(0.2f, 0.9f), random.between(0.2f, 0.9f)}});
    }
    const VnProgram draw = app.program(kVertex, kFragment), number = app.program(kVertex, kNumber);
    const VnVertexLayout layout = app.meshLayout();
    const VnDepthStencilState depth = app.depthState();
    const samples::Target& numbers = app.windowTarget(VK_FORMAT_R32_UINT);
    samples::OrbitCamera camera({0, 0, 0}, 19, 0.5, -0.3);
    glm::vec2 mouse(static_cast<float>(app.width()) / 2, static_cast<float>(app.height()) / 2);
    if (!pointer.empty() && std::sscanf(pointer.c_str(), "%f,%f", &mouse.x, &mouse.y) != 2) {
        std::fprintf(stderr, "--pointer is \"%s\", but must be X,Y\n", pointer.c_str());
        return 1;
    }

    return app.run([&](const samples::Frame& frame) {
        camera.update(frame.input);
        if (app.hasWindow()) mouse = frame.input.mouse;
        const glm::mat4 viewProjection = samples::perspective(0.8, app.aspect(), 0.5, 80) * camera.view() *
                                         samples::rotation(frame.seconds * 0.2, {0, 1, 0});
        vnBindVertexLayout(context, layout);
        vnBindDepthStencilState(context, depth);
        // Everything with its number; 0 is the background.
        const auto drawAll = [&](uint32_t picked) {
            for (uint32_t i = 0; i < objects.size(); ++i) {
                const Object& object = objects[i];
                const float glow = i + 1 == picked ? 0.7f : 0.0f;
                app.push(Push{viewProjection * object.place, glm::vec4(object.color, glow), i + 1});
                app.draw(*object.mesh);
            }
        };

        const auto x = static_cast<int32_t>(glm::clamp(mouse.x, 0.0f, static_cast<float>(app.width() - 1)));
        const auto y = static_cast<int32_t>(glm::clamp(mouse.y, 0.0f, static_cast<float>(app.height() - 1)));
        app.beginPass({numbers}, app.depth(), glm::vec4(0));
        const VkRect2D onePixel{{x, y}, {1, 1}};
        vnSetScissor(context, &onePixel);
        vnBindProgram(context, number);
        drawAll(0);
        app.endPass();
        VnRegion region{};
        region.x = static_cast<uint32_t>(x);
        region.y = static_cast<uint32_t>(y);
        region.width = region.height = 1;
        uint32_t picked = 0;
        vnReadImage(context, numbers.image, &region, &picked, sizeof picked);

        app.beginPass({0.03f, 0.03f, 0.04f, 1});
        vnBindProgram(context, draw);
        drawAll(picked);
        // A cross at the pointer, cleared into the picture.
        const VkClearColorValue white{{1, 1, 1, 1}};
        const VkRect2D across{{glm::max(x - 8, 0), y}, {16, 1}}, down{{x, glm::max(y - 8, 0)}, {1, 16}};
        vnClearColor(context, 0, &white, &across);
        vnClearColor(context, 0, &white, &down);
        app.endPass();
    });
}
