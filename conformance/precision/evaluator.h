// Runs a function of the table: through batch programs compiled from GLSL, and as a compute shader of a Vulkan driver.
#pragma once

#include <memory>
#include <vector>

#include "base/result.h"
#include "conformance/precision/function.h"

namespace vernier::precision {

/// By word and call: operand k of the i-th call is operands[k][i], or of 64 bits, operands[2 * k][i] with the upper
/// half in the next row. Results likewise.
using Operands = std::array<std::vector<float>, kMaxOperands>;
using Results = std::array<std::vector<float>, 2>;

/// A function compiled for one tier. Immutable; thread-safe.
class BatchFunction {
  public:
    static Result<BatchFunction> compile(const Function& function, MathTier tier, Isa isa);
    const std::shared_ptr<const BatchProgram>& program() const { return program_; }
    /// The input row of a row of operands; kNoSlot if the program does not read it.
    static constexpr uint32_t kNoSlot = ~0u;
    uint32_t slot(uint32_t operand) const { return slots_[operand]; }
    /// Of results, and the output row of each.
    uint32_t words() const { return words_; }
    uint32_t output(uint32_t word) const { return outputs_[word]; }

  private:
    std::shared_ptr<const BatchProgram> program_;
    std::array<uint32_t, kMaxOperands> slots_{};
    std::array<uint32_t, 2> outputs_{};
    uint32_t words_ = 1;
};

/// The registers of one thread for a function. Not thread-safe.
class BatchRunner {
  public:
    explicit BatchRunner(const BatchFunction& function);
    void run(const Operands& operands, size_t calls, Results& results);

  private:
    const BatchFunction& function_;
    BatchContext context_;
    std::vector<uint32_t> mask_;
};

/// A Vulkan driver found through the loader.
class VulkanRunner {
  public:
    VulkanRunner();
    ~VulkanRunner();
    Status create();
    std::string name() const;
    Status run(const Function& function, const Operands& operands, size_t calls, Results& results);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vernier::precision
