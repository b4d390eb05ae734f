// loadShader and checkModule of program.h: validation by SPIRV-Tools, then the lowering.
#include "spirv_interp/capture.h"
#include "spirv_interp/front/lower_module.h"
#include "spirv_interp/front/lowering.h"
#include "spirv_interp/front/spirv_tools.h"
#include "spirv_interp/ir/analyse.h"
#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/ir/verify.h"

namespace vernier {
namespace {

/// Vulkan 1.1 takes SPIR-V up to 1.3, and later versions by extension and with later core versions.
spv_target_env environmentOf(uint32_t version) {
    if (version > 0x00010500) return SPV_ENV_VULKAN_1_3;
    if (version > 0x00010400) return SPV_ENV_VULKAN_1_2;
    return version > 0x00010300 ? SPV_ENV_VULKAN_1_1_SPIRV_1_4 : SPV_ENV_VULKAN_1_1;
}

/// The names of ids in messages take longer to make than the rest of the validation: they are for modules that are
/// known to be wrong.
Status validate(std::span<const uint32_t> words, bool names) {
    const SpirvContext context(spvContextCreate(environmentOf(words[1])));
    // What features of the device may allow and every program can have: LocalSizeId (maintenance4) and any layout of
    // blocks.
    const SpirvValidatorOptions options(spvValidatorOptionsCreate());
    spvValidatorOptionsSetAllowLocalSizeId(options.get(), true);
    spvValidatorOptionsSetRelaxBlockLayout(options.get(), true);
    spvValidatorOptionsSetUniformBufferStandardLayout(options.get(), true);
    spvValidatorOptionsSetScalarBlockLayout(options.get(), true);
    spvValidatorOptionsSetWorkgroupScalarBlockLayout(options.get(), true);
    spvValidatorOptionsSetFriendlyNames(options.get(), names);
    spv_diagnostic told = nullptr;
    spv_const_binary_t binary{words.data(), words.size()};
    const spv_result_t status = spvValidateWithOptions(context.get(), options.get(), &binary, &told);
    const SpirvDiagnostic diagnostic(told);
    if (status == SPV_SUCCESS) return {};
    std::string message = "SPIR-V: the module is not valid";
    if (diagnostic) {
        message += ": ";
        message += diagnostic->error;
        message += " (at word " + std::to_string(diagnostic->position.index) + ")";
    }
    return invalidArgument(std::move(message));
}

/// The module with the capabilities declared that stand for built-in variables alone: some compilers use those without
/// (Mesa's Zink: SampleId, ViewportIndex), and every program can have them.
std::vector<uint32_t> withBuiltinCapabilities(const std::vector<uint32_t>& words) {
    std::vector<uint32_t> more(words.begin(), words.begin() + Module::kFirstInstruction);
    for (const auto capability :
         {spv::Capability::Geometry, spv::Capability::MultiViewport, spv::Capability::SampleRateShading}) {
        more.push_back(2u << 16 | static_cast<uint32_t>(spv::Op::OpCapability));
        more.push_back(static_cast<uint32_t>(capability));
    }
    more.insert(more.end(), words.begin() + Module::kFirstInstruction, words.end());
    return more;
}

}  // namespace

Status checkModule(std::span<const uint32_t> words) {
    if (words.size() < Module::kFirstInstruction)
        return invalidArgument("SPIR-V: the module is shorter than its header");
    return validate(words, false).ok() ? Status() : validate(words, true);
}

Result<ir::Program> lowerModule(const ShaderSource& source) {
    CaptureLayout ignored;
    return lowerModule(source, ignored);
}

Result<ir::Program> lowerModule(const ShaderSource& source, CaptureLayout& capture) {
    Result<Module> module = Module::read(source.words);
    if (!module) return module.error();
    ir::Program program;
    try {
        Lowering lowering(*module, source, program);
        lowering.run();
        capture = lowering.capture();
    } catch (const LoweringError& error) {
        return error.error;
    }
    return program;
}

Result<ir::Program> lowerAnyModule(const ShaderSource& source) {
    Result<ir::Program> program = lowerModule(source);
    if (!program) return program;
    ir::removeUnreachable(*program);
    ir::analyse(*program);
    if (const Status verified = ir::verify(*program, ir::LoopForm::open); !verified) return verified.error();
    return program;
}

Result<ValidatedModule> ValidatedModule::create(std::vector<uint32_t> words) {
    const Status valid = checkModule(words);
    if (valid.ok()) return ValidatedModule(std::move(words));
    if (words.size() < Module::kFirstInstruction) return valid.error();
    std::vector<uint32_t> more = withBuiltinCapabilities(words);
    if (!validate(more, false).ok()) return valid.error();
    return ValidatedModule(std::move(more));
}

Result<ir::Program> loadShader(const ShaderSource& source) {
    CaptureLayout ignored;
    return loadShader(source, ignored);
}

Result<ir::Program> loadShader(const ShaderSource& given, CaptureLayout& capture) {
    ShaderSource source = given;
    if (source.module != nullptr) {
        source.words = source.module->words();
    } else if (const Status valid = checkModule(source.words); !valid) {
        return valid.error();
    }
    Result<ir::Program> program = lowerModule(source, capture);
    if (!program) return program;
    ir::optimise(*program, {.contract = source.contract});
    if (const Status verified = ir::verify(*program); !verified) return verified.error();
    return program;
}

}  // namespace vernier
