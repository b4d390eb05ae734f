// One invocation of a shader as an explicit-stack machine. It runs until it is done or needs values of the
// other invocations of its quad; whoever drives it (interpreter.cpp) then hands those in and lets it go on.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "spirv_interp/reference/interpreter.h"
#include "spirv_interp/reference/module_data.h"
#include "spirv_interp/reference/number_ops.h"

namespace vernier::reference {

/// Values of more scalars than this count as several steps.
inline constexpr uint64_t kScalarsPerStep = 16;

template <class Number>
using Scalars = std::vector<Scalar<Number>>;

/// The contents of a variable that is not in a buffer.
template <class Number>
struct Object {
    Scalars<Number> cells;
    std::vector<bool> written;
    const InterfaceLayout* layout = nullptr;  // inputs and outputs
};

struct MatrixLayout {
    uint32_t stride = 0;
    bool rowMajor = false;
};

/// Exactly one of three: cells of an object, bytes of a buffer, or an opaque descriptor.
template <class Number>
struct Pointer {
    uint32_t type = 0;  // index of the pointee's type
    std::shared_ptr<Object<Number>> object;
    uint64_t offset = 0;   // first cell, or byte
    bool outside = false;  // an index left its array: reads give 0, writes are dropped
    bool isBuffer = false;
    BufferKind kind = BufferKind::uniform;
    Descriptor descriptor;
    bool atDescriptors = false;    // points at the whole array of descriptors: the next index chooses one
    MatrixLayout matrix;           // of the matrices inside
    uint32_t componentStride = 0;  // between the components of a vector: 0 = next to each other
};

struct ImageHandle {
    uint32_t type = 0;  // index of the image type (sampler: unused)
    Descriptor image, sampler;
};

template <class Number>
struct Value {
    Scalars<Number> scalars;
    std::optional<Pointer<Number>> pointer;
    std::optional<ImageHandle> image;
    bool defined = false;
};

/// What all invocations of an interpreter share.
template <class Number>
struct Program {
    std::shared_ptr<const ModuleData> module;
    size_t entryPoint = 0;
    Options options;
    std::vector<Value<Number>> constants;  // as ModuleData::constants
};

template <class Number>
class Machine {
  public:
    enum class Status : uint8_t { running, waiting, done };
    /// What the invocations of a group have brought to a derivative; empty where one does not take part.
    using QuadValues = std::array<std::vector<Number>, 4>;

    Machine(const Program<Number>& program, const InterfaceValues<Number>& inputs, Resources<Number>& resources,
            uint32_t invocation, bool helper);

    /// Until waiting or done. Throws Failure.
    Status run();

    /// Where the machine is: instructions of all frames, outermost first. Earlier in the program compares
    /// less.
    std::vector<size_t> position() const;
    /// While waiting: what this invocation brings.
    const std::vector<Number>& offer() const { return offer_; }
    /// Ends the waiting.
    void resume(QuadValues values);

    Outcome<Number> outcome() const;

  private:
    struct Frame {
        const Function* function = nullptr;
        size_t next = 0;  // instruction
        Id block = 0;
        std::vector<Value<Number>> values;  // by slot
        Id caller = 0;                      // the OpFunctionCall that gets the result
    };

    // machine.cpp: control flow and operands
    void call(const Function& function, Id result, const std::vector<Value<Number>>& arguments);
    void returnFrom(const Value<Number>* result);
    void enterBlock(Id label);
    void execute(const Instruction& i);
    bool executeControl(const Instruction& i);
    void demote();
    void charge(uint64_t steps);
    /// True when the other invocations' values are in quad_; false when the machine has to wait for them
    /// first.
    bool exchange(std::vector<Number> offer);
    Number difference(size_t component, bool alongX, bool coarse) const;
    void derivative(const Instruction& i);

    const Value<Number>& value(Id id) const;
    const Scalars<Number>& data(Id id) const;
    const Scalars<Number>& data(Id id, size_t count) const;
    const Scalar<Number>& scalar(Id id) const { return data(id, 1)[0]; }
    uint64_t bits(Id id) const { return scalar(id).bits; }
    int64_t signedInteger(Id id) const;
    Value<Number>& slot(const Instruction& i);
    void setValue(const Instruction& i, Value<Number> value);
    void setResult(const Instruction& i, Scalars<Number> scalars);
    void setResult(const Instruction& i, Scalar<Number> scalar) { setResult(i, Scalars<Number>{scalar}); }
    const Type& resultType(const Instruction& i) const { return module_.typeOf(i.type); }
    size_t resultCount(const Instruction& i) const { return module_.valueScalars(resultType(i)); }
    Number rounded(const Number& x) const { return program_.options.roundToFloat ? Number(toFloat32(x)) : x; }

    // memory.cpp
    bool executeMemory(const Instruction& i);
    bool executeAtomic(const Instruction& i);
    Pointer<Number> variablePointer(const Variable& variable);
    const Pointer<Number>& pointer(Id id);
    void createInterface(const InterfaceValues<Number>& inputs);
    Pointer<Number> index(Pointer<Number> pointer, Id index) const;
    Value<Number> load(const Pointer<Number>& pointer);
    Scalars<Number> loadScalars(const Pointer<Number>& pointer);
    void store(const Pointer<Number>& pointer, const Scalars<Number>& scalars);
    template <class Visit>
    void forEachScalar(const Type& type, uint64_t offset, MatrixLayout matrix, uint32_t componentStride,
                       const Visit& visit) const;
    uint64_t arrayLength(const Instruction& i);

    // composite.cpp, arithmetic.cpp, conversion.cpp, glsl450.cpp
    bool executeComposite(const Instruction& i);
    bool executeArithmetic(const Instruction& i);
    bool executeFloat(const Instruction& i);
    bool executeFloatComparison(const Instruction& i);
    bool executeInteger(const Instruction& i);
    bool executeExtended(const Instruction& i);
    bool executeMatrix(const Instruction& i);
    bool executeConversion(const Instruction& i);
    Scalars<Number> bitcast(const Instruction& i) const;
    void executeGlsl(const Instruction& i);
    bool glslNumber(const Instruction& i, uint32_t function);
    template <class W>
    bool glslNumberIn(const Instruction& i, uint32_t function);
    bool glslGeometric(const Instruction& i, uint32_t function);
    template <class W>
    bool glslGeometricIn(const Instruction& i, uint32_t function);
    bool glslStructured(const Instruction& i, uint32_t function);
    bool glslInteger(const Instruction& i, uint32_t function);
    bool glslPacking(const Instruction& i, uint32_t function);
    bool glslInterpolate(const Instruction& i, uint32_t function);

    // images.cpp
    bool executeImage(const Instruction& i);
    ImageHandle imageHandle(Id id) const;
    ImageRequest<Number> request(const ImageHandle& handle) const;
    size_t coordinateCount(const ImageShape& shape) const;
    void applyOperands(ImageRequest<Number>& request, const Instruction& i, size_t maskIndex) const;
    void setTexel(const Instruction& i, const Texel<Number>& texel, const ImageShape& shape);
    void sampleImage(const Instruction& i);
    void gatherImage(const Instruction& i);
    void fetchImage(const Instruction& i);
    void writeImage(const Instruction& i);
    bool implicitDerivatives(ImageRequest<Number>& request);

    const Program<Number>& program_;
    const ModuleData& module_;
    Resources<Number>& resources_;
    uint32_t invocation_;
    bool helper_;
    bool discarded_ = false;
    Status status_ = Status::running;
    uint64_t steps_ = 0;
    std::vector<Frame> frames_;
    std::vector<std::optional<Pointer<Number>>> variables_;  // as ModuleData::variables
    std::vector<Number> offer_;
    std::optional<QuadValues> quad_;
};

}  // namespace vernier::reference
