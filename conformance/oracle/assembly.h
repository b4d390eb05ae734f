// From a draw to primitives: index and vertex fetch, the vertex shader, primitive assembly.
#pragma once

#include "base/result.h"
#include "conformance/oracle/homogeneous.h"
#include "conformance/oracle/shader_resources.h"
#include "conformance/scene/scene.h"
#include "spirv_interp/reference/interpreter.h"

#include <array>
#include <map>
#include <optional>
#include <vector>

namespace vernier::conformance::exact {

/// What the last shader before the rasteriser left for one vertex.
struct ShadedVertex {
    Clip<double> position{};
    std::vector<double> clipDistances;
    double pointSize = 1;
    uint32_t layer = 0, viewport = 0;
    std::optional<uint32_t> primitiveId;  // of a geometry shader that writes it
    std::map<reference::Location, reference::Texel<double>> varyings;
};

/// A triangle, line or point: indices into DrawGeometry::vertices in the order of Vulkan's topology definitions.
struct AssembledPrimitive {
    std::array<uint32_t, 3> vertices{};  // the first `count` of them
    uint32_t count = 3;
    uint32_t provoking = 0;  // an index into DrawGeometry::vertices
    uint32_t id = 0;
    bool startsStrip = false;  // of lines: a segment of a list, or the first one of a strip
};

struct DrawGeometry {
    std::vector<ShadedVertex> vertices;
    std::vector<AssembledPrimitive> primitives;
};

/// Parses a scene's shader with its specialisation.
Result<reference::Module> parseShader(const SceneShader& shader);

/// What a vertex is to the rasteriser that a shader has left with these outputs.
ShadedVertex shadedVertex(const reference::InterfaceValues<double>& outputs, const ScenePipeline& pipeline);

/// A stage of a pipeline; refused where its stores cannot be foreseen.
Result<reference::Interpreter<double>> createStage(const SceneShader& shader, spv::ExecutionModel model);
/// One invocation; what it stores goes to `resources`.
Result<reference::Outcome<double>> runAlone(const reference::Interpreter<double>& shader,
                                            const reference::InterfaceValues<double>& inputs,
                                            ShaderResources& resources);
/// The invocations of a control stage for one patch, the same.
Result<reference::InterfaceValues<double>> runPatch(const reference::Interpreter<double>& shader,
                                                    const reference::InterfaceValues<double>& inputs,
                                                    ShaderResources& resources);

/// All primitives of all instances of a draw, seen by one view.
Result<DrawGeometry> assembleDraw(const Scene& scene, const SceneDraw& draw, ShaderResources& resources,
                                  uint32_t viewIndex = 0);

/// The vertex numbers of each triangle within `count` vertices that follow each other (no restart inside).
std::vector<std::array<uint32_t, 3>> trianglesOf(VkPrimitiveTopology topology, uint32_t count);

}  // namespace vernier::conformance::exact
