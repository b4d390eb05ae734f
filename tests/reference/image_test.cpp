// Image instructions: what reaches the caller's Resources, and what comes back.
#include "tests/reference/reference_support.h"

namespace vernier::reference::test {
namespace {

using Floats = std::array<double, 4>;
using Ints = std::array<int32_t, 4>;

/// Remembers the last request and answers with fixed texels.
class Recorder : public Resources<double> {
  public:
    std::vector<ImageRequest<double>> requests;
    std::string calls;
    Texel<double> written{};

    Texel<double> sample(const ImageRequest<double>& r) override { return note("sample ", r); }
    Texel<double> gather(const ImageRequest<double>& r) override { return note("gather ", r); }
    Texel<double> fetch(const ImageRequest<double>& r) override { return note("fetch ", r); }
    void write(const ImageRequest<double>& r, const Texel<double>& texel) override {
        note("write ", r);
        written = texel;
    }
    std::array<int32_t, 4> querySize(const Descriptor&, const ImageShape&, int32_t lod) override {
        return {640 >> lod, 480 >> lod, 7, 3};
    }
    int32_t queryLevels(const Descriptor&, const ImageShape&) override { return 9; }
    int32_t querySamples(const Descriptor&, const ImageShape&) override { return 8; }
    std::array<double, 2> queryLod(const ImageRequest<double>& r) override {
        requests.push_back(r);
        return {1.5, 2.5};
    }

  private:
    Texel<double> note(const char* call, const ImageRequest<double>& r) {
        calls += call;
        requests.push_back(r);
        Texel<double> texel;
        for (uint32_t k = 0; k < 4; ++k)
            texel[k] = r.shape.floating ? Scalar<double>::ofNumber(k + 1.25)
                                        : Scalar<double>::ofInt(-static_cast<int32_t>(k) - 1);
        return texel;
    }
};

class Images : public testing::Test {
  protected:
    /// One fragment with v = (0.5, -1.25, 2, 3); the last request stays in `resources`.
    Outcome<double> run(std::string_view declarations, std::string_view body) {
        resources = {};
        return runFragment<double>(compileFragment(fragmentSource(declarations, body)), standardInputs<double>(),
                                   resources);
    }
    const ImageRequest<double>& last() {
        if (resources.requests.empty()) {
            ADD_FAILURE() << "no request";
            resources.requests.emplace_back();
        }
        return resources.requests.back();
    }
    Recorder resources;
};

using C = std::array<double, 4>;
using D = std::array<double, 3>;

TEST_F(Images, ImplicitAndBias) {
    EXPECT_EQ(floatsAt(run("layout(set = 2, binding = 5) uniform sampler2D s;", "r = texture(s, v.xy);")),
              (Floats{1.25, 2.25, 3.25, 4.25}));
    EXPECT_EQ(last().image, (Descriptor{2, 5, 0}));
    EXPECT_EQ(last().sampler, (Descriptor{2, 5, 0}));
    EXPECT_EQ(last().coordinates, (C{0.5, -1.25, 0, 0}));
    EXPECT_EQ(last().lodMode, LodMode::implicit);
    EXPECT_EQ(last().ddx, (D{}));
    run("layout(binding = 5) uniform sampler3D s;", "r = texture(s, v.xyz, v.w);");
    EXPECT_EQ(last().shape.dim, spv::Dim3D);
    EXPECT_EQ(last().coordinates, (C{0.5, -1.25, 2, 0}));
    EXPECT_EQ(last().bias, 3);
}

TEST_F(Images, ExplicitLodAndGradients) {
    run("layout(binding = 0) uniform samplerCubeArray s;", "r = textureLod(s, v, v.w);");
    EXPECT_EQ(last().coordinates, (C{0.5, -1.25, 2, 3}));
    EXPECT_EQ(last().lodMode, LodMode::explicitLod);
    EXPECT_EQ(last().lod, 3);
    EXPECT_TRUE(last().shape.arrayed);
    run("layout(binding = 0) uniform sampler2DArray s;", "r = textureGradOffset(s, v.xyz, v.xy, v.zw, ivec2(1, -2));");
    EXPECT_EQ(last().lodMode, LodMode::gradients);
    EXPECT_EQ(last().ddx, (D{0.5, -1.25, 0}));
    EXPECT_EQ(last().ddy, (D{2, 3, 0}));
    EXPECT_EQ(last().offset, (std::array<int32_t, 3>{1, -2, 0}));
}

TEST_F(Images, DepthComparisonAndProjection) {
    EXPECT_EQ(floatsAt(run("layout(binding = 0) uniform sampler2DShadow s;", "r = vec4(texture(s, v.xyz));"))[0], 1.25);
    EXPECT_EQ(last().dref, 2);
    EXPECT_TRUE(last().shape.depth);
    run("layout(binding = 0) uniform sampler2DShadow s;", "r = vec4(textureProjLod(s, v.xyww, v.z));");
    EXPECT_EQ(last().coordinates, (C{0.5 / 3, -1.25 / 3, 0, 0}));
    EXPECT_EQ(last().dref, 1);
    run("layout(binding = 0) uniform sampler2D s;", "r = textureProj(s, v.xyz) + textureProj(s, v);");
    EXPECT_EQ(resources.requests[0].coordinates, (C{0.25, -0.625, 0, 0}));
    EXPECT_EQ(last().coordinates, (C{0.5 / 3, -1.25 / 3, 0, 0}));
}

TEST_F(Images, FetchAndIntegerTexels) {
    EXPECT_EQ(
        intsAt(run("layout(binding = 0) uniform isampler2D s;", "ri = texelFetchOffset(s, i.xy, i.z, ivec2(3, 4));")),
        (Ints{-1, -2, -3, -4}));
    EXPECT_EQ(last().texel, (std::array<int32_t, 4>{7, -3, 0, 0}));
    EXPECT_EQ(last().texelLod, 100);
    EXPECT_EQ(last().offset, (std::array<int32_t, 3>{3, 4, 0}));
    EXPECT_FALSE(last().shape.floating);
    run("layout(binding = 0) uniform sampler2DMS s;", "r = texelFetch(s, i.xy, 2);");
    EXPECT_EQ(last().sample, 2);
    EXPECT_TRUE(last().shape.multisampled);
    run("layout(binding = 0) uniform samplerBuffer s;", "r = texelFetch(s, i.z);");
    EXPECT_EQ(last().texel[0], 100);
}

TEST_F(Images, Gather) {
    run("layout(binding = 0) uniform sampler2D s;", "r = textureGather(s, v.xy, 2);");
    EXPECT_EQ(last().component, 2u);
    EXPECT_EQ(resources.calls, "gather ");
    run("layout(binding = 0) uniform sampler2DShadow s;", "r = textureGather(s, v.xy, v.w);");
    EXPECT_EQ(last().dref, 3);
    run("layout(binding = 0) uniform sampler2D s;",
        "r = textureGatherOffsets(s, v.xy, ivec2[](ivec2(1, 2), ivec2(3, 4), ivec2(5, 6), ivec2(-7, -8)));");
    ASSERT_TRUE(last().gatherOffsets.has_value());
    EXPECT_EQ((*last().gatherOffsets)[3], (std::array<int32_t, 2>{-7, -8}));
}

TEST_F(Images, SeparateSamplersAndArrays) {
    run("layout(set = 1, binding = 3) uniform texture2D t[4]; layout(set = 2, binding = 6) uniform sampler "
        "s[2];",
        "r = texture(sampler2D(t[i.x - 4], s[1]), v.xy);");
    EXPECT_EQ(last().image, (Descriptor{1, 3, 3}));
    EXPECT_EQ(last().sampler, (Descriptor{2, 6, 1}));
    run("#extension GL_EXT_samplerless_texture_functions : require\n"
        "layout(set = 1, binding = 3) uniform texture2D t;",
        "r = texelFetch(t, i.xy, 0);");
    EXPECT_EQ(last().image, (Descriptor{1, 3, 0}));
    run("layout(binding = 3) uniform sampler2D t[4]; vec4 f(sampler2D s) { return texture(s, v.xy); }", "r = f(t[2]);");
    EXPECT_EQ(last().image, (Descriptor{0, 3, 2}));
}

TEST_F(Images, Queries) {
    EXPECT_EQ(intsAt(run("layout(binding = 0) uniform sampler2DArray s; layout(binding = 1) uniform sampler2DMS m;",
                         "ri = ivec4(textureSize(s, 1), textureQueryLevels(s) * 10 + textureSamples(m));")),
              (Ints{320, 240, 7, 98}));
    EXPECT_EQ(floatsAt(run("layout(binding = 0) uniform sampler2D s;", "r = vec4(textureQueryLod(s, v.xy), 0, 0);")),
              (Floats{1.5, 2.5, 0, 0}));
}

TEST_F(Images, InputAttachmentsAndStorageImages) {
    run("layout(input_attachment_index = 3, set = 0, binding = 4) uniform subpassInput s;", "r = subpassLoad(s);");
    EXPECT_EQ(resources.calls, "fetch ");
    EXPECT_EQ(last().shape.dim, spv::DimSubpassData);
    EXPECT_EQ(last().texel[0], 0);
    run("layout(set = 0, binding = 4, rgba32i) uniform iimage2D s;",
        "imageStore(s, i.yx, i); ri = imageLoad(s, i.xy);");
    EXPECT_EQ(resources.calls, "write fetch ");
    EXPECT_EQ(resources.requests[0].texel, (std::array<int32_t, 4>{-3, 7, 0, 0}));
    EXPECT_EQ(resources.written[2].bits, 100u);
}

TEST_F(Images, ImplicitDerivativesComeFromTheQuad) {
    const auto module = Module::parse(compileFragment(fragmentSource(
        "layout(binding = 0) uniform sampler2D s;", "r = texture(s, v.xy); r += textureProj(s, v.xyw);")));
    ASSERT_TRUE(module.ok());
    std::array<InterfaceValues<double>, 4> inputs;
    const double x[] = {1, 3, 10, 20};
    for (int k = 0; k < 4; ++k) inputs[k].setFloat(Location(0), {x[k], 2 * x[k], 0, 2});
    for (const bool coarse : {false, true}) {
        resources = {};
        const auto outcomes = interpreterOf<double>(*module, spv::ExecutionModelFragment, {.coarseDerivatives = coarse})
                                  .runQuad(inputs, {}, resources);
        ASSERT_TRUE(outcomes.ok()) << outcomes.error().message;
        ASSERT_EQ(resources.requests.size(), 8u);
        for (const auto& r : resources.requests) {
            // The second sample of an invocation projects with q = 2.
            const double scale = r.coordinates[0] == x[r.invocation] ? 1 : 0.5;
            EXPECT_EQ(r.coordinates[1], 2 * x[r.invocation] * scale);
            EXPECT_EQ(r.ddx[0], (coarse || r.invocation < 2 ? 2 : 10) * scale);
            EXPECT_EQ(r.ddx[1], (coarse || r.invocation < 2 ? 4 : 20) * scale);
            EXPECT_EQ(r.ddy[0], (coarse || r.invocation % 2 == 0 ? 9 : 17) * scale);
        }
    }
}

}  // namespace
}  // namespace vernier::reference::test
