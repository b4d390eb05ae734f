// What the viewer reads: right files come out as they are, wrong ones are refused with what is wrong in them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "samples/common/random.h"
#include "samples/viewer/scene.h"
#include "tests/samples/gltf_builder.h"

namespace samples::test {
namespace {

using ::testing::HasSubstr;

class ViewerScene : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("viewer_scene_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    template <class Container>
    std::string write(const std::string& name, const Container& content) {
        const std::string path = (folder_ / name).string();
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
        return path;
    }
    Scene read(const std::string& path) {
        Scene scene;
        std::string error;
        EXPECT_TRUE(loadScene(path, scene, error)) << error;
        return scene;
    }
    /// What is said of a file that must not be read.
    std::string refusal(const std::string& path) {
        Scene scene;
        scene.name = "before";
        std::string error;
        EXPECT_FALSE(loadScene(path, scene, error));
        EXPECT_EQ(scene.name, "before");
        EXPECT_THAT(error, HasSubstr(std::filesystem::path(path).filename().string()));
        return error;
    }

    std::filesystem::path folder_;
};

/// A square of four positions, then its six indices: 48 + 12 bytes.
std::vector<uint8_t> square() {
    Bytes bytes;
    bytes.add<float>({0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0});
    bytes.add<uint16_t>({0, 1, 2, 0, 2, 3});
    return bytes.data();
}

/// The JSON around it; `buffer` says where the bytes are.
std::string squareJson(const std::string& buffer) {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"name": "top", "translation": [10, 0, 0], "children": [1]}, {"mesh": 0, "scale": [3, 3, 3]}],
"meshes": [{"name": "square", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
"materials": [{"name": "red", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.5],
  "metallicFactor": 0, "roughnessFactor": 0.25}}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
  {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
"buffers": [{)" +
           buffer + R"("byteLength": 60}]})";
}

std::string squareGltf() {
    return squareJson("\"uri\": \"data:application/octet-stream;base64," + base64(square()) + "\", ");
}

void expectSquare(const Scene& scene) {
    ASSERT_EQ(scene.parts.size(), 1u);
    const MeshData& mesh = scene.parts[0].mesh;
    // Without normals of its own every triangle has its own corners.
    ASSERT_EQ(mesh.vertices.size(), 6u);
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
    const float half = std::sqrt(0.5f);
    for (const MeshVertex& vertex : mesh.vertices) {
        EXPECT_NEAR(std::abs(vertex.position.x), half, 1e-6);
        EXPECT_NEAR(std::abs(vertex.position.y), half, 1e-6);
        EXPECT_EQ(vertex.position.z, 0);
        EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
    }
    ASSERT_EQ(scene.parts[0].material, 0u);
    EXPECT_EQ(scene.materials[0].name, "red");
    EXPECT_EQ(scene.materials[0].color, glm::vec4(1, 0, 0, 0.5f));
    EXPECT_EQ(scene.materials[0].alpha, Alpha::kBlended);
    EXPECT_FALSE(scene.materials[0].twoSided);
}

TEST_F(ViewerScene, BuiltIn) {
    const Scene scene = builtInScene();
    EXPECT_GT(triangleCount(scene), 10000u);
    for (const ScenePart& part : scene.parts) {
        EXPECT_LT(part.material, scene.materials.size());
        for (const uint32_t index : part.mesh.indices) ASSERT_LT(index, part.mesh.vertices.size());
        for (const MeshVertex& vertex : part.mesh.vertices) ASSERT_LE(glm::length(vertex.position), 1.0001f);
    }
}

TEST_F(ViewerScene, GltfInside) {
    expectSquare(read(write("square.gltf", squareGltf())));
}

TEST_F(ViewerScene, GltfBeside) {
    write("square.bin", square());
    expectSquare(read(write("square.gltf", squareJson("\"uri\": \"square.bin\", "))));
}

TEST_F(ViewerScene, Glb) {
    expectSquare(read(write("square.glb", glb(squareJson(""), square()))));
}

TEST_F(ViewerScene, GltfMirrored) {
    const Scene scene = read(write("a.gltf", replaced(squareGltf(), "[3, 3, 3]", "[-3, 3, 3]")));
    // Turned over twice: the triangles still face up.
    const MeshData& mesh = scene.parts.at(0).mesh;
    const glm::vec3 normal =
        glm::cross(mesh.vertices[mesh.indices[1]].position - mesh.vertices[mesh.indices[0]].position,
                   mesh.vertices[mesh.indices[2]].position - mesh.vertices[mesh.indices[0]].position);
    EXPECT_GT(normal.z, 0);
    EXPECT_EQ(mesh.vertices[0].normal, glm::vec3(0, 0, 1));
}

// Fractions as integers, with gaps between the elements (KHR_mesh_quantization).
TEST_F(ViewerScene, GltfQuantized) {
    Bytes bytes;
    for (const std::vector<int16_t>& corner :
         {std::vector<int16_t>{-32768, -32767, 0, 0}, {32767, -32767, 0, 0}, {0, 32767, 0, 0}})
        bytes.add(corner);
    for (int i = 0; i < 3; ++i) bytes.add<int8_t>({0, 0, -128, 0});
    bytes.add<uint8_t>({0, 255, 0, 0, 51, 0, 0, 0, 255, 255, 0, 0});
    const std::string json = R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_mesh_quantization"],
"extensionsRequired": ["KHR_mesh_quantization"], "meshes": [{"primitives": [{"attributes":
{"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}]}], "accessors": [
{"bufferView": 0, "componentType": 5122, "normalized": true, "count": 3, "type": "VEC3"},
{"bufferView": 1, "componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"},
{"bufferView": 1, "byteOffset": 12, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC2"}],
"bufferViews": [{"buffer": 0, "byteLength": 24, "byteStride": 8},
{"buffer": 0, "byteOffset": 24, "byteLength": 24, "byteStride": 4}], "buffers": [{"byteLength": 48}]})";
    const Scene scene = read(write("a.glb", glb(json, bytes.data())));
    EXPECT_TRUE(scene.notes.empty());
    const std::vector<MeshVertex>& vertices = scene.parts.at(0).mesh.vertices;
    ASSERT_EQ(vertices.size(), 3u);
    // From -1 to 1 on both axes, then into the ball around: divided by the root of 2.
    const float half = std::sqrt(0.5f);
    const glm::vec2 places[] = {{-half, -half}, {half, -half}, {0, half}}, coordinates[] = {{0, 1}, {0.2f, 0}, {1, 1}};
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(vertices[i].position.x, places[i].x, 1e-6);
        EXPECT_NEAR(vertices[i].position.y, places[i].y, 1e-6);
        EXPECT_EQ(vertices[i].normal, glm::vec3(0, 0, -1));
        EXPECT_EQ(vertices[i].uv, coordinates[i]);
    }
}

TEST_F(ViewerScene, GltfStripsAndFans) {
    // The square as a strip needs its corners in another order: 0 1 3 2.
    Bytes bytes;
    bytes.add<float>({0, 0, 0, 2, 0, 0, 0, 2, 0, 2, 2, 0});
    bytes.add<uint16_t>({0, 1, 2, 3, 0, 0});
    std::string json = squareJson("\"uri\": \"data:application/octet-stream;base64," + base64(bytes.data()) + "\", ");
    json = replaced(json, "\"count\": 6", "\"count\": 4");
    for (const char* mode : {"5", "6"}) {
        const Scene scene =
            read(write("a.gltf", replaced(json, "\"indices\": 1", std::string("\"indices\": 1, \"mode\": ") + mode)));
        ASSERT_EQ(scene.parts.size(), 1u);
        EXPECT_EQ(scene.parts[0].mesh.indices.size(), 6u);
        // Of a strip both triangles face up; of a fan over these corners one does not.
        int up = 0;
        for (const MeshVertex& vertex : scene.parts[0].mesh.vertices) up += vertex.normal.z > 0;
        EXPECT_EQ(up, mode[0] == '5' ? 6 : 3) << mode;
    }
}

TEST_F(ViewerScene, PointsAndLinesAreNoted) {
    std::string json = squareGltf();
    json = replaced(json, "\"primitives\": [", R"("primitives": [{"attributes": {"POSITION": 0}, "mode": 1}, )");
    const Scene scene = read(write("a.gltf", json));
    expectSquare(scene);
    EXPECT_THAT(scene.notes, testing::ElementsAre("points and lines are not shown"));
}

TEST_F(ViewerScene, WhatIsLeftOutIsNoted) {
    std::string json =
        replaced(squareGltf(), "\"scene\": 0,", "\"scene\": 0, \"extensionsUsed\": [\"KHR_materials_unlit\"],");
    json = replaced(json, "\"POSITION\": 0}", "\"POSITION\": 0}, \"targets\": [{\"POSITION\": 0}]");
    json = replaced(json, "\"alphaMode\"", "\"occlusionTexture\": {\"index\": 0}, \"alphaMode\"");
    const Scene scene = read(write("a.gltf", json));
    expectSquare(scene);
    EXPECT_THAT(scene.notes, testing::ElementsAre("occlusion textures are not shown", "morph targets are not shown",
                                                  "the extension KHR_materials_unlit is left out"));
}

TEST_F(ViewerScene, WrongTexturesAreNoted) {
    std::string json =
        replaced(squareGltf(), "\"metallicFactor\"", "\"baseColorTexture\": {\"index\": 0}, \"metallicFactor\"");
    json = replaced(json, "\"materials\"",
                    R"("textures": [{"source": 0}], "images": [{"uri": "missing.png"}], "materials")");
    Scene scene = read(write("a.gltf", json));
    expectSquare(scene);
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_THAT(scene.notes[0], HasSubstr("missing.png"));
    // In a buffer view that ends beyond its buffer, and in one that holds no picture.
    json = replaced(json, "\"uri\": \"missing.png\"", "\"bufferView\": 2, \"mimeType\": \"image/png\"");
    for (const char* range : {"\"byteOffset\": 50, \"byteLength\": 500", "\"byteOffset\": 0, \"byteLength\": 60",
                              "\"byteOffset\": 4294967295, \"byteLength\": 60"}) {
        scene = read(write("b.gltf", replaced(json, "\"byteLength\": 12}]",
                                              std::string("\"byteLength\": 12}, {\"buffer\": 0, ") + range + "}]")));
        expectSquare(scene);
        ASSERT_EQ(scene.notes.size(), 1u);
        EXPECT_THAT(scene.notes[0], HasSubstr("image 0: "));
    }
}

TEST_F(ViewerScene, WrongGltfIsRefused) {
    const std::string right = squareGltf();
    const struct {
        const char *from, *to, *expected;
    } cases[] = {
        {"\"count\": 4", "\"count\": 5", "accessor 0: 5 elements of 12 bytes"},
        {"\"count\": 4", "\"count\": 0", "accessor 0: 0 elements"},
        {"\"count\": 4", "\"count\": 1537228672809129302", "accessor 0"},
        {"\"count\": 4", "\"byteOffset\": 8, \"count\": 4", "from byte 8 on"},
        {"\"byteOffset\": 48, \"byteLength\": 12", "\"byteOffset\": 56, \"byteLength\": 12",
         "buffer view 1: bytes 56 to 68"},
        {"\"bufferView\": 0, ", "\"bufferView\": 7, ", "accessor 0: there is no buffer view 7"},
        {"\"bufferView\": 0, ", "", "accessor 0: there is no buffer view -1"},
        {"{\"buffer\": 0, \"byteOffset\": 0", "{\"buffer\": 3, \"byteOffset\": 0",
         "buffer view 0: there is no buffer 3"},
        {"\"POSITION\": 0", "\"POSITION\": 9", "POSITION: there is no accessor 9"},
        {"\"POSITION\": 0", "\"POSITION\": 1", "POSITION: accessor 1 has not 3 components"},
        {"\"POSITION\": 0", "\"NORMAL\": 0", "has no POSITION"},
        {"5126", "5130", "component type 5130"},
        {"5123", "5120", "indices are unsigned"},
        {"\"indices\": 1", "\"indices\": 5", "indices"},
        {"\"material\": 0", "\"material\": 3", "there is no material 3"},
        {"\"mesh\": 0", "\"mesh\": 4", "node 1: there is no mesh 4"},
        {"\"children\": [1]", "\"children\": [8]", "there is no node 8"},
        {"\"children\": [1]", "\"children\": [1, 0]", "node 0 is the child of two nodes, or of itself"},
        {"\"scene\": 0", "\"scene\": 2", "there is no scene 2"},
        {"[10, 0, 0]", "[1e30, 0, 0]", "beyond 1e18"},
        {"\"nodes\": [0]", "\"nodes\": []", "has no triangles"},
        {"\"scene\": 0,", "\"extensionsRequired\": [\"KHR_draco_mesh_compression\"],", "KHR_draco_mesh_compression"},
        {"\"type\": \"VEC3\"", "\"type\": \"VEC9\"", "VEC9"},
        {"\"asset\": {\"version\": \"2.0\"}, ", "", "asset"},
    };
    for (const auto& item : cases) {
        const std::string wrong = replaced(right, item.from, item.to);
        ASSERT_FALSE(wrong.empty()) << item.from;
        EXPECT_THAT(refusal(write("wrong.gltf", wrong)), HasSubstr(item.expected)) << item.to;
    }
    EXPECT_THAT(refusal(write("square.gltf", squareJson("\"uri\": \"nowhere.bin\", "))), HasSubstr("nowhere.bin"));
    EXPECT_THAT(refusal(write("empty.gltf", std::string())), HasSubstr("too short"));
    EXPECT_THAT(refusal(write("list.gltf", std::string("[1, 2, 3]"))), HasSubstr("not a JSON object"));
}

TEST_F(ViewerScene, WrongNumbersAreRefused) {
    Bytes bytes;
    bytes.add<float>({0, 0, 0, 2, std::numeric_limits<float>::quiet_NaN(), 0, 2, 2, 0, 0, 2, 0});
    bytes.add<uint16_t>({0, 1, 2, 0, 2, 3});
    EXPECT_THAT(refusal(write("nan.glb", glb(squareJson(""), bytes.data()))), HasSubstr("a position is not a number"));
    Bytes far;
    far.add<float>({0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0});
    far.add<uint16_t>({0, 1, 2, 0, 2, 4});
    EXPECT_THAT(refusal(write("far.glb", glb(squareJson(""), far.data()))),
                HasSubstr("index 4, but there are 4 vertices"));
}

// Cut off anywhere, a file is refused, without a crash; only spaces at the end of a text are no loss.
TEST_F(ViewerScene, CutOff) {
    const std::vector<uint8_t> binary = glb(squareJson(""), square());
    for (size_t size = 0; size < binary.size(); size += 3)
        refusal(
            write("cut.glb", std::vector<uint8_t>(binary.begin(), binary.begin() + static_cast<std::ptrdiff_t>(size))));
    // A header that knows of the cut, too.
    for (size_t size = 12; size < binary.size(); size += 3) {
        std::vector<uint8_t> cut(binary.begin(), binary.begin() + static_cast<std::ptrdiff_t>(size));
        const auto length = static_cast<uint32_t>(size);
        std::memcpy(&cut[8], &length, 4);
        refusal(write("cut.glb", cut));
    }
    const std::string text = squareGltf();
    for (size_t size = 0; size < text.size(); size += 7) refusal(write("cut.gltf", text.substr(0, size)));
}

// Every byte of the JSON changed: whatever comes out, nothing crashes and every index has its vertex.
TEST_F(ViewerScene, AnyByteChanged) {
    const std::string json = squareJson("");
    for (size_t at = 0; at < json.size(); ++at) {
        std::string changed = json;
        changed[at] = "9-\"]"[at * 7 / 5 % 4];
        Scene scene;
        std::string error;
        if (!loadScene(write("changed.glb", glb(changed, square())), scene, error)) {
            EXPECT_FALSE(error.empty());
            continue;
        }
        for (const ScenePart& part : scene.parts) {
            ASSERT_LT(part.material, scene.materials.size());
            for (const uint32_t index : part.mesh.indices) ASSERT_LT(index, part.mesh.vertices.size());
        }
    }
}

/// Reads `count` files made of `right` by changing a few bytes at random; what is read must hang together.
void readChanged(const std::vector<uint8_t>& right, const std::string& path, int count) {
    Random random(11);
    for (int i = 0; i < count; ++i) {
        std::vector<uint8_t> changed = right;
        for (uint32_t change = random.below(6); change != ~0u; --change) {
            const uint32_t at = random.below(static_cast<uint32_t>(changed.size()));
            // Another byte, one of the file's own, a digit, or nothing.
            const uint32_t kind = random.below(4);
            if (kind == 0) changed[at] = static_cast<uint8_t>(random.below(256));
            if (kind == 1) changed[at] = changed[random.below(static_cast<uint32_t>(changed.size()))];
            if (kind == 2) changed[at] = static_cast<uint8_t>('0' + random.below(10));
            if (kind == 3) changed.erase(changed.begin() + at);
        }
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(changed.data()), static_cast<std::streamsize>(changed.size()));
        Scene scene;
        std::string error;
        if (!loadScene(path, scene, error)) {
            ASSERT_FALSE(error.empty());
            continue;
        }
        for (const ScenePart& part : scene.parts) {
            ASSERT_LT(part.material, scene.materials.size());
            ASSERT_LT(scene.materials[part.material].texture.texture, static_cast<int>(scene.textures.size()));
            for (const uint32_t index : part.mesh.indices) ASSERT_LT(index, part.mesh.vertices.size());
            for (const MeshVertex& vertex : part.mesh.vertices) ASSERT_LE(glm::length(vertex.position), 2);
        }
    }
}

TEST_F(ViewerScene, BytesChangedAtRandom) {
    readChanged(glb(squareJson(""), square()), (folder_ / "changed.glb").string(), 500);
    const std::string gltf = squareGltf();
    readChanged({gltf.begin(), gltf.end()}, (folder_ / "changed.gltf").string(), 250);
    const std::string obj =
        "mtllib no.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nvt 0 1\nvn 0 0 1\no thing\ng part\nf 1/1/1 2/1/1 3/1/1\n"
        "usemtl red\nf 1//1 2//1 3//1 4//1\ns 1\nf -4 -3 -2\nl 1 2 3\np 1\nt crease 1/0/1 2\n";
    readChanged({obj.begin(), obj.end()}, (folder_ / "changed.obj").string(), 500);
}

TEST_F(ViewerScene, Obj) {
    write("colors.mtl",
          std::string("newmtl red\nKd 1 0 0\nNs 50\nmap_Kd missing.png\nnewmtl glass\nKd 0 0 1\nd 0.5\n"));
    const Scene scene = read(write("a.obj", std::string("mtllib colors.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n"
                                                        "f 1 2 3\nusemtl red\nf 1 2 3 4\nusemtl glass\nf -4 -3 -2\n")));
    ASSERT_EQ(scene.parts.size(), 3u);
    EXPECT_EQ(triangleCount(scene), 4u);
    EXPECT_EQ(scene.materials[scene.parts[0].material].name, "red");
    EXPECT_EQ(scene.parts[0].mesh.indices.size(), 6u);
    EXPECT_EQ(scene.materials[scene.parts[1].material].alpha, Alpha::kBlended);
    EXPECT_EQ(scene.materials[scene.parts[2].material].name, "");
    for (const MeshVertex& vertex : scene.parts[0].mesh.vertices) EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_THAT(scene.notes[0], HasSubstr("missing.png"));
}

TEST_F(ViewerScene, WrongObjIsRefused) {
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_THAT(refusal(write("index.obj", corners + "f 1 2 4\n")), HasSubstr("triangle 0 of"));
    EXPECT_THAT(refusal(write("uv.obj", corners + "vt 0 0\nf 1/1 2/1 3/9\n")), HasSubstr("triangle 0 of"));
    EXPECT_THAT(refusal(write("normal.obj", corners + "vn 0 0 1\nf 1//1 2//1 3//2\n")), HasSubstr("triangle 0 of"));
    EXPECT_THAT(refusal(write("far.obj", "v 1e300 0 0\n" + corners + "f 1 2 3\n")), HasSubstr("not a number below"));
    EXPECT_THAT(refusal(write("zero.obj", corners + "f 0 1 2\n")), HasSubstr("zero.obj"));
    EXPECT_THAT(refusal(write("nothing.obj", corners)), HasSubstr("no triangles"));
    EXPECT_THAT(refusal((folder_ / "nowhere.obj").string()), HasSubstr("nowhere.obj"));
}

TEST_F(ViewerScene, OtherFilesAreRefused) {
    EXPECT_THAT(refusal(write("a.txt", std::string("text"))), HasSubstr("reads .obj, .gltf and .glb"));
    EXPECT_THAT(refusal((folder_ / "nowhere.glb").string()), HasSubstr("could not be read"));
    EXPECT_THAT(refusal(folder_.string() + ".gltf"), HasSubstr("could not be read"));
    std::filesystem::create_directories(folder_ / "folder.glb");
    EXPECT_FALSE(refusal((folder_ / "folder.glb").string()).empty());
}

}  // namespace
}  // namespace samples::test
