#include "conformance/oracle/sample_states.h"

#include "conformance/oracle/blending.h"
#include "conformance/oracle/quantise.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vernier::conformance::exact {

namespace {

// States beyond this number are united, which loses their edge decisions but stays on the permitting side.
constexpr size_t kMaxStates = 8;

struct Answer {
    bool value = false, open = false;
};

bool holds(VkCompareOp op, double a, double b) {
    switch (op) {
        case VK_COMPARE_OP_NEVER:
            return false;
        case VK_COMPARE_OP_LESS:
            return a < b;
        case VK_COMPARE_OP_EQUAL:
            return a == b;
        case VK_COMPARE_OP_LESS_OR_EQUAL:
            return a <= b;
        case VK_COMPARE_OP_GREATER:
            return a > b;
        case VK_COMPARE_OP_NOT_EQUAL:
            return a != b;
        case VK_COMPARE_OP_GREATER_OR_EQUAL:
            return a >= b;
        default:
            return true;
    }
}

Answer compareDepth(VkCompareOp op, const Interval& fragment, const Interval& stored, bool sameTriangle) {
    if (op == VK_COMPARE_OP_NEVER || op == VK_COMPARE_OP_ALWAYS) return {op == VK_COMPARE_OP_ALWAYS, false};
    if (sameTriangle) return {holds(op, 0, 0), false};
    const bool value = holds(op, fragment.value, stored.value);
    if (fragment.high < stored.low || fragment.low > stored.high || (fragment.isExact() && stored.isExact())) {
        return {value, false};
    }
    // Touching ranges with one common point still decide the inclusive or exclusive comparison.
    if (fragment.low == stored.high && (op == VK_COMPARE_OP_LESS || op == VK_COMPARE_OP_GREATER_OR_EQUAL))
        return {value, false};
    if (fragment.high == stored.low && (op == VK_COMPARE_OP_GREATER || op == VK_COMPARE_OP_LESS_OR_EQUAL))
        return {value, false};
    return {value, true};
}

uint8_t applyStencilOp(VkStencilOp op, uint8_t stored, uint8_t reference) {
    switch (op) {
        case VK_STENCIL_OP_ZERO:
            return 0;
        case VK_STENCIL_OP_REPLACE:
            return reference;
        case VK_STENCIL_OP_INCREMENT_AND_CLAMP:
            return static_cast<uint8_t>(stored == 255 ? 255 : stored + 1);
        case VK_STENCIL_OP_DECREMENT_AND_CLAMP:
            return static_cast<uint8_t>(stored == 0 ? 0 : stored - 1);
        case VK_STENCIL_OP_INVERT:
            return static_cast<uint8_t>(~stored);
        case VK_STENCIL_OP_INCREMENT_AND_WRAP:
            return static_cast<uint8_t>(stored + 1);
        case VK_STENCIL_OP_DECREMENT_AND_WRAP:
            return static_cast<uint8_t>(stored - 1);
        default:
            return stored;
    }
}

void updateStencil(const VkStencilOpState& state, VkStencilOp op, SampleState& s) {
    const auto reference = static_cast<uint8_t>(state.reference), mask = static_cast<uint8_t>(state.writeMask);
    const uint8_t updated = applyStencilOp(op, s.stencil, reference);
    s.stencil = static_cast<uint8_t>((s.stencil & ~mask) | (updated & mask));
}

Color clampForFormat(const PixelFormat& format, Color color) {
    const Encoding encoding = format.components[0].encoding;
    const bool fixed = encoding == Encoding::unorm || encoding == Encoding::srgb || encoding == Encoding::snorm;
    if (!fixed) return color;
    for (Interval& c : color) c = c.clamped(encoding == Encoding::snorm ? -1 : 0, 1);
    return color;
}

/// One operand of a blend equation with its factor.
struct BlendTerm {
    const Interval& operand;
    const Interval& factor;
    bool operandIsCode, factorIsCode;  // as stored already: nothing to round
};

double magnitude(const Interval& v) {
    return std::max(std::abs(v.low), std::abs(v.high));
}

/// Vulkan, Blending: "basic blend operations are performed with a precision and dynamic range no lower than that used
/// to represent destination components": an operand, its factor and their product may each be rounded to a code. By how
/// many codes all three may move the term.
double roundingOf(const BlendTerm& term) {
    if (term.factor == Interval(0.0) || term.operand == Interval(0.0)) return 0;
    const bool whole = term.factor == Interval(1.0);
    return (term.operandIsCode ? 0 : magnitude(term.factor) / 2) +
           (whole || term.factorIsCode ? 0 : magnitude(term.operand) / 2) + (whole ? 0 : 0.5);
}

/// Whether a blend factor is a component of the destination, or 1 less it: those are codes.
bool isOfDestination(VkBlendFactor factor) {
    return factor == VK_BLEND_FACTOR_DST_COLOR || factor == VK_BLEND_FACTOR_DST_ALPHA ||
           factor == VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR || factor == VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA;
}

/// A logic operation on codes (Vulkan, Logical Operations).
uint64_t applyLogicOp(VkLogicOp op, uint64_t source, uint64_t stored, uint64_t mask) {
    uint64_t result = 0;
    switch (op) {
        case VK_LOGIC_OP_CLEAR:
            break;
        case VK_LOGIC_OP_AND:
            result = source & stored;
            break;
        case VK_LOGIC_OP_AND_REVERSE:
            result = source & ~stored;
            break;
        case VK_LOGIC_OP_COPY:
            result = source;
            break;
        case VK_LOGIC_OP_AND_INVERTED:
            result = ~source & stored;
            break;
        case VK_LOGIC_OP_NO_OP:
            result = stored;
            break;
        case VK_LOGIC_OP_XOR:
            result = source ^ stored;
            break;
        case VK_LOGIC_OP_OR:
            result = source | stored;
            break;
        case VK_LOGIC_OP_NOR:
            result = ~(source | stored);
            break;
        case VK_LOGIC_OP_EQUIVALENT:
            result = ~(source ^ stored);
            break;
        case VK_LOGIC_OP_INVERT:
            result = ~stored;
            break;
        case VK_LOGIC_OP_OR_REVERSE:
            result = source | ~stored;
            break;
        case VK_LOGIC_OP_COPY_INVERTED:
            result = ~source;
            break;
        case VK_LOGIC_OP_OR_INVERTED:
            result = ~source | stored;
            break;
        case VK_LOGIC_OP_NAND:
            result = ~(source & stored);
            break;
        default:
            result = mask;
            break;
    }
    return result & mask;
}

/// Logic operations are judged on unsigned codes: normalised or integer. Where either side has more than a few codes,
/// all results are possible.
Interval logicComponent(VkLogicOp op, const Component& component, const Interval& source, const Interval& stored) {
    const uint64_t mask = (uint64_t{1} << component.bits) - 1;
    const double scale = component.encoding == Encoding::unorm ? static_cast<double>(mask) : 1;
    const Interval from = quantise(component, source);
    constexpr int64_t kMostCodes = 8;
    const auto code = [&](double value) { return std::llround(value * scale); };
    const auto result = [&](int64_t a, int64_t b) {
        return static_cast<double>(applyLogicOp(op, static_cast<uint64_t>(a), static_cast<uint64_t>(b), mask)) / scale;
    };
    Interval answer(result(code(from.value), code(stored.value)));
    if (code(from.high) - code(from.low) > kMostCodes || code(stored.high) - code(stored.low) > kMostCodes) {
        return {answer.value, 0, static_cast<double>(mask) / scale};
    }
    for (int64_t a = code(from.low); a <= code(from.high); ++a) {
        for (int64_t b = code(stored.low); b <= code(stored.high); ++b) answer = answer.united(result(a, b));
    }
    return answer;
}

/// Vulkan, Logical Operations: for unsigned normalised and integer attachments; floats and sRGB pass unchanged.
bool takesLogicOps(const PixelFormat& format) {
    const Encoding encoding = format.components[0].encoding;
    return encoding == Encoding::unorm || encoding == Encoding::uint;
}

void writeColors(const OutputState& output, const FragmentResult& fragment, SampleState& s) {
    for (size_t i = 0; i < output.colorCount; ++i) {
        const PixelFormat* format = output.colorFormats[i];
        if (!format || i >= output.pipeline->blend.size()) continue;
        const VkPipelineColorBlendAttachmentState& state = output.pipeline->blend[i];
        uint32_t present = 0;
        for (const Component& c : format->all()) present |= 1u << c.channel;
        const uint32_t mask = state.colorWriteMask & present;
        if (mask == 0) continue;
        const Color source = clampForFormat(*format, fragment.colors[i]);
        Color result = source;
        const bool logic = output.pipeline->logicOpEnable;  // for all attachments, and instead of blending
        const bool blend = state.blendEnable && !format->isInteger() && !logic;
        std::array<double, 4> budget{};
        if (blend) {
            Color constants;
            for (size_t c = 0; c < 4; ++c) constants[c] = static_cast<double>(output.pipeline->blendConstants[c]);
            constants = clampForFormat(*format, constants);
            const Color source1 = clampForFormat(*format, fragment.source1.value_or(Color{}));
            for (size_t c = 0; c < 4; ++c) {
                result[c] = blendComponent(state, c, source, s.colors[i], constants, source1);
                const Component* component = format->channel(static_cast<uint8_t>(c));
                const bool sourceIsCode = component && quantise(*component, source[c]).isExact();
                const VkBlendOp op = c == 3 ? state.alphaBlendOp : state.colorBlendOp;
                if (op == VK_BLEND_OP_MIN || op == VK_BLEND_OP_MAX) {
                    budget[c] = sourceIsCode ? 0 : 0.5;
                    continue;
                }
                const auto term = [&](VkBlendFactor color, VkBlendFactor alpha, const Interval& operand, bool isCode) {
                    const VkBlendFactor factor = c == 3 ? alpha : color;
                    const Interval value = blendFactor(factor, c, source, s.colors[i], constants, source1);
                    return roundingOf({operand, value, isCode, isOfDestination(factor)});
                };
                budget[c] = term(state.srcColorBlendFactor, state.srcAlphaBlendFactor, source[c], sourceIsCode) +
                            term(state.dstColorBlendFactor, state.dstAlphaBlendFactor, s.colors[i][c], true);
            }
        }
        OracleFlags& flags = s.flags[i];
        if (!blend && !logic && mask == present) flags = 0;
        flags |= fragment.colorFlags[i];
        for (const Component& c : format->all()) {
            if (!(mask & (1u << c.channel))) continue;
            // Vulkan defines no fixed-point code for NaN; floats keep it.
            const bool isFloat = c.encoding == Encoding::sfloat || c.encoding == Encoding::ufloat;
            if (result[c.channel].isNan()) flags |= isFloat ? kOracleUnknown : kOracleUndefined;
            if (logic && takesLogicOps(*format)) {
                s.colors[i][c.channel] =
                    logicComponent(output.pipeline->logicOp, c, result[c.channel], s.colors[i][c.channel]);
                continue;
            }
            s.colors[i][c.channel] = quantise(c, result[c.channel], budget[c.channel]);
        }
    }
}

/// Notes reasons why what is drawn is open.
void mark(SampleState& state, OracleFlags reasons) {
    for (OracleFlags& flags : state.flags) flags |= reasons;
}

/// States that differ, the declared one first.
class StateSet {
  public:
    void add(SampleState state, bool nominal) {
        for (size_t i = 0; i < states_.size(); ++i) {
            if (!states_[i].sameContents(state)) continue;
            // Keep what both know.
            std::erase_if(states_[i].decisions, [&](const EdgeDecision& d) {
                return std::ranges::find(state.decisions, d) == state.decisions.end();
            });
            if (nominal) makeFirst(i);
            return;
        }
        states_.push_back(std::move(state));
        if (nominal) makeFirst(states_.size() - 1);
        if (states_.size() > kMaxStates) uniteLastTwo();
    }

    Sample take() { return std::move(states_); }

  private:
    void makeFirst(size_t index) {
        if (index != 0) std::swap(states_[0], states_[index]);
    }

    void uniteLastTwo() {
        SampleState last = std::move(states_.back());
        states_.pop_back();
        SampleState& into = states_.back();
        for (size_t i = 0; i < kMaxColorAttachments; ++i) {
            for (size_t c = 0; c < 4; ++c) into.colors[i][c] = into.colors[i][c].united(last.colors[i][c]);
        }
        into.depth = into.depth.united(last.depth);
        if (into.depthOrigin != last.depthOrigin) into.depthOrigin = 0;
        const OracleFlags lost = into.stencil == last.stencil ? kOracleEdge : kOracleEdge | kOracleUnknown;
        for (size_t i = 0; i < into.flags.size(); ++i) into.flags[i] |= last.flags[i] | lost;
        into.decisions.clear();
    }

    Sample states_;
};

class Splitter {
  public:
    Splitter(const OutputState& output, const SampleInput& input) : output_(output), input_(input) {}

    // One state meets the triangle.
    void process(const SampleState& before, bool nominal) {
        SampleState state = before;
        const SampleVerdict& verdict = input_.verdict;
        for (uint32_t i = 0; i < verdict.edgeCount; ++i) {
            const OpenEdge& edge = verdict.edges[i];
            const auto known = std::ranges::find(state.decisions, edge.key, &EdgeDecision::key);
            if (known != state.decisions.end()) {
                if (known->side == edge.insideSide) continue;
                add(std::move(state), nominal);
                return;
            }
            mark(state, edge.tie ? kOracleTie : kOracleSnap);
            SampleState outside = state;
            outside.decisions.push_back({edge.key, !edge.insideSide});
            add(std::move(outside), nominal && !edge.nominalInside);
            state.decisions.push_back({edge.key, edge.insideSide});
            nominal = nominal && edge.nominalInside;
        }
        splitOff(state, nominal, verdict.openAsWhole, verdict.nominalAsWhole, kOracleSnap);
        splitOff(state, nominal, verdict.cutOpen, verdict.cutNominal, kOracleSnap);
        splitOff(state, nominal, input_.coverageOpen, true, kOraclePattern);
        splitOff(state, nominal, input_.fragment->discardOpen, !input_.fragment->discarded, OracleFlag{});
        if (input_.fragment->discarded && !input_.fragment->discardOpen) {
            add(std::move(state), nominal);
            return;
        }
        testAndWrite(std::move(state), nominal);
    }

    Sample take() { return states_.take(); }

  private:
    // The uncovered alternative of an open question goes its own way.
    void splitOff(SampleState& state, bool& nominal, bool open, bool covered, OracleFlag reason) {
        if (!open) return;
        mark(state, reason);
        add(state, nominal && !covered);
        nominal = nominal && covered;
    }

    void testAndWrite(SampleState state, bool nominal) {
        const ScenePipeline& pipeline = *output_.pipeline;
        const VkStencilOpState& stencil = input_.frontFacing ? pipeline.front : pipeline.back;
        const bool stencilTest = pipeline.stencilTest && output_.depthFormat && output_.depthFormat->stencil;
        const bool depthTest = pipeline.depthTest && output_.depthFormat && output_.depthFormat->depth;
        if (pipeline.depthBoundsTest && output_.depthFormat && output_.depthFormat->depth) {
            const Interval low(static_cast<double>(pipeline.minDepthBounds)),
                high(static_cast<double>(pipeline.maxDepthBounds));
            const Answer above = compareDepth(VK_COMPARE_OP_GREATER_OR_EQUAL, state.depth, low, false),
                         below = compareDepth(VK_COMPARE_OP_LESS_OR_EQUAL, state.depth, high, false);
            const bool mustFail = (!above.value && !above.open) || (!below.value && !below.open);
            if (mustFail) {
                add(std::move(state), nominal);
                return;
            }
            splitOff(state, nominal, above.open || below.open, above.value && below.value, kOracleOrder);
        }
        if (stencilTest) {
            const auto masked = [&stencil](uint32_t v) { return static_cast<double>(v & stencil.compareMask & 0xff); };
            if (!holds(stencil.compareOp, masked(stencil.reference), masked(state.stencil))) {
                updateStencil(stencil, stencil.failOp, state);
                add(std::move(state), nominal);
                return;
            }
        }
        Interval depth = input_.fragment->depth.value_or(input_.depth);
        if (pipeline.depthClamp) {
            const auto [low, high] = std::minmax(input_.viewport.minDepth, input_.viewport.maxDepth);
            depth = depth.clamped(low, high);
        }
        if (output_.depthFormat && output_.depthFormat->depth)
            depth = quantise(output_.depthFormat->components[0], depth);
        Answer passes{true, false};
        if (depthTest) {
            const bool same =
                input_.depthOrigin != 0 && input_.depthOrigin == state.depthOrigin && !input_.fragment->depth;
            passes = compareDepth(pipeline.depthCompare, depth, state.depth, same);
        }
        if (passes.open) mark(state, kOracleOrder);
        if (passes.open || !passes.value) {
            SampleState failed = state;
            if (stencilTest) updateStencil(stencil, stencil.depthFailOp, failed);
            add(std::move(failed), nominal && !passes.value);
        }
        if (passes.open || passes.value) {
            if (stencilTest) updateStencil(stencil, stencil.passOp, state);
            if (depthTest && pipeline.depthWrite) {
                state.depth = depth;
                state.depthOrigin = input_.fragment->depth ? 0 : input_.depthOrigin;
                state.flags[kDepthFlags] &= static_cast<OracleFlags>(~kOracleUnknown);
            }
            writeColors(output_, *input_.fragment, state);
            add(std::move(state), nominal && passes.value);
        }
    }

    void add(SampleState state, bool nominal) { states_.add(std::move(state), nominal); }

    const OutputState& output_;
    const SampleInput& input_;
    StateSet states_;
};

}  // namespace

void FragmentResult::unite(const FragmentResult& other) {
    const bool had = !discarded || discardOpen;  // else there are no outputs
    discardOpen = discardOpen || other.discardOpen || discarded != other.discarded;
    if (other.discarded && !other.discardOpen) return;
    for (size_t i = 0; i < colors.size(); ++i) {
        for (size_t c = 0; c < 4; ++c)
            colors[i][c] = had ? colors[i][c].united(other.colors[i][c]) : other.colors[i][c];
        colorFlags[i] |= other.colorFlags[i];
    }
    if (source1 && other.source1) {
        for (size_t c = 0; c < 4; ++c) (*source1)[c] = (*source1)[c].united((*other.source1)[c]);
    }
    if (depth && other.depth) depth = depth->united(*other.depth);
}

bool SampleState::sameContents(const SampleState& other) const {
    return stencil == other.stencil && depth == other.depth && depthOrigin == other.depthOrigin &&
           flags == other.flags && colors == other.colors;
}

void addAlternatives(Sample& sample, const Sample& others, OracleFlags reasons) {
    const auto isIn = [&sample](const SampleState& other) {
        return std::ranges::any_of(sample, [&](const SampleState& each) { return each.sameContents(other); });
    };
    if (std::ranges::all_of(others, isIn)) return;
    StateSet states;
    bool nominal = true;
    for (const Sample* each : {static_cast<const Sample*>(&sample), &others}) {
        for (SampleState state : *each) {
            mark(state, reasons);
            states.add(std::move(state), std::exchange(nominal, false));
        }
    }
    sample = states.take();
}

void applyTriangle(const OutputState& output, const SampleInput& input, Sample& sample) {
    Splitter splitter(output, input);
    for (size_t i = 0; i < sample.size(); ++i) splitter.process(sample[i], i == 0);
    sample = splitter.take();
}

}  // namespace vernier::conformance::exact
