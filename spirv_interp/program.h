// The door of spirv_interp: SPIR-V words in, programs that run on batches of lanes out. Everything a pipeline needs is
// here and in ir/ir.h (reflection) and resources.h (descriptors).
//
//   Result<ir::Program> a = loadShader({words, "main", Stage::vertex, specialization});   // validated, lowered
//   ir::linkStages(a, b)                                                                   // ir/link.h: drop dead
//   varyings Result<std::shared_ptr<const BatchProgram>> p = BatchProgram::compile(a, {isa, MathTier::standard});
//   BatchContext context(*p);              // per thread
//   context.beginDraw(bindings);           // runs draw-rate code once
//   fill context.input(slot)[lane] ...; context.run(lanes, execMask, storeMask); read context.output(slot)[lane]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/simd.h"
#include "spirv_interp/ir/ir.h"
#include "spirv_interp/resources.h"

namespace vernier {

/// Accuracy of transcendental functions, division and square root; see docs/precision.md.
enum class MathTier : uint8_t { fast, standard, fine, reference };

struct Specialization {
    struct Entry {
        uint32_t constantId = 0;
        uint32_t offset = 0;  // bytes into data
        uint32_t size = 0;    // bytes
    };
    std::span<const Entry> entries;
    std::span<const std::byte> data;
};

/// The words of a module that SPIRV-Tools has found valid (Vulkan 1.1 rules), once for all programs made from it. More
/// words than were given: it used built-in variables whose capabilities it did not declare, now it does. Immutable.
class ValidatedModule {
  public:
    /// Thread-safe. Defined in front/.
    static Result<ValidatedModule> create(std::vector<uint32_t> words);
    /// Of words that create() has taken as they are before; whoever says so answers for it.
    static ValidatedModule known(std::vector<uint32_t> words) { return ValidatedModule(std::move(words)); }
    std::span<const uint32_t> words() const { return words_; }

  private:
    explicit ValidatedModule(std::vector<uint32_t> words) : words_(std::move(words)) {}
    std::vector<uint32_t> words_;
};

struct ShaderSource {
    std::span<const uint32_t> words;
    std::string entryPoint = "main";
    ir::Stage stage = ir::Stage::vertex;
    Specialization specialization;
    bool contract = false;                    // fuse a * b + c where NoContraction does not forbid it
    const ValidatedModule* module = nullptr;  // instead of `words`: not validated again
};

/// Validates the module unless it comes validated, specialises it, lowers the entry point to the IR, removes dead
/// code and verifies the result. An instruction or capability that is not supported is an ErrorCode::unsupported whose
/// message names it. Thread-safe. Defined in front/.
Result<ir::Program> loadShader(const ShaderSource& source);

/// Validation alone.
Status checkModule(std::span<const uint32_t> words);

struct BatchOptions {
    Isa isa = kLowestIsa;
    MathTier tier = MathTier::standard;
    uint32_t lanes = 0;  // at most so many (16, 32, 64 or 128); the instruction set may allow fewer. 0: all it allows
    uint32_t backEdges = 1u << 24;  // budget per lane and run: a loop that goes on for longer loses the device
    /// Where to count how often each block of the batch code is run, for measurements: the listing names the blocks
    /// (countBlock), and those beyond the end of this are not counted. Running is then not thread-safe.
    std::span<uint64_t> blockRuns{};
    bool verified = false;  // the program is as loadShader or linkStages left it, and not verified once more
};

struct BatchStatistics {
    uint32_t instructions = 0;  // per batch
    uint32_t drawRateInstructions = 0;
    uint32_t registers = 0;  // of `lanes` 32-bit words each
    uint32_t lanes = 0;
    uint32_t workGroupRateInstructions = 0;  // per work-group, for what is the same in all of it
};

class BatchContext;

/// A program ready to run: bytecode and register assignment. Immutable and shared between threads.
class BatchProgram {
  public:
    virtual ~BatchProgram() = default;
    /// `program` must verify and be in loop-closed form. Thread-safe. Defined in batch/.
    static Result<std::shared_ptr<const BatchProgram>> compile(ir::Program program, const BatchOptions& options);

    virtual const ir::Program& source() const = 0;
    virtual const BatchStatistics& statistics() const = 0;
    virtual std::string disassemble() const = 0;
    uint32_t lanes() const { return statistics().lanes; }
};

/// The registers of one thread for one program. Not thread-safe; cheap to keep between draws.
class BatchContext {
  public:
    explicit BatchContext(std::shared_ptr<const BatchProgram> program);
    ~BatchContext();
    BatchContext(BatchContext&&) noexcept;
    BatchContext& operator=(BatchContext&&) noexcept;

    /// Names the resources of the draws to come and evaluates everything that cannot change inside a draw. The bindings
    /// must stay alive and their read-only contents unchanged until the next beginDraw.
    void beginDraw(const ResourceBindings& bindings);

    /// The lanes of input `slot` (index into Program::inputs), `lanes()` 32-bit words, 64-byte aligned. nullptr when
    /// the compiled program does not read it. run() may overwrite the lanes: fill them again before every run.
    float* input(uint32_t slot);

    /// Runs `lanes` lanes (a multiple of 4, at most BatchProgram::lanes()). `execMask`: ~0 for every lane that runs,
    /// helpers included; `storeMask`: ~0 for every lane whose effects count (a subset). Both have room for
    /// BatchProgram::lanes() words; lanes beyond `lanes` may be computed but have no effects.
    /// Both nullptr: all `lanes` run and have effects. Returns false if a loop passed the back-edge budget
    /// (BatchOptions::backEdges): the device is lost.
    bool run(uint32_t lanes, const uint32_t* execMask, const uint32_t* storeMask);

    /// After run(): the lanes of output `slot`; lanes that were not live hold arbitrary bits.
    const float* output(uint32_t slot) const;

    /// The memory of the program's resources of the kind stageMemory, one after the other. run() leaves what it does
    /// not write.
    uint32_t* stageMemory();
    const uint32_t* stageMemory() const;

    /// After run(): storeMask less the lanes that were killed or demoted.
    const uint32_t* liveMask() const;

    /// Centroid/sample/offset interpolation asks its caller back; set by the backend before run() when the program has
    /// such instructions. `where`: 0 centroid, 1 sample (a = i32 sample), 2 offset (a = x, b = y in pixels).
    struct Interpolator {
        void* self = nullptr;
        void (*at)(void* self, uint32_t slot, uint32_t where, uint32_t lanes, const float* a, const float* b,
                   float* result) = nullptr;
    };
    void setInterpolator(const Interpolator& interpolator);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Runs the work-groups of a dispatch, one thread's share of them. A work-group is as many batches as its invocations
/// need; at a barrier each batch keeps its registers while the others come up to it. Work-groups without barriers,
/// shared memory and subgroup operations may share a batch. Not thread-safe; cheap to keep between dispatches.
class WorkGroupContext {
  public:
    explicit WorkGroupContext(std::shared_ptr<const BatchProgram> program);
    ~WorkGroupContext();
    WorkGroupContext(WorkGroupContext&&) noexcept;
    WorkGroupContext& operator=(WorkGroupContext&&) noexcept;

    struct Grid {
        std::array<uint32_t, 3> count{1, 1, 1};  // NumWorkgroups
        std::array<uint32_t, 3> base{0, 0, 0};   // added to WorkgroupId, as vkCmdDispatchBase wants it
        uint64_t size() const { return uint64_t{count[0]} * count[1] * count[2]; }
    };

    /// As BatchContext::beginDraw. Resources of the kind workgroupMemory have no binding: the context owns the memory.
    void beginDispatch(const ResourceBindings& bindings, const Grid& grid);

    /// Runs the work-groups first .. first + count - 1 in linear order, x fastest, z slowest; first + count <=
    /// Grid::size(). Returns false if a loop passed the back-edge budget: the device is lost.
    bool run(uint64_t first, uint32_t count);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vernier
