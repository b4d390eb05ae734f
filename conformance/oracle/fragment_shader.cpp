#include "conformance/oracle/fragment_shader.h"

#include <spirv/unified1/GLSL.std.450.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace vernier::conformance::exact {

namespace {

using reference::InterfaceVariable;

// Interpolation in the spec-legal sense: "each operation good to about 1 part in 10^5".
constexpr double kInterpolationError = 1e-5;
constexpr double kFloatError = 0x1p-22;
constexpr double kRoundingFactor = 8;

struct ModuleTraits {
    bool derivatives = false;
    double imprecision = 0;
};

// Vulkan, Precision and Operation of SPIR-V Instructions: sin and cos 2^-11 absolute, atan 4096 ULP, exp and
// log some ULP; pow magnifies the error of its logarithm by the exponent.
double imprecisionOf(uint32_t instruction) {
    switch (instruction) {
        case GLSLstd450Sin:
        case GLSLstd450Cos:
        case GLSLstd450Tan:
        case GLSLstd450Asin:
        case GLSLstd450Acos:
        case GLSLstd450Atan:
        case GLSLstd450Atan2:
        case GLSLstd450Sinh:
        case GLSLstd450Cosh:
        case GLSLstd450Tanh:
        case GLSLstd450Asinh:
        case GLSLstd450Acosh:
        case GLSLstd450Atanh:
            return 0x1p-10;
        case GLSLstd450Pow:
            return 0x1p-14;
        case GLSLstd450Exp:
        case GLSLstd450Exp2:
        case GLSLstd450Log:
        case GLSLstd450Log2:
            return 0x1p-18;
        case GLSLstd450Sqrt:
        case GLSLstd450InverseSqrt:
        case GLSLstd450Length:
        case GLSLstd450Distance:
        case GLSLstd450Normalize:
            return 0x1p-20;
        default:
            return 0;
    }
}

ModuleTraits scan(const std::vector<uint32_t>& words) {
    ModuleTraits traits;
    for (size_t at = 5; at < words.size();) {
        const uint32_t length = words[at] >> 16, opcode = words[at] & 0xffff;
        if (length == 0) break;
        traits.derivatives =
            traits.derivatives || opcode == spv::OpDPdx || opcode == spv::OpDPdy || opcode == spv::OpFwidth;
        if (opcode == spv::OpExtInst && length > 4 && at + 4 < words.size()) {
            traits.imprecision = std::max(traits.imprecision, imprecisionOf(words[at + 4]));
        }
        at += length;
    }
    return traits;
}

// The nominal number of an output component and what other runs made of it.
class Spread {
  public:
    explicit Spread(double nominal) : nominal_(nominal) {}

    /// Deviations of one kind, given as the extremes seen so far in this kind.
    void see(double other) {
        below_ = std::max(below_, nominal_ - other);
        above_ = std::max(above_, other - nominal_);
        varies_ = varies_ || (open_ && other != nominal_);
        if (std::isnan(other)) below_ = above_ = HUGE_VAL;
    }
    void endKind(double factor = 1, bool symmetric = false) {
        if (symmetric) below_ = above_ = std::max(below_, above_);
        totalBelow_ += below_ * factor;
        totalAbove_ += above_ * factor;
        below_ = above_ = 0;
    }
    /// Kinds seen later (rounding alone) do not count as variation with the inputs.
    void closeVariation() { open_ = false; }
    bool varies() const { return varies_; }
    Interval range(double slack) const {
        return {nominal_, nominal_ - totalBelow_ - slack, nominal_ + totalAbove_ + slack};
    }

  private:
    double nominal_;
    double below_ = 0, above_ = 0, totalBelow_ = 0, totalAbove_ = 0;
    bool varies_ = false, open_ = true;
};

struct Runs {
    std::array<reference::Outcome<double>, 4> nominal;
    std::vector<std::array<reference::Outcome<double>, 4>> shifted, filtered, coarse, rounded;
};

template <class Read>
std::optional<Spread> spreadOf(const Runs& runs, size_t lane, Read read) {
    const std::optional<double> nominal = read(runs.nominal[lane].outputs);
    if (!nominal) return std::nullopt;
    Spread spread(*nominal);
    const auto kind = [&](const auto& list, double factor, bool symmetric) {
        for (const auto& run : list) {
            if (run[lane].discarded != runs.nominal[lane].discarded) continue;
            spread.see(read(run[lane].outputs).value_or(*nominal));
        }
        spread.endKind(factor, symmetric);
    };
    kind(runs.shifted, 1, false);
    kind(runs.filtered, 1, false);
    kind(runs.coarse, 1, true);
    spread.closeVariation();
    kind(runs.rounded, kRoundingFactor, true);
    return spread;
}

bool isInteger(const InterfaceVariable& v) {
    return v.kind != reference::ScalarKind::float32 && v.kind != reference::ScalarKind::float64;
}

double numberOf(const reference::Scalar<double>& scalar, const InterfaceVariable& variable) {
    if (!isInteger(variable)) return scalar.number;
    const auto bits = static_cast<uint32_t>(scalar.bits);
    return variable.kind == reference::ScalarKind::int32 ? static_cast<double>(static_cast<int32_t>(bits))
                                                         : static_cast<double>(bits);
}

}  // namespace

Result<FragmentShader> FragmentShader::create(const Scene& scene, const ScenePipeline& pipeline) {
    const SceneShader& shader = scene.shaders[pipeline.fragmentShader];
    auto module = parseShader(shader);
    if (!module) return module.error();
    auto nominal = Interpreter::create(*module, spv::ExecutionModelFragment);
    if (!nominal) return nominal.error();
    reference::Options rounding;
    rounding.roundToFloat = true;
    auto rounded = Interpreter::create(*module, spv::ExecutionModelFragment, "main", rounding);
    if (!rounded) return rounded.error();
    FragmentShader result(*module, *nominal, *rounded);

    const ModuleTraits traits = scan(shader.spirv);
    result.imprecision_ = traits.imprecision;
    if (traits.derivatives) {
        reference::Options coarse;
        coarse.coarseDerivatives = true;
        auto interpreter = Interpreter::create(*module, spv::ExecutionModelFragment, "main", coarse);
        if (!interpreter) return interpreter.error();
        result.coarse_ = std::make_shared<const Interpreter>(*interpreter);
    }
    for (size_t i = 0; i < module->entryPoints().size(); ++i) {
        const reference::EntryPoint& entry = module->entryPoints()[i];
        if (entry.model != spv::ExecutionModelFragment || entry.name != "main") continue;
        for (const InterfaceVariable& v : module->interfaceVariables(i)) {
            if (v.output) {
                result.outputs_.push_back(v);
                continue;
            }
            const bool perSample = v.sample || (v.isBuiltin && (v.builtin == spv::BuiltInSampleId ||
                                                                v.builtin == spv::BuiltInSamplePosition));
            if (pipeline.samples != VK_SAMPLE_COUNT_1_BIT && (perSample || v.centroid)) {
                return unsupported("oracle: fragment input '" + v.name +
                                   "' asks for per-sample or centroid shading");
            }
            const bool interpolated =
                v.isBuiltin ? v.builtin == spv::BuiltInFragCoord : !v.flat && !isInteger(v);
            result.variesWithPosition_ = result.variesWithPosition_ || interpolated;
            result.inputs_.push_back(v);
        }
    }
    return result;
}

void FragmentShader::setVariable(const InterfaceVariable& variable, const FragmentSource& source,
                                 const std::array<double, 3>& weights, Values& values) const {
    for (uint32_t k = 0; k < variable.locations; ++k) {
        const reference::Location location(variable.location + k);
        std::array<reference::Texel<double>, 3> at{};
        for (size_t i = 0; i < 3; ++i) {
            const auto found = source.vertices[i]->varyings.find(location);
            if (found != source.vertices[i]->varyings.end()) at[i] = found->second;
        }
        reference::Texel<double>& texel = values.locations[location];
        for (size_t c = variable.component; c < std::min<size_t>(4, variable.component + variable.components);
             ++c) {
            if (variable.flat || isInteger(variable)) {
                texel[c] = at[0][c];
                continue;
            }
            const std::array<double, 3> f{at[0][c].number, at[1][c].number, at[2][c].number};
            const auto& shape = source.triangle->homogeneous();
            texel[c].number =
                variable.noPerspective ? shape.linear(weights, f) : shape.perspective(weights, f);
        }
    }
}

std::array<FragmentShader::Values, 4> FragmentShader::inputsAt(const FragmentSource& source, uint32_t x,
                                                               uint32_t y, double shiftX,
                                                               double shiftY) const {
    std::array<Values, 4> result;
    for (uint32_t lane = 0; lane < 4; ++lane) {
        Values& values = result[lane];
        const double px = x + lane % 2 + 0.5, py = y + lane / 2 + 0.5;
        const auto& shape = source.triangle->homogeneous();
        const auto weights = shape.weights(px + shiftX, py + shiftY);
        for (const InterfaceVariable& v : inputs_) {
            if (!v.isBuiltin) {
                setVariable(v, source, weights, values);
                continue;
            }
            switch (v.builtin) {
                case spv::BuiltInFragCoord:
                    values.setFloat(spv::BuiltInFragCoord,
                                    {px, py, shape.depth(weights), shape.inverseW(weights)});
                    break;
                case spv::BuiltInFrontFacing:
                    values.setInt(v.builtin, source.frontFacing);
                    break;
                case spv::BuiltInPrimitiveId:
                    values.setInt(v.builtin, static_cast<int32_t>(source.primitiveId));
                    break;
                default:
                    break;  // reads as 0: SampleId and layers of what is modelled
            }
        }
    }
    return result;
}

Result<std::array<FragmentResult, 4>> FragmentShader::evaluate(const FragmentSource& source, uint32_t x,
                                                               uint32_t y, const std::array<bool, 4>& covered,
                                                               const OutputState& output,
                                                               ShaderResources& resources) const {
    Runs runs;
    std::array<bool, 4> helper;
    for (size_t i = 0; i < 4; ++i) helper[i] = !covered[i];
    const auto run = [&](const Interpreter& shader, const std::array<Values, 4>& inputs) {
        return shader.runQuad(inputs, helper, resources);
    };
    resources.end = RangeEnd::nominal;
    resources.sawRange = false;
    resources.flags = 0;
    const auto inputs = inputsAt(source, x, y, 0, 0);
    auto nominal = run(nominal_, inputs);
    if (!nominal) return nominal.error();
    runs.nominal = std::move(*nominal);
    const bool filtered = resources.sawRange;
    const auto add = [&](auto& list, const Interpreter& shader, const std::array<Values, 4>& at) -> Status {
        auto outcome = run(shader, at);
        if (!outcome) return outcome.error();
        list.push_back(std::move(*outcome));
        return {};
    };
    if (variesWithPosition_) {
        const double d = source.triangle->freedom();
        for (const double dx : {-d, d}) {
            for (const double dy : {-d, d}) {
                if (Status s = add(runs.shifted, nominal_, inputsAt(source, x, y, dx, dy)); !s)
                    return s.error();
            }
        }
    }
    if (filtered) {
        for (const RangeEnd end : {RangeEnd::low, RangeEnd::high}) {
            resources.end = end;
            if (Status s = add(runs.filtered, nominal_, inputs); !s) return s.error();
        }
        resources.end = RangeEnd::nominal;
    }
    if (coarse_) {
        if (Status s = add(runs.coarse, *coarse_, inputs); !s) return s.error();
    }
    if (Status s = add(runs.rounded, rounded_, inputs); !s) return s.error();
    if (resources.wrote) return unsupported("oracle: the fragment shader uses storage buffers or images");

    const uint8_t flags = resources.flags;
    std::array<FragmentResult, 4> results;
    for (size_t lane = 0; lane < 4; ++lane) {
        FragmentResult& result = results[lane];
        result.discarded = runs.nominal[lane].discarded;
        for (const auto* list : {&runs.shifted, &runs.filtered, &runs.coarse, &runs.rounded}) {
            for (const auto& other : *list)
                result.discardOpen = result.discardOpen || other[lane].discarded != result.discarded;
        }
        // A nominally discarded fragment that others keep: take the outputs of one that kept it.
        if (result.discarded && result.discardOpen) {
            for (const auto* list : {&runs.shifted, &runs.filtered, &runs.coarse, &runs.rounded}) {
                for (const auto& other : *list) {
                    if (!other[lane].discarded) runs.nominal[lane].outputs = other[lane].outputs;
                }
            }
        }
        const auto range = [&](const InterfaceVariable& v, auto read) -> std::optional<Interval> {
            const auto spread = spreadOf(runs, lane, read);
            if (!spread) return std::nullopt;
            const double nominalNumber = std::abs(spread->range(0).value);
            if (isInteger(v)) return spread->range(0);
            const double relative = imprecision_ + (spread->varies() ? kInterpolationError : kFloatError);
            return spread->range(relative *
                                 std::max(1.0, std::isfinite(nominalNumber) ? nominalNumber : 1.0));
        };
        std::array<bool, kMaxColorAttachments> written{};
        for (const InterfaceVariable& v : outputs_) {
            if (v.isBuiltin) {
                if (v.builtin != spv::BuiltInFragDepth) continue;
                result.depth = range(v, [](const Values& values) -> std::optional<double> {
                    const auto found = values.builtins.find(spv::BuiltInFragDepth);
                    if (found == values.builtins.end() || found->second.empty()) return std::nullopt;
                    return found->second[0].number;
                });
                continue;
            }
            for (uint32_t k = 0; k < v.locations; ++k) {
                const size_t target = v.location + k;
                if (target >= output.colorCount) continue;
                Color color{};
                for (size_t c = v.component; c < std::min<size_t>(4, v.component + v.components); ++c) {
                    const auto component = range(v, [&](const Values& values) -> std::optional<double> {
                        const auto found = values.locations.find({v.location + k, v.index});
                        if (found == values.locations.end()) return std::nullopt;
                        return numberOf(found->second[c], v);
                    });
                    if (!component) continue;
                    color[c] = *component;
                    if (v.index == 0) written[target] = true;
                }
                if (v.index == 1) {
                    result.source1 = color;
                } else {
                    for (size_t c = v.component; c < 4; ++c) result.colors[target][c] = color[c];
                }
            }
        }
        for (size_t i = 0; i < output.colorCount; ++i) {
            result.colorFlags[i] = static_cast<uint8_t>(flags | (written[i] ? 0 : kOracleUnknown));
        }
    }
    return results;
}

}  // namespace vernier::conformance::exact
