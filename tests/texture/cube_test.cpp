// Cube maps: faces, ties, seams and corners.
#include <cstring>

#include "runtime/texture/cube.h"
#include "tests/texture/model.h"

namespace vernier::texture_test {
namespace {

TEST(Cube, AgreesWithTheModel) {
    std::mt19937 random(21);
    std::normal_distribution<float> direction;
    for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R16G16B16A16_SFLOAT}) {
        Image image(VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, format, 4, 4, 1, 12, 3);
        image.randomize(22);
        for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR}) {
            const SamplerState sampler =
                makeSampler(filter, VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_MIPMAP_MODE_LINEAR);
            std::array<std::vector<float>, 4> reference;
            Batch batch(128);
            for (int round = 0; round < 20; ++round) {
                for (uint32_t i = 0; i < batch.lanes; ++i) {
                    for (int a = 0; a < 3; ++a) batch.coord[a][i] = direction(random);
                    if (round % 2 == 1) {  // close to edges and corners
                        for (int a = 0; a < 3; ++a) {
                            const float sign = batch.coord[a][i] < 0 ? -1.0f : 1.0f;
                            if (random() % 3 != 0) batch.coord[a][i] = sign * (1 + 0.1f * batch.coord[a][i]);
                        }
                    }
                    batch.coord[3][i] = static_cast<float>(random() % 3) - 0.4f;
                    batch.lod[i] = static_cast<float>(random() % 100) * 0.025f;
                }
                for (const Isa isa : availableIsas()) {
                    const TextureView view = image.view(isa);
                    ASSERT_TRUE(checkSampling(view, sampler).ok());
                    batch.run(selectSampler(view, sampler, isa), view, sampler);
                    if (isa != kLowestIsa) {
                        for (int c = 0; c < 4; ++c) {
                            ASSERT_EQ(0, std::memcmp(reference[c].data(), batch.out[c].data(), 4 * batch.lanes));
                        }
                        continue;
                    }
                    reference = batch.out;
                    for (uint32_t i = 0; i < batch.lanes; ++i) {
                        const Point at{batch.coord[0][i],
                                       batch.coord[1][i],
                                       batch.coord[2][i],
                                       batch.coord[3][i],
                                       0,
                                       batch.lod[i],
                                       {}};
                        if (distanceToJump(view, sampler, at) < 1e-3) continue;
                        const Rgba expected = modelSample(view, sampler, at), actual = batch.result(view, i);
                        for (int c = 0; c < 4; ++c) {
                            ASSERT_NEAR(actual[c], expected[c], 1e-4)
                                << at.s << " " << at.t << " " << at.r << " " << at.layer;
                        }
                    }
                }
            }
        }
    }
}

// T16: ties of the largest axis go to z, then y.
TEST(Cube, Ties) {
    Image image(VK_IMAGE_VIEW_TYPE_CUBE, VK_FORMAT_R32_UINT, 2, 2, 1, 6, 1);
    for (uint32_t face = 0; face < 6; ++face) {
        for (uint32_t i = 0; i < 4; ++i) image.set(0, i % 2, i / 2, face, {.uint32 = {face}});
    }
    const SamplerState sampler = makeSampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    const auto face = [&](float x, float y, float z) { return sampleOne(image, sampler, x, y, z)[0]; };
    EXPECT_EQ(face(1, 0, 0), 0);
    EXPECT_EQ(face(-1, 0, 0), 1);
    EXPECT_EQ(face(0, 1, 0), 2);
    EXPECT_EQ(face(0, -1, 0), 3);
    EXPECT_EQ(face(0, 0, 1), 4);
    EXPECT_EQ(face(0, 0, -1), 5);
    EXPECT_EQ(face(1, 1, 1), 4);
    EXPECT_EQ(face(-1, 1, -1), 5);
    EXPECT_EQ(face(1, -1, 0), 3);
    EXPECT_EQ(face(0, 0, 0), 4);
}

// Folding over an edge and back again is the way home, for all edges.
TEST(Cube, FoldingIsAnInvolution) {
    for (const int32_t size : {1, 2, 5}) {
        for (int32_t face = 0; face < 6; ++face) {
            for (int32_t i = 0; i < size; ++i) {
                for (const CubeTexel start : {CubeTexel{face, -1, i}, CubeTexel{face, size, i}, CubeTexel{face, i, -1},
                                              CubeTexel{face, i, size}}) {
                    const CubeTexel there = foldOverEdge(start, size);
                    ASSERT_NE(there.face, face);
                    ASSERT_TRUE(there.x >= 0 && there.x < size && there.y >= 0 && there.y < size);
                    // The edge texel we came from is one of the neighbour's own neighbours.
                    const CubeTexel home{face, std::min(std::max(start.x, 0), size - 1),
                                         std::min(std::max(start.y, 0), size - 1)};
                    int found = 0;
                    for (const CubeTexel step :
                         {CubeTexel{there.face, there.x - 1, there.y}, CubeTexel{there.face, there.x + 1, there.y},
                          CubeTexel{there.face, there.x, there.y - 1}, CubeTexel{there.face, there.x, there.y + 1}}) {
                        const bool outside = step.x < 0 || step.y < 0 || step.x >= size || step.y >= size;
                        if (!outside) continue;
                        const CubeTexel back = foldOverEdge(step, size);
                        found += back.face == home.face && back.x == home.x && back.y == home.y;
                    }
                    EXPECT_EQ(found, 1);
                }
            }
        }
    }
}

}  // namespace
}  // namespace vernier::texture_test
