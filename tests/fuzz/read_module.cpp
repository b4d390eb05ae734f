// By itself, as the front end and the reference interpreter use different headers for SPIR-V's names.
#include "spirv_interp/front/module.h"

#include "tests/fuzz/exercise.h"

namespace vernier::proof {

void readModule(std::span<const uint32_t> words) {
    (void)vernier::Module::read(words);
}

}  // namespace vernier::proof
