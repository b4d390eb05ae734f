// How much room transform feedback takes, and where it goes on.
#include "runtime/command/transform_feedback.h"

#include <gtest/gtest.h>

#include <vector>

namespace vernier {
namespace {

CapturePlan planOf(uint32_t buffer, uint32_t offset, uint32_t stride) {
    ir::InterfaceSlot slot;
    CaptureLayout layout;
    layout.words = {{slot, buffer, offset}};
    layout.strides[buffer] = stride;
    return planCapture(layout, {});
}

TEST(TransformFeedback, PlansWordsInTheirOrder) {
    ir::Program vertex;
    ir::InterfaceSlot slot;
    for (const uint16_t location : {7, 3}) {
        slot.location = location;
        vertex.outputs.push_back(slot);
    }
    CaptureLayout layout;
    layout.strides = {0, 24, 8, 0};
    slot.location = 3;
    layout.words.push_back({slot, 2, 4});
    layout.words.push_back({slot, 1, 16});
    slot.location = 7;
    layout.words.push_back({slot, 1, 0});
    slot.component = 1;  // never written
    layout.words.push_back({slot, 1, 8});
    const CapturePlan plan = planCapture(layout, vertex);
    ASSERT_EQ(plan.outputs.size(), 4u);
    const uint32_t expected[4][3] = {{0, 1, 0}, {ir::kNoIndex, 1, 8}, {1, 1, 16}, {1, 2, 4}};
    for (size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(plan.outputs[k].slot, expected[k][0]) << k;
        EXPECT_EQ(plan.outputs[k].buffer, expected[k][1]) << k;
        EXPECT_EQ(plan.outputs[k].offset, expected[k][2]) << k;
    }
    EXPECT_EQ(plan.extents, (std::array<uint32_t, kCaptureBuffers>{0, 20, 8, 0}));
}

TEST(TransformFeedback, DropsWhatDoesNotFit) {
    std::vector<std::byte> memory(100);
    TransformFeedback feedback;
    const CapturePlan plan = planOf(1, 4, 12);
    feedback.bind(1, memory.data(), memory.size());
    EXPECT_FALSE(feedback.active());
    feedback.begin();
    EXPECT_TRUE(feedback.active());
    CaptureTarget target = feedback.place(plan, 2, 3);
    EXPECT_EQ(target.primitives, 3u);
    EXPECT_EQ(target.data[1], memory.data());
    EXPECT_EQ(feedback.offset(1), 72u);
    // 28 bytes are left: two vertices with 8 of their 12 bytes each.
    target = feedback.place(plan, 2, 5);
    EXPECT_EQ(target.primitives, 1u);
    EXPECT_EQ(target.data[1], memory.data() + 72);
    EXPECT_EQ(feedback.offset(1), 96u);
    EXPECT_EQ(feedback.place(plan, 1, 1).primitives, 0u);
    EXPECT_EQ(feedback.offset(1), 96u);
    // From the begin again; and from a counter, which may say anything.
    feedback.end();
    feedback.begin();
    EXPECT_EQ(feedback.offset(1), 0u);
    feedback.resume(1, 92);
    EXPECT_EQ(feedback.place(plan, 1, 2).primitives, 1u);
    feedback.resume(1, 93);
    EXPECT_EQ(feedback.place(plan, 1, 1).primitives, 0u);
    feedback.resume(1, ~0u);
    EXPECT_EQ(feedback.place(plan, 1, ~uint64_t{0}).primitives, 0u);
    EXPECT_EQ(feedback.offset(1), ~0u);
}

TEST(TransformFeedback, GoesNoFurtherThanCountersCount) {
    std::byte first{};
    for (const uint32_t stride : {4u, 12u, 16u}) {
        TransformFeedback feedback;
        feedback.bind(0, &first, uint64_t{1} << 40);
        feedback.begin();
        const CapturePlan plan = planOf(0, 0, stride);
        EXPECT_EQ(feedback.place(plan, 1, uint64_t{1} << 32).primitives, UINT32_MAX / stride);
        EXPECT_LE(feedback.offset(0), UINT32_MAX);
        EXPECT_EQ(feedback.place(plan, 1, 1).primitives, 0u);
    }
}

TEST(TransformFeedback, NeedsEveryBufferOfTheProgram) {
    std::vector<std::byte> memory(64);
    TransformFeedback feedback;
    CapturePlan plan = planOf(0, 0, 4);
    plan.strides[3] = 8;
    plan.extents[3] = 8;
    feedback.bind(0, memory.data(), 64);
    feedback.begin();
    EXPECT_EQ(feedback.place(plan, 1, 1).primitives, 0u);
    feedback.bind(3, memory.data(), 16);
    EXPECT_EQ(feedback.place(plan, 1, 1).primitives, 0u) << "binding counts from the next begin on";
    feedback.begin();
    EXPECT_EQ(feedback.place(plan, 1, 9).primitives, 2u);
    feedback.bind(0, nullptr, 64);
    feedback.bind(kCaptureBuffers, memory.data(), 64);
    feedback.begin();
    EXPECT_EQ(feedback.place(plan, 1, 1).primitives, 0u);
}

}  // namespace
}  // namespace vernier
