// run: an invocation, or the work-groups of a dispatch, on the batch engine and on the reference interpreter.
#include <bit>
#include <cstdio>
#include <cstring>
#include <memory>

#include "spirv_interp/tool/reference_run.h"
#include "spirv_interp/tool/tool.h"

namespace vernier::tool {
namespace {

using reference::InterfaceVariable;
using reference::ScalarKind;

/// Built-ins that both sides know by scalar.
constexpr std::pair<ir::Builtin, spv::BuiltIn> kBuiltins[] = {
    {ir::Builtin::vertexIndex, spv::BuiltInVertexIndex},   {ir::Builtin::instanceIndex, spv::BuiltInInstanceIndex},
    {ir::Builtin::baseVertex, spv::BuiltInBaseVertex},     {ir::Builtin::baseInstance, spv::BuiltInBaseInstance},
    {ir::Builtin::drawIndex, spv::BuiltInDrawIndex},       {ir::Builtin::position, spv::BuiltInPosition},
    {ir::Builtin::pointSize, spv::BuiltInPointSize},       {ir::Builtin::clipDistance, spv::BuiltInClipDistance},
    {ir::Builtin::cullDistance, spv::BuiltInCullDistance}, {ir::Builtin::fragCoord, spv::BuiltInFragCoord},
    {ir::Builtin::frontFacing, spv::BuiltInFrontFacing},   {ir::Builtin::pointCoord, spv::BuiltInPointCoord},
    {ir::Builtin::sampleId, spv::BuiltInSampleId},         {ir::Builtin::samplePosition, spv::BuiltInSamplePosition},
    {ir::Builtin::primitiveId, spv::BuiltInPrimitiveId},   {ir::Builtin::fragDepth, spv::BuiltInFragDepth},
};

std::string scalarText(ScalarKind kind, uint32_t word) {
    char text[40];
    if (kind == ScalarKind::float32) {
        std::snprintf(text, sizeof text, "%.9g", static_cast<double>(std::bit_cast<float>(word)));
    } else if (kind == ScalarKind::boolean) {
        return word != 0 ? "true" : "false";
    } else if (kind == ScalarKind::uint32) {
        std::snprintf(text, sizeof text, "%u", word);
    } else {
        std::snprintf(text, sizeof text, "%d", static_cast<int32_t>(word));
    }
    return text;
}

/// The words of every output, by the place that the reference interpreter gives it.
struct Outputs {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> locations;  // location, component
    std::map<std::pair<spv::BuiltIn, uint32_t>, uint32_t> builtins;
    bool discarded = false;
};

void print(const char* engine, const reference::Module& module, size_t entry, const Outputs& outputs) {
    std::printf("%s:%s\n", engine, outputs.discarded ? " discarded" : "");
    if (outputs.discarded) return;
    for (const InterfaceVariable& variable : module.interfaceVariables(entry)) {
        if (!variable.output) continue;
        std::string values;
        for (uint32_t k = 0; k < variable.components * variable.columns * variable.elements; ++k) {
            uint32_t word = 0;
            if (variable.isBuiltin) {
                const auto found = outputs.builtins.find({variable.builtin, k});
                if (found == outputs.builtins.end()) continue;
                word = found->second;
            } else {
                const auto found = outputs.locations.find(
                    {variable.location + k / variable.components, variable.component + k % variable.components});
                if (found == outputs.locations.end()) continue;
                word = found->second;
            }
            values += " " + scalarText(variable.kind, word);
        }
        if (!values.empty()) std::printf("  %s =%s\n", variableName(variable).c_str(), values.c_str());
    }
}

void printBuffers(const Invocation& before, const Invocation& after) {
    for (const auto& [place, bytes] : after.buffers) {
        const auto& old = before.buffers.at(place);
        if (bytes == old) continue;
        std::printf("  buffer %u.%u:\n", place.first, place.second);
        for (size_t at = 0; at + 4 <= bytes.size(); at += 4) {
            uint32_t word = 0;
            std::memcpy(&word, bytes.data() + at, 4);
            if (std::memcmp(old.data() + at, bytes.data() + at, 4) == 0) continue;
            std::printf("    [%zu] %.9g  %d  0x%08x\n", at / 4, static_cast<double>(std::bit_cast<float>(word)),
                        static_cast<int32_t>(word), word);
        }
    }
}

/// Wide scalars have a place of 64 bits and are left out: outputs of the graphics stages that this prints are 32 bits.
Result<Outputs> onReference(const ModuleInput& input, const reference::Module& module, size_t entry,
                            Invocation& invocation) {
    reference::Options options;
    options.stepwise = true;
    const auto outcome = runReference<float>(input, module, invocation, options);
    if (!outcome) return outcome.error();
    Outputs outputs;
    outputs.discarded = outcome->discarded;
    for (const InterfaceVariable& variable : module.interfaceVariables(entry)) {
        if (!variable.output) continue;
        const auto word = [&](const reference::Scalar<float>& s) {
            return variable.kind == ScalarKind::float32 ? std::bit_cast<uint32_t>(s.number)
                                                        : static_cast<uint32_t>(s.bits);
        };
        for (const auto& [builtin, scalars] : outcome->outputs.builtins) {
            if (!variable.isBuiltin || builtin != variable.builtin) continue;
            for (uint32_t k = 0; k < scalars.size(); ++k) outputs.builtins[{builtin, k}] = word(scalars[k]);
        }
        for (const auto& [location, texel] : outcome->outputs.locations) {
            const uint32_t last = variable.location + variable.locations;
            if (variable.isBuiltin || location.location < variable.location || location.location >= last) continue;
            for (uint32_t c = variable.component; c < variable.component + variable.components && c < 4; ++c) {
                outputs.locations[{location.location, c}] = word(texel[c]);
            }
        }
    }
    return outputs;
}

/// The descriptors of a program over the buffers of an invocation.
struct Bindings {
    std::vector<BufferBinding> buffers;
    std::vector<ImageBinding> images;
    std::vector<const void*> samplers;
    std::vector<uint32_t> base, count;

    Bindings(const ir::Program& program, Invocation& invocation) {
        for (const ir::Resource& r : program.resources) {
            const bool isPush = r.kind == ir::ResourceKind::pushConstants;
            const bool isBuffer =
                isPush || r.kind == ir::ResourceKind::uniformBuffer || r.kind == ir::ResourceKind::storageBuffer;
            const uint32_t descriptors = r.kind == ir::ResourceKind::workgroupMemory ? 0 : std::max(1u, r.arraySize);
            count.push_back(descriptors);
            base.push_back(static_cast<uint32_t>(isBuffer                              ? buffers.size()
                                                 : r.kind == ir::ResourceKind::sampler ? samplers.size()
                                                                                       : images.size()));
            for (uint32_t k = 0; k < descriptors; ++k) {
                if (!isBuffer) {
                    // Unbound: reads give 0.
                    if (r.kind == ir::ResourceKind::sampler) samplers.push_back(nullptr);
                    if (r.kind != ir::ResourceKind::sampler) images.push_back({});
                    continue;
                }
                const auto found = invocation.buffers.find({r.set, r.binding});
                std::vector<std::byte>* bytes = isPush                              ? &invocation.pushConstants
                                                : found != invocation.buffers.end() ? &found->second
                                                                                    : nullptr;
                buffers.push_back(bytes == nullptr || k > 0
                                      ? BufferBinding{}
                                      : BufferBinding{bytes->data(), static_cast<uint32_t>(bytes->size())});
            }
        }
    }
    ResourceBindings get() const {
        ResourceBindings bindings;
        bindings.buffers = buffers.data();
        bindings.images = images.data();
        bindings.samplers = samplers.data();
        bindings.base = base.data();
        bindings.count = count.data();
        bindings.combine = [](const ImageBinding& image, const void*) { return image; };
        return bindings;
    }
};

uint32_t inputWord(const ir::InterfaceSlot& slot, const reference::InterfaceValues<float>& values) {
    const auto word = [&](const reference::Scalar<float>& s) {
        if (slot.type == ir::Type::f32) return std::bit_cast<uint32_t>(s.number);
        return slot.type == ir::Type::b1 ? (s.bits != 0 ? ~0u : 0u) : static_cast<uint32_t>(s.bits);
    };
    if (slot.builtin == ir::Builtin::user) {
        const auto found = values.locations.find({slot.location, slot.index});
        return found == values.locations.end() ? 0 : word(found->second[slot.component]);
    }
    for (const auto& [ours, theirs] : kBuiltins) {
        const auto found = values.builtins.find(theirs);
        if (ours != slot.builtin || found == values.builtins.end()) continue;
        return slot.component < found->second.size() ? word(found->second[slot.component]) : 0;
    }
    return 0;
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
    const auto values = interfaceValues<float>(invocation, module, entry);
    if (!values) return values.error();
    BatchContext context(*compiled);
    context.beginDraw(bindings.get());
    for (uint32_t slot = 0; slot < program->inputs.size(); ++slot) {
        auto* row = reinterpret_cast<uint32_t*>(context.input(slot));
        for (uint32_t lane = 0; row != nullptr && lane < 4; ++lane)
            row[lane] = inputWord(program->inputs[slot], *values);
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
        if (output.builtin == ir::Builtin::user) outputs.locations[{output.location, output.component}] = row[0];
        for (const auto& [ours, theirs] : kBuiltins)
            if (ours == output.builtin) outputs.builtins[{theirs, output.component}] = row[0];
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
        const auto outputs =
            batch ? onBatch(input, *module, entry, own, options.tier) : onReference(input, *module, entry, own);
        if (!outputs) return outputs.error();
        print(engine, *module, entry, *outputs);
        printBuffers(invocation, own);
    }
    return 0;
}

}  // namespace vernier::tool
