// What a sample may hold. Wherever the specification leaves an answer open (an edge within snapping freedom,
// a depth test within its budget) the sample splits into the states that legal implementations can be in;
// every state goes on through the per-sample operations by itself. States remember on which side of an edge
// they have put the sample, so that two triangles at a shared edge never both cover it and never both leave
// it.
#pragma once

#include "conformance/oracle/image_store.h"
#include "conformance/oracle/memory.h"
#include "conformance/oracle/triangle.h"
#include "conformance/oracle/word_writes.h"
#include "conformance/scene/scene.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vernier::conformance::exact {

inline constexpr size_t kMaxColorAttachments = 4;
inline constexpr size_t kDepthFlags = kMaxColorAttachments;  // index of the depth/stencil attachment's flags

struct EdgeDecision {
    uint64_t key;
    bool side;
    friend bool operator==(const EdgeDecision&, const EdgeDecision&) = default;
};

struct SampleState {
    std::array<Color, kMaxColorAttachments> colors{};
    Interval depth;
    uint64_t depthOrigin = 0;  // identity of the triangle that wrote the depth; 0: none
    uint8_t stencil = 0;
    std::array<OracleFlags, kMaxColorAttachments + 1> flags{};  // per attachment
    std::vector<EdgeDecision> decisions;

    bool sameContents(const SampleState& other) const;
};

/// The states a sample may be in; the first is the declared one.
using Sample = std::vector<SampleState>;

/// What the fragment shader left for one fragment.
struct FragmentResult {
    std::array<Color, kMaxColorAttachments> colors{};
    std::array<OracleFlags, kMaxColorAttachments> colorFlags{};  // of OracleFlag
    std::optional<Color> source1;                                // dual-source blending
    std::optional<Interval> depth;                               // FragDepth
    std::vector<TexelWrite> writes;                              // in the order of the shader
    std::vector<WordWrite> wordWrites;
    bool discarded = false, discardOpen = false;

    /// Lets it be what another one is, too.
    void unite(const FragmentResult& other);
};

/// State of a pass and a pipeline that per-sample operations need.
struct OutputState {
    const ScenePipeline* pipeline = nullptr;
    std::array<const PixelFormat*, kMaxColorAttachments> colorFormats{};
    size_t colorCount = 0;
    const PixelFormat* depthFormat = nullptr;
};

/// What one primitive brings to one sample.
struct SampleInput {
    SampleVerdict verdict;
    VkViewport viewport{};
    const FragmentResult* fragment = nullptr;
    Interval depth;  // window depth with bias, before clamping and storage
    uint64_t depthOrigin = 0;
    bool frontFacing = false;
    bool coverageOpen = false;  // alpha to coverage with alpha between 0 and 1
};

/// Adds what a sample may hold instead, for `reasons`; the declared state stays the first.
void addAlternatives(Sample& sample, const Sample& others, OracleFlags reasons);

/// Applies a triangle to a sample: coverage, stencil, depth, blending, in API order.
void applyTriangle(const OutputState& output, const SampleInput& input, Sample& sample);

}  // namespace vernier::conformance::exact
