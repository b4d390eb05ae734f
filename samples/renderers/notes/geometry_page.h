// The page on geometry stages: a ring of triangles four times. Each triangle gets a line along its normal; each corner
// becomes a square that faces the eye; each triangle leaves its place; and edges between triangles that face the eye
// and those that do not become lines, for which the stage is given every triangle with its three neighbours.
#pragma once

#include "samples/renderers/notes/quarters.h"

namespace samples {

class GeometryPage {
  public:
    explicit GeometryPage(App& app);
    void draw(const PageView& view);

  private:
    void drawRing(VnProgram program, VkPrimitiveTopology topology, VnBuffer indices, uint32_t count);

    App& app_;
    Quarters quarters_;
    VnProgram body_, normals_, squares_, shell_, outline_;
    VnBuffer places_, triangles_, adjacency_;
    uint32_t vertexCount_, triangleIndices_, adjacencyIndices_;
};

}  // namespace samples
