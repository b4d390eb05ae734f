// The reference interpreter: SPIR-V vertex, tessellation, geometry, fragment and compute shaders, one invocation at a
// time, in any of three number types. It is slow, plain and meant to be obviously right: the judge of the batch
// interpreter, and the shader of the oracle.
//
// Where SPIR-V leaves a result open, this is what is done: integer division and remainder by zero give 0,
// INT_MIN / -1 gives INT_MIN; shift counts are taken modulo the width; float to integer truncates, saturates,
// and NaN gives 0; min and max ignore a NaN; reads outside a buffer or an array give 0 and writes there are
// dropped; undefined values are 0; GLSL Round is to nearest even; fma has one rounding; a multiply and an add
// are never contracted. Reaching OpUnreachable is an error.
//
// Number types: with float every instruction is IEEE single precision, and each GLSL.std.450 function is
// computed in double and rounded once. With double and Real every 32-bit float of the module is held in that
// type: results are not rounded to float unless Options::roundToFloat asks for it (then each instruction is
// computed in Number and its result rounded). 64-bit floats of a module are held in Number too: with Number =
// float they have only float's precision. Bit casts and packing go through the bits of the declared type
// (float16, float32 or float64), rounding to nearest. 16-bit floats are rounded to their format
// after every instruction when Number is float.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <spirv/unified1/spirv.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "spirv_interp/reference/number.h"
#include "spirv_interp/reference/resources.h"

namespace vernier::reference {

struct ModuleData;

/// Execution modes of an entry point.
struct ExecutionModes {
    bool originUpperLeft = false;
    bool originLowerLeft = false;
    bool pixelCenterInteger = false;
    bool earlyFragmentTests = false;
    bool depthReplacing = false;
    bool depthGreater = false, depthLess = false, depthUnchanged = false;
    std::array<uint32_t, 3> localSize{1, 1, 1};  // LocalSize; LocalSizeId's values
    uint32_t outputVertices = 0;
    uint32_t invocations = 1;        // of a geometry stage, for each primitive
    uint32_t primitiveVertices = 1;  // of a primitive that a geometry stage puts out: a point, line or triangle
};

/// Subgroups are consecutive invocations of a work-group by LocalInvocationIndex; the last may be incomplete.
inline constexpr uint32_t kSubgroupSize = 32;

/// Which work-group of a dispatch.
struct WorkGroup {
    std::array<uint32_t, 3> id{0, 0, 0};     // WorkgroupId
    std::array<uint32_t, 3> count{1, 1, 1};  // NumWorkgroups
};

struct EntryPoint {
    std::string name;
    spv::ExecutionModel model = spv::ExecutionModelVertex;
    ExecutionModes modes;
};

enum class ScalarKind : uint8_t {
    boolean,
    int8,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    int64,
    uint64,
    float16,
    float32,
    float64,
};
constexpr bool isFloating(ScalarKind kind) {
    return kind >= ScalarKind::float16;
}
/// Of 64 bits.
constexpr bool isWide(ScalarKind kind) {
    return kind == ScalarKind::int64 || kind == ScalarKind::uint64 || kind == ScalarKind::float64;
}

/// One input or output of an entry point, or one member of an input or output block. Matrices and arrays take
/// one location per column and element (two for three or four 64-bit components), one after the other.
struct InterfaceVariable {
    std::string name;  // may be empty: names are debug information
    bool output = false;
    bool isBuiltin = false;
    spv::BuiltIn builtin = spv::BuiltInMax;  // isBuiltin
    uint32_t location = 0;                   // !isBuiltin
    uint32_t component = 0;                  // first component
    uint32_t index = 0;                      // dual-source blending; perVertex
    ScalarKind kind = ScalarKind::float32;
    uint32_t components = 1;  // of a vector, or of a column
    uint32_t columns = 1;     // of a matrix
    uint32_t elements = 1;    // of all array dimensions together
    bool isArray = false;
    bool flat = false, noPerspective = false, centroid = false, sample = false;
    /// Of what is an array over the vertices of a primitive or patch (inputs of geometry and tessellation stages,
    /// outputs of tessellation control), the value of one of them: its number, and one. 0: no such array.
    uint32_t vertex = 0;
    /// Of what PerVertexKHR declares, the value of one vertex: `index` is the vertex's number.
    bool perVertex = false;
    uint32_t locations = 1;  // taken up

    uint32_t scalars() const { return components * columns * elements; }
    /// Where scalar k stands, in the order of the value's scalars; one of 64 bits takes the next component, too.
    struct Place {
        uint32_t location = 0, component = 0;
    };
    Place placeOf(uint32_t k) const {
        const uint32_t size = isWide(kind) ? 2 : 1, at = component + k % components * size;
        return {location + k / components * locationsPerColumn() + at / 4, at % 4};
    }
    uint32_t locationsPerColumn() const { return component + components * (isWide(kind) ? 2 : 1) > 4 ? 2 : 1; }
};

enum class DescriptorKind : uint8_t {
    uniformBuffer,
    storageBuffer,
    combinedImageSampler,
    sampledImage,
    sampler,
    storageImage,
    uniformTexelBuffer,
    storageTexelBuffer,
    inputAttachment,
};

struct DescriptorBinding {
    std::string name;
    uint32_t set = 0, binding = 0;
    DescriptorKind kind = DescriptorKind::uniformBuffer;
    uint32_t count = 1;     // descriptors in the array; 0 = runtime-sized
    uint64_t byteSize = 0;  // buffers: size of the block without a trailing runtime array
    ImageShape shape;       // images
    uint32_t inputAttachmentIndex = 0;
};

/// A parsed SPIR-V module with its specialisation applied. Immutable; copies share the contents; thread-safe.
class Module {
  public:
    /// Specialisation constants by SpecId; 64-bit ones take the whole value, booleans 0 or not 0.
    using Specialization = std::map<uint32_t, uint64_t>;

    /// Accepts any words. An Error names what is broken or which instruction is not supported.
    static Result<Module> parse(std::span<const uint32_t> words, const Specialization& specialization = {});

    const std::vector<EntryPoint>& entryPoints() const;
    /// Inputs and outputs of entryPoints()[entryPoint].
    const std::vector<InterfaceVariable>& interfaceVariables(size_t entryPoint) const;
    /// All descriptor bindings that the module declares, used or not.
    const std::vector<DescriptorBinding>& descriptorBindings() const;
    /// Bytes of the push-constant block up to the end of its last member; 0 without one.
    uint64_t pushConstantSize() const;

    /// The parsed contents, for the interpreter.
    const ModuleData& data() const { return *data_; }
    std::shared_ptr<const ModuleData> shared() const { return data_; }

  private:
    explicit Module(std::shared_ptr<const ModuleData> data) : data_(std::move(data)) {}

    std::shared_ptr<const ModuleData> data_;
};

/// A user-defined interface location; `index` is 1 only for the second source of dual-source blending.
struct Location {
    uint32_t location = 0;
    uint32_t index = 0;

    Location() = default;
    Location(uint32_t location_, uint32_t index_ = 0) : location(location_), index(index_) {}
    auto operator<=>(const Location&) const = default;
};

/// The values on one side of an invocation. Inputs that are missing read as 0. Outputs hold exactly the
/// locations and built-ins of which the invocation has written a component. 64-bit components take two: a float's
/// value is in the even one, of an integer each has 32 bits. Integers of 8 and 16 bits come out as the 32 of their
/// value.
template <class Number>
struct InterfaceValues {
    std::map<Location, Texel<Number>> locations;
    /// Scalars of the built-in in order: 4 for Position, n for ClipDistance, 1 for VertexIndex...
    std::map<spv::BuiltIn, std::vector<Scalar<Number>>> builtins;
    /// What arrays over vertices hold for each of them: the locations and built-ins of one vertex.
    std::vector<InterfaceValues> vertices;

    void setFloat(spv::BuiltIn builtin, std::initializer_list<Number> values) {
        auto& scalars = builtins[builtin];
        scalars.clear();
        for (const Number& value : values) scalars.push_back(Scalar<Number>::ofNumber(value));
    }
    void setInt(spv::BuiltIn builtin, int32_t value) { builtins[builtin] = {Scalar<Number>::ofInt(value)}; }
    void setFloat(Location location, std::initializer_list<Number> values) {
        size_t component = 0;
        for (const Number& value : values)
            if (component < 4) locations[location][component++] = Scalar<Number>::ofNumber(value);
    }
    void setInt(Location location, std::initializer_list<int32_t> values) {
        size_t component = 0;
        for (const int32_t value : values)
            if (component < 4) locations[location][component++] = Scalar<Number>::ofInt(value);
    }
};

/// What OpEmitVertex or OpEmitStreamVertex has put out: the outputs as they were.
template <class Number>
struct EmittedVertex {
    InterfaceValues<Number> outputs;
    uint32_t stream = 0;
    bool startsStrip = false;  // the first, or the first behind OpEndPrimitive or OpEndStreamPrimitive
};

/// What became of one invocation.
template <class Number>
struct Outcome {
    InterfaceValues<Number> outputs;
    std::vector<EmittedVertex<Number>> vertices;  // of a geometry stage, at most OutputVertices: more are dropped
    bool discarded = false;                       // by OpKill, OpTerminateInvocation or OpDemoteToHelperInvocation
    uint64_t steps = 0;                           // instructions executed
};

/// Stands in for the functions whose accuracy an implementation chooses: the trigonometric, hyperbolic, exponential
/// and logarithmic ones of GLSL.std.450 and InverseSqrt (Normalize's too) on 32-bit floats.
class ElementaryFunctions {
  public:
    virtual ~ElementaryFunctions() = default;
    /// `function` is a GLSLstd450 number with one operand in `x`, or two in `x` and `y` (Atan2: y / x in the order of
    /// the instruction, Pow).
    virtual float evaluate(uint32_t function, float x, float y) const = 0;
};

/// An instruction that an invocation has executed.
struct Step {
    uint32_t invocation = 0;  // place in the quad or subgroup
    spv::Op op = spv::OpNop;
    uint32_t result = 0;  // id; 0 without one. Of OpFunctionCall when the call returns
    uint32_t type = 0;    // id of the result's type, or 0
    std::span<const uint32_t> operands;
    uint32_t line = 0;  // of the source, 0 = unknown
    /// The scalars of the result, or of the object of an OpStore; empty for pointers. Which of the two counts follows
    /// from isFloat.
    bool isFloat = false;
    std::vector<double> numbers;
    std::vector<uint64_t> bits;
};

class StepObserver {
  public:
    virtual ~StepObserver() = default;
    virtual void executed(const Step& step) = 0;
};

struct Options {
    /// Told of every instruction after its execution. Must outlive the interpreter.
    StepObserver* observer = nullptr;
    /// Round every 32-bit float result to float32, inputs and image results included. No effect with Number =
    /// float.
    bool roundToFloat = false;
    /// Functions and instructions that the specification describes by an expression (Radians, Length, Normalize,
    /// Reflect, SmoothStep, FMix, MatrixInverse, packing, OpDot, matrix products, OpFRem, OpFMod...) are computed as
    /// that expression, every operation rounded to the type of the result; otherwise exactly, rounded once. The
    /// expressions:
    ///   Fract: min(x - floor(x), the largest number below 1)   Radians, Degrees: x * constant
    ///   Length: sqrt(dot(x, x)), of a scalar |x|               Distance: Length(x - y)
    ///   Normalize: x * InverseSqrt(dot(x, x)), of a scalar sign(x)
    ///   InverseSqrt: 1 / sqrt(x), if not `elementary`          FMix: x * (1 - a) + y * a
    ///   SmoothStep: t * t * (3 - 2 * t) with t = clamp((x - e0) / (e1 - e0), 0, 1)
    ///   Refract: eta * I - (eta * d + sqrt(k)) * N, k = 1 - eta * eta * (1 - d * d), d = dot(N, I)
    ///   Determinant: expanded along the first column           MatrixInverse: cofactors times 1 / determinant
    ///   Pack...norm: round(clamp(x) * scale)                   OpFRem, OpFMod: x - y * trunc or floor(x / y)
    bool stepwise = false;
    /// nullptr: the C library's in Wide, or MPFR's. Must outlive the interpreter and be thread-safe.
    const ElementaryFunctions* elementary = nullptr;
    /// OpDPdx, OpDPdy, OpFwidth and implicit levels of detail use one difference for the whole quad, the one
    /// of its first row or column (as the ...Coarse instructions do); otherwise that of the invocation's own
    /// row and column.
    bool coarseDerivatives = false;
    /// An invocation that executes more instructions ends in an Error. Instructions on large values count for
    /// several.
    uint64_t stepBudget = 10'000'000;
};

/// Runs one entry point of a module. Immutable after creation and thread-safe, as far as the Resources are.
/// Instantiated for float, double and Real.
template <class Number>
class Interpreter {
  public:
    /// Vertex, tessellation, geometry, fragment and compute entry points.
    static Result<Interpreter> create(const Module& module, spv::ExecutionModel model,
                                      std::string_view entryPoint = "main", const Options& options = {});

    /// One work-group. Between barriers the invocations run one after the other (those of a subgroup up to its
    /// operations), so that a program with races gets one of its possible results. An OpControlBarrier that not all
    /// invocations reach that have not ended is an Error. Work-group variables without initialiser begin as 0.
    ///
    /// A subgroup operation is carried out by the invocations of the subgroup that have come to the same dynamic
    /// instance of the instruction: the same calls, and in every loop around it the same iteration. Invocations that
    /// part come together again at the merge block, and those that leave a loop wait behind it for the others.
    Status runWorkGroup(const WorkGroup& group, Resources<Number>& resources) const;
    /// Of a compute entry point: LocalSize, or the constant decorated WorkgroupSize.
    std::array<uint32_t, 3> localSize() const;

    /// The invocations of a tessellation control stage for one patch, in one subgroup, as those of a work-group; their
    /// InvocationId need not be among `inputs`. Returns the outputs: those of the patch, and those of its vertices.
    Result<InterfaceValues<Number>> runPatch(const InterfaceValues<Number>& inputs, Resources<Number>& resources) const;

    /// Up to 32 invocations of a vertex, tessellation evaluation or geometry stage, by their place in a subgroup; a
    /// place without inputs is empty. Helpers have no effect on memory.
    Result<std::vector<Outcome<Number>>> runSubgroup(std::span<const std::optional<InterfaceValues<Number>>> inputs,
                                                     const std::vector<bool>& helper,
                                                     Resources<Number>& resources) const;

    /// One invocation on its own, but of tessellation control: all derivatives are 0.
    Result<Outcome<Number>> run(const InterfaceValues<Number>& inputs, Resources<Number>& resources) const;

    /// The four fragments (0,0) (1,0) (0,1) (1,1) of a quad, in step at derivatives and implicit levels of
    /// detail. Helper invocations (and demoted ones) have no effect on memory. An invocation that does not
    /// take part in a derivative (it has ended, or is elsewhere in the program) leaves the others with the
    /// difference of the other row or column if that is there (coarse), or with 0.
    Result<std::array<Outcome<Number>, 4>> runQuad(const std::array<InterfaceValues<Number>, 4>& inputs,
                                                   const std::array<bool, 4>& helper,
                                                   Resources<Number>& resources) const;

  private:
    struct State;
    explicit Interpreter(std::shared_ptr<const State> state) : state_(std::move(state)) {}

    std::shared_ptr<const State> state_;
};

extern template class Interpreter<float>;
extern template class Interpreter<double>;
extern template class Interpreter<Real>;

}  // namespace vernier::reference
