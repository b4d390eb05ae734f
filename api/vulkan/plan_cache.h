// The plans of a pipeline whose state is partly dynamic: a plan is made for each combination of state that draws meet,
// once, and looked up from then on. Pipelines without such state have one plan and no cache.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "api/vulkan/render_pass.h"
#include "runtime/limits.h"
#include "runtime/plan/pipeline.h"

namespace vernier::vulkan {

/// Dynamic state that plans depend on.
enum class PlanState : uint8_t {
#define VERNIER_PLAN_STATE(name, member, part) name,
#include "api/vulkan/plan_states.def"
#undef VERNIER_PLAN_STATE
    STENCIL_OP,
    COLOR_BLEND_ENABLE_EXT,
    COLOR_BLEND_EQUATION_EXT,
    COLOR_WRITE_MASK_EXT,
    VERTEX_INPUT_EXT,
    VERTEX_INPUT_BINDING_STRIDE,
};

/// A set of PlanState.
using PlanStates = uint64_t;
constexpr PlanStates planStateBit(PlanState state) {
    return PlanStates{1} << static_cast<uint32_t>(state);
}
/// 0 for dynamic state that is no PlanState.
PlanStates planStateBit(VkDynamicState state);

/// What commands have set, whether or not the pipeline asks for it.
struct SetState {
    GraphicsState state;
    std::array<uint32_t, kMaxVertexBindings> strides{};  // by binding
    uint32_t viewportCount = 1;
};

class PlanCache {
  public:
    struct Desc {
        GraphicsState state;  // what is dynamic of it does not count
        std::shared_ptr<const ShaderProgram> program;
        std::shared_ptr<const GraphicsPipeline> example;  // of the state as it is here
        PlanStates dynamic = 0;
        /// Without a depth clip state of its own a pipeline clips where it does not clamp.
        bool clipsUnlessClamped = true;
        bool hasDepth = false, hasStencil = false;  // aspects of the attachment that the pipeline was made for
    };
    explicit PlanCache(Desc desc) : desc_(std::move(desc)) {}

    /// The plan for this state in a pass of these attachments. Thread-safe. A plan stays alive as long as somebody
    /// holds it; the cache forgets its plans when there are too many.
    Result<std::shared_ptr<const GraphicsPipeline>> find(const SetState& set, const SubpassFormats& formats);

  private:
    using Key = std::vector<uint32_t>;
    struct Hash {
        using is_transparent = void;
        size_t operator()(std::span<const uint32_t> words) const;
    };
    struct Equal {
        using is_transparent = void;
        bool operator()(std::span<const uint32_t> a, std::span<const uint32_t> b) const;
    };

    GraphicsState stateOf(const SetState& set, const SubpassFormats& formats) const;

    Desc desc_;
    std::mutex mutex_;  // of what follows
    std::unordered_map<Key, std::shared_ptr<const GraphicsPipeline>, Hash, Equal> plans_;
};

}  // namespace vernier::vulkan
