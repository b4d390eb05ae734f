// What a pipeline does, one picture each:
//   --scene lines         lines in all directions by Bresenham's rule, on pixels large enough to count
//           scan-line     a triangle as spans that this program computes with integers, over the same triangle
//                         rasterised in red: none of it is left
//           barycentric   weights of the three corners: by areas, by Cramer's rule, by cross products in space, as
//                         interpolated
//           ray           the left half rasterised, the right half by a ray per pixel against each triangle
//           frustum       boxes outside of the view are not drawn; the upper right corner looks from above, those left
//                         out are red
//           affine        what a floor looks like when texture coordinates are not divided by w
//           tessellation  patches undivided, at two levels, and by distance: notes/tessellation_page.h
//           geometry      what a geometry stage makes of triangles and points: notes/geometry_page.h
//   --spacing equal|even|odd   of levels of tessellation that are not whole
//   --clip-space vulkan|gl     depth 0..1 and y down, or -1..1 and y up: the same picture
//   --cull                     leave out back faces
#include <optional>

#include "samples/common/app.h"
#include "samples/common/camera.h"
#include "samples/common/random.h"
#include "samples/common/trigonometry.h"
#include "samples/renderers/notes/geometry_page.h"
#include "samples/renderers/notes/tessellation_page.h"

namespace {

enum Scene { kLines, kScanLine, kBarycentric, kRay, kFrustum, kAffine, kTessellation, kGeometry };

struct Vertex {
    glm::vec3 position, color;
};

struct Push {
    glm::mat4 transform;
    glm::vec4 eye, options;
};

const std::string kPush =
    "#version 450\nlayout(push_constant) uniform Push { mat4 transform; vec4 eye; vec4 options; };\n";

const std::string kVertex = kPush + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 tint;
layout(location = 0) out vec3 color;
layout(location = 1) out vec3 place;
layout(location = 2) noperspective out vec3 affine;
void main() {
    color = tint;
    place = affine = position;
    gl_Position = transform * vec4(position, 1);
})";
const std::string kColor = kPush + R"(
layout(location = 0) in vec3 color;
layout(location = 0) out vec4 result;
void main() { result = vec4(color, 1); })";

// Left half: place interpolated linearly in the picture; right half: perspective-correct.
const std::string kFloor = kPush + R"(
layout(location = 1) in vec3 place;
layout(location = 2) noperspective in vec3 affine;
layout(location = 0) out vec4 result;
void main() {
    vec2 cell = floor((gl_FragCoord.x < options.x ? affine : place).xz);
    result = vec4(mix(vec3(0.1, 0.15, 0.3), vec3(0.8, 0.8, 0.7), mod(cell.x + cell.y, 2)), 1);
})";

// Four quarters, four ways to the same weights; the colour is the weights. The corners are those of corner(), below.
const std::string kWeights = kPush + R"(
layout(location = 0) in vec3 color;
layout(location = 1) in vec3 place;
layout(location = 0) out vec4 result;
const vec3 a = vec3(-1, -0.8, 0.3), b = vec3(1, -0.6, -0.2), c = vec3(0.1, 0.9, 0);
float area(vec2 p, vec2 q, vec2 r) { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x); }
void main() {
    vec3 weights = color;
    if (options.y == 0) {  // areas of the three parts over that of the whole
        float whole = area(a.xy, b.xy, c.xy);
        weights = vec3(area(place.xy, b.xy, c.xy), area(a.xy, place.xy, c.xy), area(a.xy, b.xy, place.xy)) / whole;
    } else if (options.y == 1) {  // place - a = v (b - a) + w (c - a), by Cramer's rule on the dot products
        vec3 e = b - a, f = c - a, p = place - a;
        float ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), pe = dot(p, e), pf = dot(p, f), d = ee * ff - ef * ef;
        float v = (ff * pe - ef * pf) / d, w = (ee * pf - ef * pe) / d;
        weights = vec3(1 - v - w, v, w);
    } else if (options.y == 2) {  // areas in space: cross products against the normal
        vec3 n = cross(b - a, c - a);
        weights = vec3(dot(cross(c - b, place - b), n), dot(cross(a - c, place - c), n), dot(cross(b - a, place - a), n)) / dot(n, n);
    }
    result = vec4(weights, 1);
})";

// Moeller and Trumbore 1997, for every triangle; the nearest counts. The ray goes through the pixel's place on the far
// plane.
const std::string kRayFragment = kPush + R"(
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;
layout(set = 0, binding = 0) readonly buffer Triangles { float numbers[]; };  // position and colour, three per triangle
vec3 at(int i) { return vec3(numbers[i], numbers[i + 1], numbers[i + 2]); }
void main() {
    if (gl_FragCoord.x < options.x) discard;
    vec4 far = transform * vec4(uv * 2 - 1, 1, 1);
    vec3 direction = far.xyz / far.w - eye.xyz;
    float nearest = 1e30;
    for (int i = 0; i < int(options.y); ++i) {
        vec3 a = at(i * 18), e = at(i * 18 + 6) - a, f = at(i * 18 + 12) - a;
        vec3 h = cross(direction, f), s = eye.xyz - a, q = cross(s, e);
        float d = dot(e, h);
        if (abs(d) < 1e-9) continue;
        float v = dot(s, h) / d, w = dot(direction, q) / d, t = dot(f, q) / d;
        if (v < 0 || w < 0 || v + w > 1 || t <= 0 || t >= nearest) continue;
        nearest = t;
        result = vec4(at(i * 18 + 3) * (1 - v - w) + at(i * 18 + 9) * v + at(i * 18 + 15) * w, 1);
    }
    if (nearest == 1e30) discard;
})";

/// Boxes of random sizes on a plain.
struct Box {
    glm::vec3 low, high, color;
};
std::vector<Box> boxes() {
    std::vector<Box> list;
    samples::Random random(2);
    for (int z = -10; z <= 10; ++z)
        for (int x = -10; x <= 10; ++x) {
            const float size = random.between(0.2f, 0.7f), height = random.between(0.3f, 2);
            const glm::vec3 middle(static_cast<float>(x) * 2, 0, static_cast<float>(z) * 2);
            list.push_back({middle - glm::vec3(size, 0, size),
                            middle + glm::vec3(size, height, size),
                            {random.between(0.2f, 0.9f), random.between(0.2f, 0.9f), random.between(0.3f, 1)}});
        }
    return list;
}

/// Whether the box may be seen: not if all of its corners lie beyond one plane of the clip volume (depth 0..w).
bool inView(const Box& box, const glm::mat4& transform) {
    int outside[6] = {};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec4 p =
            transform * glm::vec4(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                  corner & 4 ? box.high.z : box.low.z, 1);
        const bool beyond[6] = {p.x<-p.w, p.x> p.w, p.y<-p.w, p.y> p.w, p.z<0, p.z> p.w};
        for (int plane = 0; plane < 6; ++plane) outside[plane] += beyond[plane];
    }
    for (const int count : outside)
        if (count == 8) return false;
    return true;
}

void addBox(std::vector<Vertex>& list, const Box& box, const glm::vec3& color) {
    const samples::MeshData cube = samples::boxMesh();
    for (const uint32_t index : cube.indices) {
        const samples::MeshVertex& v = cube.vertices[index];
        const glm::vec3 share = v.position * 0.5f + 0.5f;
        const float light = 0.5f + 0.5f * (v.normal.y > 0 ? 1.0f : v.normal.x * 0.5f);
        list.push_back({box.low + (box.high - box.low) * share, color * light});
    }
}

/// The spans of a triangle with corners at pixel corners: of each row the pixels whose centres lie inside, by exact
/// integers; of centres on an edge those count whose edge is a left or a horizontal upper one.
std::vector<glm::ivec3> spansOf(const glm::ivec2 (&corners)[3], int width, int height) {
    std::vector<glm::ivec3> spans;  // first, last (not included), row
    const auto inside = [&](int x, int y) {
        for (int i = 0; i < 3; ++i) {
            // Doubled, so that centres are integers. Corners go round clockwise in the picture (y down).
            const glm::ivec2 a = corners[i] * 2, d = corners[(i + 1) % 3] * 2 - a,
                             p = glm::ivec2(x * 2 + 1, y * 2 + 1) - a;
            const int side = d.x * p.y - d.y * p.x;
            const bool topOrLeft = d.y < 0 || (d.y == 0 && d.x > 0);
            if (side < 0 || (side == 0 && !topOrLeft)) return false;
        }
        return true;
    };
    for (int y = 0; y < height; ++y) {
        int first = 0;
        while (first < width && !inside(first, y)) ++first;
        int last = first;
        while (last < width && inside(last, y)) ++last;
        if (first < last) spans.push_back({first, last, y});
    }
    return spans;
}

}  // namespace

int main(int argc, char** argv) {
    int scene = kFrustum, clipSpace = 0, spacing = 0;
    bool cull = false;
    samples::App app(argc, argv, "Pipeline notes",
                     {{"--scene",
                       "which picture",
                       &scene,
                       's',
                       {"lines", "scan-line", "barycentric", "ray", "frustum", "affine", "tessellation", "geometry"}},
                      {"--spacing",
                       "of levels of tessellation: equal, or fractional even or odd",
                       &spacing,
                       'v',
                       {"equal", "even", "odd"}},
                      {"--clip-space", "vulkan or gl", &clipSpace, 'g', {"vulkan", "gl"}},
                      {"--cull", "leave out back faces", &cull, 'c'}});
    VnContext context = app.context();
    const VnProgram color = app.program(kVertex, kColor), floor = app.program(kVertex, kFloor);
    const VnProgram weights = app.program(kVertex, kWeights),
                    ray = app.program(samples::kFullScreenVertex, kRayFragment);
    const VnVertexLayout layout = app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                                              {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, color)}},
                                             {{sizeof(Vertex), 0}});
    const VnDepthStencilState depth = app.depthState();
    VnRasterState rasters[2][2], bresenham{};  // by clip space and culling
    for (int gl = 0; gl < 2; ++gl)
        for (int back = 0; back < 2; ++back) {
            VnRasterStateDesc desc{};
            desc.depthNegativeOneToOne = gl;
            desc.cullMode = back ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
            vnCreateRasterState(app.device(), &desc, &rasters[gl][back]);
        }
    VnRasterStateDesc lineDesc{};
    lineDesc.lineMode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    vnCreateRasterState(app.device(), &lineDesc, &bresenham);
    const samples::Target& coarse = app.windowTarget(VK_FORMAT_R8G8B8A8_SRGB, [](VkExtent2D size) {
        return VkExtent2D{size.width / 10 + 1, size.height / 10 + 1};
    });
    const std::vector<Box> world = boxes();
    const VnBuffer buffer = app.buffer(std::vector<Vertex>(world.size() * 80 + 4096));

    const auto bind = [&](VnProgram program, const std::vector<Vertex>& list) {
        app.update(buffer, list);
        vnBindProgram(context, program);
        vnBindVertexLayout(context, layout);
        vnBindVertexBuffer(context, 0, buffer, 0);
        vnBindDepthStencilState(context, VnDepthStencilState{});
        vnBindRasterState(context, rasters[0][cull]);
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 0);
    };
    // Pixels of the coarse picture, y down, to clip space.
    const auto pixelsToClip = [&] {
        return glm::translate(glm::mat4(1), glm::vec3(-1, -1, 0)) *
               glm::scale(glm::mat4(1), glm::vec3(2.0f / static_cast<float>(coarse.width),
                                                  2.0f / static_cast<float>(coarse.height), 1));
    };
    const auto enlarge = [&] {
        VnRegion from{}, to{};
        from.width = app.width() / 10;
        from.height = app.height() / 10;
        to.width = from.width * 10;
        to.height = from.height * 10;
        vnBlitImage(context, coarse.image, &from, app.color().image, &to, VK_FILTER_NEAREST);
    };

    const auto drawLines = [&](double seconds) {
        std::vector<Vertex> list;
        const glm::vec2 middle(static_cast<float>(coarse.width / 2) + 0.5f,
                               static_cast<float>(coarse.height / 2) + 0.5f);
        for (int i = 0; i < 24; ++i) {
            const double angle = i * samples::kPi / 12 + seconds * 0.1 + 0.03;
            const glm::vec2 way(samples::cosineF(angle), samples::sineF(angle));
            const float length = static_cast<float>(coarse.height) * 0.45f;
            const glm::vec3 tint(0.5f + 0.5f * way.x, 0.5f + 0.5f * way.y, i % 2 ? 1.0f : 0.3f);
            // End points on pixel centres, as the integer algorithm has them.
            for (const float from : {0.25f, 1.0f})
                list.push_back({glm::vec3(glm::floor(middle + way * length * from) + 0.5f, 0), tint});
        }
        bind(color, list);
        vnBindRasterState(context, bresenham);
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 0);
        app.push(Push{pixelsToClip(), {}, {}});
        app.beginPass({coarse}, {}, {0.01f, 0.01f, 0.02f, 1});
        vnDraw(context, static_cast<uint32_t>(list.size()), 1, 0, 0);
        app.endPass();
        enlarge();
    };

    const auto drawSpans = [&] {
        const int w = static_cast<int>(coarse.width), h = static_cast<int>(coarse.height);
        const glm::ivec2 corners[3] = {{w / 8, h / 6}, {w * 7 / 8, h / 3}, {w / 3, h * 9 / 10}};
        // First the triangle in red, then the spans over it: red that is left would be a pixel that the spans lack.
        std::vector<Vertex> list;
        for (const glm::ivec2& corner : corners) list.push_back({glm::vec3(corner, 0), {0.9f, 0.1f, 0.1f}});
        int row = 0;
        for (const glm::ivec3& span : spansOf(corners, w, h)) {
            const glm::vec3 tint = row++ % 2 ? glm::vec3(0.3f, 0.7f, 0.4f) : glm::vec3(0.25f, 0.6f, 0.7f);
            for (const int x : {span.x, span.y})
                list.push_back({{static_cast<float>(x), static_cast<float>(span.z) + 0.5f, 0}, tint});
        }
        bind(color, list);
        app.push(Push{pixelsToClip(), {}, {}});
        app.beginPass({coarse}, {}, {0.01f, 0.01f, 0.02f, 1});
        vnDraw(context, 3, 1, 0, 0);
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 0);
        vnDraw(context, static_cast<uint32_t>(list.size()) - 3, 1, 3, 0);
        app.endPass();
        enlarge();
    };

    // Made when they are first shown: their programs take a while to compile.
    std::optional<samples::TessellationPage> tessellationPage;
    std::optional<samples::GeometryPage> geometryPage;

    return app.run([&](const samples::Frame& frame) {
        const samples::PageView view{frame.seconds, clipSpace != 0, cull};
        if (scene == kTessellation) {
            if (!tessellationPage) tessellationPage.emplace(app);
            return tessellationPage->draw(view, spacing);
        }
        if (scene == kGeometry) {
            if (!geometryPage) geometryPage.emplace(app);
            return geometryPage->draw(view);
        }
        if (scene == kLines) return drawLines(frame.seconds);
        if (scene == kScanLine) return drawSpans();
        const double angle = frame.seconds * 0.2;
        const glm::vec3 eye(2 * samples::sineF(angle), 2.2f, 4 * samples::cosineF(angle) + 2);
        const glm::mat4 camera = glm::lookAt(eye, glm::vec3(0, 0.8f, 0), glm::vec3(0, 1, 0));
        const glm::mat4 transform = samples::perspective(0.9, app.aspect(), 0.3, 60) * camera;
        const glm::mat4 shown = clipSpace ? samples::perspectiveGl(0.9, app.aspect(), 0.3, 60) * camera : transform;
        const auto width = static_cast<float>(app.width()), height = static_cast<float>(app.height());
        const VkViewport upwards{0, height, width, -height, 0, 1};
        Push push{shown, glm::vec4(eye, 1), {width / 2, 0, 0, 0}};

        std::vector<Vertex> list;
        const glm::vec3 rgb[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        if (scene == kBarycentric) {
            const glm::vec3 corner[] = {{-1, -0.8f, 0.3f}, {1, -0.6f, -0.2f}, {0.1f, 0.9f, 0}};
            for (int i = 0; i < 3; ++i) list.push_back({corner[i], rgb[i]});
        } else if (scene == kAffine) {
            for (const glm::vec2& p : {glm::vec2(-9, -9), {9, -9}, {9, 2.5f}, {-9, -9}, {9, 2.5f}, {-9, 2.5f}})
                list.push_back({{p.x, 0, p.y}, glm::vec3(1)});
        } else if (scene == kRay) {
            for (int i = 0; i < 6; ++i) {
                const double turn = i * samples::kPi / 3;
                const glm::vec3 out(samples::cosineF(turn), 0, samples::sineF(turn));
                list.push_back({out * 0.4f + glm::vec3(0, 2.2f, 0), rgb[i % 3]});
                list.push_back({out * 1.9f + glm::vec3(out.z, 0, -out.x) * 0.7f, rgb[(i + 1) % 3]});
                list.push_back({out * 1.6f - glm::vec3(out.z, 0, -out.x), rgb[(i + 2) % 3]});
            }
        } else {
            for (const Box& box : world)
                if (inView(box, transform)) addBox(list, box, box.color);
        }
        const auto inFirstView = static_cast<uint32_t>(list.size());
        if (scene == kFrustum)
            for (const Box& box : world)
                addBox(list, box, inView(box, transform) ? box.color : glm::vec3(0.8f, 0.05f, 0.05f));
        bind(scene == kAffine ? floor : scene == kBarycentric ? weights : color, list);
        app.beginPass({0.03f, 0.04f, 0.06f, 1});
        vnBindDepthStencilState(context, depth);
        vnBindRasterState(context, rasters[clipSpace][cull]);
        if (clipSpace) vnSetViewport(context, &upwards);
        if (scene == kBarycentric) {
            for (int quarter = 0; quarter < 4; ++quarter) {
                const float x = quarter % 2 ? width / 2 : 0, y = quarter < 2 ? 0 : height / 2;
                const VkViewport part{
                    x, clipSpace ? y + height / 2 : y, width / 2, clipSpace ? -height / 2 : height / 2, 0, 1};
                vnSetViewport(context, &part);
                const glm::mat4 near = glm::lookAt(glm::vec3(0.6f, 0.2f, 2.6f), glm::vec3(0), glm::vec3(0, 1, 0));
                push.transform = (clipSpace ? samples::perspectiveGl(0.9, app.aspect(), 0.3, 60)
                                            : samples::perspective(0.9, app.aspect(), 0.3, 60)) *
                                 near;
                push.options.y = static_cast<float>(quarter);
                app.push(push);
                vnDraw(context, 3, 1, 0, 0);
            }
        } else {
            app.push(push);
            vnDraw(context, inFirstView, 1, 0, 0);
        }
        if (scene == kRay) {
            // The right half again, by rays.
            const VkClearColorValue background{{0.03f, 0.04f, 0.06f, 1}};
            const VkRect2D right{{static_cast<int32_t>(app.width() / 2), 0},
                                 {app.width() - app.width() / 2, app.height()}};
            vnClearColor(context, 0, &background, &right);
            const VkViewport whole{0, 0, width, height, 0, 1};
            vnSetViewport(context, &whole);
            push.transform = glm::inverse(transform);
            push.options.y = static_cast<float>(list.size() / 3);
            app.push(push);
            vnBindProgram(context, ray);
            vnBindVertexLayout(context, VnVertexLayout{});
            vnBindDepthStencilState(context, VnDepthStencilState{});
            vnBindRasterState(context, VnRasterState{});
            vnBindBuffer(context, 0, 0, 0, buffer, 0, 0);
            vnDraw(context, 3, 1, 0, 0);
        }
        if (scene == kFrustum) {
            const VkViewport corner{width * 0.62f, 0, width * 0.38f, height * 0.38f, 0, 1};
            const VkRect2D rect{{static_cast<int32_t>(width * 0.62f), 0},
                                {static_cast<uint32_t>(width * 0.38f), static_cast<uint32_t>(height * 0.38f)}};
            vnSetViewport(context, &corner);
            vnSetScissor(context, &rect);
            vnClearDepthStencil(context, VK_IMAGE_ASPECT_DEPTH_BIT, 1, 0, &rect);
            const VkClearColorValue dark{{0, 0, 0, 1}};
            vnClearColor(context, 0, &dark, &rect);
            vnBindRasterState(context, rasters[0][cull]);
            push.transform = samples::orthographic(-23 * app.aspect(), 23 * app.aspect(), -23, 23, 0, 60) *
                             glm::lookAt(glm::vec3(0, 50, 0), glm::vec3(0), glm::vec3(0, 0, -1));
            app.push(push);
            vnDraw(context, static_cast<uint32_t>(list.size()) - inFirstView, 1, inFirstView, 0);
        }
        app.endPass();
    });
}
