// By itself, as the front end and the reference interpreter use different headers for SPIR-V's names.
#include "spirv_interp/front/module.h"

#include <cstdio>
#include <cstdlib>

#include "spirv_interp/front/lower_module.h"
#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/ir/verify.h"
#include "tests/fuzz/exercise.h"

namespace vernier::proof {

void readModule(std::span<const uint32_t> words) {
    (void)vernier::Module::read(words);
}

Result<ir::Program> lowerUnvalidated(std::span<const uint32_t> words, ir::Stage stage) {
    ShaderSource source;
    source.words = words;
    source.stage = stage;
    Result<ir::Program> program = lowerAnyModule(source);
    if (!program) return program;
    ir::optimise(*program, {});
    if (const Status verified = ir::verify(*program); !verified) {
        std::fprintf(stderr, "after the passes: %s\n", verified.error().message.c_str());
        std::abort();
    }
    return program;
}

}  // namespace vernier::proof
