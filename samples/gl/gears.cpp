// Three gears that turn each other: the oldest of the GL demonstrations, with GL's own clip space.
//
//   glGenLists, glNewList, glBegin .. glEnd   vertices in a vnCreateBuffer, drawn by vnDraw
//   glShadeModel(GL_FLAT)                     one normal per face in the vertices
//   glLightfv(GL_LIGHT0, GL_POSITION)         a constant of the vertex shader
//   glMaterialfv, glPushMatrix, glRotatef     vnPushConstants before each draw
//   glFrustum                                 samples::frustumGl: clip depths from -w to w, y up, as GL has them, with
//                                             VnRasterStateDesc::depthNegativeOneToOne and a vnSetViewport of negative
//                                             height
//   glEnable(GL_CULL_FACE)                    VnRasterStateDesc::cullMode
//   glEnable(GL_DEPTH_TEST)                   VnDepthStencilStateDesc::depthTest and depthWrite
//   glXSwapBuffers                            vnEndPass, vnReadImage
#include "samples/common/app.h"
#include "samples/common/camera.h"
#include "samples/common/trigonometry.h"

namespace {

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 projection; mat4 modelView; vec4 material; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 lit;
void main() {
    const vec3 light = normalize(vec3(5, 5, 10));
    vec3 n = normalize(mat3(modelView) * normal);
    lit = material.rgb * (0.2 + max(dot(n, light), 0));
    gl_Position = projection * modelView * vec4(position, 1);
})";

constexpr const char* kFragment = R"(#version 450
layout(location = 0) in vec3 lit;
layout(location = 0) out vec4 color;
void main() { color = vec4(lit, 1); })";

struct Vertex {
    glm::vec3 position, normal;
};

/// What glBegin(GL_QUADS) did: four corners around, two triangles; the normal is that of the plane.
void quad(std::vector<Vertex>& list, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    for (const glm::vec3& corner : {a, b, c, a, c, d}) list.push_back({corner, normal});
}

/// A wheel around the z axis, from the hole to the tips of the teeth.
std::vector<Vertex> gear(float innerRadius, float outerRadius, float width, int teeth, float toothDepth) {
    std::vector<Vertex> list;
    const float root = outerRadius - toothDepth / 2, tip = outerRadius + toothDepth / 2, z = width / 2;
    const double step = 2 * samples::kPi / teeth / 4;
    const auto at = [](float radius, double angle, float height) {
        return glm::vec3(radius * samples::cosineF(angle), radius * samples::sineF(angle), height);
    };
    for (int tooth = 0; tooth < teeth; ++tooth) {
        const double a0 = tooth * 4 * step, a[5] = {a0, a0 + step, a0 + 2 * step, a0 + 3 * step, a0 + 4 * step};
        // Four slices: flank up, tip, flank down, gap.
        const float radius[5] = {root, tip, tip, root, root};
        for (int slice = 0; slice < 4; ++slice) {
            const double from = a[slice], to = a[slice + 1];
            const float r0 = radius[slice], r1 = radius[slice + 1];
            quad(list, at(innerRadius, from, z), at(r0, from, z), at(r1, to, z), at(innerRadius, to, z));
            quad(list, at(innerRadius, to, -z), at(r1, to, -z), at(r0, from, -z), at(innerRadius, from, -z));
            quad(list, at(r0, from, z), at(r0, from, -z), at(r1, to, -z), at(r1, to, z));
            quad(list, at(innerRadius, to, z), at(innerRadius, to, -z), at(innerRadius, from, -z),
                 at(innerRadius, from, z));
        }
    }
    return list;
}

struct Gear {
    std::vector<Vertex> vertices;
    VnBuffer buffer;
    glm::vec4 material;
    glm::vec3 place;
    double speed, phase;  // degrees
};

}  // namespace

int main(int argc, char** argv) {
    samples::App app(argc, argv, "Gears");
    VnContext context = app.context();
    const VnProgram program = app.program(kVertex, kFragment);
    const VnVertexLayout layout = app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                                              {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)}},
                                             {{sizeof(Vertex), 0}});
    const VnDepthStencilState depth = app.depthState();
    VnRasterStateDesc rasterDesc{};
    rasterDesc.cullMode = VK_CULL_MODE_BACK_BIT;
    rasterDesc.depthNegativeOneToOne = 1;
    VnRasterState raster{};
    vnCreateRasterState(app.device(), &rasterDesc, &raster);

    Gear gears[] = {{gear(1, 4, 1, 20, 0.7f), {}, {0.8f, 0.1f, 0, 1}, {-3, -2, 0}, 1, 0},
                    {gear(0.5f, 2, 2, 10, 0.7f), {}, {0, 0.8f, 0.2f, 1}, {3.1f, -2, 0}, -2, -9},
                    {gear(1.3f, 2, 0.5f, 10, 0.7f), {}, {0.2f, 0.2f, 1, 1}, {-3.1f, 4.2f, 0}, -2, -25}};
    for (Gear& one : gears) one.buffer = app.buffer(one.vertices);
    samples::OrbitCamera camera({0, 0.9f, 0}, 20, 0.52, -0.35);

    return app.run({0, 0, 0, 1}, [&](const samples::Frame& frame) {
        camera.update(frame.input);
        const VkViewport upwards{
            0, static_cast<float>(app.height()), static_cast<float>(app.width()), -static_cast<float>(app.height()), 0,
            1};
        vnSetViewport(context, &upwards);
        vnBindProgram(context, program);
        vnBindVertexLayout(context, layout);
        vnBindDepthStencilState(context, depth);
        vnBindRasterState(context, raster);
        const double angle = frame.seconds * 70;
        for (const Gear& one : gears) {
            struct {
                glm::mat4 projection, modelView;
                glm::vec4 material;
            } push;
            push.projection = samples::frustumGl(-app.aspect(), app.aspect(), -1, 1, 2.8, 60);
            push.modelView = camera.view() * glm::translate(glm::mat4(1), one.place) *
                             samples::rotation((angle * one.speed + one.phase) * samples::kPi / 180, {0, 0, 1});
            push.material = one.material;
            app.push(push);
            vnBindVertexBuffer(context, 0, one.buffer, 0);
            vnDraw(context, static_cast<uint32_t>(one.vertices.size()), 1, 0, 0);
        }
    });
}
