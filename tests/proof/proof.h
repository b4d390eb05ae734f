// Holds the batch interpreter against the reference interpreter: one shader, one world, every instruction set, every
// batch width, several mask shapes; what comes out must be the same bits.
//
// The rules of comparison:
//  - two NaNs are equal whatever their sign and payload (SPIR-V leaves them open, and which operand's NaN an addition
//    hands on is the compiler's choice); in memory a word, or half of one, counts as a float when both sides hold a NaN
//    there;
//  - elementary functions (sin ... pow) are the tier's own: the reference interpreter is given them through
//    ElementaryFunctions, so that programs stay comparable to the bit after any number of operations. How far they are
//    from the truth is measured elsewhere, against MPFR;
//  - functions that the specification describes by an expression are that expression (reference Options::stepwise);
//  - everything else is equal to the bit.
// An output component that the reference never wrote is undefined and not compared.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "spirv_interp/program.h"
#include "spirv_interp/reference/interpreter.h"
#include "tests/proof/world.h"

namespace vernier::proof {

using Words = std::vector<uint32_t>;

struct SpecConstant {
    uint32_t id = 0;
    uint32_t value = 0;
};

/// A shader and its surroundings.
struct Case {
    std::string name;
    Words words;
    ir::Stage stage = ir::Stage::fragment;
    std::vector<SpecConstant> specialization;
    uint32_t invocations = 64;                // all but compute: a multiple of 4; control: of patches
    std::array<uint32_t, 3> groups{1, 1, 1};  // compute
    World world;
};

/// Which invocations run, and which of them have effects.
struct Shape {
    std::string name;
    std::vector<bool> exec, store;
};
/// All, one alone, every other quad, the first few, and random ones with helpers among them. Of a compute shader, whose
/// work-groups are always whole: none.
std::vector<Shape> maskShapes(const Case& subject);

/// What one run leaves behind.
struct Ending {
    // By slot of the program, by invocation. Of a geometry program for every vertex that there may be, one vertex after
    // the other, and the last is how many there are. Of a control program, the invocations are patches.
    std::vector<std::vector<uint32_t>> outputs;
    std::vector<std::vector<bool>> written;  // likewise; all true after a run by batches
    std::vector<bool> live;                  // has effects and was not discarded
    std::unique_ptr<Memory> memory;
    std::string error;  // empty: the run ended well
};

/// Of Ending::outputs.
size_t outputCount(const ir::Program& program);
const ir::InterfaceSlot& outputAt(const ir::Program& program, size_t output);
/// Of an input slot, so that the vertices of a primitive differ.
uint32_t invocationOfInput(const ir::Program& program, const ir::InterfaceSlot& slot, uint32_t invocation);

struct Program {
    ir::Program ir;
    std::string error;  // empty: lowered
};
Program lower(const Case& subject);

Ending runReference(const Case& subject, const ir::Program& interface, const Shape& shape, MathTier tier);
Ending runBatch(const Case& subject, const ir::Program& program, const Shape& shape, const BatchOptions& options);

struct ProofOptions {
    std::vector<uint32_t> lanes{16, 32, 64, 128};
    MathTier tier = MathTier::standard;
    bool allShapes = true;  // false: all invocations only
};

/// Runs everything and returns the differences in words, at most a few of each run; empty when the proof holds. A
/// shader that either side refuses is a difference.
std::string differences(const Case& subject, const ProofOptions& options = {});

/// What differs between two endings, at most `limit` lines.
std::string compare(const ir::Program& program, const Shape& shape, const Ending& expected, const Ending& got,
                    size_t limit = 4);

}  // namespace vernier::proof
