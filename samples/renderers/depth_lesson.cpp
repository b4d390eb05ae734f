// What is in front? Three answers, and where they fail: the painter's algorithm, a "y-buffer" that renders a flat world
// to one row, and the depth buffer. Then a model with flat light and a texture.
//   --scene overlap|y-buffer|model  --hidden painter|buffer|none  --texture FILE  [FILE.obj]
// Pictures come and go as TGA, too: --texture face.tga --headless out.tga
#include <algorithm>

#include "samples/common/app.h"
#include "samples/common/camera.h"
#include "samples/common/obj_file.h"
#include "samples/common/picture_file.h"
#include "samples/common/trigonometry.h"

namespace {

const std::string kVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; vec4 options; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 tint;
layout(location = 2) in vec2 textureCoordinate;
layout(location = 0) out vec3 color;
layout(location = 1) out vec3 place;
layout(location = 2) out vec2 uv;
void main() {
    color = tint;
    place = position;
    uv = textureCoordinate;
    gl_Position = transform * vec4(position, 1);
})";

const std::string kColored = R"(#version 450
layout(location = 0) in vec3 color;
layout(location = 0) out vec4 result;
void main() { result = vec4(color, 1); })";

// The normal of the face from how the place changes over the pixels; the light comes from where the eye is. Back faces
// are dark by the same cosine.
const std::string kFlat = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; vec4 options; };
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 1) in vec3 place;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 result;
void main() {
    vec3 normal = normalize(cross(dFdy(place), dFdx(place)));
    float light = max(dot(normal, options.xyz), 0);
    result = vec4(texture(image, uv).rgb * (light + 0.03), 1);
})";

struct Vertex {
    glm::vec3 position, color;
    glm::vec2 uv;
};
using Triangle = std::array<Vertex, 3>;

/// Three planks, each over the next: no order of drawing is right.
std::vector<Triangle> planks() {
    std::vector<Triangle> triangles;
    const glm::vec3 colors[] = {{0.8f, 0.12f, 0.1f}, {0.1f, 0.6f, 0.15f}, {0.12f, 0.2f, 0.85f}};
    for (int i = 0; i < 3; ++i) {
        const glm::mat4 turn = samples::rotation(i * 2 * samples::kPi / 3, {0, 0, 1});
        const auto corner = [&](float x, float y, float z) {
            return Vertex{glm::vec3(turn * glm::vec4(x, y, z, 1)), colors[i], {}};
        };
        // Its right end lies in front, its left end behind.
        triangles.push_back({corner(-1.25f, 0.35f, -0.4f), corner(1.25f, 0.1f, 0.4f), corner(1.25f, 0.6f, 0.4f)});
    }
    return triangles;
}

/// Walls of a flat world, seen from above: x across, y away from the eye.
struct Segment {
    glm::vec2 from, to;
    glm::vec3 color;
};
const Segment kSegments[] = {{{-0.85f, 0.25f}, {-0.1f, 0.75f}, {0.9f, 0.2f, 0.15f}},
                             {{-0.5f, 0.8f}, {0.6f, 0.3f}, {0.2f, 0.8f, 0.25f}},
                             {{0.15f, 0.15f}, {0.85f, 0.65f}, {0.25f, 0.4f, 1}},
                             {{-0.95f, 0.9f}, {0.95f, 0.9f}, {0.5f, 0.5f, 0.5f}}};

}  // namespace

int main(int argc, char** argv) {
    int scene = 0, hidden = 0;
    std::string file, textureFile;
    samples::App app(argc, argv, "Depth lesson",
                     {{"file", "an OBJ file for the model (a torus knot)", &file},
                      {"--scene", "overlap, y-buffer or model", &scene, 's', {"overlap", "y-buffer", "model"}},
                      {"--hidden", "painter, buffer or none", &hidden, 'h', {"painter", "buffer", "none"}},
                      {"--texture", "of the model: TGA, PNG, BMP (a checkerboard)", &textureFile}});
    VnContext context = app.context();
    const VnProgram colored = app.program(kVertex, kColored), flat = app.program(kVertex, kFlat);
    const VnVertexLayout layout = app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                                              {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, color)},
                                              {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv)}},
                                             {{sizeof(Vertex), 0}});
    samples::MeshData model = file.empty() ? samples::torusKnotMesh(160, 16) : samples::loadObj(file);
    samples::fitIntoUnitBall(model);
    std::vector<Triangle> modelTriangles;
    for (size_t i = 0; i + 2 < model.indices.size(); i += 3) {
        Triangle triangle;
        for (size_t k = 0; k < 3; ++k) {
            const samples::MeshVertex& vertex = model.vertices[model.indices[i + k]];
            triangle[k] = {vertex.position, glm::vec3(1), vertex.uv};
        }
        modelTriangles.push_back(triangle);
    }
    samples::Picture picture{64, 64, samples::checkerTexels(64, 2, 0xFF50A0F0, 0xFFE8E8E0)};
    if (!textureFile.empty()) picture = samples::loadPicture(textureFile);
    const VnView texture = app.texture(picture.width, picture.height, picture.texels);
    const VnSampler linear = app.sampler(VK_FILTER_LINEAR);
    const VnDepthStencilState depth = app.depthState();
    const VnBuffer buffer = app.buffer(std::vector<Triangle>(std::max(modelTriangles.size(), size_t{64})));
    const auto oneRow = [](VkExtent2D size) { return VkExtent2D{size.width, 1}; };
    const samples::Target& row = app.windowTarget(VK_FORMAT_R8G8B8A8_SRGB, oneRow);
    const samples::Target& rowDepth = app.windowTarget(VK_FORMAT_D32_SFLOAT, oneRow);
    struct {
        glm::mat4 transform;
        glm::vec4 options;
    } push;

    const auto drawTriangles = [&](std::vector<Triangle> triangles, const glm::mat4& transform, VnProgram program) {
        if (hidden == 0) {
            // The painter's: farthest first, by the middle of each.
            const auto distance = [&](const Triangle& t) {
                return (transform * glm::vec4(t[0].position + t[1].position + t[2].position, 3)).w;
            };
            std::stable_sort(triangles.begin(), triangles.end(),
                             [&](const Triangle& a, const Triangle& b) { return distance(a) > distance(b); });
        }
        app.update(buffer, triangles);
        app.beginPass({0.02f, 0.02f, 0.03f, 1});
        push.transform = transform;
        app.push(push);
        vnBindProgram(context, program);
        vnBindVertexLayout(context, layout);
        vnBindVertexBuffer(context, 0, buffer, 0);
        vnBindTexture(context, 0, 0, 0, texture, linear);
        vnBindDepthStencilState(context, hidden == 1 ? depth : VnDepthStencilState{});
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 0);
        vnDraw(context, static_cast<uint32_t>(triangles.size() * 3), 1, 0, 0);
        app.endPass();
    };

    // Above the world as a plan, below the one row that an eye at the bottom of the plan sees, tall enough to look at.
    const auto drawRow = [&] {
        std::vector<Vertex> plan, seen;
        for (const Segment& s : kSegments)
            for (const glm::vec2& end : {s.from, s.to}) {
                plan.push_back({{end.x, 0.65f - end.y * 1.5f, 0}, s.color, {}});
                // The distance is the depth; the row's middle is y = 0.
                seen.push_back({{end.x, 0, end.y}, s.color, {}});
            }
        plan.insert(plan.end(), seen.begin(), seen.end());
        vnUpdateBuffer(context, buffer, 0, plan.data(), plan.size() * sizeof(Vertex));
        push.transform = glm::mat4(1);
        app.push(push);
        vnBindProgram(context, colored);
        vnBindVertexLayout(context, layout);
        vnBindVertexBuffer(context, 0, buffer, 0);
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 0);
        const uint32_t count = static_cast<uint32_t>(seen.size());
        vnBindDepthStencilState(context, depth);
        app.beginPass({row}, rowDepth, {0, 0, 0, 1});
        vnDraw(context, count, 1, count, 0);
        app.endPass();
        vnBindDepthStencilState(context, VnDepthStencilState{});
        app.beginPass({0.02f, 0.02f, 0.03f, 1});
        vnDraw(context, count, 1, 0, 0);
        app.endPass();
        VnRegion all{}, band{};
        band.y = app.height() * 5 / 6;
        band.width = app.width();
        band.height = app.height() / 8;
        vnBlitImage(context, row.image, &all, app.color().image, &band, VK_FILTER_NEAREST);
    };

    return app.run([&](const samples::Frame& frame) {
        const glm::mat4 projection = samples::perspective(0.8, app.aspect(), 0.1, 20);
        const glm::vec3 eye(0, 0.3f, 3);
        const glm::mat4 view = projection * glm::lookAt(eye, glm::vec3(0), glm::vec3(0, 1, 0));
        const glm::mat4 turn = samples::rotation(frame.seconds * 0.6, {0, 1, 0});
        push.options = glm::vec4(glm::normalize(glm::vec3(glm::inverse(turn) * glm::vec4(0.3f, 0.5f, 1, 0))), 0);
        if (scene == 0)
            drawTriangles(planks(), view * samples::rotation(frame.seconds * 0.3, {0, 0, 1}), colored);
        else if (scene == 1)
            drawRow();
        else
            drawTriangles(modelTriangles, view * turn, flat);
    });
}
