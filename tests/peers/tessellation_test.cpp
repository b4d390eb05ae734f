// What patches are subdivided into, on Vernier and on lavapipe. The specification leaves open how the area between
// rings of a patch is cut into triangles, and where the shorter segments of fractional spacings lie. Where it leaves
// nothing open, both must agree: in the number of primitives, in their winding, and in the points of whole levels.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <sstream>

#include "tests/vulkan/test_feedback.h"

namespace vernier::test {
namespace {

/// The fixture as an object, on one driver.
class TessellationLab : public FeedbackTest {
  public:
    explicit TessellationLab(const char* manifest) : manifest_(manifest) { SetUp(); }
    ~TessellationLab() override { TearDown(); }
    using FeedbackTest::capture;
    using FeedbackTest::Captured;
    using FeedbackTest::Feedback;
    std::vector<uint8_t> picture(const std::string& modes, float level);

  private:
    const char* driver() override { return manifest_; }
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }  // of domain origins
    void TestBody() override {}
    const char* manifest_;
};

constexpr VkExtent2D kPicture{256, 256};

/// A bicubic patch, lit, as its levels leave it: its normals are those of its triangles.
std::vector<uint8_t> TessellationLab::picture(const std::string& modes, float level) {
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kPicture,
                                      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    const TestImage depth = makeImage(VK_FORMAT_D32_SFLOAT, kPicture, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    const Pass pass = makePass(color, &depth);
    PipelineDesc desc;
    desc.extent = kPicture;
    desc.depthTest = true;
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
void main() {
    vec2 p = vec2(gl_VertexIndex & 3, gl_VertexIndex >> 2) / 1.5 - 1.0;
    float bumps[16] = float[16](0.9, 0.1, 0.7, -0.4, -0.2, 1.8, -1.9, 0.3, 0.5, -2.1, 2.2, 0.0, -0.6, 0.4, -0.3, 0.8);
    gl_Position = vec4(p.x, bumps[gl_VertexIndex], p.y, 1.0);
})");
    desc.control = makeShader(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, R"(#version 450
layout(vertices = 16) out;
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    gl_TessLevelOuter[gl_InvocationID & 3] = )" + std::to_string(level) +
                                                                            R"(;
    gl_TessLevelInner[gl_InvocationID & 1] = )" + std::to_string(level) + R"(;
})");
    desc.evaluation =
        makeShader(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, "#version 450\nlayout(quads, " + modes + R"() in;
layout(location = 0) out vec3 place;
vec4 basis(float t) {
    float s = 1.0 - t;
    return vec4(s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t);
}
void main() {
    vec4 u = basis(gl_TessCoord.x), v = basis(gl_TessCoord.y);
    vec3 p = vec3(0);
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) p += gl_in[4 * j + i].gl_Position.xyz * u[i] * v[j];
    place = p;
    vec3 turned = vec3(p.x * 0.8 - p.z * 0.6, p.y, p.x * 0.6 + p.z * 0.8);
    gl_Position = vec4(turned.x * 0.9, -turned.y * 0.7 + turned.z * 0.5, turned.z * 0.4 + turned.y * 0.1 + 0.9, 1.8);
})");
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) in vec3 place;
layout(location = 0) out vec4 color;
void main() {
    vec3 n = normalize(cross(dFdx(place), dFdy(place)));
    float light = 0.25 + 0.75 * abs(dot(n, normalize(vec3(0.4, 0.8, 0.3))));
    vec2 lines = abs(fract(place.xz * 4.0) - 0.5);
    color = vec4(vec3(0.9, 0.6, 0.3) * light * (min(lines.x, lines.y) < 0.06 ? 0.5 : 1.0), 1.0);
})");
    desc.patchControlPoints = 16;
    desc.change = [](const PipelineStates& states) { states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST; };
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(commands, 16, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    return readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
}

struct Levels {
    std::array<float, 4> outer{};
    std::array<float, 2> inner{};
};

struct Modes {
    std::string domain, spacing, order;
    bool points = false;
    bool lowerLeft = false;
};

TessellationLab::Feedback feedbackOf(const Modes& modes, const Levels& levels) {
    TessellationLab::Feedback feedback;
    feedback.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
    feedback.patchControlPoints = 1;
    feedback.domainLowerLeft = modes.lowerLeft;
    feedback.vertex = "#version 450\nvoid main() { gl_Position = vec4(gl_VertexIndex, 0, 0, 1); }";
    std::ostringstream control;
    control << "#version 450\nlayout(vertices = 1) out;\nvoid main() {\n";
    for (size_t n = 0; n < 4; ++n) control << "gl_TessLevelOuter[" << n << "] = float(" << levels.outer[n] << ");\n";
    for (size_t n = 0; n < 2; ++n) control << "gl_TessLevelInner[" << n << "] = float(" << levels.inner[n] << ");\n";
    control << "gl_out[gl_InvocationID].gl_Position = gl_in[0].gl_Position;\n}";
    feedback.control = control.str();
    feedback.evaluation = "#version 450\nlayout(" + modes.domain + ", " + modes.spacing + ", " + modes.order +
                          (modes.points ? ", point_mode" : "") + R"() in;
layout(location = 0, xfb_buffer = 0, xfb_stride = 12, xfb_offset = 0) out vec3 place;
void main() {
    gl_Position = vec4(gl_TessCoord.xy, 0.5, 1);
    place = gl_TessCoord;
)" + (modes.points ? "    gl_PointSize = 1;\n}" : "}");
    feedback.sizes = {12 * 3 * 8400};
    feedback.draws = {{1}};
    return feedback;
}

using Place = std::array<float, 3>;

std::vector<Place> placesOf(const TessellationLab::Captured& captured) {
    return captured.as<Place>(0, 0, captured.counters[0] / sizeof(Place));
}

bool near(const Place& a, const Place& b) {
    // lavapipe multiplies the length of a segment, which has 16 fractional bits, by up to 63.
    constexpr float kTolerance = 64.0f / 65536;
    return std::abs(a[0] - b[0]) < kTolerance && std::abs(a[1] - b[1]) < kTolerance;
}

std::vector<Place> distinct(std::vector<Place> places) {
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
}

/// Whether each of `some` has one of `others` near it.
bool eachHas(const std::vector<Place>& some, const std::vector<Place>& others) {
    return std::all_of(some.begin(), some.end(), [&](const Place& a) {
        return std::any_of(others.begin(), others.end(), [&](const Place& b) { return near(a, b); });
    });
}

/// Twice the area that triangles cover, with its sign.
double areaOf(const std::vector<Place>& places) {
    double sum = 0;
    for (size_t n = 0; n + 2 < places.size(); n += 3) {
        const Place &a = places[n], &b = places[n + 1], &c = places[n + 2];
        sum += double{b[0] - a[0]} * double{c[1] - a[1]} - double{b[1] - a[1]} * double{c[0] - a[0]};
    }
    return sum;
}

class TessellationPeers : public testing::Test {
  protected:
    void SetUp() override {
        if (!std::filesystem::exists(VERNIER_LAVAPIPE_JSON)) GTEST_SKIP() << "no lavapipe here";
    }
    static void compare(TessellationLab& vernier, TessellationLab& lavapipe, const Modes& modes, const Levels& levels,
                        bool points) {
        const auto feedback = feedbackOf(modes, levels);
        const auto ours = vernier.capture(feedback), theirs = lavapipe.capture(feedback);
        std::ostringstream what;
        what << modes.domain << ' ' << modes.spacing << ' ' << modes.order << (modes.points ? " points" : "");
        for (const float level : levels.outer) what << ' ' << level;
        for (const float level : levels.inner) what << " / " << level;
        SCOPED_TRACE(what.str());
        EXPECT_EQ(ours.primitives, theirs.primitives);
        EXPECT_EQ(ours.generated, theirs.generated);
        EXPECT_EQ(ours.counters, theirs.counters);
        const std::vector<Place> mine = placesOf(ours), other = placesOf(theirs);
        if (points) {
            const std::vector<Place> a = distinct(mine), b = distinct(other);
            EXPECT_TRUE(eachHas(a, b));
            EXPECT_TRUE(eachHas(b, a));
        }
        if (modes.domain == "isolines" || modes.points) return;
        EXPECT_NEAR(areaOf(mine), areaOf(other), 1e-4);
    }
};

TEST_F(TessellationPeers, wholeLevels) {
    TessellationLab vernier(VERNIER_ICD_JSON), lavapipe(VERNIER_LAVAPIPE_JSON);
    if (HasFatalFailure()) return;
    std::mt19937 random(1);
    for (uint32_t n = 0; n < 45; ++n) {
        const uint32_t kind = random() % 3;  // spacing
        const auto level = [&] {
            const uint32_t most = n < 40 ? 12 : 64;
            const uint32_t value = 1 + random() % most;
            return static_cast<float>(kind == 0 ? value : kind == 1 ? (value + 1) / 2 * 2 : std::min(value | 1, 63u));
        };
        Modes modes;
        modes.domain = std::array{"triangles", "quads", "isolines"}[n % 3];
        modes.spacing = std::array{"equal_spacing", "fractional_even_spacing", "fractional_odd_spacing"}[kind];
        modes.order = random() % 2 == 0 ? "cw" : "ccw";
        modes.lowerLeft = random() % 2 == 0;
        modes.points = random() % 4 == 0;
        Levels levels;
        for (float& one : levels.outer) one = level();
        for (float& one : levels.inner) one = level();
        // An inner level of 1 beside others counts as a little more: how much is open for odd spacing.
        const bool open = kind == 2 && (levels.inner[0] == 1 || levels.inner[1] == 1);
        compare(vernier, lavapipe, modes, levels, !open);
        if (HasFatalFailure()) return;
    }
}

TEST_F(TessellationPeers, countsOfFractionalLevels) {
    TessellationLab vernier(VERNIER_ICD_JSON), lavapipe(VERNIER_LAVAPIPE_JSON);
    if (HasFatalFailure()) return;
    std::mt19937 random(2);
    std::uniform_real_distribution<float> level(0.2f, 20.0f);
    for (uint32_t n = 0; n < 30; ++n) {
        Modes modes;
        modes.domain = std::array{"triangles", "quads", "isolines"}[n % 3];
        modes.spacing = std::array{"equal_spacing", "fractional_even_spacing", "fractional_odd_spacing"}[random() % 3];
        modes.order = random() % 2 == 0 ? "cw" : "ccw";
        modes.points = random() % 4 == 0;
        Levels levels;
        for (float& one : levels.outer) one = level(random);
        for (float& one : levels.inner) one = level(random);
        if (n % 5 == 4) levels.outer[random() % 2] = n % 10 == 4 ? 0.0f : -1.0f;
        compare(vernier, lavapipe, modes, levels, modes.spacing == "equal_spacing");
        if (HasFatalFailure()) return;
    }
}

/// Where two pictures differ by more than a little.
size_t differences(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    size_t count = 0;
    for (size_t n = 0; n + 3 < a.size(); n += 4) {
        int most = 0;
        for (size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(int{a[n + c]} - int{b[n + c]}));
        count += most > 24 ? 1 : 0;
    }
    return count;
}

TEST_F(TessellationPeers, pictures) {
    TessellationLab vernier(VERNIER_ICD_JSON), lavapipe(VERNIER_LAVAPIPE_JSON);
    if (HasFatalFailure()) return;
    // Edges of triangles and of the patch differ, and where a diagonal was chosen the other way.
    for (const char* modes : {"equal_spacing, ccw", "fractional_odd_spacing, cw"}) {
        const auto ours = vernier.picture(modes, 33), theirs = lavapipe.picture(modes, 33);
        ASSERT_EQ(ours.size(), theirs.size());
        EXPECT_LT(differences(ours, theirs), ours.size() / 4 / 100) << modes;
        // Another level gives another picture.
        EXPECT_GT(differences(ours, vernier.picture(modes, 3)), ours.size() / 4 / 100);
    }
}

}  // namespace
}  // namespace vernier::test
