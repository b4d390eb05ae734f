// Runs a fragment shader over a quad and finds what else it might legally have returned.
//
// Method: the nominal run has exact inputs at the sample's place. Further runs see
//   - the quad moved by the snapping freedom in the four diagonal directions (inputs, FragCoord.z and w move;
//     FragCoord.xy does not). Freedom coarser than a 256th of a pixel also turns and stretches triangles: then every
//     coordinate of every vertex moves by itself, and the six deviations add up;
//   - centroid inputs at each of the places they may choose;
//   - every texture read at the lower, then at the upper end of its range, and at zero if that is inside;
//   - derivatives per quad instead of per row and column (where the module takes derivatives);
//   - every result rounded to float32; its deviation, times 8, stands for the float rounding of another
//   implementation.
// Per component, deviations of one kind give a range by their extremes, and the ranges of different kinds add
// up. A relative term covers interpolation (OracleRules::interpolationError where the result varies with the inputs)
// and imprecise functions (Vulkan's precision table).
//
// Limits: a shader that is not monotone between the perturbed runs can reach values outside their range (a
// texture read that feeds a coordinate, a test on equality); interactions between kinds of perturbation are
// taken as additive.
#pragma once

#include "base/result.h"
#include "conformance/oracle/assembly.h"
#include "conformance/oracle/line_shape.h"
#include "conformance/oracle/sample_states.h"
#include "conformance/oracle/shader_resources.h"
#include "conformance/oracle/triangle.h"
#include "spirv_interp/reference/interpreter.h"

#include <array>
#include <memory>
#include <vector>

namespace vernier::conformance::exact {

/// A primitive with everything its fragments read.
struct FragmentSource {
    const Triangle* triangle = nullptr;             // of lines and points: their carrier
    std::array<const ShadedVertex*, 3> vertices{};  // of the triangle
    const ShadedVertex* provoking = nullptr;
    const PointShape* point = nullptr;  // of points
    bool frontFacing = false;
    uint32_t primitiveId = 0;
    // Barycentric inputs: which of `vertices` has which number; none for edges and corners of polygons.
    uint32_t corners = 0;
    std::array<uint32_t, 3> numbered{};

    /// Vulkan, Barycentric Interpolation, numbers vertices so that the provoking one is the first or, where it is the
    /// last one of a primitive, the last, in the order of the topology. `count` of `vertices` are the primitive's.
    void number(uint32_t count, bool provokingLast);
};

/// Where in its pixel each of a quad's fragments is shaded.
struct ShadingPlace {
    std::array<double, 2> offset{0.5, 0.5};  // of inputs and FragCoord, from the pixel's upper left corner
    uint32_t pixels = 1;                     // on a side of a fragment: from one fragment of the quad to the next
    uint32_t sample = 0;                     // SampleId
    bool perSample = false;  // `offset` is a sample's: inputs without Sample may be taken at the centre all the same
    // Per lane: the places, in pixels of the framebuffer, among which centroid inputs may choose; the first is the
    // declared one. None: they are taken at `offset`.
    std::array<std::vector<std::array<double, 2>>, 4> centroids;
};

struct ShaderRuns;

class FragmentShader {
  public:
    /// For pipelines without a fragment shader, use no FragmentShader at all.
    static Result<FragmentShader> create(const Scene& scene, const ScenePipeline& pipeline, uint32_t viewIndex = 0);

    /// The quad whose upper left pixel is (x, y). `resources` is used by one thread at a time.
    Result<std::array<FragmentResult, 4>> evaluate(const FragmentSource& source, uint32_t x, uint32_t y,
                                                   const std::array<bool, 4>& covered, const OutputState& output,
                                                   ShaderResources& resources, const ShadingPlace& place = {}) const;

    /// Whether it runs for each sample because of what it reads.
    bool perSample() const { return perSample_; }
    bool hasCentroids() const { return hasCentroids_; }
    /// Whether it knows the primitive's vertices by number.
    bool knowsVertices() const { return knowsVertices_; }
    /// Whether it neither knows single pixels nor decides about them: fragments may then stand for several.
    bool mayShadeCoarsely() const { return mayShadeCoarsely_; }

  private:
    using Interpreter = reference::Interpreter<double>;
    using Values = reference::InterfaceValues<double>;
    using Outcomes = std::array<reference::Outcome<double>, 4>;

    FragmentShader(reference::Module module, Interpreter nominal, Interpreter rounded)
        : module_(std::move(module)), nominal_(std::move(nominal)), rounded_(std::move(rounded)) {}

    /// One run of a quad; its stores are kept apart.
    static Result<Outcomes> runQuad(const Interpreter& shader, const std::array<Values, 4>& inputs,
                                    const std::array<bool, 4>& helper, ShaderResources& resources);
    /// Runs with the vertices where else snapping may have put them.
    Status addMoved(const FragmentSource& source, uint32_t x, uint32_t y, const ShadingPlace& place,
                    const std::array<bool, 4>& helper, ShaderResources& resources, ShaderRuns& runs) const;

    /// `shape`: of the triangle, or with vertices moved. `centroid`: which of each lane's places centroid inputs take;
    /// `centred`: inputs without Sample at the centre.
    std::array<Values, 4> inputsAt(const FragmentSource& source, const HomogeneousTriangle<double>& shape, uint32_t x,
                                   uint32_t y, const ShadingPlace& place, double shiftX, double shiftY,
                                   size_t centroid = 0, bool centred = false) const;
    void setVariable(const reference::InterfaceVariable& variable, const FragmentSource& source,
                     const HomogeneousTriangle<double>& shape, const std::array<double, 3>& weights,
                     Values& values) const;

    reference::Module module_;
    Interpreter nominal_, rounded_;
    std::shared_ptr<const Interpreter> coarse_;  // only if the module takes derivatives
    std::vector<reference::InterfaceVariable> inputs_, outputs_;
    bool variesWithPosition_ = false;  // reads something interpolated
    bool perSample_ = false, hasCentroids_ = false, mayShadeCoarsely_ = true, knowsVertices_ = false;
    uint32_t viewIndex_ = 0;
    double imprecision_ = 0;  // relative error of the built-in functions used
};

}  // namespace vernier::conformance::exact
