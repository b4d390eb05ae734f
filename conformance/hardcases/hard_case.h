// Numeric hard cases as data: small scenes whose right answer is known exactly, and the judges that know it. A case
// runs on any driver; what a driver may do is decided by exact arithmetic, never by another driver's picture.
//
// Case ids are those of the project's catalogue of numeric hard cases, a letter for the group and a number; numbers go
// on behind it for what stages and types that came later can do.
#pragma once

#include "base/result.h"
#include "conformance/hardcases/declared.h"
#include "conformance/scene/scene.h"

#include <array>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::conformance::hardcases {

/// How a driver stands to a case, in rising order of severity.
/// X(name, what the table says)
#define VERNIER_OUTCOMES(X)                                                                                            \
    X(exact, "exact: the exact answer in the nearest code, everywhere")                                                \
    X(declared, "declared: not the nearest, but within bounds of the driver's own, narrower than the specification's") \
    X(allowed, "allowed: another answer that the specification permits")                                               \
    X(unsupported, "unsupported: the driver lacks what the case needs")                                                \
    X(wrong, "wrong: an answer that the specification does not permit")                                                \
    X(crashed, "crashed: the driver's process died or hung")

enum class Outcome : uint8_t {
#define VERNIER_ENUMERATOR(name, text) name,
    VERNIER_OUTCOMES(VERNIER_ENUMERATOR)
#undef VERNIER_ENUMERATOR
};
inline constexpr size_t kOutcomeCount = static_cast<size_t>(Outcome::crashed) + 1;

std::string_view outcomeName(Outcome outcome);
std::string_view outcomeText(Outcome outcome);

/// An outcome and, unless it is `exact`, where and why: the first wrong pixel, its exact value, the cause.
struct Verdict {
    Outcome outcome = Outcome::exact;
    std::string witness;

    static Verdict wrong(std::string witness) { return {Outcome::wrong, std::move(witness)}; }
    static Verdict declared(std::string witness) { return {Outcome::declared, std::move(witness)}; }
    static Verdict allowed(std::string witness) { return {Outcome::allowed, std::move(witness)}; }
    static Verdict unsupported(std::string witness) { return {Outcome::unsupported, std::move(witness)}; }

    /// Not exact: permitted or not.
    static Verdict inexact(bool permitted, std::string witness) {
        return {permitted ? Outcome::allowed : Outcome::wrong, std::move(witness)};
    }

    /// The more severe of the two; the first one when they are equal.
    Verdict worse(const Verdict& other) const { return other.outcome > outcome ? other : *this; }
};

/// The outputs of one scene.
using Drawn = std::vector<RenderedImage>;

/// One question to the images of some of the case's scenes.
struct Judge {
    std::vector<size_t> scenes;  // which images `ask` gets, in this order
    std::function<Verdict(std::span<const Drawn* const> images, const Declared& declared)> ask;
};

/// The scenes of a case and who judges them.
class CaseInput {
  public:
    /// Adds a scene and returns its index. An error is kept and makes the case fail as a whole.
    size_t scene(Result<Scene> scene);
    void judge(std::vector<size_t> scenes, decltype(Judge::ask) ask) { judges_.push_back({std::move(scenes), ask}); }

    const std::vector<Scene>& scenes() const { return scenes_; }
    const std::vector<Judge>& judges() const { return judges_; }
    const Status& status() const { return status_; }

  private:
    std::vector<Scene> scenes_;
    std::vector<Judge> judges_;
    Status status_;
};

/// Something that was read in a driver's source and never run. The case's outcome on that driver decides it: one as bad
/// as `seenAs` or worse confirms it, a better one strikes it out.
struct Candidate {
    std::string_view driver;  // as on the command line: "lavapipe", "swiftshader"
    std::string_view claim;
    Outcome seenAs = Outcome::wrong;
};

struct HardCase {
    std::string_view id;     // e.g. "E01"
    std::string_view title;  // the input, in a few words
    std::string_view rule;   // the exact answer and why
    std::string_view
        source;  // where the rule comes from: a section of the Vulkan specification, or a promise of Vernier's
    void (*build)(CaseInput& input) = nullptr;
    std::string_view unreachable{};  // why this renderer cannot run it; then there is no `build`
    std::vector<Candidate> candidates{};

    char group() const { return id.front(); }
};

/// A group's letter and what it is about.
struct CaseGroup {
    char letter;
    std::string_view title;
    std::span<const HardCase> cases;
};

/// All groups in the order of the catalogue.
std::span<const CaseGroup> caseGroups();

/// The case called `id`, or nullptr.
const HardCase* findCase(std::string_view id);

}  // namespace vernier::conformance::hardcases
