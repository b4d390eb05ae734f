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

}  // namespace

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

}  // namespace vernier::conformance::hardcases
