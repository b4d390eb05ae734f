#include "conformance/hardcases/topology_cases.h"

#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/scenes/recorder.h"

#include <cmath>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{64, 64};

const char* const kFlatVertexGlsl = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 0) flat out vec4 vColor;
void main() {
    gl_Position = position;
    vColor = vec4(float(gl_VertexIndex * 11 % 256) / 255.0, float(gl_VertexIndex) / 255.0, 0.5, 1.0);
}
)";
const char* const kFlatFragmentGlsl = R"(#version 450
layout(location = 0) flat in vec4 vColor;
layout(location = 0) out vec4 color;
void main() { color = vColor; }
)";

// Vertices in a zigzag, which make a strip, a fan, or a list.
std::vector<ClipPosition> zigzag(VkPrimitiveTopology topology) {
    std::vector<ClipPosition> positions;
    if (topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN) {
        positions.push_back(clipAt({31, 33}, viewportOf(kTarget)));
        for (int i = 0; i < 9; ++i) {
            const double angle = 0.6 * i;
            positions.push_back(clipAt({31 + 28 * std::cos(angle), 33 + 27 * std::sin(angle)}, viewportOf(kTarget)));
        }
        return positions;
    }
    for (int i = 0; i < 12; ++i)
        positions.push_back(clipAt({3 + 5.2 * i, i % 2 == 0 ? 6 + 1.5 * i : 58 - i}, viewportOf(kTarget)));
    return positions;
}

constexpr VkPrimitiveTopology kTopologies[] = {
    VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN};

Result<Scene> flatScene(std::string_view name, VkPrimitiveTopology topology, VkCullModeFlags cull, uint32_t first = 0) {
    SceneRecorder record(name, "Flat colours of the provoking vertices.");
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
    const std::vector<ClipPosition> positions = zigzag(topology);
    const uint32_t pipeline = record.pipeline(record.vertex(kFlatVertexGlsl), record.fragment(kFlatFragmentGlsl))
                                  .binding(sizeof(ClipPosition))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                  .topology(topology)
                                  .cull(cull, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    record.pass(kTarget).color(target, {0, 0, 0, 1});
    record.draw(pipeline, static_cast<uint32_t>(positions.size()) - first)
        .vertices(record.vertexBuffer("positions", positions))
        .first(first);
    record.output(target);
    return record.finish();
}

// Restart indices against draws of the pieces; the value is compared before the offset is added.
template <class Index>
void restarts(CaseInput& input, VkIndexType type) {
    constexpr Index kRestart = static_cast<Index>(~Index{0});
    const std::vector<std::vector<Index>> pieces{{0, 1, 2, 3, 4}, {5}, {6, 7}, {}, {7, 8, 9, 10, 11}};
    for (const int32_t offset : {0, -3}) {
        const auto scene = [&](bool split) {
            SceneRecorder record("V09", "Strips with restart indices.");
            const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
            const uint32_t pipeline =
                record.pipeline(record.vertex(kFlatVertexGlsl), record.fragment(kFlatFragmentGlsl))
                    .binding(sizeof(ClipPosition))
                    .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                    .topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, !split);
            std::vector<Index> indices;
            std::vector<std::pair<uint32_t, uint32_t>> ranges;
            for (const auto& piece : pieces) {
                if (!indices.empty() && !split) indices.insert(indices.end(), {kRestart, kRestart});
                ranges.emplace_back(static_cast<uint32_t>(indices.size()), static_cast<uint32_t>(piece.size()));
                for (const Index i : piece) indices.push_back(static_cast<Index>(i - offset));
            }
            const uint32_t vertices = record.vertexBuffer("positions", zigzag(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP));
            const uint32_t buffer = record.indexBuffer("indices", indices);
            record.pass(kTarget).color(target, {0, 0, 0, 1});
            const auto draw = [&](uint32_t first, uint32_t count) {
                if (count != 0)
                    record.draw(pipeline, count).vertices(vertices).indices(buffer, type).first(first, offset);
            };
            if (split) {
                for (const auto& [first, count] : ranges) draw(first, count);
            } else {
                draw(0, static_cast<uint32_t>(indices.size()));
            }
            record.output(target);
            return record.finish();
        };
        const size_t separate = addForOracle(input, scene(true));
        judgeSame(input, input.scene(scene(false)), separate, "a restart index ends a strip as a new draw does");
    }
}

// ---- Provoking vertices of every topology ----

const char* const kNumberVertexGlsl = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 0) flat out uint vNumber;
void main() {
    gl_Position = position;
    vNumber = uint(gl_VertexIndex) + 1u;
}
)";
const char* const kNumberFragmentGlsl = R"(#version 450
layout(location = 0) flat in uint vNumber;
layout(location = 0) out uint number;
void main() { number = vNumber; }
)";

/// How primitives are put together: primitive i has vertices stride * i + offset, of which the first and the last one
/// can be provoking (Vulkan, table "Provoking Vertex Selection"). Vertices that are no corner lie far outside.
struct Assembly {
    VkPrimitiveTopology topology;
    uint32_t primitives, vertices, stride;
    std::vector<uint32_t> corners;
    bool apart = false;  // primitives share no vertices
};
const std::vector<Assembly>& assemblies() {
    static const std::vector<Assembly> all{
        {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 2, 6, 3, {0, 1, 2}, true},
        {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, 5, 7, 1, {0, 1, 2}},
        {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, 5, 7, 1, {1, 2}},  // and vertex 0
        {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY, 2, 12, 6, {0, 2, 4}, true},
        {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY, 5, 14, 2, {0, 2, 4}},
        {VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 3, 6, 2, {0, 1}, true},
        {VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, 6, 7, 1, {0, 1}},
        {VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY, 3, 12, 4, {1, 2}, true},
        {VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY, 6, 9, 1, {1, 2}}};
    return all;
}

/// The place of corner `corner` of primitive `primitive`.
WindowPoint cornerAt(const Assembly& assembly, uint32_t primitive, uint32_t corner) {
    const auto corners = static_cast<uint32_t>(assembly.corners.size());
    const uint32_t step = assembly.apart ? primitive * (corners + 1) + corner : primitive + corner;
    if (assembly.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN)
        return {32 + 28 * std::cos(0.6 * step), 32 + 28 * std::sin(0.6 * step)};
    const bool line = corners == 2;
    return {4.5 + 7 * step, line ? 20.5 : step % 2 == 0 ? 8 : 30};
}

void addProvoking(CaseInput& input, const Assembly& assembly, bool last) {
    SceneRecorder record("V15", "Numbers of the provoking vertices.");
    const uint32_t target = record.colorTarget("numbers", VK_FORMAT_R32_UINT, kTarget);
    std::vector<ClipPosition> positions(assembly.vertices, clipAt({-500, -500}, viewportOf(kTarget)));
    const bool fan = assembly.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN;
    const WindowPoint hub{32, 32};
    if (fan) positions[0] = clipAt(hub, viewportOf(kTarget));
    std::vector<Spot> spots;
    for (uint32_t i = 0; i < assembly.primitives; ++i) {
        WindowPoint sum = fan ? hub : WindowPoint{};
        for (uint32_t corner = 0; corner < assembly.corners.size(); ++corner) {
            const WindowPoint at = cornerAt(assembly, i, corner);
            positions[assembly.stride * i + assembly.corners[corner]] = clipAt(at, viewportOf(kTarget));
            sum = {sum.x + at.x, sum.y + at.y};
        }
        const double corners = static_cast<double>(assembly.corners.size()) + (fan ? 1 : 0);
        const uint32_t provoking = last ? assembly.corners.back() : assembly.corners.front();
        spots.push_back({static_cast<uint32_t>(sum.x / corners), static_cast<uint32_t>(sum.y / corners),
                         uint64_t{assembly.stride} * i + provoking + 1});
    }
    PipelineRecorder pipeline = record.pipeline(record.vertex(kNumberVertexGlsl), record.fragment(kNumberFragmentGlsl))
                                    .binding(sizeof(ClipPosition))
                                    .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                    .topology(assembly.topology);
    if (last) pipeline.provokingVertexLast();
    record.pass(kTarget).color(target, {0, 0, 0, 0});
    record.draw(pipeline, assembly.vertices).vertices(record.vertexBuffer("positions", positions));
    record.output(target);
    judgeSpots(input, input.scene(record.finish()), kTarget, std::move(spots),
               std::string("the number of the ") + (last ? "last" : "first") + " vertex, from 1, topology " +
                   std::to_string(assembly.topology));
}

// ---- Numbers of primitives ----

const char* const kPrimitiveFragmentGlsl = R"(#version 450
layout(location = 0) flat in int vInstance;
layout(location = 0) out uint number;
void main() { number = uint(gl_PrimitiveID + 1 + 100 * vInstance); }
)";

/// Two instances, the second one 32 pixels below the first, of indexed vertices in a zigzag.
size_t addPrimitiveNumbers(CaseInput& input, VkPrimitiveTopology topology, const std::vector<uint16_t>& indices) {
    SceneRecorder record("V18", "Numbers of primitives.");
    const uint32_t target = record.colorTarget("numbers", VK_FORMAT_R32_UINT, kTarget);
    PipelineRecorder pipeline = record
                                    .pipeline(record.vertex(R"(#version 450
layout(location = 0) flat out int vInstance;
void main() {
    vec2 pixel = vec2(4 + 7 * gl_VertexIndex, (gl_VertexIndex & 1) * 20 + 4 + 32 * gl_InstanceIndex);
    gl_Position = vec4(pixel / 32.0 - 1.0, 0.5, 1.0);
    vInstance = gl_InstanceIndex;
}
)"),
                                              record.fragment(kPrimitiveFragmentGlsl))
                                    .topology(topology, topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP)
                                    .cull(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    record.pass(kTarget).color(target, {0, 0, 0, 0});
    record.draw(pipeline, static_cast<uint32_t>(indices.size()))
        .indices(record.indexBuffer("indices", indices), VK_INDEX_TYPE_UINT16)
        .instances(2);
    record.output(target);
    return input.scene(record.finish());
}

/// The middle of the triangle of vertices `first` to `first` + 2 of the zigzag, of both instances.
void addSpots(std::vector<Spot>& spots, uint32_t first, uint64_t number) {
    const uint32_t x = 4 + 7 * (first + 1), y = first % 2 == 0 ? 10 : 17;
    spots.push_back({x, y, number});
    spots.push_back({x, y + 32, number == 0 ? 0 : number + 100});
}

}  // namespace

void judgeSpots(CaseInput& input, size_t scene, VkExtent2D extent, std::vector<Spot> spots, std::string law) {
    judgePixels(input, scene, 0, extent, [=](const PixelReader& pixels, const Declared&) -> Verdict {
        for (const Spot& spot : spots) {
            const uint64_t seen = pixels.code(spot.x, spot.y, 0);
            if (seen == spot.number) continue;
            return Verdict::wrong(pixelText(spot.x, spot.y) + " has " + std::to_string(seen) + ", exactly " +
                                  std::to_string(spot.number) + "; " + law);
        }
        return {};
    });
}

void v08(CaseInput& input) {
    for (const VkPrimitiveTopology topology : kTopologies) {
        for (const VkCullModeFlags cull : {VK_CULL_MODE_NONE, VK_CULL_MODE_BACK_BIT}) {
            for (const uint32_t first : {0u, 1u}) addForOracle(input, flatScene("V08", topology, cull, first));
        }
    }
}

void v09(CaseInput& input) {
    restarts<uint16_t>(input, VK_INDEX_TYPE_UINT16);
    restarts<uint32_t>(input, VK_INDEX_TYPE_UINT32);
}

// Vertex and instance numbers beyond 2^24, where floats are no longer whole; and counts of 0.
void v11(CaseInput& input) {
    constexpr uint32_t kFirst = (1u << 24) + 1;
    const char* const vertex = R"(#version 450
layout(location = 0) flat out uvec2 numbers;
void main() {
    int corner = gl_VertexIndex - 16777217;
    gl_Position = vec4(float((corner & 1) * 4 - 1), float((corner >> 1) * 4 - 1), 0.0, 1.0);
    numbers = uvec2(gl_VertexIndex, gl_InstanceIndex);
}
)";
    const char* const fragment = R"(#version 450
layout(location = 0) flat in uvec2 numbers;
layout(location = 0) out uint color;
void main() { color = numbers.x * 3u + numbers.y; }
)";
    const auto scene = [&](uint32_t vertices, uint32_t instances) {
        SceneRecorder record("V11", "Large first vertices and instances.");
        const uint32_t target = record.colorTarget("numbers", VK_FORMAT_R32_UINT, {4, 4});
        record.pass({4, 4}).color(target, {0, 0, 0, 0});
        record.draw(record.pipeline(record.vertex(vertex), record.fragment(fragment)), vertices)
            .first(kFirst)
            .instances(instances, kFirst + 4);
        record.output(target);
        return record.finish();
    };
    judgeCodes(input, input.scene(scene(3, 1)), 0, {4, 4}, {uint64_t{kFirst} * 3 + kFirst + 4}, "numbers are integers");
    judgeCodes(input, input.scene(scene(3, 3)), 0, {4, 4}, {uint64_t{kFirst} * 3 + kFirst + 6},
               "the last instance is seen");
    judgeCodes(input, input.scene(scene(3, 0)), 0, {4, 4}, {0}, "no instances, no fragments");
    judgeCodes(input, input.scene(scene(0, 5)), 0, {4, 4}, {0}, "no vertices, no fragments");
    judgeCodes(input, input.scene(scene(2, 5)), 0, {4, 4}, {0}, "two vertices are no triangle");
}

void v15(CaseInput& input) {
    for (const Assembly& assembly : assemblies()) {
        for (const bool last : {false, true}) addProvoking(input, assembly, last);
    }
}

void v18(CaseInput& input) {
    constexpr uint16_t kRestart = 0xffff;
    const std::string law = "primitives are counted through restarts, drawn or not, and anew in each instance";
    // Two triangles; an empty one and one more; none; and one.
    std::vector<Spot> spots;
    const size_t strips =
        addPrimitiveNumbers(input, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP,
                            {0, 1, 2, 3, kRestart, kRestart, 3, 3, 4, 5, kRestart, 5, 6, kRestart, 6, 7, 8});
    for (const auto& [first, number] : {std::pair{0u, 1u}, {1u, 2u}, {3u, 4u}, {6u, 5u}})
        addSpots(spots, first, number);
    judgeSpots(input, strips, kTarget, spots, law);
    // The second one faces back, the third one is empty.
    spots.clear();
    const size_t list =
        addPrimitiveNumbers(input, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, {0, 1, 2, 3, 4, 5, 4, 4, 5, 6, 7, 8});
    for (const auto& [first, number] : {std::pair{0u, 1u}, {3u, 0u}, {6u, 4u}}) addSpots(spots, first, number);
    judgeSpots(input, list, kTarget, spots, law);
}

}  // namespace vernier::conformance::hardcases
