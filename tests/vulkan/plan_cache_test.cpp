// The plans of pipelines with dynamic state: looked up, and forgotten when there are too many.
#include "api/vulkan/plan_cache.h"

#include <gtest/gtest.h>

#include "spirv_interp/ir/parse.h"

namespace vernier::vulkan {
namespace {

std::shared_ptr<const ShaderProgram> vertexProgram() {
    const Result<ir::Program> vertex = ir::parse(R"(program vertex "main"
output 0 f32 position 0.0
b0:
  %0 f32 = constant 0x0
  storeOutput #0 %0
  ret
)");
    EXPECT_TRUE(vertex.ok()) << (vertex.ok() ? "" : vertex.error().message);
    ShaderProgramDesc desc;
    desc.vertex = &*vertex;
    const auto program = ShaderProgram::create(desc);
    EXPECT_TRUE(program.ok()) << (program.ok() ? "" : program.error().message);
    return *program;
}

TEST(PlanCache, forgetsPlansButNotThoseInUse) {
    PlanCache::Desc desc;
    desc.state.rasterizerDiscard = true;
    desc.program = vertexProgram();
    desc.dynamic = planStateBit(PlanState::SAMPLE_MASK_EXT);
    PlanCache cache(desc);
    SetState set;
    const auto find = [&](uint32_t mask) {
        set.state.sampleMask = mask;
        const auto plan = cache.find(set, {});
        EXPECT_TRUE(plan.ok()) << (plan.ok() ? "" : plan.error().message);
        return *plan;
    };
    const auto held = find(0);
    const std::weak_ptr<const GraphicsPipeline> watched = find(1);
    EXPECT_EQ(find(0), held);
    EXPECT_EQ(find(1), watched.lock());
    uint32_t mask = 2;
    while (!watched.expired() && mask < 100'000) (void)find(mask++);
    EXPECT_LT(mask, 100'000u) << "a program that gives every draw a state of its own fills the memory";
    EXPECT_GT(mask, 100u) << "programs with many states make plans again and again";
    EXPECT_EQ(held->state().sampleMask, 0u);
    const auto again = find(0);
    EXPECT_NE(again, held);
    EXPECT_EQ(again->state().sampleMask, 0u);
    EXPECT_EQ(find(0), again);
}

}  // namespace
}  // namespace vernier::vulkan
