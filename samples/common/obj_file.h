// Wavefront OBJ files, read by tinyobjloader.
#pragma once

#include <string>

#include "samples/common/mesh.h"

namespace samples {

/// All shapes of the file in one mesh. Where the file has no normals they are computed: `smooth`, from the triangles
/// around a vertex, or of the face. Texture coordinates turn to Vernier's: v runs down. A file that cannot be read ends
/// the program with a message.
MeshData loadObj(const std::string& path, bool smooth = true);

/// Moves and scales the mesh into the ball of radius 1 around the origin.
void fitIntoUnitBall(MeshData& mesh);

}  // namespace samples
