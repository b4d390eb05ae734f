// validate, disassemble, ir, rates.
#include <array>
#include <cstdio>

#include "spirv_interp/front/lower_module.h"
#include "spirv_interp/front/spirv_tools.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/rates.h"
#include "spirv_interp/tool/tool.h"

namespace vernier::tool {

Result<int> validate(const ModuleInput& input) {
    if (const Status status = checkModule(input.words); !status.ok()) {
        std::printf("%s: %s\n", input.path.c_str(), status.error().message.c_str());
        return 1;
    }
    std::printf("%s: valid, %zu words\n", input.path.c_str(), input.words.size());
    const auto program = loadShader(input.shader());
    if (!program) {
        std::printf("%s: %s\n", input.path.c_str(), program.error().message.c_str());
        return 1;
    }
    std::printf("%s: can be run, entry point \"%s\"\n", input.path.c_str(), input.entryPoint.c_str());
    return 0;
}

Result<int> disassemble(const ModuleInput& input) {
    const SpirvContext context(spvContextCreate(SPV_ENV_UNIVERSAL_1_6));
    spv_text made = nullptr;
    spv_diagnostic told = nullptr;
    constexpr uint32_t kOptions = SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES | SPV_BINARY_TO_TEXT_OPTION_INDENT;
    const spv_result_t result =
        spvBinaryToText(context.get(), input.words.data(), input.words.size(), kOptions, &made, &told);
    const SpirvText text(made);
    const SpirvDiagnostic diagnostic(told);
    if (result != SPV_SUCCESS) {
        return invalidArgument(diagnostic ? diagnostic->error : "the module cannot be disassembled");
    }
    std::fwrite(text->str, 1, text->length, stdout);
    return 0;
}

Result<int> printIr(const ModuleInput& input, const IrOptions& options) {
    if (!options.passes && options.after.empty()) {
        const auto program = loadShader(input.shader(options.contract));
        if (!program) return program.error();
        std::fputs(ir::print(*program).c_str(), stdout);
        return 0;
    }
    if (const Status status = checkModule(input.words); !status.ok()) return status.error();
    auto program = lowerModule(input.shader(options.contract));
    if (!program) return program.error();
    bool found = false;
    const ir::PassObserver observer = [&](std::string_view pass, const ir::Program& after) {
        if (!options.after.empty() && pass != options.after) return;
        found = true;
        std::printf("; after %.*s\n%s\n", static_cast<int>(pass.size()), pass.data(), ir::print(after).c_str());
    };
    ir::optimise(*program, {options.contract, &observer});
    if (!found) std::printf("; %s changes nothing\n", options.after.c_str());
    return 0;
}

Result<int> printRates(const ModuleInput& input) {
    const auto program = input.program();
    if (!program) return program.error();
    const auto compiled = BatchProgram::compile(*program, {bestIsa(), MathTier::standard, 0});
    if (!compiled) return compiled.error();
    const std::vector<ir::Rate> rates = ir::computeRates(*program);
    std::array<uint32_t, ir::kRateCount> counts{};
    for (const ir::Block& block : program->blocks) {
        for (const ir::Inst& inst : block.insts) {
            if (inst.result == ir::kNoValue) continue;
            const ir::Rate rate = rates[inst.result];
            counts[static_cast<size_t>(rate)] += ir::opInfo(inst.op).results;
            std::printf("%-10s  %s\n", std::string(ir::rateName(rate)).c_str(),
                        ir::printInst(*program, block, inst).c_str());
        }
    }
    std::printf("\nvalues by rate:");
    for (size_t k = 0; k < counts.size(); ++k) {
        if (counts[k] == 0) continue;
        std::printf(" %s %u", std::string(ir::rateName(static_cast<ir::Rate>(k))).c_str(), counts[k]);
    }
    const BatchStatistics& s = (*compiled)->statistics();
    std::printf("\nbatch: %u lanes, %u registers (%u bytes), %u operations; once per draw %u, once per work-group %u\n",
                s.lanes, s.registers, s.registers * s.lanes * 4, s.instructions, s.drawRateInstructions,
                s.workGroupRateInstructions);
    return 0;
}

}  // namespace vernier::tool
