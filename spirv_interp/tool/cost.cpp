// cost: what an invocation has to do, by kind of operation and by source line.
#include <array>
#include <cstdio>
#include <map>

#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/rates.h"
#include "spirv_interp/tool/tool.h"

namespace vernier::tool {
namespace {

enum class Kind : uint8_t { arithmetic, division, elementary, wide, memory, image, control, moves };
constexpr std::array<const char*, 8> kKindNames = {
    "arithmetic", "division, square root", "elementary functions", "64-bit", "memory", "images",
    "control",    "constants, inputs"};
/// Rough weights in additions of one batch, chosen by hand; bench/micro/interp_cost measures single operations.
constexpr std::array<double, 8> kWeights = {1, 1.5, 4, 12, 4, 40, 2, 0};

Kind kindOf(const ir::Inst& inst) {
    using ir::Op;
    const ir::OpInfo& info = ir::opInfo(inst.op);
    if (info.kind == 'T') return Kind::control;
    if (inst.op == Op::image || inst.op == Op::imageStore) return Kind::image;
    if (info.kind == 'R' || info.kind == 'S') return Kind::memory;
    if (inst.op <= Op::copy) return Kind::moves;
    if (ir::isWide(inst.type)) return Kind::wide;
    if (inst.op == Op::fdiv || inst.op == Op::fsqrt || inst.op == Op::frem || inst.op == Op::fmod) {
        return Kind::division;
    }
    return inst.op >= Op::finverseSqrt && inst.op <= Op::fpow ? Kind::elementary : Kind::arithmetic;
}

struct Tally {
    std::array<uint32_t, kKindNames.size()> counts{};
    double weight = 0;
    bool inLoop = false;

    void add(Kind kind, bool loop) {
        ++counts[static_cast<size_t>(kind)];
        weight += kWeights[static_cast<size_t>(kind)];
        inLoop = inLoop || loop;
    }
};

}  // namespace

Result<int> printCost(const ModuleInput& input, const IrOptions& options) {
    const auto program = input.program(options.contract);
    if (!program) return program.error();
    const auto compiled = BatchProgram::compile(*program, {bestIsa(), MathTier::standard, 0});
    if (!compiled) return compiled.error();
    const std::vector<ir::Rate> rates = ir::computeRates(*program);
    Tally perInvocation, perDraw;
    std::map<uint32_t, Tally> byLine;
    uint32_t loopEnd = 0;
    for (uint32_t b = 0; b < program->blocks.size(); ++b) {
        const ir::Block& block = program->blocks[b];
        if (block.loopHeader) loopEnd = std::max(loopEnd, block.loopEnd);
        for (const ir::Inst& inst : block.insts) {
            const Kind kind = kindOf(inst);
            const bool once = inst.result != ir::kNoValue && ir::isUniform(rates[inst.result]);
            (once ? perDraw : perInvocation).add(kind, b < loopEnd);
            if (!once) byLine[inst.line].add(kind, b < loopEnd);
        }
    }
    std::printf("%-24s %12s %12s\n", "operations of the IR", "invocation", "draw");
    for (size_t k = 0; k < kKindNames.size(); ++k) {
        if (perInvocation.counts[k] + perDraw.counts[k] == 0) continue;
        std::printf("%-24s %12u %12u\n", kKindNames[k], perInvocation.counts[k], perDraw.counts[k]);
    }
    std::printf("%-24s %12.1f %12.1f   in additions%s\n\n", "estimate", perInvocation.weight, perDraw.weight,
                perInvocation.inLoop ? "; loop bodies counted once (*)" : "");
    for (const auto& [line, tally] : byLine) {
        if (tally.weight == 0) continue;
        const std::string place = line == 0 ? "no line" : "line " + std::to_string(line);
        std::printf("%8.1f%s %-10s %s\n", tally.weight, tally.inLoop ? "*" : " ", place.c_str(),
                    input.sourceLine(line).c_str());
    }
    const BatchStatistics& s = (*compiled)->statistics();
    std::printf("\nbatch: %u lanes, %u registers, %u operations; once per draw %u, once per work-group %u\n", s.lanes,
                s.registers, s.instructions, s.drawRateInstructions, s.workGroupRateInstructions);
    if (options.listing) std::fputs((*compiled)->disassemble().c_str(), stdout);
    return 0;
}

}  // namespace vernier::tool
