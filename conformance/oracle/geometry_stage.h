// The geometry stage of the oracle: primitives in, vertices and primitives out, one invocation after the other.
#pragma once

#include "conformance/oracle/assembly.h"

#include <span>

namespace vernier::conformance::exact {

class GeometryStage {
  public:
    /// `pipeline` and `resources` must outlive it.
    static Result<GeometryStage> create(const SceneShader& shader, const ScenePipeline& pipeline,
                                        ShaderResources& resources, uint32_t viewIndex);

    /// Adds what becomes of the primitives that `run`, indices into `vertices` without a restart between, makes up.
    /// `primitiveId` counts them.
    Status run(const std::vector<reference::InterfaceValues<double>>& vertices, std::span<const uint32_t> run,
               uint32_t& primitiveId, DrawGeometry& geometry) const;
    /// Adds what becomes of one primitive.
    Status runPrimitive(const std::vector<reference::InterfaceValues<double>>& vertices,
                        std::span<const uint32_t> primitive, uint32_t primitiveId, DrawGeometry& geometry) const;

  private:
    GeometryStage(reference::Interpreter<double> shader, const ScenePipeline& pipeline, ShaderResources& resources)
        : shader_(std::move(shader)), pipeline_(&pipeline), resources_(&resources) {}
    void add(const std::vector<reference::EmittedVertex<double>>& emitted, uint32_t primitiveId,
             DrawGeometry& geometry) const;

    reference::Interpreter<double> shader_;
    const ScenePipeline* pipeline_;
    ShaderResources* resources_;
    reference::ExecutionModes modes_;
    uint32_t viewIndex_ = 0;
};

}  // namespace vernier::conformance::exact
