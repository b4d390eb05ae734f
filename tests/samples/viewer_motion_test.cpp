// What the viewer reads besides bare triangles: sparse accessors, colours, maps, skins, animations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "samples/viewer/scene.h"
#include "tests/samples/gltf_builder.h"

namespace samples::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A file of pieces: accessors over views of one buffer.
class Gltf {
  public:
    /// Returns the number of the view.
    template <class T>
    size_t view(const std::vector<T>& values) {
        const size_t first = (bytes_.data().size() + 3) / 4 * 4;
        bytes_.add(std::vector<uint8_t>(first - bytes_.data().size()));
        bytes_.add(values);
        views_ += std::string(views_.empty() ? "" : ", ") + "{\"buffer\": 0, \"byteOffset\": " + std::to_string(first) +
                  ", \"byteLength\": " + std::to_string(values.size() * sizeof(T)) + "}";
        return viewCount_++;
    }
    /// Returns the number of the accessor.
    size_t accessor(const std::string& view, int componentType, size_t count, const std::string& type,
                    const std::string& more = "") {
        accessors_ += std::string(accessors_.empty() ? "{" : ", {") + view +
                      "\"componentType\": " + std::to_string(componentType) + ", \"count\": " + std::to_string(count) +
                      ", \"type\": \"" + type + "\"" + more + "}";
        return accessorCount_++;
    }
    size_t floats(const std::vector<float>& values, const std::string& type, size_t width) {
        return accessor(inView(view(values)), 5126, values.size() / width, type);
    }
    static std::string inView(size_t view) { return "\"bufferView\": " + std::to_string(view) + ", "; }
    std::vector<uint8_t> file(const std::string& rest) const {
        return glb("{\"asset\": {\"version\": \"2.0\"}, \"accessors\": [" + accessors_ + "], \"bufferViews\": [" +
                       views_ + "], \"buffers\": [{\"byteLength\": " + std::to_string(bytes_.data().size()) + "}], " +
                       rest + "}",
                   bytes_.data());
    }

  private:
    Bytes bytes_;
    std::string views_, accessors_;
    size_t viewCount_ = 0, accessorCount_ = 0;
};

class ViewerMotion : public ::testing::Test {
  protected:
    void SetUp() override {
        path_ =
            std::filesystem::temp_directory_path() /
            ("viewer_motion_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".glb");
    }
    void TearDown() override { std::filesystem::remove(path_); }
    bool tryRead(const std::vector<uint8_t>& file, Scene& scene, std::string& error) {
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
        return loadScene(path_.string(), scene, error);
    }
    Scene read(const std::vector<uint8_t>& file) {
        Scene scene;
        std::string error;
        EXPECT_TRUE(tryRead(file, scene, error)) << error;
        return scene;
    }
    std::string refusal(const std::vector<uint8_t>& file) {
        Scene scene;
        std::string error;
        EXPECT_FALSE(tryRead(file, scene, error));
        return error;
    }

    std::filesystem::path path_;
};

/// Where a vertex was before the scene was moved into the ball.
glm::vec3 placeOf(const Scene& scene, size_t vertex) {
    return scene.parts.at(0).mesh.vertices.at(vertex).position * scene.ball.radius + scene.ball.center;
}

void expectNear(const glm::vec3& a, const glm::vec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-5f)
        << a.x << " " << a.y << " " << a.z << ", expected " << b.x << " " << b.y << " " << b.z;
}

const std::vector<float> kCorners = {0, 0, 0, 2, 0, 0, 0, 2, 0}, kUp = {0, 0, 1, 0, 0, 1, 0, 0, 1};

TEST_F(ViewerMotion, SparseAccessors) {
    for (const bool based : {true, false}) {
        Gltf gltf;
        const size_t corners = gltf.view(kCorners), places = gltf.view(std::vector<uint16_t>{1, 2}),
                     values = gltf.view(std::vector<float>{4, 0, 0, 0, 6, 0});
        const std::string sparse =
            ", \"sparse\": {\"count\": 2, \"indices\": {\"bufferView\": " + std::to_string(places) +
            ", \"componentType\": 5123}, \"values\": {\"bufferView\": " + std::to_string(values) + "}}";
        gltf.accessor(based ? Gltf::inView(corners) : "", 5126, 3, "VEC3", sparse);
        const Scene scene = read(gltf.file("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}]"));
        expectNear(placeOf(scene, 0), {0, 0, 0});
        expectNear(placeOf(scene, 1), {4, 0, 0});
        expectNear(placeOf(scene, 2), {0, 6, 0});
    }
    Gltf gltf;
    const size_t places = gltf.view(std::vector<uint8_t>{1, 3}), values = gltf.view(std::vector<float>(6));
    gltf.accessor("", 5126, 3, "VEC3",
                  ", \"sparse\": {\"count\": 2, \"indices\": {\"bufferView\": " + std::to_string(places) +
                      ", \"componentType\": 5121}, \"values\": {\"bufferView\": " + std::to_string(values) + "}}");
    EXPECT_THAT(refusal(gltf.file("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}]")),
                HasSubstr("accessor 0: replaces element 3 of 3"));
}

TEST_F(ViewerMotion, ColoursOfVertices) {
    Gltf gltf;
    gltf.floats(kCorners, "VEC3", 3);
    gltf.accessor(Gltf::inView(gltf.view(std::vector<uint8_t>{255, 0, 0, 51, 0, 255, 0, 255, 0, 0, 255, 255})), 5121, 3,
                  "VEC4", ", \"normalized\": true");
    gltf.floats({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3", 3);
    for (const char* accessor : {"1", "2"}) {
        const Scene scene = read(
            gltf.file(std::string("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0, \"COLOR_0\": ") +
                      accessor + "}}]}]"));
        EXPECT_TRUE(scene.notes.empty());
        const std::vector<VertexExtras>& extras = scene.parts.at(0).extras;
        ASSERT_EQ(extras.size(), 3u);
        EXPECT_EQ(extras[0].color, glm::vec4(1, 0, 0, *accessor == '1' ? 0.2f : 1.0f));
        EXPECT_EQ(extras[2].color, glm::vec4(0, 0, 1, 1));
    }
}

TEST_F(ViewerMotion, MapsOfTheSurface) {
    Gltf gltf;
    gltf.floats(kCorners, "VEC3", 3);
    gltf.floats(kUp, "VEC3", 3);
    gltf.floats({0, 0, 1, 0, 0, -1}, "VEC2", 2);  // u to the right, v down
    // A picture of one pixel (PNG, 2 x 1 grey would do as well).
    const std::string picture =
        "data:image/"
        "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";
    const Scene scene = read(gltf.file(R"("images": [{"uri": ")" + picture +
                                       R"("}], "textures": [{"source": 0}, {"source": 0, "sampler": 0}],
"samplers": [{"magFilter": 9728, "wrapS": 33071}], "materials": [{"normalTexture": {"index": 0, "scale": 0.5},
"emissiveTexture": {"index": 1}, "emissiveFactor": [1, 1, 0], "pbrMetallicRoughness":
{"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0, "texCoord": 1}}}],
"meshes": [{"primitives": [{"material": 0, "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}]}])"));
    EXPECT_THAT(scene.notes, ElementsAre("textures with coordinates of their own are not shown"));
    const SceneMaterial& material = scene.materials.at(0);
    EXPECT_EQ(material.normalScale, 0.5f);
    EXPECT_EQ(material.surfaceTexture.texture, -1);
    // The same picture as colours, which two have in common, and as numbers.
    ASSERT_EQ(scene.textures.size(), 2u);
    EXPECT_EQ(material.texture.texture, material.emissionTexture.texture);
    EXPECT_FALSE(scene.textures.at(static_cast<size_t>(material.texture.texture)).linear);
    EXPECT_TRUE(scene.textures.at(static_cast<size_t>(material.normalTexture.texture)).linear);
    EXPECT_EQ(material.emissionTexture.filter, VK_FILTER_NEAREST);
    EXPECT_EQ(material.emissionTexture.addressU, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    EXPECT_EQ(material.texture.addressU, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    // Tangents, which the file lacks: u goes along x, and v against y, so that up in the map is up.
    for (const VertexExtras& extras : scene.parts.at(0).extras) EXPECT_EQ(extras.tangent, glm::vec4(1, 0, 0, 1));
}

/// A triangle of which corner 0 stays, corner 1 follows node 1, and corner 2 both by half.
Gltf skinned() {
    Gltf gltf;
    gltf.floats(kCorners, "VEC3", 3);
    gltf.floats(kUp, "VEC3", 3);
    gltf.accessor(Gltf::inView(gltf.view(std::vector<uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0})), 5121, 3, "VEC4");
    gltf.floats({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4", 4);
    // Of joint 1: from where it is at rest, at (1, 0, 0), to its own place.
    gltf.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1},
                "MAT4", 16);
    gltf.floats({0, 1, 3}, "SCALAR", 1);                           // 5: times
    gltf.floats({1, 0, 0, 1, 0, 4, 1, 0, 0}, "VEC3", 3);           // 6: places
    gltf.floats({0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1}, "VEC4", 4);  // 7: half a turn about z and back
    gltf.floats(std::vector<float>(27, 1), "VEC3", 3);             // 8: a spline
    return gltf;
}

std::string skinnedScene(const std::string& animations) {
    return R"("scene": 0, "scenes": [{"nodes": [0, 2]}], "nodes": [{"children": [1]}, {"translation": [1, 0, 0]},
{"mesh": 0, "skin": 0, "translation": [50, 0, 0]}], "skins": [{"joints": [0, 1], "inverseBindMatrices": 4}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "JOINTS_0": 2, "WEIGHTS_0": 3}}]}])" +
           animations;
}

std::string channel(const std::string& path, int output, const std::string& interpolation) {
    return R"(, "animations": [{"channels": [{"sampler": 0, "target": {"node": 1, "path": ")" + path +
           R"("}}], "samplers": [{"input": 5, "output": )" + std::to_string(output) + R"(, "interpolation": ")" +
           interpolation + "\"}]}]";
}

TEST_F(ViewerMotion, Skins) {
    // At rest joints change nothing, and where the mesh's own node is does not matter.
    const Scene scene = read(skinned().file(skinnedScene("")));
    EXPECT_TRUE(scene.notes.empty());
    EXPECT_EQ(scene.motion, nullptr);
    expectNear(placeOf(scene, 0), {0, 0, 0});
    expectNear(placeOf(scene, 1), {2, 0, 0});
    expectNear(placeOf(scene, 2), {0, 2, 0});
    for (const auto& [from, to, expected] :
         {std::tuple("\"joints\": [0, 1]", "\"joints\": [0, 7]", "skin 0: there is no node 7"),
          std::tuple("\"joints\": [0, 1]", "\"joints\": [0]", "joint 1, but its skin has 1"),
          std::tuple("\"joints\": [0, 1]", "\"joints\": [0, 1, 2]", "skin 0: 2 matrices for 3 joints"),
          std::tuple("\"skin\": 0", "\"skin\": 4", "there is no skin 4"),
          std::tuple("\"nodes\": [0, 2]", "\"nodes\": [2]", "skin 0: node 0 is not in the scene")})
        EXPECT_THAT(refusal(skinned().file(replaced(skinnedScene(""), from, to))), HasSubstr(expected));
}

TEST_F(ViewerMotion, Animations) {
    Scene scene = read(skinned().file(skinnedScene(channel("translation", 6, "LINEAR"))));
    ASSERT_NE(scene.motion, nullptr);
    EXPECT_EQ(scene.motion->animations(), 1u);
    EXPECT_EQ(scene.motion->seconds(0), 3);
    poseScene(scene, 0, 0.5);  // joint 1 at (1, 0, 2)
    expectNear(placeOf(scene, 0), {0, 0, 0});
    expectNear(placeOf(scene, 1), {2, 0, 2});
    expectNear(placeOf(scene, 2), {0, 2, 1});
    poseScene(scene, 0, 3 + 2);  // anew, halfway back
    expectNear(placeOf(scene, 1), {2, 0, 2});
    poseScene(scene, 0, 1);
    expectNear(placeOf(scene, 1), {2, 0, 4});

    scene = read(skinned().file(skinnedScene(channel("translation", 6, "STEP"))));
    poseScene(scene, 0, 2.9);
    expectNear(placeOf(scene, 1), {2, 0, 4});

    // Half a turn in a second: after half of it, a quarter; what was 1 to the right of the joint is 1 above.
    scene = read(skinned().file(skinnedScene(channel("rotation", 7, "LINEAR"))));
    poseScene(scene, 0, 0.5);
    expectNear(placeOf(scene, 1), {1, 1, 0});
    EXPECT_EQ(scene.parts[0].mesh.vertices[1].normal, glm::vec3(0, 0, 1));
    poseScene(scene, 0, 1.0 / 3);
    expectNear(placeOf(scene, 1), {1.5f, std::sqrt(0.75f), 0});

    // A spline of equal points and slopes of 1: in the middle of a key of 2 seconds both slopes cancel.
    scene = read(skinned().file(skinnedScene(channel("scale", 8, "CUBICSPLINE"))));
    poseScene(scene, 0, 2);
    expectNear(placeOf(scene, 1), {2, 0, 0});
    // A quarter of it: 1 + 2 (t^3 - 2 t^2 + t) + 2 (t^3 - t^2), t = 1/4.
    poseScene(scene, 0, 1.5);
    expectNear(placeOf(scene, 1), {2.1875f, 0, 0});
}

TEST_F(ViewerMotion, WrongAnimationsAreNoted) {
    const auto notesOf = [&](const std::string& animations) {
        const Scene scene = read(skinned().file(skinnedScene(animations)));
        EXPECT_EQ(scene.motion, nullptr);
        return scene.notes;
    };
    EXPECT_THAT(notesOf(channel("translation", 7, "LINEAR")),
                ElementsAre(HasSubstr("animation 0: accessor 7 has not 3 components")));
    EXPECT_THAT(notesOf(channel("translation", 8, "LINEAR")), ElementsAre("animation 0: 3 keys, but values for 9"));
    EXPECT_THAT(notesOf(channel("colour", 6, "LINEAR")), ElementsAre("animation 0: moves \"colour\""));
    EXPECT_THAT(notesOf(replaced(channel("translation", 6, "LINEAR"), "\"node\": 1", "\"node\": 9")),
                ElementsAre("animation 0: there is no node 9"));
    EXPECT_THAT(notesOf(replaced(channel("translation", 6, "LINEAR"), "\"input\": 5", "\"input\": 6")),
                ElementsAre(HasSubstr("animation 0: accessor 6 has not 1 components")));
    EXPECT_THAT(notesOf(channel("weights", 6, "LINEAR")), ElementsAre("morph targets are not shown"));
}

}  // namespace
}  // namespace samples::test
