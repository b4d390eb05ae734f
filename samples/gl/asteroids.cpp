// A planet and its ring of two thousand rocks, drawn by one call.
//
//   glVertexAttribDivisor(location, 1)        VnVertexBinding::perInstance
//   glVertexAttribPointer x 4 for a matrix    here place, axis and angle: two attributes of the instance
//   glDrawElementsInstanced                   vnDrawIndexed with instanceCount
//   gl_InstanceID                             gl_InstanceIndex (which counts from firstInstance)
//   glUniformMatrix4fv                        vnPushConstants
#include "samples/common/app.h"
#include "samples/common/camera.h"
#include "samples/common/random.h"
#include "samples/common/trigonometry.h"

namespace {

// Turns around the instance's axis (Rodrigues), then moves along the orbit.
constexpr const char* kRockVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 viewProjection; vec4 time; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 3) in vec4 orbit;  // radius, angle, height, speed
layout(location = 4) in vec4 spin;   // axis, size
layout(location = 0) out vec3 worldNormal;
layout(location = 1) out float tint;
vec3 turn(vec3 v, vec3 axis, float angle) {
    return v * cos(angle) + cross(axis, v) * sin(angle) + axis * dot(axis, v) * (1 - cos(angle));
}
void main() {
    float angle = orbit.y + orbit.w * time.x;
    float tumble = time.x * (1 + orbit.w * 20) + orbit.y * 7;
    worldNormal = turn(normal, spin.xyz, tumble);
    tint = fract(orbit.y * 37);
    vec3 place = vec3(orbit.x * cos(angle), orbit.z, orbit.x * sin(angle));
    gl_Position = viewProjection * vec4(place + turn(position, spin.xyz, tumble) * spin.w, 1);
})";

constexpr const char* kRockFragment = R"(#version 450
layout(location = 0) in vec3 worldNormal;
layout(location = 1) in float tint;
layout(location = 0) out vec4 color;
void main() {
    float light = max(dot(normalize(worldNormal), normalize(vec3(0.8, 0.35, 0.5))), 0);
    color = vec4(mix(vec3(0.42, 0.36, 0.3), vec3(0.3, 0.3, 0.34), tint) * (light + 0.03), 1);
})";

constexpr const char* kPlanetVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 viewProjection; vec4 time; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 worldNormal;
layout(location = 1) out vec3 local;
void main() {
    worldNormal = normal;
    local = position;
    gl_Position = viewProjection * vec4(position, 1);
})";

constexpr const char* kPlanetFragment = R"(#version 450
layout(location = 0) in vec3 worldNormal;
layout(location = 1) in vec3 local;
layout(location = 0) out vec4 color;
void main() {
    float bands = sin(local.y * 5 + 0.4 * sin(local.x * 3 + local.z * 2)) * 0.5 + 0.5;
    vec3 albedo = mix(vec3(0.75, 0.5, 0.28), vec3(0.5, 0.24, 0.12), bands);
    float light = max(dot(normalize(worldNormal), normalize(vec3(0.8, 0.35, 0.5))), 0);
    color = vec4(albedo * (light + 0.015), 1);
})";

struct Instance {
    glm::vec4 orbit, spin;
};

std::vector<Instance> ring(uint32_t count) {
    std::vector<Instance> instances;
    samples::Random random(7);
    for (uint32_t i = 0; i < count; ++i) {
        // The sum of three is thickest in the middle of the ring.
        float across = 0;
        for (int part = 0; part < 3; ++part) across += random.between(-1, 1);
        Instance one;
        one.orbit = {8.5f + across * 1.3f, random.between(0, 6.2831853f), random.between(-0.35f, 0.35f), 0};
        one.orbit.w = 0.6f / one.orbit.x;
        const glm::vec3 axis{random.between(-1, 1), random.between(0.1f, 1), random.between(-1, 1)};
        one.spin = glm::vec4(glm::normalize(axis), random.between(0.04f, 0.16f));
        instances.push_back(one);
    }
    return instances;
}

/// A coarse sphere with dents.
samples::MeshData rock() {
    samples::MeshData mesh = samples::sphereMesh(1, 12, 8);
    for (samples::MeshVertex& vertex : mesh.vertices) {
        const glm::vec3 p = vertex.position;
        const float bump = samples::sineF(p.x * 3 + 1) * samples::sineF(p.y * 4 + 2) * samples::sineF(p.z * 5);
        vertex.position = p * (1 + 0.35f * bump);
    }
    samples::computeNormals(mesh);
    return mesh;
}

}  // namespace

int main(int argc, char** argv) {
    int count = 2000;
    samples::App app(argc, argv, "Asteroids", {{"--count", "rocks (2000)", &count}});
    VnContext context = app.context();
    const std::vector<Instance> instances = ring(static_cast<uint32_t>(glm::clamp(count, 1, 1000000)));
    const VnBuffer instanceBuffer = app.buffer(instances);
    const samples::Mesh rockMesh = app.mesh(rock()), planet = app.mesh(samples::sphereMesh(4, 64, 32));
    const VnProgram rocks = app.program(kRockVertex, kRockFragment),
                    sphere = app.program(kPlanetVertex, kPlanetFragment);
    const VnVertexLayout planetLayout = app.meshLayout();
    const VnVertexLayout rockLayout =
        app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(samples::MeshVertex, position)},
                    {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(samples::MeshVertex, normal)},
                    {3, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Instance, orbit)},
                    {4, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Instance, spin)}},
                   {{sizeof(samples::MeshVertex), 0}, {sizeof(Instance), 1}});
    const VnDepthStencilState depth = app.depthState();
    const VnRasterState cullBack = app.rasterState(VK_CULL_MODE_BACK_BIT);
    samples::OrbitCamera camera({0, 0, 0}, 17, 0.3, -0.3);

    return app.run({0.002f, 0.002f, 0.006f, 1}, [&](const samples::Frame& frame) {
        camera.update(frame.input);
        struct {
            glm::mat4 viewProjection;
            glm::vec4 time;
        } push{samples::perspective(0.8, app.aspect(), 0.5, 100) * camera.view(),
               glm::vec4(static_cast<float>(frame.seconds))};
        app.push(push);
        vnBindDepthStencilState(context, depth);
        vnBindRasterState(context, cullBack);
        vnBindProgram(context, sphere);
        vnBindVertexLayout(context, planetLayout);
        app.draw(planet);
        vnBindProgram(context, rocks);
        vnBindVertexLayout(context, rockLayout);
        vnBindVertexBuffer(context, 1, instanceBuffer, 0);
        app.draw(rockMesh, static_cast<uint32_t>(instances.size()));
    });
}
