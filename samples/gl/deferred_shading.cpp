// Deferred shading: geometry once into three images, then 48 lights over them.
//
//   glFramebufferTexture2D(GL_COLOR_ATTACHMENT0 + n)   VnPassDesc::colors[n]
//   glDrawBuffers                                      the fragment shader's output locations
//   glClear                                            VnAttachment::loadOp
//   uniform block, glBindBufferBase                    vnBindBuffer (set, binding)
//   glActiveTexture, glBindTexture x 3                 vnBindTexture x 3
//   a quad of two triangles                            vnDraw(3): one triangle covers everything, no vertex buffer
#include "samples/common/app.h"
#include "samples/common/camera.h"
#include "samples/common/random.h"
#include "samples/common/trigonometry.h"

namespace {

constexpr uint32_t kLights = 48;

constexpr const char* kGeometryVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 viewProjection; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 worldPosition;
layout(location = 1) out vec3 worldNormal;
void main() {
    vec3 place = vec3(gl_InstanceIndex % 7 - 3, 0, gl_InstanceIndex / 7 - 3) * 2.2;
    if (gl_InstanceIndex >= 49) place = vec3(0);
    worldPosition = position + place;
    worldNormal = normal;
    gl_Position = viewProjection * vec4(worldPosition, 1);
})";

constexpr const char* kGeometryFragment = R"(#version 450
layout(location = 0) in vec3 worldPosition;
layout(location = 1) in vec3 worldNormal;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 position;
void main() {
    vec2 tile = floor(worldPosition.xz);
    float pattern = worldPosition.y < 0.001 ? 0.35 + 0.25 * mod(tile.x + tile.y, 2) : 0.8;
    albedo = vec4(vec3(pattern), 1);
    normal = vec4(normalize(worldNormal), 0);
    position = vec4(worldPosition, 1);
})";

// `show`: 0 the lit picture, 1 to 3 what the first pass wrote.
constexpr const char* kLightFragment = R"(#version 450
layout(constant_id = 0) const int kLights = 48;
layout(push_constant) uniform Push { vec4 eye; int show; };
layout(set = 0, binding = 0) uniform sampler2D albedoImage;
layout(set = 0, binding = 1) uniform sampler2D normalImage;
layout(set = 0, binding = 2) uniform sampler2D positionImage;
struct Light { vec4 place; vec4 color; };
layout(set = 0, binding = 3) uniform Lights { Light lights[kLights]; };
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 place = texelFetch(positionImage, pixel, 0);
    vec3 albedo = texelFetch(albedoImage, pixel, 0).rgb, normal = texelFetch(normalImage, pixel, 0).xyz;
    if (place.w == 0) discard;
    vec3 sum = albedo * 0.02;
    vec3 toEye = normalize(eye.xyz - place.xyz);
    for (int i = 0; i < kLights; ++i) {
        vec3 way = lights[i].place.xyz - place.xyz;
        float distance2 = dot(way, way);
        float window = max(1 - distance2 / (lights[i].place.w * lights[i].place.w), 0);
        if (window == 0) continue;
        vec3 toLight = way * inversesqrt(distance2);
        float diffuse = max(dot(normal, toLight), 0);
        float specular = pow(max(dot(normal, normalize(toLight + toEye)), 0), 40);
        sum += lights[i].color.rgb * (albedo * diffuse + 0.5 * specular) * window * window / (0.3 + distance2);
    }
    if (show == 1) sum = albedo;
    if (show == 2) sum = normal * 0.5 + 0.5;
    if (show == 3) sum = fract(place.xyz);
    color = vec4(sum, 1);
})";

struct Light {
    glm::vec4 place, color;  // place.w: reach
};

std::vector<Light> lightsAt(double seconds) {
    std::vector<Light> lights;
    samples::Random random(3);
    for (uint32_t i = 0; i < kLights; ++i) {
        const float start = random.between(0, 6.28f), speed = random.between(-0.8f, 0.8f);
        const double angle = start + seconds * speed;
        const float radius = random.between(0.5f, 8), height = random.between(0.4f, 1.7f);
        const float hue = random.between(0, 6.28f);
        const glm::vec3 color =
            glm::vec3(samples::cosineF(hue), samples::cosineF(hue - 2.09), samples::cosineF(hue + 2.09));
        lights.push_back({{radius * samples::cosineF(angle), height, radius * samples::sineF(angle), 3.5f},
                          glm::vec4(color * 0.5f + 0.55f, 1)});
    }
    return lights;
}

}  // namespace

int main(int argc, char** argv) {
    int show = 0;
    samples::App app(argc, argv, "Deferred shading",
                     {{"--show",
                       "the lit picture or what the first pass wrote: lit, albedo, normal, position",
                       &show,
                       'v',
                       {"lit", "albedo", "normal", "position"}}});
    VnContext context = app.context();
    samples::MeshData solid;
    const glm::mat4 up = glm::translate(glm::mat4(1), glm::vec3(0, 0.35f, 0));
    samples::append(solid, samples::boxMesh(), up * glm::scale(glm::mat4(1), glm::vec3(0.35f)));
    samples::append(solid, samples::sphereMesh(0.42f, 24, 16), glm::translate(glm::mat4(1), glm::vec3(0, 1.1f, 0)));
    const samples::Mesh solids = app.mesh(solid), floor = app.mesh(samples::planeMesh(10));
    const VnProgram geometry = app.program(kGeometryVertex, kGeometryFragment);
    const VnProgram lighting = app.program(samples::kFullScreenVertex, kLightFragment);
    const VnVertexLayout layout = app.meshLayout();
    const VnDepthStencilState depth = app.depthState();
    const samples::Target& albedo = app.windowTarget(VK_FORMAT_R8G8B8A8_UNORM);
    const samples::Target& normal = app.windowTarget(VK_FORMAT_R16G16B16A16_SFLOAT);
    const samples::Target& position = app.windowTarget(VK_FORMAT_R32G32B32A32_SFLOAT);
    const VnBuffer lights = app.buffer(lightsAt(0));
    const VnSampler nearest = app.sampler(VK_FILTER_NEAREST);
    samples::OrbitCamera camera({0, 0, 0}, 13, 0.4, -0.5);

    return app.run([&](const samples::Frame& frame) {
        camera.update(frame.input);
        app.update(lights, lightsAt(frame.seconds));
        const glm::mat4 viewProjection = samples::perspective(0.8, app.aspect(), 0.5, 60) * camera.view();

        app.beginPass({albedo, normal, position}, app.depth(), glm::vec4(0));
        vnBindProgram(context, geometry);
        vnBindVertexLayout(context, layout);
        vnBindDepthStencilState(context, depth);
        app.push(viewProjection);
        app.draw(solids, 49);
        vnBindVertexBuffer(context, 0, floor.vertices, 0);
        vnBindIndexBuffer(context, floor.indices, 0, VK_INDEX_TYPE_UINT32);
        vnDrawIndexed(context, floor.indexCount, 1, 0, 0, 49);
        app.endPass();

        app.beginPass({0.01f, 0.01f, 0.02f, 1});
        vnBindProgram(context, lighting);
        vnBindVertexLayout(context, VnVertexLayout{});
        vnBindDepthStencilState(context, VnDepthStencilState{});
        vnBindTexture(context, 0, 0, 0, albedo.view, nearest);
        vnBindTexture(context, 0, 1, 0, normal.view, nearest);
        vnBindTexture(context, 0, 2, 0, position.view, nearest);
        vnBindBuffer(context, 0, 3, 0, lights, 0, 0);
        struct {
            glm::vec4 eye;
            int show;
        } push{glm::vec4(camera.position(), 1), show};
        app.push(push);
        vnDraw(context, 3, 1, 0, 0);
        app.endPass();
    });
}
