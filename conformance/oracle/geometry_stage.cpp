#include "conformance/oracle/geometry_stage.h"

#include <algorithm>

namespace vernier::conformance::exact {

namespace {

using Interpreter = reference::Interpreter<double>;
using Values = reference::InterfaceValues<double>;

/// The vertices of each primitive, those of its neighbours where Vulkan's definitions of the topologies put them.
std::vector<std::vector<uint32_t>> inputsOf(VkPrimitiveTopology topology, uint32_t count) {
    std::vector<std::vector<uint32_t>> result;
    switch (topology) {
        case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
            for (uint32_t i = 0; i < count; ++i) result.push_back({i});
            break;
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
            for (uint32_t i = 0; i + 1 < count; i += 2) result.push_back({i, i + 1});
            break;
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
            for (uint32_t i = 0; i + 1 < count; ++i) result.push_back({i, i + 1});
            break;
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
            for (uint32_t i = 0; i + 3 < count; i += 4) result.push_back({i, i + 1, i + 2, i + 3});
            break;
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
            for (uint32_t i = 0; i + 3 < count; ++i) result.push_back({i, i + 1, i + 2, i + 3});
            break;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
            for (uint32_t i = 0; i + 5 < count; i += 6) result.push_back({i, i + 1, i + 2, i + 3, i + 4, i + 5});
            break;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY: {
            // The corner of a neighbour across the edge towards the triangle before, across the outer edge, and towards
            // the one behind.
            const uint32_t triangles = count < 6 ? 0 : (count - 4) / 2;
            for (uint32_t i = 0; i < triangles; ++i) {
                const uint32_t before = i == 0 ? 1 : 2 * i - 2, outer = 2 * i + 3;
                const uint32_t behind = i + 1 == triangles ? 2 * i + 5 : 2 * i + 6;
                if (i % 2 == 0) {
                    result.push_back({2 * i, before, 2 * i + 2, behind, 2 * i + 4, outer});
                } else {
                    result.push_back({2 * i, outer, 2 * i + 4, behind, 2 * i + 2, before});
                }
            }
            break;
        }
        default:
            for (const auto& triangle : trianglesOf(topology, count))
                result.emplace_back(triangle.begin(), triangle.end());
            break;
    }
    return result;
}

}  // namespace

Result<GeometryStage> GeometryStage::create(const SceneShader& shader, const ScenePipeline& pipeline,
                                            ShaderResources& resources, uint32_t viewIndex) {
    const auto module = parseShader(shader);
    if (!module) return module.error();
    auto made = createStage(shader, spv::ExecutionModelGeometry);
    if (!made) return made.error();
    GeometryStage stage(std::move(*made), pipeline, resources);
    for (const reference::EntryPoint& entry : module->entryPoints())
        if (entry.model == spv::ExecutionModelGeometry) stage.modes_ = entry.modes;
    stage.viewIndex_ = viewIndex;
    return stage;
}

Status GeometryStage::run(const std::vector<Values>& vertices, std::span<const uint32_t> run, uint32_t& primitiveId,
                          DrawGeometry& geometry) const {
    for (std::vector<uint32_t>& primitive : inputsOf(pipeline_->topology, static_cast<uint32_t>(run.size()))) {
        for (uint32_t& vertex : primitive) vertex = run[vertex];
        if (Status s = runPrimitive(vertices, primitive, primitiveId, geometry); !s) return s;
        ++primitiveId;
    }
    return {};
}

Status GeometryStage::runPrimitive(const std::vector<Values>& vertices, std::span<const uint32_t> primitive,
                                   uint32_t primitiveId, DrawGeometry& geometry) const {
    Values inputs;
    for (const uint32_t vertex : primitive) inputs.vertices.push_back(vertices[vertex]);
    inputs.setInt(spv::BuiltInPrimitiveId, static_cast<int32_t>(primitiveId));
    inputs.setInt(spv::BuiltInViewIndex, static_cast<int32_t>(viewIndex_));
    for (uint32_t invocation = 0; invocation < modes_.invocations; ++invocation) {
        inputs.setInt(spv::BuiltInInvocationId, static_cast<int32_t>(invocation));
        const auto outcome = runAlone(shader_, inputs, *resources_);
        if (!outcome) return outcome.error();
        add(outcome->vertices, primitiveId, geometry);
    }
    return {};
}

/// Strips of stream 0, which alone is rasterised.
void GeometryStage::add(const std::vector<reference::EmittedVertex<double>>& emitted, uint32_t primitiveId,
                        DrawGeometry& geometry) const {
    const uint32_t each = modes_.primitiveVertices;
    uint32_t strip = 0;  // vertices of it so far
    for (const reference::EmittedVertex<double>& vertex : emitted) {
        if (vertex.stream != 0) continue;
        strip = vertex.startsStrip || each == 1 ? 1 : strip + 1;
        geometry.vertices.push_back(shadedVertex(vertex.outputs, *pipeline_));
        if (strip < each) continue;
        const auto end = static_cast<uint32_t>(geometry.vertices.size());
        AssembledPrimitive primitive;
        primitive.count = each;
        primitive.startsStrip = strip == each;
        // Every other triangle of a strip is turned around.
        const bool turned = each == 3 && strip % 2 == 0;
        for (uint32_t n = 0; n < each; ++n) primitive.vertices[n] = end - each + n;
        if (turned) std::swap(primitive.vertices[1], primitive.vertices[2]);
        primitive.provoking = pipeline_->provokingVertexLast ? end - 1 : end - each;
        primitive.id = geometry.vertices[primitive.provoking].primitiveId.value_or(primitiveId);
        geometry.primitives.push_back(primitive);
    }
}

}  // namespace vernier::conformance::exact
