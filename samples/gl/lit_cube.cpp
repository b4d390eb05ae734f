// A crate with a texture and a light: the second lesson of every GL course.
//
//   glGenBuffers, glBufferData                vnCreateBuffer
//   glVertexAttribPointer, VAO                vnCreateVertexLayout, vnBindVertexBuffer
//   glGenTextures, glTexImage2D               vnCreateImage, vnUpdateImage
//   glGenerateMipmap                          vnGenerateMips
//   glTexParameteri                           vnCreateSampler
//   glActiveTexture, glBindTexture            vnBindTexture (set, binding)
//   glUniformMatrix4fv                        vnPushConstants
//   glClear                                   VnAttachment::loadOp of the pass
//   glDrawElements                            vnDrawIndexed
#include "samples/common/app.h"
#include "samples/common/camera.h"
#include "samples/common/random.h"

namespace {

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; mat4 model; vec4 eye; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 textureCoordinate;
layout(location = 0) out vec3 worldPosition;
layout(location = 1) out vec3 worldNormal;
layout(location = 2) out vec2 uv;
void main() {
    worldPosition = (model * vec4(position, 1)).xyz;
    worldNormal = mat3(model) * normal;
    uv = textureCoordinate;
    gl_Position = transform * vec4(position, 1);
})";

// Phong: ambient + diffuse + specular (Phong 1975).
constexpr const char* kFragment = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; mat4 model; vec4 eye; };
layout(set = 0, binding = 0) uniform sampler2D wood;
layout(location = 0) in vec3 worldPosition;
layout(location = 1) in vec3 worldNormal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 color;
const vec3 lightPosition = vec3(2.5, 3.5, 3.0);
void main() {
    vec3 normal = normalize(worldNormal);
    vec3 toLight = normalize(lightPosition - worldPosition);
    vec3 toEye = normalize(eye.xyz - worldPosition);
    float diffuse = max(dot(normal, toLight), 0);
    float specular = diffuse > 0 ? pow(max(dot(reflect(-toLight, normal), toEye), 0), 32) : 0;
    vec3 albedo = texture(wood, uv).rgb;
    color = vec4(albedo * (0.08 + diffuse) + 0.35 * specular, 1);
})";

uint32_t shade(float r, float g, float b, float light) {
    const auto byte = [&](float x) { return static_cast<uint32_t>(glm::clamp(x * light, 0.0f, 1.0f) * 255 + 0.5f); };
    return byte(r) | byte(g) << 8 | byte(b) << 16 | 0xFF000000u;
}

/// Five planks with grain and a frame around and across.
std::vector<uint32_t> crateTexels(int size) {
    std::vector<uint32_t> texels;
    samples::Random random(1);
    std::vector<float> grain;
    for (int i = 0; i < size; ++i) grain.push_back(random.between(0.85f, 1.05f));
    const int frame = size / 8;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const bool border = x < frame || y < frame || x >= size - frame || y >= size - frame;
            const bool across = !border && glm::abs(x - y) < frame * 3 / 4;
            const int plank = y * 5 / size;
            float light = grain[static_cast<size_t>((border || across ? x + y * 2 : y) % size)];
            light *= 0.9f + 0.05f * static_cast<float>(plank % 3);
            const int edge = border ? glm::min(glm::min(x, y), size - 1 - glm::max(x, y)) : -1;
            if (edge == 0 || edge == frame - 1) light *= 0.5f;
            if (!border && !across && y * 5 % size < 5) light *= 0.35f;
            texels.push_back(border || across ? shade(0.72f, 0.5f, 0.28f, light) : shade(0.6f, 0.4f, 0.22f, light));
        }
    return texels;
}

}  // namespace

int main(int argc, char** argv) {
    samples::App app(argc, argv, "Lit cube");
    VnContext context = app.context();
    const samples::Mesh cube = app.mesh(samples::boxMesh());
    const VnVertexLayout layout = app.meshLayout();
    const VnProgram program = app.program(kVertex, kFragment);
    const VnView wood = app.texture(256, 256, crateTexels(256));
    const VnSampler trilinear = app.sampler(VK_FILTER_LINEAR);
    const VnDepthStencilState depth = app.depthState();
    const VnRasterState cullBack = app.rasterState(VK_CULL_MODE_BACK_BIT);
    samples::OrbitCamera camera({0, 0, 0}, 4.6f, 0, -0.45);

    return app.run({0.05f, 0.07f, 0.1f, 1}, [&](const samples::Frame& frame) {
        camera.update(frame.input);
        struct {
            glm::mat4 transform, model;
            glm::vec4 eye;
        } push;
        push.model = samples::rotation(frame.seconds * 0.6 + 0.6, {0, 1, 0});
        push.transform = samples::perspective(0.8, app.aspect(), 0.1, 50) * camera.view() * push.model;
        push.eye = glm::vec4(camera.position(), 1);
        vnBindProgram(context, program);
        vnBindVertexLayout(context, layout);
        vnBindDepthStencilState(context, depth);
        vnBindRasterState(context, cullBack);
        vnBindTexture(context, 0, 0, 0, wood, trilinear);
        app.push(push);
        app.draw(cube);
    });
}
