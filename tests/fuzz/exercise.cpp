#include "tests/fuzz/exercise.h"

#include "spirv_interp/reference/interpreter.h"
#include "tests/proof/proof.h"

namespace vernier::proof {

void exercise(std::span<const uint32_t> words) {
    // These two take any words, valid or not.
    readModule(words);
    (void)reference::Module::parse(words);
    const bool valid = checkModule(words).ok();
    for (const ir::Stage stage : kStages) {
        Case subject;
        subject.words.assign(words.begin(), words.end());
        subject.stage = stage;
        subject.invocations = 16;
        subject.world.contents = {Filling::Kind::special, 0, 0};
        subject.world.inputs = {Filling::Kind::special, 0, 0};
        Program program;
        if (valid) {
            program = lower(subject);
            if (!program.error.empty()) continue;
        } else {
            Result<ir::Program> lowered = lowerUnvalidated(words, stage);
            if (!lowered) continue;
            program.ir = std::move(*lowered);
        }
        const Shape shape = maskShapes(subject).back();
        // Endless loops, which mutation makes many of, end soon.
        (void)runBatch(subject, program.ir, shape, {bestIsa(), MathTier::standard, 16, 2000});
    }
}

}  // namespace vernier::proof
