// Runs a fragment shader over a quad and finds what else it might legally have returned.
//
// Method: the nominal run has exact inputs at the sample's place. Further runs see
//   - the quad moved by the snapping freedom in the four diagonal directions (inputs, FragCoord.z and w move;
//   FragCoord.xy
//     does not);
//   - every texture read at the lower, then at the upper end of its range;
//   - derivatives per quad instead of per row and column (where the module takes derivatives);
//   - every result rounded to float32; its deviation, times 8, stands for the float rounding of another
//   implementation.
// Per component, deviations of one kind give a range by their extremes, and the ranges of different kinds add
// up. A relative term covers interpolation (1e-5 where the result varies with the inputs) and imprecise
// functions (Vulkan's precision table).
//
// Limits: a shader that is not monotone between the perturbed runs can reach values outside their range (a
// texture read that feeds a coordinate, a test on equality); interactions between kinds of perturbation are
// taken as additive.
#pragma once

#include "base/result.h"
#include "conformance/oracle/assembly.h"
#include "conformance/oracle/sample_states.h"
#include "conformance/oracle/shader_resources.h"
#include "conformance/oracle/triangle.h"
#include "spirv_interp/reference/interpreter.h"

#include <array>
#include <memory>
#include <vector>

namespace vernier::conformance::exact {

/// A triangle with everything its fragments read.
struct FragmentSource {
    const Triangle* triangle = nullptr;
    std::array<const ShadedVertex*, 3> vertices{};  // the first is provoking
    bool frontFacing = false;
    uint32_t primitiveId = 0;
};

class FragmentShader {
  public:
    /// For pipelines without a fragment shader, use no FragmentShader at all. Refuses shaders that need what
    /// the oracle does not model: per-sample shading, centroid inputs with several samples.
    static Result<FragmentShader> create(const Scene& scene, const ScenePipeline& pipeline);

    /// The quad whose upper left pixel is (x, y). `resources` is used by one thread at a time.
    Result<std::array<FragmentResult, 4>> evaluate(const FragmentSource& source, uint32_t x, uint32_t y,
                                                   const std::array<bool, 4>& covered, const OutputState& output,
                                                   ShaderResources& resources) const;

  private:
    using Interpreter = reference::Interpreter<double>;
    using Values = reference::InterfaceValues<double>;
    using Outcomes = std::array<reference::Outcome<double>, 4>;

    FragmentShader(reference::Module module, Interpreter nominal, Interpreter rounded)
        : module_(std::move(module)), nominal_(std::move(nominal)), rounded_(std::move(rounded)) {}

    std::array<Values, 4> inputsAt(const FragmentSource& source, uint32_t x, uint32_t y, double shiftX,
                                   double shiftY) const;
    void setVariable(const reference::InterfaceVariable& variable, const FragmentSource& source,
                     const std::array<double, 3>& weights, Values& values) const;

    reference::Module module_;
    Interpreter nominal_, rounded_;
    std::shared_ptr<const Interpreter> coarse_;  // only if the module takes derivatives
    std::vector<reference::InterfaceVariable> inputs_, outputs_;
    bool variesWithPosition_ = false;  // reads something interpolated
    double imprecision_ = 0;           // relative error of the built-in functions used
};

}  // namespace vernier::conformance::exact
