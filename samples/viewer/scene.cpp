#include "samples/viewer/scene.h"

#include <algorithm>
#include <filesystem>

#include "samples/common/app.h"
#include "samples/common/obj_file.h"
#include "samples/common/trigonometry.h"
#include "samples/viewer/gltf_scene.h"

namespace samples {
namespace {

std::string lowerCaseEnd(const std::string& path) {
    std::string end = std::filesystem::path(path).extension().string();
    for (char& c : end)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return end;
}

/// One texture of a material, if it can be read; a model without it is worth seeing.
int textureOf(const std::string& folder, const std::string& name, Scene& scene) {
    if (name.empty()) return -1;
    // Exporters of other systems write backslashes.
    std::string path = name;
    std::replace(path.begin(), path.end(), '\\', '/');
    Picture picture;
    std::string error;
    if (!readPicture((std::filesystem::path(folder) / path).string(), picture, error)) {
        scene.notes.push_back(error);
        return -1;
    }
    scene.textures.push_back({std::move(picture)});
    return static_cast<int>(scene.textures.size()) - 1;
}

bool readObjScene(const std::string& path, Scene& scene, std::string& error) {
    ObjModel model;
    if (!readObj(path, true, model, error)) return false;
    const std::string folder = std::filesystem::path(path).parent_path().string();
    for (const ObjMaterial& from : model.materials) {
        SceneMaterial material;
        material.name = from.name;
        material.texture.texture = textureOf(folder, from.texture, scene);
        material.color = glm::vec4(from.color, from.opacity);
        // Exporters that know no colour beside a texture write black.
        if (material.texture.texture >= 0 && from.color == glm::vec3(0))
            material.color = glm::vec4(1, 1, 1, from.opacity);
        if (from.opacity < 1) material.alpha = Alpha::kBlended;
        material.roughness = 1 / (1 + std::max(from.shininess, 0.0f) * 0.02f);
        scene.materials.push_back(material);
    }
    scene.materials.push_back({"", {0.8f, 0.75f, 0.65f, 1}});
    for (size_t i = 0; i < model.parts.size(); ++i)
        if (!model.parts[i].indices.empty()) scene.parts.push_back({std::move(model.parts[i]), i, {}});
    if (!model.warning.empty()) scene.notes.push_back(model.warning);
    return true;
}

void fit(Scene& scene) {
    std::vector<MeshData*> meshes;
    for (ScenePart& part : scene.parts) meshes.push_back(&part.mesh);
    scene.ball = ballAround(meshes);
    for (MeshData* mesh : meshes) moveIntoUnitBall(scene.ball, *mesh);
}

glm::mat4 placed(float x, float y, float z, float scale) {
    return glm::scale(glm::translate(glm::mat4(1), glm::vec3(x, y, z)), glm::vec3(scale));
}

MeshData moved(const MeshData& mesh, const glm::mat4& transform) {
    MeshData result;
    append(result, mesh, transform);
    return result;
}

}  // namespace

bool loadScene(const std::string& path, Scene& scene, std::string& error) {
    Scene read;
    read.name = std::filesystem::path(path).filename().string();
    const std::string end = lowerCaseEnd(path);
    if (end == ".obj") {
        if (!readObjScene(path, read, error)) return false;
    } else if (end == ".gltf" || end == ".glb") {
        if (!readGltfScene(path, read, error)) return false;
    } else {
        error = path + ": the viewer reads .obj, .gltf and .glb";
        return false;
    }
    fit(read);
    scene = std::move(read);
    return true;
}

void poseScene(Scene& scene, size_t animation, double seconds) {
    scene.motion->pose(animation, seconds, scene.parts);
    for (ScenePart& part : scene.parts) moveIntoUnitBall(scene.ball, part.mesh);
}

Scene builtInScene() {
    Scene scene;
    scene.name = "built-in";
    scene.textures.push_back({{256, 256, checkerTexels(256, 16, 0xFF606870, 0xFFE8E4DC)}});
    scene.textures.push_back({{128, 128, checkerTexels(128, 8, 0xFF2868C8, 0xFFF0F0F0)}});
    // A lattice: what is not 0xFF in alpha is left out.
    scene.textures.push_back({{128, 128, checkerTexels(128, 16, 0xFF48A0D8, 0x0048A0D8)}});
    scene.materials = {{"floor", {0.9f, 0.9f, 0.9f, 1}}, {"knot", {0.95f, 0.8f, 0.5f, 1}},
                       {"ball", {0.9f, 0.35f, 0.3f, 1}}, {"crate", {1, 1, 1, 1}},
                       {"lattice", {1, 1, 1, 1}},        {"glass", {0.35f, 0.7f, 0.9f, 0.4f}}};
    scene.materials[0].texture.texture = 0;
    scene.materials[0].roughness = 0.9f;
    scene.materials[1].metallic = 0.8f;
    scene.materials[1].roughness = 0.35f;
    scene.materials[2].roughness = 0.2f;
    scene.materials[3].texture.texture = 1;
    scene.materials[4].texture.texture = 2;
    scene.materials[4].alpha = Alpha::kMasked;
    scene.materials[5].alpha = Alpha::kBlended;
    scene.materials[5].roughness = 0.15f;
    for (const size_t closed : {0u, 1u, 2u, 3u}) scene.materials[closed].twoSided = false;
    MeshData knot = torusKnotMesh(240, 20);
    const glm::mat4 pane =
        placed(0.4f, 0.9f, 1.9f, 1) * rotation(0.5, {0, 1, 0}) * glm::scale(glm::mat4(1), glm::vec3(1.1f, 0.9f, 0.03f));
    const glm::mat4 fence = placed(-1.9f, 0.75f, 1.2f, 1) * rotation(-0.35, {0, 1, 0}) * rotation(kPi / 2, {1, 0, 0}) *
                            glm::scale(glm::mat4(1), glm::vec3(0.8f, 1, 0.75f));
    const std::pair<MeshData, size_t> parts[] = {
        {moved(planeMesh(3.1f, 3), glm::mat4(1)), 0},
        {moved(knot, placed(0, 1.35f, -0.4f, 0.38f)), 1},
        {moved(sphereMesh(0.6f, 48, 24), placed(2.1f, 0.6f, -0.2f, 1)), 2},
        {moved(boxMesh(), placed(-2.2f, 0.6f, -1.1f, 0.6f) * rotation(0.6, {0, 1, 0})), 3},
        {moved(planeMesh(1, 1), fence), 4},
        {moved(boxMesh(), pane), 5}};
    for (const auto& [mesh, material] : parts) scene.parts.push_back({mesh, material, {}});
    fit(scene);
    return scene;
}

size_t triangleCount(const Scene& scene) {
    size_t count = 0;
    for (const ScenePart& part : scene.parts) count += part.mesh.indices.size() / 3;
    return count;
}

}  // namespace samples
