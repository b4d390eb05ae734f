// Wavefront OBJ files, read by tinyobjloader.
#pragma once

#include <string>
#include <vector>

#include "samples/common/mesh.h"

namespace samples {

struct ObjMaterial {
    std::string name;
    glm::vec3 color{1};   // Kd
    float shininess = 0;  // Ns
    float opacity = 1;    // d
    std::string texture;  // map_Kd, as the file says it; empty: none
};

/// The faces of each material, and at the end of those without.
struct ObjModel {
    std::vector<ObjMaterial> materials;
    std::vector<MeshData> parts;  // one more than materials; any may be empty
    std::string warning;          // what was left out, in lines
};

/// Where the file has no normals they are computed: `smooth`, from the triangles around a vertex, or of the face.
/// Texture coordinates turn to Vernier's: v runs down. False with what is wrong: no file, no triangles, an index or a
/// position that there cannot be.
bool readObj(const std::string& path, bool smooth, ObjModel& model, std::string& error);

/// All of the file in one mesh. A file that cannot be read ends the program with a message.
MeshData loadObj(const std::string& path, bool smooth = true);

/// The ball around the box around meshes.
struct Ball {
    glm::vec3 center{0};
    float radius = 1;
};
Ball ballAround(const std::vector<MeshData*>& meshes);
/// Moves and scales what lies in a ball into that of radius 1 around the origin.
void moveIntoUnitBall(const Ball& ball, MeshData& mesh);
/// The same with the ball around them, together.
void fitIntoUnitBall(const std::vector<MeshData*>& meshes);
void fitIntoUnitBall(MeshData& mesh);

/// Whether every position is a number below 1e18: what is beyond cannot be scaled.
bool positionsAreFinite(const MeshData& mesh);

}  // namespace samples
