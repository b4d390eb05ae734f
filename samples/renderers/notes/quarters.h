// What the pages on programmable stages share: the picture in four quarters, each of which shows one thing, programs of
// more than two stages, and an eye that circles the origin.
#pragma once

#include "samples/common/app.h"

namespace samples {

/// How a page is shown.
struct PageView {
    double seconds;
    bool gl;    // clip space with y up and depths from -1 on, as OpenGL has it: the same picture
    bool cull;  // leave out back faces
};

/// GLSL by stage; empty where there is none.
struct StageSources {
    std::string vertex, control, evaluation, geometry, fragment;
};

class Quarters {
  public:
    /// The head of every shader: `transform` to clip space, the `eye` in the world, a `tint` and four `options`.
    static const char* const kHead;
    /// A vertex shader for stages that want places in the world.
    static const std::string kWorldVertex;
    /// Surfaces: facets by the derivatives of `place` (location 0), lit on the side of the eye, in `color` (location
    /// 1).
    static const std::string kFacetFragment;
    /// `color` (location 1) as it is.
    static const std::string kColorFragment;

    explicit Quarters(App& app);

    VnProgram program(const StageSources& sources);
    /// Starts a pass. The eye is `distance` away from the origin, level with `height`.
    void begin(const PageView& view, float distance, float height);
    void end() { app_.endPass(); }
    /// 0 and 1 are the upper ones, from left to right; 2 and 3 the lower ones.
    void select(int quarter);
    /// What follows is drawn by `program` from places (three floats) in `buffer`. Faces lie a little behind where they
    /// are, so that lines on them are seen; `outlines` draws only the edges of triangles.
    void bind(VnProgram program, VnBuffer buffer, VkPrimitiveTopology topology, bool outlines = false);
    void push(const glm::vec3& tint, const glm::vec4& options = glm::vec4(0));

  private:
    App& app_;
    VnVertexLayout layout_;
    VnDepthStencilState depth_;
    VnRasterState rasters_[2][2][2];  // by clip space, culling, outlines
    PageView view_{};
    glm::mat4 transform_{};
    glm::vec3 eye_{};
};

}  // namespace samples
