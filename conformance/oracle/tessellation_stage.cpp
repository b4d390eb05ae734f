#include "conformance/oracle/tessellation_stage.h"

#include "conformance/oracle/geometry_stage.h"

#include <algorithm>
#include <cmath>

namespace vernier::conformance::exact {

namespace {

using Interpreter = reference::Interpreter<double>;
using Values = reference::InterfaceValues<double>;

/// Takes over what a stage of a pipeline says; what one leaves open the other says.
void readModes(std::span<const uint32_t> module, PatchModes& modes) {
    for (size_t at = 5; at + 2 < module.size();) {
        const uint32_t length = module[at] >> 16, opcode = module[at] & 0xffff;
        if (length == 0) break;
        if (opcode == spv::OpExecutionMode) {
            const uint32_t mode = module[at + 2];
            if (mode == spv::ExecutionModeTriangles) modes.domain = PatchDomain::triangles;
            if (mode == spv::ExecutionModeQuads) modes.domain = PatchDomain::quads;
            if (mode == spv::ExecutionModeIsolines) modes.domain = PatchDomain::isolines;
            if (mode == spv::ExecutionModeSpacingEqual) modes.spacing = PatchSpacing::equal;
            if (mode == spv::ExecutionModeSpacingFractionalEven) modes.spacing = PatchSpacing::fractionalEven;
            if (mode == spv::ExecutionModeSpacingFractionalOdd) modes.spacing = PatchSpacing::fractionalOdd;
            if (mode == spv::ExecutionModeVertexOrderCw) modes.clockwise = true;
            if (mode == spv::ExecutionModePointMode) modes.points = true;
        }
        at += length;
    }
}

Result<bool> readsPrimitiveId(const SceneShader& shader) {
    const auto module = parseShader(shader);
    if (!module) return module.error();
    for (size_t i = 0; i < module->entryPoints().size(); ++i) {
        const auto& variables = module->interfaceVariables(i);
        const bool reads = std::ranges::any_of(variables, [](const reference::InterfaceVariable& v) {
            return !v.output && v.isBuiltin && v.builtin == spv::BuiltInPrimitiveId;
        });
        if (reads) return true;
    }
    return false;
}

/// Levels are floats; one that is not written is undefined, here 0.
template <size_t kCount>
std::array<double, kCount> levelsOf(const Values& patch, spv::BuiltIn builtin) {
    std::array<double, kCount> levels{};
    const auto found = patch.builtins.find(builtin);
    if (found == patch.builtins.end()) return levels;
    for (size_t i = 0; i < kCount && i < found->second.size(); ++i)
        levels[i] = static_cast<double>(static_cast<float>(found->second[i].number));
    return levels;
}

}  // namespace

Result<TessellationStage> TessellationStage::create(const Scene& scene, const ScenePipeline& pipeline,
                                                    ShaderResources& resources, uint32_t viewIndex) {
    const SceneShader &control = scene.shaders[pipeline.controlShader],
                      &evaluation = scene.shaders[pipeline.evaluationShader];
    auto first = createStage(control, spv::ExecutionModelTessellationControl);
    if (!first) return first.error();
    auto second = createStage(evaluation, spv::ExecutionModelTessellationEvaluation);
    if (!second) return second.error();
    const uint32_t next = pipeline.geometryShader != kNone ? pipeline.geometryShader : pipeline.fragmentShader;
    if (next != kNone) {
        const auto reads = readsPrimitiveId(scene.shaders[next]);
        if (!reads) return reads.error();
        if (*reads) return unsupported("oracle: numbers of primitives that come out of patches");
    }
    TessellationStage stage(std::move(*first), std::move(*second), pipeline, resources);
    stage.modes_.lowerLeft = pipeline.domainLowerLeft;
    readModes(control.spirv, stage.modes_);
    readModes(evaluation.spirv, stage.modes_);
    stage.viewIndex_ = viewIndex;
    return stage;
}

Status TessellationStage::run(const std::vector<Values>& vertices, std::span<const uint32_t> run, uint32_t& patchId,
                              const GeometryStage* geometryStage, DrawGeometry& geometry) const {
    const uint32_t size = pipeline_->patchVertices;
    for (; run.size() >= size; run = run.subspan(size)) {
        Values inputs;
        for (const uint32_t vertex : run.first(size)) inputs.vertices.push_back(vertices[vertex]);
        inputs.setInt(spv::BuiltInPrimitiveId, static_cast<int32_t>(patchId));
        inputs.setInt(spv::BuiltInPatchVertices, static_cast<int32_t>(size));
        inputs.setInt(spv::BuiltInViewIndex, static_cast<int32_t>(viewIndex_));
        auto patch = runPatch(control_, inputs, *resources_);
        if (!patch) return patch.error();
        const Result<Subdivision> parts = subdivided(*patch);
        if (!parts) return parts.error();
        patch->setInt(spv::BuiltInPrimitiveId, static_cast<int32_t>(patchId));
        const auto made = evaluated(std::move(*patch), parts->points);
        if (!made) return made.error();
        if (geometryStage == nullptr) {
            add(*made, *parts, patchId, geometry);
        } else {
            for (const std::vector<uint32_t>& primitive : parts->primitives) {
                if (Status s = geometryStage->runPrimitive(*made, primitive, patchId, geometry); !s) return s;
            }
        }
        ++patchId;
    }
    return {};
}

Result<Subdivision> TessellationStage::subdivided(const Values& patch) const {
    const PatchLevels levels{levelsOf<4>(patch, spv::BuiltInTessLevelOuter),
                             levelsOf<2>(patch, spv::BuiltInTessLevelInner)};
    if (std::ranges::any_of(levels.inner, [](double level) { return std::isnan(level); }))
        return unsupported("oracle: an inner level that is no number");
    return subdivide(modes_, levels, resources_->rules().tessellation);
}

Result<std::vector<Values>> TessellationStage::evaluated(Values patch, const std::vector<DomainPoint>& points) const {
    patch.setInt(spv::BuiltInPatchVertices, static_cast<int32_t>(patch.vertices.size()));
    patch.setInt(spv::BuiltInViewIndex, static_cast<int32_t>(viewIndex_));
    std::vector<Values> result;
    for (const DomainPoint& point : points) {
        patch.setFloat(spv::BuiltInTessCoord, {point[0].get_d(), point[1].get_d(), point[2].get_d()});
        auto outcome = runAlone(evaluation_, patch, *resources_);
        if (!outcome) return outcome.error();
        result.push_back(std::move(outcome->outputs));
    }
    return result;
}

void TessellationStage::add(const std::vector<Values>& vertices, const Subdivision& parts, uint32_t patchId,
                            DrawGeometry& geometry) const {
    const auto first = static_cast<uint32_t>(geometry.vertices.size());
    for (const Values& vertex : vertices) geometry.vertices.push_back(shadedVertex(vertex, *pipeline_));
    for (const std::vector<uint32_t>& part : parts.primitives) {
        AssembledPrimitive primitive;
        primitive.count = static_cast<uint32_t>(part.size());
        for (size_t n = 0; n < part.size(); ++n) primitive.vertices[n] = first + part[n];
        primitive.provoking = first + (pipeline_->provokingVertexLast ? part.back() : part.front());
        primitive.id = patchId;
        primitive.startsStrip = true;
        geometry.primitives.push_back(primitive);
    }
}

}  // namespace vernier::conformance::exact
