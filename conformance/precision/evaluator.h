// Runs a function of the table: through batch programs compiled from GLSL, and as a compute shader of a Vulkan driver.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/result.h"
#include "conformance/precision/function.h"

namespace vernier::precision {

/// operands[k][i] is operand k of the i-th call; results has as many elements.
using Operands = std::array<std::vector<float>, kMaxOperands>;

/// A function compiled for one tier. Immutable; thread-safe.
class BatchFunction {
  public:
    static Result<BatchFunction> compile(const Function& function, MathTier tier, Isa isa);
    const std::shared_ptr<const BatchProgram>& program() const { return program_; }
    /// The input row of operand k; kNoSlot if the program does not read it.
    static constexpr uint32_t kNoSlot = ~0u;
    uint32_t slot(uint32_t operand) const { return slots_[operand]; }

  private:
    std::shared_ptr<const BatchProgram> program_;
    std::array<uint32_t, kMaxOperands> slots_{};
};

/// The registers of one thread for a function. Not thread-safe.
class BatchRunner {
  public:
    explicit BatchRunner(const BatchFunction& function);
    void run(const Operands& operands, std::span<float> results);

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
    Status run(const Function& function, const Operands& operands, std::span<float> results);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vernier::precision
