// run: an invocation, or the work-groups of a dispatch, on the batch engine and on the reference interpreter.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <memory>
#include <tuple>

#include "spirv_interp/ir/primitive_inputs.h"
#include "spirv_interp/reference/module_data.h"
#include "spirv_interp/reference/number_ops.h"
#include "spirv_interp/tool/bindings.h"
#include "spirv_interp/tool/reference_run.h"
#include "spirv_interp/tool/scalar_text.h"
#include "spirv_interp/tool/tool.h"

namespace vernier::tool {
namespace {

using reference::InterfaceVariable;
using reference::ScalarKind;

/// Built-ins that both sides know by scalar.
constexpr std::pair<ir::Builtin, spv::BuiltIn> kBuiltins[] = {
    {ir::Builtin::vertexIndex, spv::BuiltInVertexIndex},
    {ir::Builtin::instanceIndex, spv::BuiltInInstanceIndex},
    {ir::Builtin::baseVertex, spv::BuiltInBaseVertex},
    {ir::Builtin::baseInstance, spv::BuiltInBaseInstance},
    {ir::Builtin::drawIndex, spv::BuiltInDrawIndex},
    {ir::Builtin::position, spv::BuiltInPosition},
    {ir::Builtin::pointSize, spv::BuiltInPointSize},
    {ir::Builtin::clipDistance, spv::BuiltInClipDistance},
    {ir::Builtin::cullDistance, spv::BuiltInCullDistance},
    {ir::Builtin::fragCoord, spv::BuiltInFragCoord},
    {ir::Builtin::frontFacing, spv::BuiltInFrontFacing},
    {ir::Builtin::pointCoord, spv::BuiltInPointCoord},
    {ir::Builtin::sampleId, spv::BuiltInSampleId},
    {ir::Builtin::samplePosition, spv::BuiltInSamplePosition},
    {ir::Builtin::primitiveId, spv::BuiltInPrimitiveId},
    {ir::Builtin::fragDepth, spv::BuiltInFragDepth},
    {ir::Builtin::baryCoord, spv::BuiltInBaryCoordKHR},
    {ir::Builtin::baryCoordNoPersp, spv::BuiltInBaryCoordNoPerspKHR},
};

/// The words of inputs or outputs, by place; a scalar of 64 bits has two, one of less is held in one. Halves are
/// floats.
struct Words {
    std::map<std::tuple<uint32_t, uint32_t, uint32_t>, uint32_t> locations;  // location, index, component
    std::map<std::pair<spv::BuiltIn, uint32_t>, uint32_t> builtins;
};

struct Outputs {
    Words words;
    bool discarded = false;
};

template <class Number>
Words wordsOf(const reference::Module& module, size_t entry, bool output,
              const reference::InterfaceValues<Number>& values) {
    Words words;
    for (const InterfaceVariable& variable : module.interfaceVariables(entry)) {
        if (variable.output != output) continue;
        const auto word = [&](const reference::Scalar<Number>& s) {
            return isFloating(variable.kind) ? std::bit_cast<uint32_t>(static_cast<float>(s.number))
                                             : static_cast<uint32_t>(s.bits);
        };
        for (uint32_t k = 0; k < variable.scalars(); ++k) {
            if (variable.isBuiltin) {
                const auto found = values.builtins.find(variable.builtin);
                if (found == values.builtins.end() || k >= found->second.size()) break;
                words.builtins[{variable.builtin, k}] = word(found->second[k]);
                continue;
            }
            const auto at = variable.placeOf(k);
            const auto found = values.locations.find({at.location, variable.index});
            if (found == values.locations.end()) continue;
            const auto& scalar = found->second[at.component];
            uint32_t& low = words.locations[{at.location, variable.index, at.component}] = word(scalar);
            if (!isWide(variable.kind)) continue;
            uint32_t& high = words.locations[{at.location, variable.index, at.component + 1}];
            high = word(found->second[at.component + 1]);
            if (variable.kind != ScalarKind::float64) continue;
            const auto bits = std::bit_cast<uint64_t>(static_cast<double>(scalar.number));
            low = static_cast<uint32_t>(bits);
            high = static_cast<uint32_t>(bits >> 32);
        }
    }
    return words;
}

void print(const char* engine, const reference::Module& module, size_t entry, const Outputs& outputs) {
    std::printf("%s:%s\n", engine, outputs.discarded ? " discarded" : "");
    if (outputs.discarded) return;
    for (const InterfaceVariable& variable : module.interfaceVariables(entry)) {
        if (!variable.output) continue;
        std::string values;
        for (uint32_t k = 0; k < variable.scalars(); ++k) {
            uint64_t bits = 0;
            if (variable.isBuiltin) {
                const auto found = outputs.words.builtins.find({variable.builtin, k});
                if (found == outputs.words.builtins.end()) continue;
                bits = found->second;
            } else {
                const auto at = variable.placeOf(k);
                const auto found = outputs.words.locations.find({at.location, variable.index, at.component});
                if (found == outputs.words.locations.end()) continue;
                bits = found->second;
                const auto high = outputs.words.locations.find({at.location, variable.index, at.component + 1});
                if (isWide(variable.kind) && high != outputs.words.locations.end())
                    bits |= uint64_t{high->second} << 32;
            }
            if (variable.kind == ScalarKind::float16) {
                bits = reference::float32ToHalf(std::bit_cast<float>(static_cast<uint32_t>(bits)));
            }
            values += " " + scalarText(variable.kind, bits);
        }
        if (!values.empty()) std::printf("  %s =%s\n", variableName(variable).c_str(), values.c_str());
    }
}

/// In double with floats rounded where the module has doubles: floats do not hold them.
template <class Number>
Result<Outputs> onReference(const ModuleInput& input, const reference::Module& module, size_t entry,
                            Invocation& invocation) {
    reference::Options options;
    options.stepwise = true;
    options.roundToFloat = true;
    const auto outcome = runReference<Number>(input, module, invocation, options);
    if (!outcome) return outcome.error();
    return Outputs{wordsOf(module, entry, true, outcome->outputs), outcome->discarded};
}

bool hasDoubles(const reference::Module& module) {
    const auto& types = module.data().types;
    return std::any_of(types.begin(), types.end(), [](const reference::Type& type) {
        return type.kind == reference::TypeKind::floating && type.width == 64;
    });
}

uint32_t inputWord(const ir::InterfaceSlot& slot, const Words& words) {
    uint32_t word = 0;
    if (slot.builtin == ir::Builtin::user) {
        const uint32_t index = ir::isPerVertex(slot) ? ir::vertexNumber(slot) : slot.index;
        const auto found = words.locations.find({slot.location, index, slot.component});
        if (found != words.locations.end()) word = found->second;
    }
    for (const auto& [ours, theirs] : kBuiltins) {
        const auto found = words.builtins.find({theirs, slot.component});
        if (ours == slot.builtin && found != words.builtins.end()) word = found->second;
    }
    return slot.type != ir::Type::b1 ? word : word != 0 ? ~0u : 0u;
}

Result<Outputs> onBatch(const ModuleInput& input, const reference::Module& module, size_t entry, Invocation& invocation,
                        MathTier tier) {
    const auto program = loadShader(input.shader());
    if (!program) return program.error();
    const auto compiled = BatchProgram::compile(*program, {bestIsa(), tier, 0});
    if (!compiled) return compiled.error();
    const Bindings bindings(*program, invocation);
    Outputs outputs;
    const Error lost{ErrorCode::deviceLost, "the back-edge budget is used up: the loop does not end"};
    if (input.stage == ir::Stage::compute) {
        WorkGroupContext context(*compiled);
        const WorkGroupContext::Grid grid{invocation.groups, {0, 0, 0}};
        context.beginDispatch(bindings.get(), grid);
        if (!context.run(0, static_cast<uint32_t>(grid.size()))) return lost;
        return outputs;
    }
    const auto values = interfaceValues<double>(invocation, module, entry);
    if (!values) return values.error();
    const Words inputs = wordsOf(module, entry, false, *values);
    BatchContext context(*compiled);
    context.beginDraw(bindings.get());
    for (uint32_t slot = 0; slot < program->inputs.size(); ++slot) {
        auto* row = reinterpret_cast<uint32_t*>(context.input(slot));
        for (uint32_t lane = 0; row != nullptr && lane < 4; ++lane)
            row[lane] = inputWord(program->inputs[slot], inputs);
    }
    // A whole quad of the same invocation: all derivatives are 0, as on the reference interpreter.
    std::vector<uint32_t> exec((*compiled)->lanes()), store((*compiled)->lanes());
    for (uint32_t lane = 0; lane < 4; ++lane) exec[lane] = ~0u;
    store[0] = ~0u;
    if (!context.run(4, exec.data(), store.data())) return lost;
    outputs.discarded = context.liveMask()[0] == 0;
    for (uint32_t slot = 0; slot < program->outputs.size(); ++slot) {
        const ir::InterfaceSlot& output = program->outputs[slot];
        const auto* row = reinterpret_cast<const uint32_t*>(context.output(slot));
        if (row == nullptr) continue;
        if (output.builtin == ir::Builtin::user) {
            outputs.words.locations[{output.location, output.index, output.component}] = row[0];
        }
        for (const auto& [ours, theirs] : kBuiltins)
            if (ours == output.builtin) outputs.words.builtins[{theirs, output.component}] = row[0];
    }
    return outputs;
}

}  // namespace

Result<int> run(const ModuleInput& input, const Invocation& invocation, const RunOptions& options) {
    const auto module = reference::Module::parse(input.words);
    if (!module) return module.error();
    const size_t entry = entryPointIndex(*module, input);
    for (const bool batch : {true, false}) {
        const char* engine = batch ? "batch" : "reference";
        if (options.engine != "both" && options.engine != engine) continue;
        Invocation own = invocation;
        const auto outputs = batch                 ? onBatch(input, *module, entry, own, options.tier)
                             : hasDoubles(*module) ? onReference<double>(input, *module, entry, own)
                                                   : onReference<float>(input, *module, entry, own);
        if (!outputs) return outputs.error();
        print(engine, *module, entry, *outputs);
        printChanges(*module, invocation, own);
    }
    return 0;
}

}  // namespace vernier::tool
