// A scene of several models with every way to shade them, seen by a camera that walks: W A S D, the arrows, Q and E,
// drag.
//   --shading flat|gouraud|half-lambert|phong|textured|alpha-tested|blended|deferred
//   --wireframe off|polygon-mode|lines   --clip (Sutherland and Hodgman's clipping, shown)   --texture FILE [FILE.obj]
#include "samples/common/app.h"
#include "samples/common/camera.h"
#include "samples/common/obj_file.h"
#include "samples/common/picture_file.h"
#include "samples/common/trigonometry.h"

namespace {

enum Shading { kFlat, kGouraud, kHalfLambert, kPhong, kTextured, kAlphaTested, kBlended, kDeferred };

const std::string kPush = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; mat4 model; vec4 eye; vec4 color; int shading; };
const vec3 toLight = vec3(0.4682929, 0.7804881, 0.4136587);  // of length 1
float halfLambert(vec3 normal) {
    float light = dot(normal, toLight) * 0.5 + 0.5;
    return light * light;
}
)";

const std::string kVertex = kPush + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 textureCoordinate;
layout(location = 0) out vec3 place;
layout(location = 1) out vec3 worldNormal;
layout(location = 2) out vec2 uv;
layout(location = 3) out float vertexLight;
void main() {
    vec4 world = model * vec4(position, 1);
    place = world.xyz;
    worldNormal = normalize(mat3(model) * normal);
    uv = textureCoordinate;
    vertexLight = max(dot(worldNormal, toLight), 0) + 0.08;
    gl_Position = transform * world;
})";

const std::string kFragment = kPush + R"(
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 worldNormal;
layout(location = 2) in vec2 uv;
layout(location = 3) in float vertexLight;
layout(location = 0) out vec4 result;
void main() {
    vec3 normal = normalize(worldNormal);
    vec4 texel = texture(image, uv);
    result = vec4(color.rgb, 1);
    if (shading == 0) result.rgb *= max(dot(normalize(cross(dFdy(place), dFdx(place))), toLight), 0) + 0.08;
    if (shading == 1) result.rgb *= vertexLight;
    if (shading == 2) result.rgb *= halfLambert(normal);
    if (shading == 3) {
        float shine = pow(max(dot(reflect(-toLight, normal), normalize(eye.xyz - place)), 0), 40);
        result.rgb = result.rgb * (max(dot(normal, toLight), 0) + 0.08) + 0.6 * shine;
    }
    if (shading >= 4) result = vec4(texel.rgb * color.rgb * halfLambert(normal), 1);
    if (shading == 5 && texel.r < 0.3) discard;
    if (shading == 6) result.a = 0.45;
})";

const std::string kGeometry = kPush + R"(
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 1) in vec3 worldNormal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;
void main() {
    albedo = vec4(texture(image, uv).rgb * color.rgb, 1);
    normal = vec4(normalize(worldNormal), 1);
})";

const std::string kLight = kPush + R"(
layout(set = 0, binding = 1) uniform sampler2D albedo;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(location = 0) out vec4 result;
void main() {
    vec4 n = texelFetch(normal, ivec2(gl_FragCoord.xy), 0);
    if (n.w == 0) discard;
    result = vec4(texelFetch(albedo, ivec2(gl_FragCoord.xy), 0).rgb * halfLambert(n.xyz), 1);
})";

const std::string kLineVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; mat4 model; vec4 eye; vec4 color; int shading; };
layout(location = 0) in vec3 position;
void main() { gl_Position = transform * model * vec4(position, 1); })";
const std::string kLineFragment = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; mat4 model; vec4 eye; vec4 color; int shading; };
layout(location = 0) out vec4 result;
void main() { result = color; })";

struct Push {
    glm::mat4 transform, model;
    glm::vec4 eye, color;
    int shading;
};

/// Each edge of each triangle as two indices, each edge once.
std::vector<uint32_t> edgesOf(const samples::MeshData& mesh) {
    std::set<std::pair<uint32_t, uint32_t>> edges;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = mesh.indices[i + k], b = mesh.indices[i + (k + 1) % 3];
            edges.insert({glm::min(a, b), glm::max(a, b)});
        }
    std::vector<uint32_t> indices;
    for (const auto& edge : edges) indices.insert(indices.end(), {edge.first, edge.second});
    return indices;
}

/// Sutherland and Hodgman 1974: what of a polygon lies in the square from -half to half, one side after the other.
std::vector<glm::vec3> clipped(std::vector<glm::vec3> polygon, float half) {
    for (int side = 0; side < 4; ++side) {
        const int axis = side / 2;
        const float sign = side % 2 ? 1.0f : -1.0f;
        std::vector<glm::vec3> kept;
        for (size_t i = 0; i < polygon.size(); ++i) {
            const glm::vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            const float insideA = half - sign * a[axis], insideB = half - sign * b[axis];
            if (insideA >= 0) kept.push_back(a);
            if ((insideA >= 0) != (insideB >= 0)) kept.push_back(a + (b - a) * (insideA / (insideA - insideB)));
        }
        polygon = kept;
    }
    return polygon;
}

}  // namespace

int main(int argc, char** argv) {
    int shading = kTextured, wireframe = 0;
    bool clip = false;
    std::string file, textureFile;
    samples::App app(
        argc, argv, "Scene renderer",
        {{"file", "an OBJ file instead of the knot", &file},
         {"--shading",
          "how surfaces are shaded",
          &shading,
          'v',
          {"flat", "gouraud", "half-lambert", "phong", "textured", "alpha-tested", "blended", "deferred"}},
         {"--wireframe", "edges: off, by polygon-mode, as lines", &wireframe, 'x', {"off", "polygon-mode", "lines"}},
         {"--clip", "show how a polygon is clipped", &clip, 'c'},
         {"--texture", "PNG, TGA or BMP (a checkerboard)", &textureFile}});
    VnContext context = app.context();
    samples::MeshData knot = file.empty() ? samples::torusKnotMesh(120, 12) : samples::loadObj(file);
    samples::fitIntoUnitBall(knot);
    const samples::MeshData shapes[] = {knot, samples::boxMesh(), samples::sphereMesh(1, 24, 16),
                                        samples::planeMesh(8, 8)};
    std::vector<samples::Mesh> meshes, outlines;
    for (const samples::MeshData& shape : shapes) {
        meshes.push_back(app.mesh(shape));
        const std::vector<uint32_t> edges = edgesOf(shape);
        outlines.push_back({meshes.back().vertices, app.buffer(edges), static_cast<uint32_t>(edges.size())});
    }
    const auto at = [](float x, float y, float z) { return glm::translate(glm::mat4(1), glm::vec3(x, y, z)); };
    samples::Picture picture{128, 128, samples::checkerTexels(128, 8, 0xFF4070B0, 0xFFF0F0F0)};
    // The dark squares of this checkerboard are dark in red, which is what the alpha test looks at.
    for (uint32_t& texel : picture.texels)
        if (texel == 0xFF4070B0) texel = 0xFFB07030;
    if (!textureFile.empty()) picture = samples::loadPicture(textureFile);
    const VnView texture = app.texture(picture.width, picture.height, picture.texels);
    const VnSampler linear = app.sampler(VK_FILTER_LINEAR), nearest = app.sampler(VK_FILTER_NEAREST);
    const VnProgram program = app.program(kVertex, kFragment), geometry = app.program(kVertex, kGeometry);
    const VnProgram light = app.program(samples::kFullScreenVertex, kLight),
                    line = app.program(kLineVertex, kLineFragment);
    const VnVertexLayout layout = app.meshLayout();
    const VnVertexLayout positions =
        app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}}, {{sizeof(samples::MeshVertex), 0}});
    const VnVertexLayout points = app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}}, {{sizeof(glm::vec3), 0}});
    const VnDepthStencilState depth = app.depthState(), readDepth = app.depthState(false);
    const VnDepthStencilState edgeDepth = app.depthState(false, VK_COMPARE_OP_LESS_OR_EQUAL);
    VnRasterStateDesc edgeDesc{};
    edgeDesc.polygonMode = VK_POLYGON_MODE_LINE;
    edgeDesc.depthBias = 1;
    edgeDesc.depthBiasConstant = -8;
    edgeDesc.depthBiasSlope = -1;
    VnRasterState edgeRaster{};
    vnCreateRasterState(app.device(), &edgeDesc, &edgeRaster);
    const VnBlendState over = app.blendState(VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA);
    const samples::Target& albedo = app.windowTarget(VK_FORMAT_R8G8B8A8_UNORM);
    const samples::Target& normal = app.windowTarget(VK_FORMAT_R16G16B16A16_SFLOAT);
    const VnBuffer polygonBuffer = app.buffer(std::vector<glm::vec3>(64));
    samples::FlyCamera camera({0, 2.2f, 7}, 0, -0.22);

    return app.run([&](const samples::Frame& frame) {
        camera.update(frame.input, frame.elapsed, 4);
        const glm::vec3 clear(0.05f, 0.07f, 0.1f);
        Push push{samples::perspective(0.9, app.aspect(), 0.1, 60) * camera.view(), glm::mat4(1),
                  glm::vec4(camera.position(), 1), glm::vec4(1), shading};
        const struct {
            size_t shape;
            glm::mat4 place;
            glm::vec3 color;
        } models[] = {
            {3, glm::mat4(1), {0.6f, 0.6f, 0.6f}},
            {0, at(0, 1.2f, 0) * samples::rotation(frame.seconds * 0.5, {0, 1, 0}), {0.9f, 0.75f, 0.4f}},
            {1,
             at(-2.6f, 0.8f, -0.8f) * samples::rotation(0.5, {0, 1, 0}) * glm::scale(glm::mat4(1), glm::vec3(0.8f)),
             {0.4f, 0.7f, 0.9f}},
            {2, at(2.6f, 1, -0.6f), {0.9f, 0.5f, 0.45f}},
            {1,
             at(1.4f, 0.35f, 2) * samples::rotation(0.9, {0, 1, 0}) * glm::scale(glm::mat4(1), glm::vec3(0.35f)),
             {0.6f, 0.85f, 0.5f}}};
        const auto drawModels = [&](const std::vector<samples::Mesh>& from, bool plain) {
            for (const auto& model : models) {
                push.model = model.place;
                push.color = plain ? glm::vec4(1, 0.9f, 0.2f, 1) : glm::vec4(model.color, 1);
                app.push(push);
                app.draw(from[model.shape]);
            }
        };
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 0);
        vnBindTexture(context, 0, 0, 0, texture, linear);
        vnBindVertexLayout(context, layout);
        vnBindRasterState(context, VnRasterState{});
        vnBindDepthStencilState(context, depth);
        vnBindBlendState(context, VnBlendState{});
        if (shading == kDeferred) {
            app.beginPass({albedo, normal}, app.depth(), glm::vec4(0));
            vnBindProgram(context, geometry);
            drawModels(meshes, false);
            app.endPass();
            app.beginPass({app.color()}, {}, glm::vec4(clear, 1));
            vnBindProgram(context, light);
            vnBindVertexLayout(context, VnVertexLayout{});
            vnBindDepthStencilState(context, VnDepthStencilState{});
            vnBindTexture(context, 0, 1, 0, albedo.view, nearest);
            vnBindTexture(context, 0, 2, 0, normal.view, nearest);
            vnDraw(context, 3, 1, 0, 0);
            app.endPass();
            // What comes over it has the depths of the first pass.
            VnPassDesc pass{};
            pass.colors[0].view = app.color().view;
            pass.depthStencil.view = app.depth().view;
            samples::must(vnBeginPass(context, &pass));
        } else {
            app.beginPass(glm::vec4(clear, 1));
            vnBindProgram(context, program);
            if (shading == kBlended) {
                vnBindBlendState(context, over);
                vnBindDepthStencilState(context, readDepth);
            }
            drawModels(meshes, false);
        }
        vnBindBlendState(context, VnBlendState{});
        vnBindProgram(context, line);
        vnBindVertexLayout(context, positions);
        vnBindDepthStencilState(context, edgeDepth);
        if (wireframe == 1) {
            vnBindRasterState(context, edgeRaster);
            drawModels(meshes, true);
        } else if (wireframe == 2) {
            vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 0);
            vnBindRasterState(context, VnRasterState{});
            drawModels(outlines, true);
        }
        if (clip) {
            // The whole outline, the square, and over both what is left of the polygon.
            std::vector<glm::vec3> star;
            for (int i = 0; i < 5; ++i) {
                const double angle = frame.seconds + i * 2 * samples::kPi / 5;
                star.push_back({0.62f * samples::cosineF(angle) + 0.12f, 0.62f * samples::sineF(angle), 0});
            }
            constexpr float kHalf = 0.45f;
            const std::vector<glm::vec3> square{
                {-kHalf, -kHalf, 0}, {kHalf, -kHalf, 0}, {kHalf, kHalf, 0}, {-kHalf, kHalf, 0}};
            const std::vector<glm::vec3> left = clipped(star, kHalf);
            std::vector<glm::vec3> list;
            std::vector<uint32_t> firsts;
            for (const auto& loop : {star, square, left}) {
                firsts.push_back(static_cast<uint32_t>(list.size()));
                list.insert(list.end(), loop.begin(), loop.end());
                if (!loop.empty()) list.push_back(loop[0]);
            }
            firsts.push_back(static_cast<uint32_t>(list.size()));
            app.endPass();
            app.update(polygonBuffer, list);
            VnPassDesc pass{};
            pass.colors[0].view = app.color().view;
            samples::must(vnBeginPass(context, &pass));
            vnBindRasterState(context, VnRasterState{});
            vnBindDepthStencilState(context, VnDepthStencilState{});
            vnBindVertexLayout(context, points);
            vnBindVertexBuffer(context, 0, polygonBuffer, 0);
            push.transform = glm::scale(glm::mat4(1), glm::vec3(1 / app.aspect(), 1, 1));
            push.model = glm::mat4(1);
            const glm::vec4 colors[] = {{0.9f, 0.3f, 0.3f, 1}, {0.8f, 0.8f, 0.8f, 1}, {0.2f, 1, 0.4f, 1}};
            for (size_t i = 0; i < 3; ++i) {
                push.color = colors[i];
                app.push(push);
                const uint32_t count = firsts[i + 1] - firsts[i];
                vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, 0);
                if (count) vnDraw(context, count, 1, firsts[i], 0);
                vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, 0);
                if (count && i == 2) vnDraw(context, count - 1, 1, firsts[i], 0);
            }
        }
        app.endPass();
    });
}
