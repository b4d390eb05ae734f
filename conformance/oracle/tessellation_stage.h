// The tessellation stages of the oracle: patches in, points of their domains between, vertices and primitives out.
#pragma once

#include "conformance/oracle/assembly.h"
#include "conformance/oracle/tessellator.h"

#include <span>

namespace vernier::conformance::exact {

class GeometryStage;

class TessellationStage {
  public:
    /// `pipeline` and `resources` must outlive it. Refused where the stage behind reads PrimitiveId, which counts
    /// primitives in an order that is the implementation's.
    static Result<TessellationStage> create(const Scene& scene, const ScenePipeline& pipeline,
                                            ShaderResources& resources, uint32_t viewIndex);

    /// Adds what becomes of the patches that `run`, indices into `vertices`, makes up. `patchId` counts them.
    Status run(const std::vector<reference::InterfaceValues<double>>& vertices, std::span<const uint32_t> run,
               uint32_t& patchId, const GeometryStage* geometryStage, DrawGeometry& geometry) const;

  private:
    using Values = reference::InterfaceValues<double>;

    TessellationStage(reference::Interpreter<double> control, reference::Interpreter<double> evaluation,
                      const ScenePipeline& pipeline, ShaderResources& resources)
        : control_(std::move(control)),
          evaluation_(std::move(evaluation)),
          pipeline_(&pipeline),
          resources_(&resources) {}
    Result<Subdivision> subdivided(const Values& patch) const;
    /// One vertex for each point.
    Result<std::vector<Values>> evaluated(Values patch, const std::vector<DomainPoint>& points) const;
    void add(const std::vector<Values>& vertices, const Subdivision& parts, uint32_t patchId,
             DrawGeometry& geometry) const;

    reference::Interpreter<double> control_, evaluation_;
    const ScenePipeline* pipeline_;
    ShaderResources* resources_;
    PatchModes modes_;
    uint32_t viewIndex_ = 0;
};

}  // namespace vernier::conformance::exact
