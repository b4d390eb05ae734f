// The tests of a one-header renderer: a triangle of three colours, a textured quad in perspective, a textured cube, and
// the fill rule. Matrices are those of such a header: left-handed, row vectors (v * M), row by row in memory - which
// are the same sixteen numbers as GLSL's column-major matrix for M * v, so they are pushed unchanged.
//   --scene triangle|quad|cube|fill-rule  --fill  --wireframe  --depth z|w  --interpolation perspective|affine
//   --filter nearest|linear|eight-bit     --texture FILE (PNG, BMP, TGA)
#include "samples/common/app.h"
#include "samples/common/picture_file.h"
#include "samples/common/trigonometry.h"

namespace {

/// Row-vector matrices: a point goes through p * model * view * projection.
struct RowMatrix {
    float m[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
};

RowMatrix operator*(const RowMatrix& a, const RowMatrix& b) {
    RowMatrix product;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
            product.m[row][column] = 0;
            for (int k = 0; k < 4; ++k) product.m[row][column] += a.m[row][k] * b.m[k][column];
        }
    return product;
}

RowMatrix axisAngle(const glm::vec3& axis, double angle) {
    const glm::vec3 a = glm::normalize(axis);
    const float c = samples::cosineF(angle), s = samples::sineF(angle), t = 1 - c;
    return {{{t * a.x * a.x + c, t * a.x * a.y + s * a.z, t * a.x * a.z - s * a.y, 0},
             {t * a.x * a.y - s * a.z, t * a.y * a.y + c, t * a.y * a.z + s * a.x, 0},
             {t * a.x * a.z + s * a.y, t * a.y * a.z - s * a.x, t * a.z * a.z + c, 0},
             {0, 0, 0, 1}}};
}

/// Left-handed: x right, y up, looking along +z.
RowMatrix lookAt(const glm::vec3& eye, const glm::vec3& at, const glm::vec3& up) {
    const glm::vec3 z = glm::normalize(at - eye), x = glm::normalize(glm::cross(up, z)), y = glm::cross(z, x);
    return {{{x.x, y.x, z.x, 0},
             {x.y, y.y, z.y, 0},
             {x.z, y.z, z.z, 0},
             {-glm::dot(x, eye), -glm::dot(y, eye), -glm::dot(z, eye), 1}}};
}

/// Depth 0..1; w is z; y turned down for the framebuffer.
RowMatrix perspective(double fieldOfView, float aspect, float nearPlane, float farPlane) {
    const auto f = static_cast<float>(1 / samples::tangent(fieldOfView / 2));
    const float range = farPlane / (farPlane - nearPlane);
    return {{{f / aspect, 0, 0, 0}, {0, -f, 0, 0}, {0, 0, range, 1}, {0, 0, -nearPlane * range, 0}}};
}

const std::string kVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; float farPlane; int filterMode; int wDepth; int textured; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 tint;
layout(location = 2) in vec2 textureCoordinate;
layout(location = 0) INTERPOLATION out vec3 color;
layout(location = 1) INTERPOLATION out vec2 uv;
void main() {
    color = tint;
    uv = textureCoordinate;
    gl_Position = transform * vec4(position, 1);
})";

// "w": the depth buffer holds w / far, which is linear in the distance. "eight-bit": the weights of the four texels
// have 8 bits, as integer renderers have them.
const std::string kFragment = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; float farPlane; int filterMode; int wDepth; int textured; };
layout(set = 0, binding = 0) uniform sampler2D image;
layout(set = 0, binding = 1) uniform sampler2D smoothImage;
layout(location = 0) INTERPOLATION in vec3 color;
layout(location = 1) INTERPOLATION in vec2 uv;
layout(location = 0) out vec4 result;
vec4 eightBits(vec2 at) {
    ivec2 size = textureSize(image, 0);
    ivec2 fixedPoint = ivec2(floor((at * vec2(size) - 0.5) * 256 + 0.5));
    ivec2 corner = fixedPoint >> 8;
    vec2 weight = vec2(fixedPoint & 255) / 256;
    vec4 texels[4];
    for (int i = 0; i < 4; ++i) {
        ivec2 p = corner + ivec2(i & 1, i >> 1);
        texels[i] = texelFetch(image, ((p % size) + size) % size, 0);
    }
    return mix(mix(texels[0], texels[1], weight.x), mix(texels[2], texels[3], weight.x), weight.y);
}
void main() {
    vec4 texel = vec4(1);
    if (textured != 0) texel = filterMode == 0 ? textureLod(image, uv, 0) : filterMode == 1 ? texture(smoothImage, uv) : eightBits(uv);
    result = texel * vec4(color, 1);
    gl_FragDepth = wDepth != 0 ? 1 / gl_FragCoord.w / farPlane : gl_FragCoord.z;
})";

const std::string kEdges = R"(#version 450
layout(location = 0) out vec4 result;
void main() { result = vec4(1, 0.9, 0.1, 1); })";

struct Vertex {
    glm::vec3 position, color;
    glm::vec2 uv;
};

enum Scene { kTriangle, kQuad, kCube, kFillRule };

std::vector<Vertex> sceneVertices(int scene) {
    std::vector<Vertex> list;
    const glm::vec3 white(1);
    if (scene == kTriangle)
        return {{{0, 0.8f, 0}, {1, 0, 0}, {}}, {{0.8f, -0.7f, 0}, {0, 1, 0}, {}}, {{-0.8f, -0.7f, 0}, {0, 0, 1}, {}}};
    if (scene == kFillRule) {
        // A fan around a point: drawn with half its light added, a pixel hit twice would be brighter, one missed dark.
        for (int i = 0; i < 24; ++i) {
            const double a = i * samples::kPi / 12, b = (i + 1) * samples::kPi / 12;
            list.push_back({{0.013f, 0.007f, 0}, glm::vec3(0.25f), {}});
            list.push_back({{samples::cosineF(a), samples::sineF(a), 0}, glm::vec3(0.25f), {}});
            list.push_back({{samples::cosineF(b), samples::sineF(b), 0}, glm::vec3(0.25f), {}});
        }
        return list;
    }
    const samples::MeshData box = samples::boxMesh();
    if (scene == kCube) {
        for (const uint32_t i : box.indices)
            list.push_back({box.vertices[i].position * 0.8f, white, box.vertices[i].uv});
        return list;
    }
    for (const int i : {0, 1, 2, 2, 1, 3}) {
        const glm::vec2 uv(i & 1, i >> 1);
        list.push_back({{uv.x * 2 - 1, uv.y * 2 - 1, 0}, white, uv});
    }
    return list;
}

std::string replaced(std::string text, const std::string& by) {
    const std::string word = "INTERPOLATION";
    for (size_t at = 0; (at = text.find(word, at)) != std::string::npos;) text.replace(at, word.size(), by);
    return text;
}

}  // namespace

int main(int argc, char** argv) {
    int scene = kCube, depthKind = 0, interpolation = 0, filter = 1;
    bool fill = true, wireframe = false;
    std::string file;
    samples::App app(argc, argv, "First triangles",
                     {{"--scene", "what is drawn", &scene, 's', {"triangle", "quad", "cube", "fill-rule"}},
                      {"--fill", "fill the triangles", &fill, 'f'},
                      {"--wireframe", "draw their edges over them", &wireframe, 'e'},
                      {"--depth", "z/w or w in the depth buffer", &depthKind, 'd', {"z", "w"}},
                      {"--interpolation", "perspective or affine", &interpolation, 'i', {"perspective", "affine"}},
                      {"--filter", "of the texture", &filter, 't', {"nearest", "linear", "eight-bit"}},
                      {"--texture", "a picture: PNG, BMP, TGA (a checkerboard)", &file}});
    VnContext context = app.context();
    samples::Picture picture{32, 32, samples::checkerTexels(32, 4, 0xFF3080E0, 0xFFF0F0E0)};
    if (!file.empty()) picture = samples::loadPicture(file);
    const VnView texture = app.texture(picture.width, picture.height, picture.texels);
    const VnSampler nearest = app.sampler(VK_FILTER_NEAREST), linear = app.sampler(VK_FILTER_LINEAR);
    const VnProgram programs[2] = {
        app.program(replaced(kVertex, ""), replaced(kFragment, "")),
        app.program(replaced(kVertex, "noperspective"), replaced(kFragment, "noperspective"))};
    const VnProgram edges = app.program(replaced(kVertex, ""), kEdges);
    const VnVertexLayout layout = app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                                              {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, color)},
                                              {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv)}},
                                             {{sizeof(Vertex), 0}});
    std::vector<Vertex> lists[4];
    VnBuffer buffers[4];
    for (int i = 0; i < 4; ++i) {
        lists[i] = sceneVertices(i);
        buffers[i] = app.buffer(lists[i]);
    }
    const VnDepthStencilState depth = app.depthState(), over = app.depthState(false, VK_COMPARE_OP_ALWAYS);
    const VnRasterState lines = app.rasterState(VK_CULL_MODE_NONE, VK_POLYGON_MODE_LINE);
    const VnBlendState add = app.blendState(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE);

    return app.run({0.02f, 0.02f, 0.03f, 1}, [&](const samples::Frame& frame) {
        struct {
            RowMatrix transform;
            float farPlane = 20;
            int filterMode, wDepth, textured;
        } push;
        const double turn = scene == kCube ? frame.seconds * 0.8 + 0.6 : scene == kQuad ? 1.0 : 0.0;
        const RowMatrix model = axisAngle(scene == kQuad ? glm::vec3(1, 0.3f, 0) : glm::vec3(0.3f, 1, 0), turn);
        const RowMatrix view = lookAt({0, 0, -3.1f}, {0, 0, 0}, {0, 1, 0});
        push.transform = model * view * perspective(0.9, app.aspect(), 0.1f, push.farPlane);
        push.filterMode = filter;
        push.wDepth = depthKind;
        push.textured = scene == kQuad || scene == kCube;
        app.push(push);
        vnBindVertexLayout(context, layout);
        vnBindVertexBuffer(context, 0, buffers[scene], 0);
        vnBindTexture(context, 0, 0, 0, texture, nearest);
        vnBindTexture(context, 0, 1, 0, texture, linear);
        const auto count = static_cast<uint32_t>(lists[scene].size());
        if (fill) {
            vnBindProgram(context, programs[interpolation]);
            vnBindDepthStencilState(context, scene == kFillRule ? VnDepthStencilState{} : depth);
            vnBindBlendState(context, scene == kFillRule ? add : VnBlendState{});
            vnBindRasterState(context, VnRasterState{});
            vnDraw(context, count, 1, 0, 0);
        }
        if (wireframe) {
            vnBindProgram(context, edges);
            vnBindDepthStencilState(context, over);
            vnBindBlendState(context, VnBlendState{});
            vnBindRasterState(context, lines);
            vnDraw(context, count, 1, 0, 0);
        }
    });
}
