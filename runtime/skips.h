// What a draw does not call for is left out, by the rules named here. None of them changes a bit of any picture; each
// can be switched off, which shows that, and what leaving out saves.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "base/result.h"

namespace vernier {

enum class Skip : uint8_t {
    unreadOutputs,      // vertex outputs that no fragment program reads, colours that no attachment keeps
    perVertexWork,      // work on flat inputs is done per vertex, not per pixel
    sharedSamples,      // what all samples of a pixel share is computed once
    idleState,          // tests, blending and logic operations that change nothing
    unkeptFragments,    // fragment programs whose results nobody keeps
    helperInvocations,  // of programs that take no derivatives
    hiddenWork,         // what later opaque primitives replace, cleared colours included
    coarseDepth,        // depth tests that the bounds of a block's depths decide
};

struct SkipRule {
    const char* name;     // "hidden_work"
    const char* meaning;  // what it leaves out
};
/// In the order of Skip.
std::span<const SkipRule> skipRules();

/// Which rules are in force: all, unless said otherwise.
class Skips {
  public:
    bool has(Skip rule) const { return (on_ >> static_cast<uint8_t>(rule) & 1) != 0; }
    void set(Skip rule, bool on) {
        const uint32_t bit = 1u << static_cast<uint8_t>(rule);
        on_ = on ? on_ | bit : on_ & ~bit;
    }
    bool all() const;
    bool operator==(const Skips&) const = default;

  private:
    uint32_t on_ = ~0u;
};

/// "on" or "" (all rules), "off" (none), or rules one by one: "hidden_work=off coarse_depth=off", with spaces or commas
/// between; those not named are on. The error names what is unknown and what is allowed.
Result<Skips> skipsFrom(std::string_view text);

}  // namespace vernier
