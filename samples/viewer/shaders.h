// The viewer's GLSL.
#pragma once

#include <glm/glm.hpp>
#include <string>

namespace samples::viewer_shaders {

/// What the model's programs are pushed.
struct ModelPush {
    glm::mat4 transform;
    glm::vec4 eye;       // place; w: what a fragment adds in the counting program
    glm::vec4 color;     // linear, of the material
    glm::vec4 emission;  // w: alpha below which masked materials are left out
    // Metallic, exponent of the highlight, strength of the highlight, 0; of mapped parts metallic, roughness, how much
    // of the highlight a smooth surface has, and how much normals of the map lean.
    glm::vec4 surface;
};

/// What the programs that show the views are pushed.
struct ShowPush {
    glm::vec4 bar;  // of the legend, in pixels: left, top, right, bottom
    float scale;    // value at the right end of the bar
    float divide;   // pixels left of the line that parts the split screen
    int sign;       // not 0: errors with their sign
    float nearPlane, farPlane;
};

extern const std::string kModelVertex;
/// Half-Lambert light and a highlight (Blinn and Phong's), in linear colours.
extern const std::string kModelFragment;
extern const std::string kModelMaskedFragment;
/// With colours of vertices and maps of metal and roughness, emission and normals: for parts that have VertexExtras.
extern const std::string kMappedVertex;
extern const std::string kMappedFragment;
extern const std::string kMappedMaskedFragment;
/// Adds how much of a run of the fragment program a pixel stands for, times a weight.
extern const std::string kCountFragment;
extern const std::string kCountMaskedFragment;
extern const std::string kPlainFragment;

// Views: a triangle over the whole picture each.
extern const std::string kShowSplit;
extern const std::string kShowError;
extern const std::string kShowDepth;
extern const std::string kShowCount;
extern const std::string kShowTiles;
/// A work-group per tile of 64 x 64 pixels: adds up the counts.
extern const std::string kSumTiles;

}  // namespace samples::viewer_shaders
