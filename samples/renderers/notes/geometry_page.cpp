#include "samples/renderers/notes/geometry_page.h"

#include <map>

#include "samples/common/trigonometry.h"

namespace samples {
namespace {

const std::string kBodyVertex = std::string(Quarters::kHead) + R"(
layout(location = 0) in vec3 position;
layout(location = 0) out vec3 place;
layout(location = 1) out vec3 color;
void main() {
    place = position;
    color = tint.rgb;
    gl_Position = transform * vec4(position, 1);
})";

const std::string kNormals = std::string(Quarters::kHead) + R"(
layout(triangles) in;
layout(line_strip, max_vertices = 2) out;
layout(location = 1) out vec3 color;
void main() {
    vec3 a = gl_in[0].gl_Position.xyz, b = gl_in[1].gl_Position.xyz, c = gl_in[2].gl_Position.xyz;
    vec3 normal = normalize(cross(b - a, c - a)), middle = (a + b + c) / 3;
    color = tint.rgb;
    gl_Position = transform * vec4(middle, 1);
    EmitVertex();
    color = abs(normal);
    gl_Position = transform * vec4(middle + normal * options.x, 1);
    EmitVertex();
})";

// Steps in clip space are seen as wide as high when divided by the ratio of the picture's sides, options.y; options.z
// is 1 or -1, the way up.
const std::string kSquares = std::string(Quarters::kHead) + R"(
layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = 0) out vec2 corner;
layout(location = 1) out vec3 color;
void main() {
    for (int i = 0; i < 4; ++i) {
        corner = vec2(i & 1, i >> 1) * 2 - 1;
        color = 0.5 + 0.5 * normalize(gl_in[0].gl_Position.xyz);
        gl_Position = transform * gl_in[0].gl_Position + vec4(corner * options.x / options.yz, 0, 0);
        EmitVertex();
    }
})";
// Each square with a frame and, inside of it, a disc.
const std::string kSquareFragment = std::string(Quarters::kHead) + R"(
layout(location = 0) in vec2 corner;
layout(location = 1) in vec3 color;
layout(location = 0) out vec4 result;
void main() {
    float frame = max(abs(corner.x), abs(corner.y)), disc = dot(corner, corner);
    if (frame < 0.8 && disc > 0.5) discard;
    result = vec4(frame < 0.8 ? color * (1.1 - disc) : color * 0.4, 1);
})";

const std::string kShell = std::string(Quarters::kHead) + R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) out vec3 place;
layout(location = 1) out vec3 color;
void main() {
    vec3 a = gl_in[0].gl_Position.xyz, b = gl_in[1].gl_Position.xyz, c = gl_in[2].gl_Position.xyz;
    vec3 normal = normalize(cross(b - a, c - a)), middle = (a + b + c) / 3;
    for (int i = 0; i < 3; ++i) {
        place = mix(gl_in[i].gl_Position.xyz, middle, 0.2) + normal * options.x;
        color = gl_PrimitiveIDIn % 2 == 0 ? vec3(0.85, 0.45, 0.2) : vec3(0.2, 0.5, 0.75);
        gl_Position = transform * vec4(place, 1);
        EmitVertex();
    }
})";

// Corners of the triangle are inputs 0, 2 and 4; 1, 3 and 5 are those of the neighbours beyond the edge that follows.
const std::string kOutline = std::string(Quarters::kHead) + R"(
layout(triangles_adjacency) in;
layout(line_strip, max_vertices = 6) out;
layout(location = 1) out vec3 color;
bool faces(int i, int j, int k) {
    vec3 a = gl_in[i].gl_Position.xyz;
    return dot(cross(gl_in[j].gl_Position.xyz - a, gl_in[k].gl_Position.xyz - a), eye.xyz - a) > 0;
}
void main() {
    if (!faces(0, 2, 4)) return;
    for (int edge = 0; edge < 6; edge += 2) {
        int next = (edge + 2) % 6;
        if (faces(edge, edge + 1, next)) continue;
        color = tint.rgb;
        gl_Position = transform * gl_in[edge].gl_Position;
        EmitVertex();
        color = tint.rgb;
        gl_Position = transform * gl_in[next].gl_Position;
        EmitVertex();
        EndPrimitive();
    }
})";

constexpr uint32_t kColumns = 26, kRows = 12;

std::vector<glm::vec3> ringPlaces() {
    std::vector<glm::vec3> places;
    for (uint32_t row = 0; row < kRows; ++row)
        for (uint32_t column = 0; column < kColumns; ++column) {
            const double around = 2 * kPi * column / kColumns, tube = 2 * kPi * row / kRows;
            const float out = 1.1f + 0.5f * cosineF(tube);
            places.push_back({out * cosineF(around), 0.5f * sineF(tube), -out * sineF(around)});
        }
    return places;
}

/// Counter-clockwise from outside; the ring is closed in both directions, so that every edge has two triangles.
std::vector<uint32_t> ringTriangles() {
    std::vector<uint32_t> indices;
    for (uint32_t row = 0; row < kRows; ++row)
        for (uint32_t column = 0; column < kColumns; ++column) {
            const auto at = [](uint32_t x, uint32_t y) { return y % kRows * kColumns + x % kColumns; };
            const uint32_t a = at(column, row), b = at(column + 1, row), c = at(column, row + 1),
                           d = at(column + 1, row + 1);
            indices.insert(indices.end(), {a, b, d, a, d, c});
        }
    return indices;
}

/// Between the corners of every triangle the third corner of the one beyond that edge, where the edge goes the other
/// way.
std::vector<uint32_t> withNeighbours(const std::vector<uint32_t>& triangles) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> thirdCorners;
    const auto corner = [&](size_t triangle, size_t i) { return triangles[triangle + i % 3]; };
    for (size_t triangle = 0; triangle < triangles.size(); triangle += 3)
        for (size_t i = 0; i < 3; ++i)
            thirdCorners[{corner(triangle, i), corner(triangle, i + 1)}] = corner(triangle, i + 2);
    std::vector<uint32_t> indices;
    for (size_t triangle = 0; triangle < triangles.size(); triangle += 3)
        for (size_t i = 0; i < 3; ++i) {
            indices.push_back(corner(triangle, i));
            indices.push_back(thirdCorners.at({corner(triangle, i + 1), corner(triangle, i)}));
        }
    return indices;
}

}  // namespace

GeometryPage::GeometryPage(App& app) : app_(app), quarters_(app) {
    const std::string &world = Quarters::kWorldVertex, &facet = Quarters::kFacetFragment,
                      &plain = Quarters::kColorFragment;
    body_ = quarters_.program({kBodyVertex, "", "", "", facet});
    normals_ = quarters_.program({world, "", "", kNormals, plain});
    squares_ = quarters_.program({world, "", "", kSquares, kSquareFragment});
    shell_ = quarters_.program({world, "", "", kShell, facet});
    outline_ = quarters_.program({world, "", "", kOutline, plain});

    const std::vector<glm::vec3> places = ringPlaces();
    const std::vector<uint32_t> triangles = ringTriangles(), adjacency = withNeighbours(triangles);
    places_ = app.buffer(places);
    triangles_ = app.buffer(triangles);
    adjacency_ = app.buffer(adjacency);
    vertexCount_ = static_cast<uint32_t>(places.size());
    triangleIndices_ = static_cast<uint32_t>(triangles.size());
    adjacencyIndices_ = static_cast<uint32_t>(adjacency.size());
}

void GeometryPage::drawRing(VnProgram program, VkPrimitiveTopology topology, VnBuffer indices, uint32_t count) {
    quarters_.bind(program, places_, topology);
    must(vnBindIndexBuffer(app_.context(), indices, 0, VK_INDEX_TYPE_UINT32));
    must(vnDrawIndexed(app_.context(), count, 1, 0, 0, 0));
}

void GeometryPage::draw(const PageView& view) {
    const auto drawTriangles = [&](VnProgram program) {
        drawRing(program, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, triangles_, triangleIndices_);
    };
    quarters_.begin(view, 3.8f, 2.6f);

    quarters_.select(0);
    quarters_.push({0.25f, 0.35f, 0.5f});
    drawTriangles(body_);
    quarters_.push({1, 1, 1}, {0.2f, 0, 0, 0});
    drawTriangles(normals_);

    quarters_.select(1);
    quarters_.push({1, 1, 1}, {0.24f, app_.aspect(), view.gl ? 1.0f : -1.0f, 0});
    quarters_.bind(squares_, places_, VK_PRIMITIVE_TOPOLOGY_POINT_LIST);
    must(vnDraw(app_.context(), vertexCount_, 1, 0, 0));

    quarters_.select(2);
    quarters_.push({1, 1, 1}, {0.12f + 0.08f * sineF(view.seconds), 0, 0, 0});
    drawTriangles(shell_);

    quarters_.select(3);
    quarters_.push({0.06f, 0.09f, 0.14f});
    drawTriangles(body_);
    quarters_.push({1, 0.85f, 0.3f});
    drawRing(outline_, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY, adjacency_, adjacencyIndices_);
    quarters_.end();
}

}  // namespace samples
