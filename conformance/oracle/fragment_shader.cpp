#include "conformance/oracle/fragment_shader.h"

#include "conformance/oracle/shader_runs.h"

#include <spirv/unified1/GLSL.std.450.h>

#include <algorithm>
#include <string>

namespace vernier::conformance::exact {

namespace {

using reference::InterfaceVariable;

struct ModuleTraits {
    bool derivatives = false;
    bool ofPixels = false;  // drops fragments, or asks for inputs at places of its own
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

/// Knows single pixels or samples, or decides about them.
bool isOfPixels(const InterfaceVariable& v) {
    if (!v.isBuiltin) return false;
    return v.output || v.builtin == spv::BuiltInSampleMask || v.builtin == spv::BuiltInPointCoord ||
           v.builtin == spv::BuiltInSampleId || v.builtin == spv::BuiltInSamplePosition;
}

ModuleTraits scan(const std::vector<uint32_t>& words) {
    ModuleTraits traits;
    for (size_t at = 5; at < words.size();) {
        const uint32_t length = words[at] >> 16, opcode = words[at] & 0xffff;
        if (length == 0) break;
        traits.derivatives =
            traits.derivatives || opcode == spv::OpDPdx || opcode == spv::OpDPdy || opcode == spv::OpFwidth;
        traits.ofPixels = traits.ofPixels || opcode == spv::OpKill || opcode == spv::OpTerminateInvocation ||
                          opcode == spv::OpDemoteToHelperInvocation;
        if (opcode == spv::OpExtInst && length > 4 && at + 4 < words.size()) {
            traits.ofPixels = traits.ofPixels || (words[at + 4] >= GLSLstd450InterpolateAtCentroid &&
                                                  words[at + 4] <= GLSLstd450InterpolateAtOffset);
            traits.imprecision = std::max(traits.imprecision, imprecisionOf(words[at + 4]));
        }
        at += length;
    }
    return traits;
}

}  // namespace

Result<FragmentShader> FragmentShader::create(const Scene& scene, const ScenePipeline& pipeline, uint32_t viewIndex) {
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
    result.viewIndex_ = viewIndex;

    const ModuleTraits traits = scan(shader.spirv);
    if (usesAtomicResults(shader.spirv)) return unsupported("oracle: what atomic operations return");
    result.imprecision_ = traits.imprecision;
    result.mayShadeCoarsely_ = !traits.ofPixels;
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
            result.mayShadeCoarsely_ = result.mayShadeCoarsely_ && !isOfPixels(v);
            if (v.output) {
                result.outputs_.push_back(v);
                continue;
            }
            const bool multisampled = pipeline.samples != VK_SAMPLE_COUNT_1_BIT;
            result.perSample_ =
                result.perSample_ ||
                (multisampled && (v.sample || (v.isBuiltin && (v.builtin == spv::BuiltInSampleId ||
                                                               v.builtin == spv::BuiltInSamplePosition))));
            result.hasCentroids_ = result.hasCentroids_ || (multisampled && v.centroid);
            const bool barycentric =
                v.isBuiltin && (v.builtin == spv::BuiltInBaryCoordKHR || v.builtin == spv::BuiltInBaryCoordNoPerspKHR);
            result.knowsVertices_ = result.knowsVertices_ || barycentric || v.perVertex;
            const bool interpolated =
                v.isBuiltin ? barycentric || v.builtin == spv::BuiltInFragCoord || v.builtin == spv::BuiltInPointCoord
                            : !v.flat && !v.perVertex && !isIntegerVariable(v);
            result.variesWithPosition_ = result.variesWithPosition_ || interpolated;
            result.inputs_.push_back(v);
        }
    }
    return result;
}

void FragmentSource::number(uint32_t count, bool provokingLast) {
    corners = count;
    const auto first = std::find(vertices.begin(), vertices.begin() + count, provoking) - vertices.begin();
    for (uint32_t n = 0; n < count; ++n)
        numbered[n] = (static_cast<uint32_t>(first) + (provokingLast ? 1 : 0) + n) % count;
}

void FragmentShader::setVariable(const InterfaceVariable& variable, const FragmentSource& source,
                                 const HomogeneousTriangle<double>& shape, const std::array<double, 3>& weights,
                                 Values& values) const {
    for (uint32_t k = 0; k < variable.locations; ++k) {
        const reference::Location location(variable.location + k);
        std::array<reference::Texel<double>, 3> at{};
        for (size_t i = 0; i < 3; ++i) {
            const auto found = source.vertices[i]->varyings.find(location);
            if (found != source.vertices[i]->varyings.end()) at[i] = found->second;
        }
        reference::Texel<double>& texel =
            values.locations[reference::Location(variable.location + k, variable.perVertex ? variable.index : 0)];
        for (size_t c = variable.component; c < std::min<size_t>(4, variable.component + variable.components); ++c) {
            if (variable.perVertex) {
                if (variable.index >= source.corners) continue;
                const auto& varyings = source.vertices[source.numbered[variable.index]]->varyings;
                const auto found = varyings.find(reference::Location(variable.location + k));
                if (found != varyings.end()) texel[c] = found->second[c];
                continue;
            }
            if (variable.flat || isIntegerVariable(variable)) {
                const auto found = source.provoking->varyings.find(location);
                if (found != source.provoking->varyings.end()) texel[c] = found->second[c];
                continue;
            }
            const std::array<double, 3> f{at[0][c].number, at[1][c].number, at[2][c].number};
            texel[c].number = variable.noPerspective ? shape.linear(weights, f) : shape.perspective(weights, f);
        }
    }
}

std::array<FragmentShader::Values, 4> FragmentShader::inputsAt(const FragmentSource& source,
                                                               const HomogeneousTriangle<double>& shape, uint32_t x,
                                                               uint32_t y, const ShadingPlace& place, double shiftX,
                                                               double shiftY, size_t centroid, bool centred) const {
    std::array<Values, 4> result;
    for (uint32_t lane = 0; lane < 4; ++lane) {
        Values& values = result[lane];
        const double px = x + place.pixels * (lane % 2) + place.offset[0];
        const double py = y + place.pixels * (lane / 2) + place.offset[1];
        const auto weights = shape.weights(px + shiftX, py + shiftY);
        const auto centreWeights = shape.weights(x + lane % 2 + 0.5 + shiftX, y + lane / 2 + 0.5 + shiftY);
        auto centroidWeights = weights;
        if (const auto& places = place.centroids[lane]; !places.empty()) {
            const std::array<double, 2>& at = places[std::min(centroid, places.size() - 1)];
            centroidWeights = shape.weights(at[0] + shiftX, at[1] + shiftY);
        }
        for (const InterfaceVariable& v : inputs_) {
            if (!v.isBuiltin) {
                setVariable(v, source, shape,
                            v.centroid             ? centroidWeights
                            : centred && !v.sample ? centreWeights
                                                   : weights,
                            values);
                continue;
            }
            switch (v.builtin) {
                case spv::BuiltInFragCoord:
                    values.setFloat(spv::BuiltInFragCoord, {px, py, shape.depth(weights), shape.inverseW(weights)});
                    break;
                case spv::BuiltInFrontFacing:
                    values.setInt(v.builtin, source.frontFacing);
                    break;
                case spv::BuiltInPrimitiveId:
                    values.setInt(v.builtin, static_cast<int32_t>(source.primitiveId));
                    break;
                case spv::BuiltInBaryCoordKHR:
                case spv::BuiltInBaryCoordNoPerspKHR: {
                    const auto& at = v.centroid ? centroidWeights : centred && !v.sample ? centreWeights : weights;
                    const bool linear = v.builtin == spv::BuiltInBaryCoordNoPerspKHR;
                    std::array<double, 3> share{};
                    for (uint32_t n = 0; n < source.corners; ++n) {
                        std::array<double, 3> one{};
                        for (size_t i = 0; i < 3; ++i)
                            one[i] = source.vertices[i] == source.vertices[source.numbered[n]] ? 1 : 0;
                        share[n] = linear ? shape.linear(at, one) : shape.perspective(at, one);
                    }
                    values.setFloat(v.builtin, {share[0], share[1], share[2]});
                    break;
                }
                case spv::BuiltInPointCoord:
                    if (source.point != nullptr) {
                        const auto [u, w] = source.point->coordinate(px + shiftX, py + shiftY);
                        values.setFloat(v.builtin, {u, w});
                    }
                    break;
                case spv::BuiltInSampleId:
                    values.setInt(v.builtin, static_cast<int32_t>(place.sample));
                    break;
                case spv::BuiltInSamplePosition:
                    values.setFloat(v.builtin, {place.offset[0], place.offset[1]});
                    break;
                case spv::BuiltInLayer:
                    values.setInt(v.builtin, static_cast<int32_t>(source.provoking->layer));
                    break;
                case spv::BuiltInViewportIndex:
                    values.setInt(v.builtin, static_cast<int32_t>(source.provoking->viewport));
                    break;
                case spv::BuiltInViewIndex:
                    values.setInt(v.builtin, static_cast<int32_t>(viewIndex_));
                    break;
                default:
                    break;  // reads as 0
            }
        }
    }
    return result;
}

Result<FragmentShader::Outcomes> FragmentShader::runQuad(const Interpreter& shader, const std::array<Values, 4>& inputs,
                                                         const std::array<bool, 4>& helper,
                                                         ShaderResources& resources) {
    resources.startRun();
    return shader.runQuad(inputs, helper, resources);
}

Status FragmentShader::addMoved(const FragmentSource& source, uint32_t x, uint32_t y, const ShadingPlace& place,
                                const std::array<bool, 4>& helper, ShaderResources& resources, ShaderRuns& runs) const {
    const HomogeneousTriangle<double>& shape = source.triangle->homogeneous();
    const double d = source.triangle->freedomAt(x + 1.0, y + 1.0);
    const auto add = [&](auto& list, const std::array<Values, 4>& inputs) -> Status {
        auto outcome = runQuad(nominal_, inputs, helper, resources);
        if (!outcome) return outcome.error();
        list.push_back(std::move(*outcome));
        return {};
    };
    constexpr double kFine = 0x1p-7;  // a 256th of a pixel and what rounding adds to it
    const bool isTriangle = source.vertices[2] != source.vertices[0];
    for (const double dx : {-d, d}) {
        for (const double dy : {-d, d}) {
            if (Status s = add(runs.shifted, inputsAt(source, shape, x, y, place, dx, dy)); !s) return s;
        }
    }
    if (d < kFine || !isTriangle) return {};
    // What a test decides may take all vertices together; what derivatives are, each by itself.
    for (size_t coordinate = 0; coordinate < runs.moved.size(); ++coordinate) {
        for (const double by : {-d, d}) {
            std::array<WindowVertex<double>, 3> vertices = shape.vertex;
            WindowVertex<double>& vertex = vertices[coordinate / 2];
            (coordinate % 2 == 0 ? vertex.x : vertex.y) += by * vertex.w;
            const HomogeneousTriangle<double> moved(vertices);
            if (Status s = add(runs.moved[coordinate], inputsAt(source, moved, x, y, place, 0, 0)); !s) return s;
        }
    }
    return {};
}

Result<std::array<FragmentResult, 4>> FragmentShader::evaluate(const FragmentSource& source, uint32_t x, uint32_t y,
                                                               const std::array<bool, 4>& covered,
                                                               const OutputState& output, ShaderResources& resources,
                                                               const ShadingPlace& place) const {
    ShaderRuns runs;
    std::array<bool, 4> helper;
    for (size_t i = 0; i < 4; ++i) helper[i] = !covered[i];
    const auto run = [&](const Interpreter& shader, const std::array<Values, 4>& inputs) {
        return runQuad(shader, inputs, helper, resources);
    };
    resources.end = RangeEnd::nominal;
    resources.resetRuns();
    resources.sawRange = resources.sawZero = false;
    resources.flags = 0;
    const HomogeneousTriangle<double>& shape = source.triangle->homogeneous();
    const auto inputs = inputsAt(source, shape, x, y, place, 0, 0);
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
        if (Status s = addMoved(source, x, y, place, helper, resources, runs); !s) return s.error();
    }
    size_t centroids = 0;
    for (const auto& places : place.centroids) centroids = std::max(centroids, places.size());
    for (size_t i = 1; i < centroids; ++i) {
        if (Status s = add(runs.shifted, nominal_, inputsAt(source, shape, x, y, place, 0, 0, i)); !s) return s.error();
    }
    if (place.perSample) {
        if (Status s = add(runs.shifted, nominal_, inputsAt(source, shape, x, y, place, 0, 0, 0, true)); !s)
            return s.error();
    }
    if (filtered) {
        for (const RangeEnd end : {RangeEnd::low, RangeEnd::high, RangeEnd::nearZero}) {
            if (end == RangeEnd::nearZero && !resources.sawZero) continue;
            resources.end = end;
            if (Status s = add(runs.filtered, nominal_, inputs); !s) return s.error();
        }
        resources.end = RangeEnd::nominal;
    }
    if (coarse_) {
        if (Status s = add(runs.coarse, *coarse_, inputs); !s) return s.error();
    }
    if (Status s = add(runs.rounded, rounded_, inputs); !s) return s.error();
    if (!resources.refusal.empty()) return unsupported("oracle: " + resources.refusal);

    const ValueError error{imprecision_, resources.rules().interpolationError};
    std::array<FragmentResult, 4> results;
    for (size_t lane = 0; lane < 4; ++lane) {
        results[lane] = combineRuns(runs, lane, outputs_, error, output.colorCount);
        for (OracleFlags& flags : results[lane].colorFlags) flags |= resources.flags;
        results[lane].writes =
            combineWrites(resources.runs, static_cast<uint32_t>(lane), resources.sceneMemory(), error, resources.flags);
        results[lane].wordWrites =
            combineWords(resources.wordRuns, static_cast<uint32_t>(lane), error, resources.flags);
    }
    return results;
}

}  // namespace vernier::conformance::exact
