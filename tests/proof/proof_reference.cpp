// A case through the reference interpreter.
#include <bit>
#include <cstring>

#include <spirv/unified1/GLSL.std.450.h>

#include "spirv_interp/ir/builder.h"
#include "spirv_interp/ir/place_vertices.h"
#include "tests/proof/proof.h"

namespace vernier::proof {
namespace {

/// The batch interpreter's elementary functions, one value at a time: a program of one operation for each.
class TierFunctions final : public reference::ElementaryFunctions {
  public:
    explicit TierFunctions(MathTier tier) : tier_(tier) {}

    float evaluate(uint32_t function, float x, float y) const override {
        std::unique_ptr<BatchContext>& context = contexts_[function];
        const bool two = function == GLSLstd450Atan2 || function == GLSLstd450Pow;
        if (!context) {
            context = std::make_unique<BatchContext>(compile(function, two));
            context->beginDraw({});
        }
        constexpr uint32_t kLanes = 16;
        for (uint32_t lane = 0; lane < kLanes; ++lane) {
            context->input(0)[lane] = x;
            if (two) context->input(1)[lane] = y;
        }
        const std::array<uint32_t, kLanes> mask{~0u, ~0u, ~0u, ~0u};
        context->run(4, mask.data(), mask.data());
        return context->output(0)[0];
    }

  private:
    std::shared_ptr<const BatchProgram> compile(uint32_t function, bool two) const {
        constexpr std::pair<GLSLstd450, ir::Op> kOps[] = {
            {GLSLstd450Sin, ir::Op::fsin},
            {GLSLstd450Cos, ir::Op::fcos},
            {GLSLstd450Tan, ir::Op::ftan},
            {GLSLstd450Asin, ir::Op::fasin},
            {GLSLstd450Acos, ir::Op::facos},
            {GLSLstd450Atan, ir::Op::fatan},
            {GLSLstd450Sinh, ir::Op::fsinh},
            {GLSLstd450Cosh, ir::Op::fcosh},
            {GLSLstd450Tanh, ir::Op::ftanh},
            {GLSLstd450Asinh, ir::Op::fasinh},
            {GLSLstd450Acosh, ir::Op::facosh},
            {GLSLstd450Atanh, ir::Op::fatanh},
            {GLSLstd450Atan2, ir::Op::fatan2},
            {GLSLstd450Pow, ir::Op::fpow},
            {GLSLstd450Exp, ir::Op::fexp},
            {GLSLstd450Log, ir::Op::flog},
            {GLSLstd450Exp2, ir::Op::fexp2},
            {GLSLstd450Log2, ir::Op::flog2},
            {GLSLstd450InverseSqrt, ir::Op::finverseSqrt},
        };
        ir::Op op = ir::Op::undef;
        for (const auto& [number, operation] : kOps)
            if (static_cast<uint32_t>(number) == function) op = operation;
        ir::Program program;
        program.stage = ir::Stage::fragment;
        ir::Builder builder(program);
        builder.setBlock(builder.newBlock());
        std::vector<ir::ValueId> operands;
        for (uint16_t k = 0; k < (two ? 2 : 1); ++k) {
            ir::InterfaceSlot slot;
            slot.location = k;
            program.inputs.push_back(slot);
            operands.push_back(builder.append(ir::Op::input, ir::Type::f32, {}, k));
        }
        program.outputs.emplace_back();
        builder.append(ir::Op::storeOutput, ir::Type::none, {builder.append(op, ir::Type::f32, operands)}, 0);
        builder.ret();
        return BatchProgram::compile(program, {bestIsa(), tier_, 16}).value();
    }

    MathTier tier_;
    mutable std::map<uint32_t, std::unique_ptr<BatchContext>> contexts_;
};

constexpr std::pair<spv::BuiltIn, ir::Builtin> kBuiltins[] = {
    {spv::BuiltInVertexIndex, ir::Builtin::vertexIndex},
    {spv::BuiltInInstanceIndex, ir::Builtin::instanceIndex},
    {spv::BuiltInBaseVertex, ir::Builtin::baseVertex},
    {spv::BuiltInBaseInstance, ir::Builtin::baseInstance},
    {spv::BuiltInDrawIndex, ir::Builtin::drawIndex},
    {spv::BuiltInViewIndex, ir::Builtin::viewIndex},
    {spv::BuiltInPosition, ir::Builtin::position},
    {spv::BuiltInPointSize, ir::Builtin::pointSize},
    {spv::BuiltInClipDistance, ir::Builtin::clipDistance},
    {spv::BuiltInCullDistance, ir::Builtin::cullDistance},
    {spv::BuiltInLayer, ir::Builtin::layer},
    {spv::BuiltInViewportIndex, ir::Builtin::viewportIndex},
    {spv::BuiltInFragCoord, ir::Builtin::fragCoord},
    {spv::BuiltInFrontFacing, ir::Builtin::frontFacing},
    {spv::BuiltInPointCoord, ir::Builtin::pointCoord},
    {spv::BuiltInSampleId, ir::Builtin::sampleId},
    {spv::BuiltInSamplePosition, ir::Builtin::samplePosition},
    {spv::BuiltInPrimitiveId, ir::Builtin::primitiveId},
    {spv::BuiltInInvocationId, ir::Builtin::invocationId},
    {spv::BuiltInPatchVertices, ir::Builtin::patchVertices},
    {spv::BuiltInTessCoord, ir::Builtin::tessCoord},
    {spv::BuiltInTessLevelOuter, ir::Builtin::tessLevelOuter},
    {spv::BuiltInTessLevelInner, ir::Builtin::tessLevelInner},
    {spv::BuiltInFragDepth, ir::Builtin::fragDepth},
    {spv::BuiltInFragStencilRefEXT, ir::Builtin::fragStencilRef},
};

std::optional<ir::Builtin> builtinOf(spv::BuiltIn builtin, bool output) {
    if (builtin == spv::BuiltInSampleMask) return output ? ir::Builtin::sampleMask : ir::Builtin::sampleMaskIn;
    for (const auto& [theirs, ours] : kBuiltins)
        if (theirs == builtin) return ours;
    return std::nullopt;
}

spv::BuiltIn builtinOf(ir::Builtin builtin) {
    if (builtin == ir::Builtin::sampleMask || builtin == ir::Builtin::sampleMaskIn) return spv::BuiltInSampleMask;
    for (const auto& [theirs, ours] : kBuiltins)
        if (ours == builtin) return theirs;
    return spv::BuiltInMax;
}

/// One run by the reference interpreter in a number type.
template <class Number>
class ReferenceRun final : public reference::Resources<Number> {
    using Texel = reference::Texel<Number>;
    using Scalar = reference::Scalar<Number>;
    using Request = reference::ImageRequest<Number>;

  public:
    ReferenceRun(const Case& subject, const ir::Program& interface, const Shape& shape, MathTier tier)
        : subject_(subject), interface_(interface), shape_(shape), tier_(tier) {}

    Ending run() {
        ending_.memory = std::make_unique<Memory>(subject_.world);
        ending_.outputs.assign(outputCount(interface_), std::vector<uint32_t>(subject_.invocations));
        ending_.written.assign(outputCount(interface_), std::vector<bool>(subject_.invocations));
        ending_.live.assign(subject_.invocations, false);
        std::map<uint32_t, uint64_t> specialization;
        for (const SpecConstant& s : subject_.specialization) specialization[s.id] = s.value;
        const auto module = reference::Module::parse(subject_.words, specialization);
        if (!module) return failed(module.error().message);
        static const std::array<TierFunctions, 4> kByTier{
            TierFunctions(MathTier::fast), TierFunctions(MathTier::standard), TierFunctions(MathTier::fine),
            TierFunctions(MathTier::reference)};
        reference::Options options;
        options.roundToFloat = true;
        options.stepwise = true;
        options.elementary = &kByTier[static_cast<size_t>(tier_)];
        options.stepBudget = 1u << 27;
        constexpr spv::ExecutionModel kModels[] = {spv::ExecutionModelVertex,
                                                   spv::ExecutionModelFragment,
                                                   spv::ExecutionModelGLCompute,
                                                   spv::ExecutionModelTessellationControl,
                                                   spv::ExecutionModelTessellationEvaluation,
                                                   spv::ExecutionModelGeometry};
        const spv::ExecutionModel model = kModels[static_cast<size_t>(subject_.stage)];
        const auto interpreter = reference::Interpreter<Number>::create(*module, model, "main", options);
        if (!interpreter) return failed(interpreter.error().message);
        if (subject_.stage == ir::Stage::compute) return runWorkGroups(*interpreter);
        variables_ = module->interfaceVariables(0);
        const bool together =
            interface_.usesSubgroups && subject_.stage != ir::Stage::fragment && subject_.stage != ir::Stage::control;
        const uint32_t step = together ? reference::kSubgroupSize : 4;
        for (uint32_t first = 0; first < subject_.invocations && ending_.error.empty(); first += step) {
            if (together) {
                runSubgroup(*interpreter, first);
            } else if (subject_.stage == ir::Stage::fragment) {
                runQuad(*interpreter, first);
            } else if (subject_.stage == ir::Stage::control) {
                for (first_ = first; first_ < first + 4; ++first_) runPatch(*interpreter);
            } else {
                for (first_ = first; first_ < first + 4; ++first_) runOne(*interpreter);
            }
        }
        return std::move(ending_);
    }

    std::span<std::byte> buffer(reference::BufferKind kind, const reference::Descriptor& d) override {
        return ending_.memory->buffer(
            kind == reference::BufferKind::pushConstants ? kPushConstants : Slot{d.set, d.binding, d.arrayIndex});
    }
    Texel sample(const Request& r) override {
        ImageAccess a = accessOf(r);
        a.kind = r.lodMode == reference::LodMode::implicit      ? ir::ImageKind::sampleImplicit
                 : r.lodMode == reference::LodMode::explicitLod ? ir::ImageKind::sampleLod
                                                                : ir::ImageKind::sampleGrad;
        return texel(r, a);
    }
    Texel gather(const Request& r) override {
        ImageAccess a = accessOf(r);
        a.kind = ir::ImageKind::gather;
        return texel(r, a);
    }
    Texel fetch(const Request& r) override {
        ImageAccess a = accessOf(r);
        const bool read = r.shape.storage || r.shape.dim == spv::DimSubpassData;
        a.kind = read ? ir::ImageKind::read : ir::ImageKind::fetch;
        return texel(r, a);
    }
    void write(const Request& r, const Texel& value) override {
        ImageAccess a = accessOf(r);
        a.kind = ir::ImageKind::store;
        for (size_t k = 0; k < 4; ++k) a.value[k] = bitsOf(value[k], r.shape.floating);
        image(r.image).access(a);
    }
    std::array<int32_t, 4> querySize(const reference::Descriptor& d, const reference::ImageShape& shape,
                                     int32_t lod) override {
        ImageAccess a;
        a.kind = ir::ImageKind::querySize;
        a.dim = dimOf(shape.dim);
        a.arrayed = shape.arrayed;
        a.level = lod;
        return std::bit_cast<std::array<int32_t, 4>>(image(d).access(a));
    }
    int32_t queryLevels(const reference::Descriptor&, const reference::ImageShape&) override {
        return TestImage::kLevels;
    }
    int32_t querySamples(const reference::Descriptor&, const reference::ImageShape&) override { return 4; }
    std::array<Number, 2> queryLod(const Request& r) override {
        ImageAccess a = accessOf(r);
        a.kind = ir::ImageKind::queryLod;
        const auto bits = image(r.image).access(a);
        return {Number(std::bit_cast<float>(bits[0])), Number(std::bit_cast<float>(bits[1]))};
    }
    std::optional<Texel> interpolateAt(const reference::InterpolationRequest<Number>& r) override {
        Texel result;
        for (uint8_t c = 0; c < 4; ++c) {
            ir::InterfaceSlot slot;
            slot.location = static_cast<uint16_t>(r.location);
            slot.component = c;
            const auto where = static_cast<uint32_t>(r.place);
            const float a = where == 1 ? std::bit_cast<float>(r.sample) : static_cast<float>(r.offset[0]);
            result[c] = Scalar::ofNumber(Number(
                subject_.world.interpolated(first_ + r.invocation, slot, where, a, static_cast<float>(r.offset[1]))));
        }
        return result;
    }

  private:
    Ending failed(const std::string& message) {
        ending_.error = "reference: " + message;
        return std::move(ending_);
    }

    Ending runWorkGroups(const reference::Interpreter<Number>& interpreter) {
        reference::WorkGroup group;
        group.count = subject_.groups;
        for (group.id[2] = 0; group.id[2] < group.count[2]; ++group.id[2])
            for (group.id[1] = 0; group.id[1] < group.count[1]; ++group.id[1])
                for (group.id[0] = 0; group.id[0] < group.count[0]; ++group.id[0])
                    if (const Status status = interpreter.runWorkGroup(group, *this); !status)
                        return failed(status.error().message);
        return std::move(ending_);
    }

    reference::InterfaceValues<Number> inputsOf(uint32_t whose) const {
        reference::InterfaceValues<Number> all;
        for (const reference::InterfaceVariable& v : variables_) {
            if (v.output) continue;
            const bool wide = isWide(v.kind), floating = isFloating(v.kind);
            ir::InterfaceSlot slot;
            slot.index = static_cast<uint8_t>(v.vertex);
            const uint32_t invocation = invocationOfInput(interface_, slot, whose);
            if (all.vertices.size() < v.vertex) all.vertices.resize(v.vertex);
            reference::InterfaceValues<Number>& inputs = v.vertex == 0 ? all : all.vertices[v.vertex - 1];
            slot.type = floating && !wide ? ir::Type::f32 : ir::Type::i32;
            if (v.isBuiltin) {
                const auto builtin = builtinOf(v.builtin, false);
                if (!builtin) continue;
                slot.builtin = *builtin;
                auto& values = inputs.builtins[v.builtin];
                for (uint32_t k = 0; k < v.scalars(); ++k) {
                    slot.component = static_cast<uint8_t>(k);
                    values.push_back(scalarOf(subject_.world.input(invocation, slot), floating));
                }
                continue;
            }
            for (uint32_t k = 0; k < v.scalars(); ++k) {
                const auto at = v.placeOf(k);
                slot.location = static_cast<uint16_t>(at.location);
                slot.component = static_cast<uint8_t>(at.component);
                auto& texel = inputs.locations[reference::Location(slot.location, v.index)];
                const uint32_t low = subject_.world.input(invocation, slot);
                texel[slot.component] = scalarOf(low, floating);
                if (!wide) continue;
                slot.component++;
                const uint32_t high = subject_.world.input(invocation, slot);
                texel[slot.component] = Scalar::ofBits(high);
                if (floating)
                    texel[at.component] =
                        Scalar::ofNumber(static_cast<Number>(std::bit_cast<double>(uint64_t{high} << 32 | low)));
            }
        }
        return all;
    }

    void runOne(const reference::Interpreter<Number>& interpreter) {
        if (!shape_.store[first_] || !ending_.error.empty()) return;
        const auto outcome = interpreter.run(inputsOf(first_), *this);
        if (!outcome) {
            failed(outcome.error().message);
            ending_.error = "reference: " + outcome.error().message;
            return;
        }
        note(first_, *outcome);
    }

    void runPatch(const reference::Interpreter<Number>& interpreter) {
        if (!shape_.store[first_] || !ending_.error.empty()) return;
        const auto outputs = interpreter.runPatch(inputsOf(first_), *this);
        if (!outputs) {
            ending_.error = "reference: " + outputs.error().message;
            return;
        }
        ending_.live[first_] = true;
        noteOutputs(first_, *outputs, 0, 0u);
        for (uint32_t v = 0; v < outputs->vertices.size(); ++v) noteOutputs(first_, outputs->vertices[v], 0, v + 1);
    }

    void runQuad(const reference::Interpreter<Number>& interpreter, uint32_t first) {
        first_ = first;
        std::array<reference::InterfaceValues<Number>, 4> inputs;
        std::array<bool, 4> helper{};
        bool any = false;
        for (uint32_t k = 0; k < 4; ++k) {
            inputs[k] = inputsOf(first + k);
            helper[k] = !shape_.store[first + k];
            any = any || shape_.exec[first + k];
        }
        if (!any) return;
        const auto outcomes = interpreter.runQuad(inputs, helper, *this);
        if (!outcomes) {
            ending_.error = "reference: " + outcomes.error().message;
            return;
        }
        for (uint32_t k = 0; k < 4; ++k)
            if (!helper[k]) note(first + k, (*outcomes)[k]);
    }

    void runSubgroup(const reference::Interpreter<Number>& interpreter, uint32_t first) {
        const uint32_t count = std::min(reference::kSubgroupSize, subject_.invocations - first);
        std::vector<std::optional<reference::InterfaceValues<Number>>> inputs(count);
        std::vector<bool> helper(count);
        for (uint32_t k = 0; k < count; ++k) {
            if (shape_.exec[first + k]) inputs[k] = inputsOf(first + k);
            helper[k] = !shape_.store[first + k];
        }
        const auto outcomes = interpreter.runSubgroup(inputs, helper, *this);
        if (!outcomes) {
            ending_.error = "reference: " + outcomes.error().message;
            return;
        }
        for (uint32_t k = 0; k < count; ++k)
            if (!helper[k]) note(first + k, (*outcomes)[k]);
    }

    void note(uint32_t invocation, const reference::Outcome<Number>& outcome) {
        ending_.live[invocation] = !outcome.discarded;
        if (subject_.stage != ir::Stage::geometry) return noteOutputs(invocation, outcome.outputs, 0);
        const size_t words = interface_.outputs.size() - 1;
        for (size_t v = 0; v < outcome.vertices.size(); ++v) {
            const reference::EmittedVertex<Number>& vertex = outcome.vertices[v];
            noteOutputs(invocation, vertex.outputs, v * words, vertex.stream);
            for (size_t s = 0; s < words; ++s)
                if (interface_.outputs[s].builtin == ir::Builtin::vertexFlags)
                    noteWord(v * words + s, invocation,
                             (vertex.startsStrip ? ir::kStartsStrip : 0) | vertex.stream << ir::kStreamBit);
        }
        noteWord(ending_.outputs.size() - 1, invocation, static_cast<uint32_t>(outcome.vertices.size()));
    }

    void noteWord(size_t output, uint32_t invocation, uint32_t word) {
        ending_.outputs[output][invocation] = word;
        ending_.written[output][invocation] = true;
    }

    /// The outputs of an invocation, or of one of its vertices, those of the stream, or of a patch, those of the
    /// vertex: from `first` on.
    void noteOutputs(uint32_t invocation, const reference::InterfaceValues<Number>& outputs, size_t first,
                     std::optional<uint32_t> stream = {}) {
        for (size_t s = 0; s < interface_.outputs.size(); ++s) {
            const ir::InterfaceSlot& slot = interface_.outputs[s];
            if (stream && slot.index != *stream) continue;
            const uint32_t index = stream ? 0 : slot.index;
            const Scalar* scalar = nullptr;
            if (slot.builtin != ir::Builtin::user) {
                const auto found = outputs.builtins.find(builtinOf(slot.builtin));
                if (found != outputs.builtins.end() && slot.component < found->second.size())
                    scalar = &found->second[slot.component];
            } else {
                const auto found = outputs.locations.find(reference::Location(slot.location, index));
                if (found != outputs.locations.end()) scalar = &found->second[slot.component];
            }
            if (const auto half = halfOfDouble(slot)) {
                const auto found = outputs.locations.find(reference::Location(half->location, index));
                if (found == outputs.locations.end()) continue;
                const auto bits = std::bit_cast<uint64_t>(static_cast<double>(found->second[half->component].number));
                noteWord(first + s, invocation,
                         static_cast<uint32_t>(half->component == slot.component ? bits : bits >> 32));
            } else if (scalar != nullptr) {
                noteWord(first + s, invocation, bitsOf(*scalar, slot.type == ir::Type::f32));
            }
        }
    }

    /// Where the double stands of which an output slot holds the lower or the upper half.
    std::optional<reference::InterfaceVariable::Place> halfOfDouble(const ir::InterfaceSlot& slot) const {
        if (slot.builtin != ir::Builtin::user) return std::nullopt;
        for (const reference::InterfaceVariable& v : variables_) {
            // Of these stages it is a vertex stream or a vertex.
            const bool counts = subject_.stage != ir::Stage::geometry && subject_.stage != ir::Stage::control;
            const uint32_t index = counts ? slot.index : 0;
            if (!v.output || v.isBuiltin || v.index != index || v.kind != reference::ScalarKind::float64) continue;
            for (uint32_t k = 0; k < v.scalars(); ++k) {
                const auto at = v.placeOf(k);
                if (at.location == slot.location && at.component == (slot.component & ~1u)) return at;
            }
        }
        return std::nullopt;
    }

    static Scalar scalarOf(uint32_t bits, bool floating) {
        return floating ? Scalar::ofNumber(Number(std::bit_cast<float>(bits))) : Scalar::ofBits(bits);
    }
    static uint32_t bitsOf(const Scalar& scalar, bool floating) {
        return floating ? std::bit_cast<uint32_t>(static_cast<float>(scalar.number))
                        : static_cast<uint32_t>(scalar.bits);
    }
    TestImage& image(const reference::Descriptor& d) { return ending_.memory->image({d.set, d.binding, d.arrayIndex}); }
    static ir::ImageDim dimOf(spv::Dim dim) {
        switch (dim) {
            case spv::Dim1D:
                return ir::ImageDim::d1;
            case spv::Dim3D:
                return ir::ImageDim::d3;
            case spv::DimCube:
                return ir::ImageDim::cube;
            case spv::DimBuffer:
                return ir::ImageDim::buffer;
            case spv::DimSubpassData:
                return ir::ImageDim::subpass;
            default:
                return ir::ImageDim::d2;
        }
    }
    ImageAccess accessOf(const Request& r) const {
        ImageAccess a;
        a.dim = dimOf(r.shape.dim);
        a.arrayed = r.shape.arrayed;
        a.compare = r.dref.has_value();
        a.texel = r.texel;
        for (size_t k = 0; k < 4; ++k) a.coordinates[k] = static_cast<float>(r.coordinates[k]);
        for (size_t k = 0; k < 3; ++k) {
            a.ddx[k] = static_cast<float>(r.ddx[k]);
            a.ddy[k] = static_cast<float>(r.ddy[k]);
        }
        a.lod = static_cast<float>(r.lod);
        a.bias = static_cast<float>(r.bias);
        if (r.minLod) a.minLod = static_cast<float>(*r.minLod);
        a.level = r.texelLod;
        a.offset = r.offset;
        if (r.dref) a.reference = static_cast<float>(*r.dref);
        a.sample = r.sample;
        a.component = r.component;
        return a;
    }
    Texel texel(const Request& r, const ImageAccess& access) {
        const auto bits = image(r.image).access(access);
        Texel result;
        for (size_t k = 0; k < 4; ++k) result[k] = scalarOf(bits[k], r.shape.floating);
        return result;
    }

    const Case& subject_;
    const ir::Program& interface_;
    const Shape& shape_;
    MathTier tier_;
    std::vector<reference::InterfaceVariable> variables_;
    uint32_t first_ = 0;  // invocation of the quad's first corner, or the one that runs
    Ending ending_;
};

/// A module with 64-bit floats needs them: float holds no more than 24 bits.
bool usesFloat64(const Words& words) {
    for (size_t at = 5; at < words.size() && (words[at] & 0xFFFF) == spv::OpCapability; at += 2)
        if (at + 1 < words.size() && words[at + 1] == spv::CapabilityFloat64) return true;
    return false;
}

}  // namespace

Ending runReference(const Case& subject, const ir::Program& interface, const Shape& shape, MathTier tier) {
    if (usesFloat64(subject.words)) return ReferenceRun<double>(subject, interface, shape, tier).run();
    return ReferenceRun<float>(subject, interface, shape, tier).run();
}

}  // namespace vernier::proof
