// The samples' own sine against the C library's, which may differ from it in the last bits only.
#include "samples/common/trigonometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "samples/common/transform.h"

namespace samples {
namespace {

TEST(Trigonometry, AgreesWithTheLibrary) {
    for (int i = -200000; i <= 200000; ++i) {
        const double angle = i * 1.37e-3;
        EXPECT_NEAR(sine(angle), std::sin(angle), 3e-15) << angle;
        EXPECT_NEAR(cosine(angle), std::cos(angle), 3e-15) << angle;
    }
    for (const double angle : {1e4, -54321.5, 99999.0}) EXPECT_NEAR(sine(angle), std::sin(angle), 1e-11) << angle;
}

TEST(Trigonometry, QuarterTurnsAreExact) {
    EXPECT_EQ(sine(0), 0);
    EXPECT_EQ(cosine(0), 1);
    EXPECT_EQ(sineF(kPi / 2), 1);
    EXPECT_EQ(cosineF(kPi), -1);
}

TEST(Transform, DepthRunsFromZeroToOneAndYDown) {
    const glm::mat4 m = perspective(1.0, 1.5, 0.5, 20);
    const glm::vec4 nearPoint = m * glm::vec4(0, 0, -0.5f, 1), farPoint = m * glm::vec4(0, 0, -20, 1);
    EXPECT_NEAR(nearPoint.z / nearPoint.w, 0, 1e-6);
    EXPECT_NEAR(farPoint.z / farPoint.w, 1, 1e-6);
    EXPECT_LT((m * glm::vec4(0, 1, -5, 1)).y, 0);
}

TEST(Transform, GlClipSpaceRunsFromMinusOneAndYUp) {
    const glm::mat4 m = perspectiveGl(1.0, 1.5, 0.5, 20);
    const glm::vec4 nearPoint = m * glm::vec4(0, 0, -0.5f, 1), farPoint = m * glm::vec4(0, 0, -20, 1);
    EXPECT_NEAR(nearPoint.z / nearPoint.w, -1, 1e-6);
    EXPECT_NEAR(farPoint.z / farPoint.w, 1, 1e-6);
    EXPECT_GT((m * glm::vec4(0, 1, -5, 1)).y, 0);
}

TEST(Transform, RotationIsGlms) {
    const glm::vec3 axis(0.3f, -1, 2);
    const glm::mat4 mine = rotation(0.7, axis), theirs = glm::rotate(glm::mat4(1), 0.7f, axis);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) EXPECT_NEAR(mine[column][row], theirs[column][row], 1e-6);
}

}  // namespace
}  // namespace samples
