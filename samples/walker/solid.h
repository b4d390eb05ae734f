// The other version: the whole map as triangles, for the depth buffer.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "samples/walker/map.h"

namespace samples {

struct SolidVertex {
    glm::vec3 position;  // x, y, height
    uint32_t number;     // surfaceNumber()
    glm::vec2 wall;      // on walls: distance along the edge and its length
};

/// Three vertices per triangle, clockwise seen from inside the sector: each is seen from there alone.
std::vector<SolidVertex> solidOf(const Map& map);

}  // namespace samples
