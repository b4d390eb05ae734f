#include "spirv_interp/ir/print.h"

#include <cstdio>

#include "spirv_interp/ir/names.h"
#include "spirv_interp/ir/ops.h"

namespace vernier::ir {
namespace {

std::string number(uint64_t value) {
    return std::to_string(value);
}

std::string hex(uint64_t value) {
    char text[24];
    std::snprintf(text, sizeof text, "0x%llx", static_cast<unsigned long long>(value));
    return text;
}

void printSlot(std::string& out, const char* what, size_t index, const InterfaceSlot& slot, bool interpolated) {
    out += std::string(what) + " " + number(index) + " " + std::string(typeName(slot.type)) + " " +
           std::string(nameOf(slot.builtin)) + " " + number(slot.location) + "." + number(slot.component);
    if (slot.index != 0) out += "." + number(slot.index);
    if (interpolated) {
        out += " " + std::string(nameOf(slot.interpolation)) + " " + std::string(nameOf(slot.sampling));
    }
    out += "\n";
}

void printImageOp(std::string& out, size_t index, const ImageOp& op) {
    out += "imageOp " + number(index) + " " + std::string(nameOf(op.kind)) + " " + std::string(nameOf(op.dim)) +
           " image " + number(op.imageResource);
    if (op.samplerResource != kNoIndex) out += " sampler " + number(op.samplerResource);
    const auto counted = [&out](const char* word, uint32_t count) {
        if (count != 0) out += std::string(" ") + word + " " + number(count);
    };
    const auto flag = [&out](const char* word, bool set) {
        if (set) out += std::string(" ") + word;
    };
    counted("coords", op.coords);
    counted("gradients", op.gradients);
    counted("offsets", op.offsets);
    counted("component", op.component);
    flag("arrayed", op.arrayed);
    flag("multisampled", op.multisampled);
    flag("depthCompare", op.depthCompare);
    flag("bias", op.hasBias);
    flag("lod", op.hasLod);
    flag("sample", op.hasSample);
    flag("minLod", op.hasMinLod);
    if (op.kind == ImageKind::atomic) out += " " + std::string(nameOf(op.atomicOp));
    out += "\n";
}

void printFlags(std::string& out, const Program& program) {
    const std::pair<const char*, bool> flags[] = {{"earlyFragmentTests", program.earlyFragmentTests},
                                                  {"postDepthCoverage", program.postDepthCoverage},
                                                  {"usesQuads", program.usesQuads},
                                                  {"canDiscard", program.canDiscard},
                                                  {"writesDepth", program.writesDepth},
                                                  {"writesSampleMask", program.writesSampleMask},
                                                  {"hasSideEffects", program.hasSideEffects},
                                                  {"perSample", program.perSample},
                                                  {"hasBarriers", program.hasBarriers},
                                                  {"usesSubgroups", program.usesSubgroups}};
    std::string line;
    for (const auto& [name, set] : flags) {
        if (set) line += std::string(" ") + name;
    }
    if (!line.empty()) out += "facts" + line + "\n";
    if (program.localSize != std::array<uint32_t, 3>{1, 1, 1}) {
        out += "localSize " + number(program.localSize[0]) + " " + number(program.localSize[1]) + " " +
               number(program.localSize[2]) + "\n";
    }
    if (program.stage == Stage::geometry) {
        out += "geometry " + std::string(nameOf(program.geometry.input)) + " " +
               std::string(nameOf(program.geometry.output)) + " invocations " + number(program.geometry.invocations) +
               " vertices " + number(program.geometry.outputVertices) + "\n";
    }
    if (program.localWords != 0) out += "local " + number(program.localWords) + "\n";
}

}  // namespace

std::string printInst(const Program& program, const Block& block, const Inst& inst) {
    const OpInfo& info = opInfo(inst.op);
    std::string out;
    if (info.results != 0) {
        out += "%" + number(inst.result);
        if (info.results > 1) out += "..%" + number(static_cast<uint64_t>(inst.result) + info.results - 1);
    }
    if (inst.type != Type::none) out += (out.empty() ? "" : " ") + std::string(typeName(inst.type));
    if (!out.empty()) out += " = ";
    out += info.name;
    switch (immKind(inst.op)) {
        case ImmKind::none:
            break;
        case ImmKind::bits:
            out += " " + hex(inst.imm);
            break;
        case ImmKind::type:
            out +=
                "." + (inst.imm <= static_cast<uint64_t>(Type::f64) ? std::string(typeName(static_cast<Type>(inst.imm)))
                                                                    : number(inst.imm));
            break;
        case ImmKind::resource:
            out += " #" + (immLow(inst) == kNoIndex ? "any" : number(immLow(inst)));
            if (immHigh(inst) != 0) out += ":" + number(immHigh(inst));
            break;
        case ImmKind::pair:
            out += " #" + number(immLow(inst)) + ":" + number(immHigh(inst));
            break;
        default:
            out += " #" + number(inst.imm);
            break;
    }
    for (uint32_t i = 0; i < inst.operandCount && inst.firstOperand + i < program.operands.size(); ++i) {
        out += " %" + number(program.operands[inst.firstOperand + i]);
    }
    if (info.kind == 'T') {
        for (size_t i = 0; i < block.successors.size(); ++i) {
            const std::string target = "b" + number(block.successors[i]);
            const bool isCase = inst.op == Op::switchOn && i > 0 && i - 1 < block.cases.size();
            out += isCase ? " [" + std::to_string(block.cases[i - 1]) + ": " + target + "]" : " " + target;
        }
    }
    if (inst.noContraction) out += " !noContraction";
    if (inst.relaxed) out += " !relaxed";
    if (inst.line != 0) out += " @" + number(inst.line);
    if (inst.line != 0 && inst.file != 0) out += ":" + number(inst.file);
    return out;
}

std::string print(const Program& program) {
    std::string out = "program " + std::string(nameOf(program.stage)) + " \"" + program.name + "\"\n";
    for (size_t i = 0; i < program.inputs.size(); ++i) {
        printSlot(out, "input", i, program.inputs[i], program.stage == Stage::fragment);
    }
    for (size_t i = 0; i < program.outputs.size(); ++i) printSlot(out, "output", i, program.outputs[i], false);
    for (size_t i = 0; i < program.resources.size(); ++i) {
        const Resource& r = program.resources[i];
        out += "resource " + number(i) + " " + std::string(nameOf(r.kind)) + " " + number(r.set) + "." +
               number(r.binding) + " x" + number(r.arraySize);
        if (r.byteSize != 0) out += " bytes " + number(r.byteSize);
        if (r.aliased) out += " aliased";
        if (r.readOnly) out += " read";
        out += "\n";
    }
    for (size_t i = 0; i < program.imageOps.size(); ++i) printImageOp(out, i, program.imageOps[i]);
    for (size_t i = 1; i < program.files.size(); ++i) out += "file " + number(i) + " \"" + program.files[i] + "\"\n";
    printFlags(out, program);
    for (size_t b = 0; b < program.blocks.size(); ++b) {
        const Block& block = program.blocks[b];
        out += "b" + number(b);
        if (block.loopHeader) out += " loop b" + number(block.loopEnd);
        if (!block.predecessors.empty()) out += " <-";
        for (const BlockId p : block.predecessors) out += " b" + number(p);
        out += ":\n";
        for (const Inst& inst : block.insts) out += "  " + printInst(program, block, inst) + "\n";
    }
    return out;
}

}  // namespace vernier::ir
