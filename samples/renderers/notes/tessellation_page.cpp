#include "samples/renderers/notes/tessellation_page.h"

#include "samples/common/random.h"

namespace samples {
namespace {

// Of a point of the patch only its place; the first invocation tells the levels. Edges that two patches share have the
// same two corners in both, and so the same level. Outer levels are those of the edges u = 0, v = 0, u = 1 and v = 1.
const std::string kControl = std::string(Quarters::kHead) + R"(
layout(vertices = 16) out;
float level(int from, int to) {
    if (options.x > 0) return options.x;
    float away = distance(eye.xyz, (gl_in[from].gl_Position.xyz + gl_in[to].gl_Position.xyz) / 2);
    return clamp(3 * (8.5 - away), 1, 24);
}
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    if (gl_InvocationID > 0) return;
    gl_TessLevelOuter[0] = level(0, 12);
    gl_TessLevelOuter[1] = level(0, 3);
    gl_TessLevelOuter[2] = level(3, 15);
    gl_TessLevelOuter[3] = level(12, 15);
    gl_TessLevelInner[0] = max(gl_TessLevelOuter[1], gl_TessLevelOuter[3]);
    gl_TessLevelInner[1] = max(gl_TessLevelOuter[0], gl_TessLevelOuter[2]);
})";

// The points weighted by Bernstein's polynomials in both directions.
std::string evaluation(const std::string& spacing) {
    return std::string(Quarters::kHead) + "layout(quads, " + spacing + R"(_spacing, ccw) in;
layout(location = 0) out vec3 place;
layout(location = 1) out vec3 color;
vec4 weights(float t) {
    float s = 1 - t;
    return vec4(s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t);
}
void main() {
    vec4 across = weights(gl_TessCoord.x), along = weights(gl_TessCoord.y);
    place = vec3(0);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            place += across[column] * along[row] * gl_in[row * 4 + column].gl_Position.xyz;
    bool odd = gl_PrimitiveID == 1 || gl_PrimitiveID == 2;
    color = tint.r > 0 ? tint.rgb : odd ? vec3(0.85, 0.45, 0.2) : vec3(0.2, 0.5, 0.75);
    gl_Position = transform * vec4(place, 1);
})";
}

const std::string kNetVertex = std::string(Quarters::kHead) + R"(
layout(location = 0) in vec3 position;
layout(location = 1) out vec3 color;
void main() {
    color = tint.rgb;
    gl_Position = transform * vec4(position, 1);
})";

constexpr int kSide = 7;  // points along two patches, which share a row

/// A smooth surface: where patches meet the points lie on the line between their neighbours.
std::vector<glm::vec3> points() {
    std::vector<glm::vec3> list;
    Random random(11);
    for (int z = 0; z < kSide; ++z)
        for (int x = 0; x < kSide; ++x)
            list.push_back(
                {static_cast<float>(x - 3) * 0.6f, random.between(-1.1f, 1.1f), static_cast<float>(z - 3) * 0.6f});
    constexpr size_t kRow = kSide;
    for (size_t x = 0; x < kRow; ++x) list[3 * kRow + x].y = (list[2 * kRow + x].y + list[4 * kRow + x].y) / 2;
    for (size_t z = 0; z < kRow; ++z) list[z * kRow + 3].y = (list[z * kRow + 2].y + list[z * kRow + 4].y) / 2;
    return list;
}

}  // namespace

TessellationPage::TessellationPage(App& app) : app_(app), quarters_(app) {
    const char* const spacings[] = {"equal", "fractional_even", "fractional_odd"};
    for (int i = 0; i < 3; ++i) {
        StageSources sources{Quarters::kWorldVertex, kControl, evaluation(spacings[i]), "", Quarters::kFacetFragment};
        surfaces_[i] = quarters_.program(sources);
        sources.fragment = Quarters::kColorFragment;
        edges_[i] = quarters_.program(sources);
    }
    net_ = quarters_.program({kNetVertex, "", "", "", Quarters::kColorFragment});

    const std::vector<glm::vec3> all = points();
    const auto at = [&](int x, int z) { return all[static_cast<size_t>(z * kSide + x)]; };
    std::vector<glm::vec3> patches, lines;
    for (const int patch : {0, 1, 2, 3})
        for (int z = 0; z < 4; ++z)
            for (int x = 0; x < 4; ++x) patches.push_back(at(patch % 2 * 3 + x, patch / 2 * 3 + z));
    for (int i = 0; i < kSide; ++i)
        for (int k = 0; k + 1 < kSide; ++k)
            for (const glm::vec3& point : {at(k, i), at(k + 1, i), at(i, k), at(i, k + 1)}) lines.push_back(point);
    patches_ = app.buffer(patches);
    netLines_ = app.buffer(lines);
    netVertices_ = static_cast<uint32_t>(lines.size());
}

void TessellationPage::draw(const PageView& view, int spacing) {
    VnContext context = app_.context();
    quarters_.begin(view, 4.6f, 4.4f);
    must(vnSetPatchVertices(context, 16));
    const float levels[] = {1, 2.6f, 7.4f, 0};  // 0: by distance
    for (int quarter = 0; quarter < 4; ++quarter) {
        quarters_.select(quarter);
        const glm::vec4 options(levels[quarter], 0, 0, 0);
        quarters_.bind(surfaces_[spacing], patches_, VK_PRIMITIVE_TOPOLOGY_PATCH_LIST);
        quarters_.push({0, 0, 0}, options);
        must(vnDraw(context, 64, 1, 0, 0));
        quarters_.bind(edges_[spacing], patches_, VK_PRIMITIVE_TOPOLOGY_PATCH_LIST, true);
        quarters_.push({0.75f, 0.75f, 0.65f}, options);
        must(vnDraw(context, 64, 1, 0, 0));
    }
    quarters_.select(0);
    quarters_.bind(net_, netLines_, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, true);
    quarters_.push({0.1f, 0.35f, 0.15f});
    must(vnDraw(context, netVertices_, 1, 0, 0));
    quarters_.end();
}

}  // namespace samples
