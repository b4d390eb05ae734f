// What the shaders of one draw do to storage buffers, word by word: stores, and atomic operations whose order does not
// matter. Vulkan orders nothing among the invocations of a draw (Shader Memory Access Ordering), so that a word may
// hold what any of those that store to it left, and any of the sums that fragments which may or may not be there make.
#pragma once

#include "base/result.h"
#include "conformance/oracle/interval.h"
#include "conformance/oracle/memory.h"
#include "conformance/oracle/value_error.h"
#include "conformance/scene/scene.h"
#include "spirv_interp/reference/resources.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vernier::conformance::exact {

/// A word that one run of a shader stores, or combines with another by an atomic instruction.
struct RunWord {
    uint32_t buffer = 0;  // of the scene
    uint64_t offset = 0;  // into it
    WordKind kind = WordKind::unsignedInteger;
    spv::Op op = spv::OpStore;
    uint32_t invocation = 0;
    double number = 0;  // the value by its kind
};

/// The same of one invocation, with the range that its runs span.
struct WordWrite {
    uint32_t buffer = 0;
    uint64_t offset = 0;
    WordKind kind = WordKind::unsignedInteger;
    spv::Op op = spv::OpStore;
    Interval value;
    OracleFlags flags = 0;
    bool open = false;    // the invocation may not be there
    bool nominal = true;  // whether it is, by the declared rules
};

/// What one invocation does, in the order of the shader; of several stores to a word the last. The first run is the
/// nominal one, the last run the one that rounds. Where runs write other words, the result is unknown.
std::vector<WordWrite> combineWords(std::span<const std::vector<RunWord>> runs, uint32_t lane, const ValueError& error,
                                    OracleFlags flags);

/// Lets the writes of a draw happen. Refuses operations whose order matters, and words of other sizes than 32 bits.
Status applyWords(const Scene& scene, const std::vector<WordWrite>& writes, Memory& memory);

/// Whether doing it again changes nothing.
bool isIdempotent(spv::Op op);

/// Whether a module uses what its atomic operations return, which depends on their order.
bool usesAtomicResults(std::span<const uint32_t> module);

}  // namespace vernier::conformance::exact
