#include "api/vulkan/plan_cache.h"

#include <algorithm>
#include <string_view>

namespace vernier::vulkan {
namespace {

/// So many plans of a pipeline are kept: a program that gives every draw a sample mask of its own, say, must not fill
/// the memory with them.
constexpr size_t kMostPlans = 1024;

/// The state of a draw in words, as far as it is dynamic. On the stack: a draw whose state changed makes one.
class KeyWords {
  public:
    template <class T>
    void add(const T& value) {
        words_[count_++] = static_cast<uint32_t>(value);
    }
    std::span<const uint32_t> words() const { return {words_.data(), count_}; }

  private:
    static constexpr size_t kScalars = 64;
    static constexpr size_t kBlendWords = 8 * kMaxColorAttachments;
    static constexpr size_t kInputWords = 5 * kMaxVertexBindings + 4 * kMaxVertexAttributes;
    std::array<uint32_t, kScalars + kBlendWords + kInputWords> words_;
    size_t count_ = 0;
};

/// Calls visit(a member of `from`, the same of `to`) for all that the states name but vertex input; `to` may be `from`.
template <class To, class Visit>
void visitState(PlanStates states, const GraphicsState& from, To& to, Visit&& visit) {
    const auto has = [states](PlanState state) { return (states & planStateBit(state)) != 0; };
#define VERNIER_PLAN_STATE(name, member, part) \
    if (has(PlanState::name)) visit(from.member, to.member);
#include "api/vulkan/plan_states.def"
#undef VERNIER_PLAN_STATE
    if (has(PlanState::STENCIL_OP)) {
        for (const auto face : {&GraphicsState::stencilFront, &GraphicsState::stencilBack}) {
            visit((from.*face).failOp, (to.*face).failOp);
            visit((from.*face).passOp, (to.*face).passOp);
            visit((from.*face).depthFailOp, (to.*face).depthFailOp);
            visit((from.*face).compareOp, (to.*face).compareOp);
        }
    }
    for (uint32_t n = 0; n < kMaxColorAttachments; ++n) {
        const VkPipelineColorBlendAttachmentState& a = from.blend[n];
        auto& b = to.blend[n];
        if (has(PlanState::COLOR_BLEND_ENABLE_EXT)) visit(a.blendEnable, b.blendEnable);
        if (has(PlanState::COLOR_WRITE_MASK_EXT)) visit(a.colorWriteMask, b.colorWriteMask);
        if (!has(PlanState::COLOR_BLEND_EQUATION_EXT)) continue;
        visit(a.srcColorBlendFactor, b.srcColorBlendFactor);
        visit(a.dstColorBlendFactor, b.dstColorBlendFactor);
        visit(a.colorBlendOp, b.colorBlendOp);
        visit(a.srcAlphaBlendFactor, b.srcAlphaBlendFactor);
        visit(a.dstAlphaBlendFactor, b.dstAlphaBlendFactor);
        visit(a.alphaBlendOp, b.alphaBlendOp);
    }
}

void addVertexInput(const GraphicsState& state, KeyWords& key) {
    key.add(state.vertexBindings.size());
    for (const VkVertexInputBindingDescription& binding : state.vertexBindings) {
        key.add(binding.binding);
        key.add(binding.stride);
        key.add(binding.inputRate);
        key.add(state.instanceDivisors[binding.binding]);
    }
    for (const VkVertexInputAttributeDescription& attribute : state.vertexAttributes) {
        key.add(attribute.location);
        key.add(attribute.binding);
        key.add(attribute.format);
        key.add(attribute.offset);
    }
}

}  // namespace

PlanStates planStateBit(VkDynamicState state) {
    switch (state) {
#define VERNIER_PLAN_STATE(name, member, part) \
    case VK_DYNAMIC_STATE_##name:              \
        return planStateBit(PlanState::name);
#include "api/vulkan/plan_states.def"
        VERNIER_PLAN_STATE(STENCIL_OP, , )
        VERNIER_PLAN_STATE(COLOR_BLEND_ENABLE_EXT, , )
        VERNIER_PLAN_STATE(COLOR_BLEND_EQUATION_EXT, , )
        VERNIER_PLAN_STATE(COLOR_WRITE_MASK_EXT, , )
        VERNIER_PLAN_STATE(VERTEX_INPUT_EXT, , )
        VERNIER_PLAN_STATE(VERTEX_INPUT_BINDING_STRIDE, , )
#undef VERNIER_PLAN_STATE
        default:
            return 0;
    }
}

size_t PlanCache::Hash::operator()(std::span<const uint32_t> words) const {
    return std::hash<std::string_view>()({reinterpret_cast<const char*>(words.data()), words.size_bytes()});
}

bool PlanCache::Equal::operator()(std::span<const uint32_t> a, std::span<const uint32_t> b) const {
    return std::ranges::equal(a, b);
}

GraphicsState PlanCache::stateOf(const SetState& set, const SubpassFormats& formats) const {
    GraphicsState state = desc_.state;
    const auto isDynamic = [this](PlanState one) { return (desc_.dynamic & planStateBit(one)) != 0; };
    visitState(desc_.dynamic, set.state, state, [](const auto& from, auto& to) { to = from; });
    if (isDynamic(PlanState::VERTEX_INPUT_EXT)) {
        state.vertexBindings = set.state.vertexBindings;
        state.vertexAttributes = set.state.vertexAttributes;
        state.instanceDivisors = set.state.instanceDivisors;
    }
    if (isDynamic(PlanState::VERTEX_INPUT_BINDING_STRIDE)) {
        for (auto& binding : state.vertexBindings) binding.stride = set.strides[binding.binding];
    }
    if (!isDynamic(PlanState::DEPTH_CLIP_ENABLE_EXT) && desc_.clipsUnlessClamped) {
        state.depthClipEnable = !state.depthClampEnable;
    }
    // "If there is no depth attachment, then the depth test is skipped": whatever the state says.
    if (!desc_.hasDepth || formats.depth == VK_FORMAT_UNDEFINED) {
        state.depthTest = state.depthWrite = state.depthBoundsTest = false;
    }
    if (!desc_.hasStencil || formats.stencil == VK_FORMAT_UNDEFINED) state.stencilTest = false;
    if (formats.depthStencil() == VK_FORMAT_UNDEFINED) state.depthStencilFormat = VK_FORMAT_UNDEFINED;
    return state;
}

Result<std::shared_ptr<const GraphicsPipeline>> PlanCache::find(const SetState& set, const SubpassFormats& formats) {
    const bool aspectsThere = (!desc_.hasDepth || formats.depth != VK_FORMAT_UNDEFINED) &&
                              (!desc_.hasStencil || formats.stencil != VK_FORMAT_UNDEFINED);
    if (desc_.dynamic == 0 && aspectsThere) return desc_.example;
    KeyWords key;
    key.add((formats.depth != VK_FORMAT_UNDEFINED ? 1 : 0) + (formats.stencil != VK_FORMAT_UNDEFINED ? 2 : 0));
    visitState(desc_.dynamic, set.state, set.state, [&key](const auto& value, const auto&) { key.add(value); });
    if ((desc_.dynamic & planStateBit(PlanState::VERTEX_INPUT_EXT)) != 0) addVertexInput(set.state, key);
    if ((desc_.dynamic & planStateBit(PlanState::VERTEX_INPUT_BINDING_STRIDE)) != 0) {
        for (const uint32_t stride : set.strides) key.add(stride);
    }
    const std::lock_guard lock(mutex_);
    if (const auto found = plans_.find(key.words()); found != plans_.end()) return found->second;
    auto made = GraphicsPipeline::create({stateOf(set, formats), desc_.program});
    if (!made) return made.error();
    if (plans_.size() >= kMostPlans) plans_.clear();
    plans_.emplace(Key(key.words().begin(), key.words().end()), *made);
    return made;
}

}  // namespace vernier::vulkan
