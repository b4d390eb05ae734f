// Machine code before register allocation: the operations of ops.def on virtual registers. lower.h makes it
// from the IR, allocate.h gives its registers rows, encode.h turns it into Insts.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "spirv_interp/batch/bytecode.h"

namespace vernier::batch {

inline constexpr uint32_t kNone = ~0u;

struct Operand {
    enum class Kind : uint8_t { none, row, scalar, accumulator, mask, label, number };
    Kind kind = Kind::none;
    uint8_t word = 0;      // of a wide register: 1 = high
    bool written = false;  // a row or scalar that the operation writes
    uint32_t id = 0;  // virtual register (of an accumulator: the one it stands for), scalar, mask slot, label or number

    static Operand read(uint32_t reg, uint8_t word = 0) { return {Kind::row, word, false, reg}; }
    static Operand write(uint32_t reg, uint8_t word = 0) { return {Kind::row, word, true, reg}; }
    static Operand scalar(uint32_t index) { return {Kind::scalar, 0, false, index}; }
    static Operand writeScalar(uint32_t index) { return {Kind::scalar, 0, true, index}; }
    static Operand mask(uint32_t slot) { return {Kind::mask, 0, false, slot}; }
    static Operand label(uint32_t index) { return {Kind::label, 0, false, index}; }
    static Operand number(uint32_t value) { return {Kind::number, 0, false, value}; }
    bool isRow() const { return kind == Kind::row; }
    bool isScalar() const { return kind == Kind::scalar; }
};

struct MachineInst {
    Op op = Op::end;
    uint8_t form = 0;
    bool inPlace = true;  // may write a row in the place of one it reads
    bool dead = false;    // a move that coalescing made needless
    std::vector<Operand> operands;
    std::vector<Operand> hidden;  // rows reached through a side table (image sites, indexed inputs)
    uint32_t line = 0;
};

/// A register of `lanes` words, or two of them for 64-bit values.
struct VirtualRegister {
    bool wide = false;
    /// Header of the innermost loop whose every round defines the register anew; kNone outside loops. A
    /// register that is alive somewhere in a loop that is not its own must survive all rounds of it.
    uint32_t loop = kNone;
    uint32_t phiOf = kNone;  // header of the loop whose phi it is
};

struct MachineLoop {
    uint32_t header = 0;          // IR block
    uint32_t parent = kNone;      // header of the next loop out
    uint32_t begin = 0, end = 0;  // positions of its first and last instruction
    uint32_t backEdges = 0;
};

struct MachineCode {
    std::vector<MachineInst> insts;
    std::vector<VirtualRegister> registers;
    std::vector<MachineLoop> loops;     // outer before inner
    std::vector<uint32_t> labels;       // position
    uint32_t masks = 1;                 // slots
    std::vector<uint32_t> inputs;       // by Program::inputs: register, or kNone
    std::vector<uint32_t> outputs;      // by Program::outputs: register, or kNone
    std::vector<ImageSite> imageSites;  // rows not filled in yet
    uint32_t indexedRows = 0;           // length of the table of indexed inputs
};

/// Calls function(field) for every row of an image site, in the order of MachineInst::hidden.
template <class F>
void forEachRow(ImageSite& site, F&& function) {
    function(site.imageIndex);
    function(site.samplerIndex);
    for (uint32_t& row : site.coord) function(row);
    function(site.dref);
    function(site.lodOrBias);
    for (uint32_t& row : site.ddx) function(row);
    for (uint32_t& row : site.ddy) function(row);
    for (uint32_t& row : site.offset) function(row);
    function(site.sample);
    function(site.minLod);
    for (uint32_t& row : site.texel) function(row);
    for (uint32_t& row : site.result) function(row);
}

/// The words that are the same for a whole draw: constants, and values the draw-rate code leaves.
class ScalarFile {
  public:
    /// The index of a constant; `wide` takes two neighbouring words.
    uint32_t constant(uint64_t bits, bool wide);
    /// A place for a value of the draw-rate code.
    uint32_t reserve(bool wide);
    const std::vector<uint32_t>& initial() const { return words_; }
    bool isConstant(uint32_t index) const { return constant_[index]; }

  private:
    std::vector<uint32_t> words_;
    std::vector<bool> constant_;
};

}  // namespace vernier::batch
