// One invocation of a shader as an explicit-stack machine. It runs until it is done or has to meet other invocations:
// of its quad at a derivative, of its subgroup, or of its work-group at a barrier. Whoever drives it (drive.h) then
// hands in what the others have brought and lets it go on.
#pragma once

#include <array>
#include <map>
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

/// A scalar as the bits of its declared type, and back.
template <class Number>
uint64_t scalarBits(const Scalar<Number>& scalar, const Type& type) {
    if (type.kind != TypeKind::floating) return scalar.bits;
    if (type.width == 16) return doubleToHalf(static_cast<double>(scalar.number));
    return type.width == 64 ? float64Bits(scalar.number) : float32Bits(scalar.number);
}
template <class Number>
Scalar<Number> bitsScalar(uint64_t bits, const Type& type) {
    if (type.kind != TypeKind::floating) return Scalar<Number>::ofBits(bits);
    return Scalar<Number>::ofNumber(type.width == 64   ? fromFloat64Bits<Number>(bits)
                                    : type.width == 32 ? fromFloat32Bits<Number>(bits)
                                                       : Number(halfToFloat32(static_cast<uint32_t>(bits))));
}

struct MatrixLayout {
    uint32_t stride = 0;
    bool rowMajor = false;
};

/// Exactly one of four: cells of an object, bytes of a buffer or at an address, a texel, or an opaque descriptor.
template <class Number>
struct Pointer {
    uint32_t type = 0;  // index of the pointee's type
    std::shared_ptr<Object<Number>> object;
    uint64_t offset = 0;   // first cell, or byte
    bool outside = false;  // an index left its array: reads give 0, writes are dropped
    bool isBuffer = false;
    BufferKind kind = BufferKind::uniform;
    /// Memory by address: isBuffer, and `offset` is the address.
    bool isPhysical = false;
    std::shared_ptr<const ImageRequest<Number>> texel;  // OpImageTexelPointer
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
    Scalars<Number> scalars;  // of a pointer too once it was needed as a number
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

/// The variables of a work-group, by index into ModuleData::variables.
template <class Number>
using SharedObjects = std::map<uint32_t, std::shared_ptr<Object<Number>>>;

/// Which invocations meet: the quad or the subgroup, to exchange values, or all of a work-group.
enum class Meeting : uint8_t { exchange, barrier };

template <class Number>
class Machine {
  public:
    enum class Status : uint8_t { running, waiting, done };
    /// What the invocations of a group have brought to an exchange, by their place in it; empty where one does not take
    /// part.
    using GroupValues = std::vector<Scalars<Number>>;

    /// `invocation`: the place in the group that exchanges values: a quad, or a subgroup. `shared`: nullptr outside
    /// compute and tessellation control; filled in by the first invocation that names a variable.
    Machine(const Program<Number>& program, const InterfaceValues<Number>& inputs, Resources<Number>& resources,
            uint32_t invocation, bool helper, SharedObjects<Number>* shared = nullptr);

    /// Until waiting or done. Throws Failure.
    Status run();

    /// Where the machine is, for all frames, outermost first: the loops around it with their numbers of iterations,
    /// then the block's place in structured order and the instruction. Of two invocations the one that compares less
    /// can still come to where the other is, and never the other way round; those that compare equal have reconverged.
    std::vector<uint64_t> position() const;
    /// While waiting.
    Meeting meeting() const { return meeting_; }
    const Scalars<Number>& offer() const { return offer_; }
    /// Ends the waiting; `values` for an exchange.
    void resume(GroupValues values);

    Outcome<Number> outcome() const;

  private:
    struct Frame {
        const Function* function = nullptr;
        size_t next = 0;  // instruction
        Id block = 0;
        uint32_t blockRank = 0;
        std::vector<Value<Number>> values;  // by slot
        struct Loop {
            uint32_t first, end;  // ranks
            uint64_t iteration;
        };
        std::vector<Loop> loops;
        Id caller = 0;  // the OpFunctionCall that gets the result
    };

    // machine.cpp: control flow and operands
    void call(const Function& function, Id result, const std::vector<Value<Number>>& arguments);
    void returnFrom(const Value<Number>* result);
    void enterBlock(Id label);
    void execute(const Instruction& i);
    bool executeControl(const Instruction& i);
    void demote();
    InterfaceValues<Number> outputs() const;
    void emitVertex(uint32_t stream);
    void charge(uint64_t steps);
    void observe(const Instruction& i) const;
    /// True when the others have come and their values are in group_; false when the machine has to wait for them
    /// first. Whoever gets true resets group_.
    bool meet(Meeting meeting, Scalars<Number> offer);
    bool exchange(const std::vector<Number>& offer);
    void noteLoops(Frame& frame, const Block& target);
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
    /// Rounds a result to the type's width where Options ask for it; 16 bits also when Number is float.
    void round(Scalar<Number>& scalar, uint32_t width) const {
        if (width == 32) scalar.number = rounded(scalar.number);
        if (width == 16 && (program_.options.roundToFloat || std::is_same_v<Number, float>))
            scalar.number = Number(halfToFloat32(doubleToHalf(static_cast<double>(scalar.number))));
    }
    /// Pointers as scalars: an address, or for a logical pointer a number in pointers_. 0 is null.
    Scalar<Number> pointerScalar(const Pointer<Number>& pointer) const;
    Pointer<Number> scalarPointer(const Type& type, uint64_t bits) const;

    // memory.cpp, atomics.cpp
    bool executeMemory(const Instruction& i);
    bool executeAtomic(const Instruction& i);
    bool executeKnownAtomic(const Instruction& i);
    void tellCombined(const Instruction& i);
    // subgroups.cpp
    bool executeSubgroup(const Instruction& i);
    bool executeVote(const Instruction& i, size_t first);
    bool executeBallot(const Instruction& i, size_t first);
    bool executeShuffle(const Instruction& i, size_t first);
    bool executeReduction(const Instruction& i);
    bool isShared(const Variable& variable) const;
    Pointer<Number> variablePointer(const Variable& variable);
    const Pointer<Number>& pointer(Id id);
    void createInterface(const InterfaceValues<Number>& inputs);
    Pointer<Number> index(Pointer<Number> pointer, Id index) const;
    Value<Number> load(const Pointer<Number>& pointer);
    Scalars<Number> loadScalars(const Pointer<Number>& pointer);
    BufferAccess accessOf(const Pointer<Number>& pointer, const Type& scalar, uint64_t offset) const;
    void store(const Pointer<Number>& pointer, const Scalars<Number>& scalars);
    template <class Visit>
    void forEachScalar(const Type& type, uint64_t offset, MatrixLayout matrix, uint32_t componentStride,
                       const Visit& visit) const;
    uint64_t arrayLength(const Instruction& i);
    Pointer<Number> element(Pointer<Number> pointer, const Type& pointerType, Id index) const;
    bool comparePointers(const Instruction& i);
    Scalars<Number> loadTexel(const Pointer<Number>& pointer);
    std::span<std::byte> bytesOf(const Pointer<Number>& pointer, uint64_t& offset, uint64_t size);

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
    bool combining_ = false;  // inside of an atomic instruction that reads and writes
    Status status_ = Status::running;
    uint64_t steps_ = 0;
    uint64_t clock_ = 0;
    std::vector<EmittedVertex<Number>> vertices_;
    bool startsStrip_ = true;
    std::vector<Frame> frames_;
    std::vector<std::optional<Pointer<Number>>> variables_;  // as ModuleData::variables
    mutable std::vector<Pointer<Number>> pointers_;          // logical pointers that were stored
    SharedObjects<Number>* shared_;
    Meeting meeting_ = Meeting::exchange;
    Scalars<Number> offer_;
    std::optional<GroupValues> group_;
};

}  // namespace vernier::reference
