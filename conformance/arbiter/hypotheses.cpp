#include "conformance/arbiter/hypotheses.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vernier::conformance {
namespace {

/// Calls change(draw, pipeline) for every draw; true if any call did.
template <class Change>
bool forDraws(Scene& scene, Change change) {
    bool any = false;
    for (SceneStep& step : scene.steps) {
        auto* pass = std::get_if<ScenePass>(&step);
        if (pass == nullptr) continue;
        for (SceneDraw& draw : pass->draws) any = change(*pass, draw, scene.pipelines[draw.pipeline]) || any;
    }
    return any;
}

template <class Change>
bool forPipelines(Scene& scene, Change change) {
    bool any = false;
    for (ScenePipeline& pipeline : scene.pipelines) any = change(pipeline) || any;
    return any;
}

bool isLines(const ScenePipeline& pipeline) {
    return pipeline.topology == VK_PRIMITIVE_TOPOLOGY_LINE_LIST ||
           pipeline.topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
}

bool filters(const Scene& scene) {
    return std::ranges::any_of(scene.samplers, [](const SceneSampler& sampler) {
        return sampler.magFilter == VK_FILTER_LINEAR || sampler.minFilter == VK_FILTER_LINEAR;
    });
}

bool hasLevels(const Scene& scene) {
    return std::ranges::any_of(scene.images, [](const SceneImage& image) { return image.mipLevels > 1; });
}

bool weightsOf(const Scene& scene, OracleRules& rules, int bits) {
    rules.weightBits = bits;
    return filters(scene);
}

/// Scissors whose right and lower borders lie `by` pixels further out, within the pass.
bool moveScissors(Scene& scene, int by) {
    return forDraws(scene, [by](const ScenePass& pass, SceneDraw& draw, const ScenePipeline&) {
        VkRect2D& scissor = draw.scissor;
        const auto moved = [by](uint32_t size, int32_t offset, uint32_t limit) {
            const int64_t end = int64_t{offset} + size;
            if (end >= limit && by > 0) return size;  // not beyond the pass
            return static_cast<uint32_t>(std::max<int64_t>(0, int64_t{size} + by));
        };
        const VkExtent2D before = scissor.extent;
        // Scissors that cover the pass were not asked for.
        if (scissor.offset.x <= 0 && scissor.offset.y <= 0 && before.width >= pass.extent.width &&
            before.height >= pass.extent.height)
            return false;
        scissor.extent = {moved(before.width, scissor.offset.x, pass.extent.width),
                          moved(before.height, scissor.offset.y, pass.extent.height)};
        return scissor.extent.width != before.width || scissor.extent.height != before.height;
    });
}

bool startScissors(Scene& scene, int by) {
    return forDraws(scene, [by](const ScenePass&, SceneDraw& draw, const ScenePipeline&) {
        VkRect2D& scissor = draw.scissor;
        if (scissor.offset.x <= 0 && scissor.offset.y <= 0) return false;
        const auto shift = [by](int32_t& offset, uint32_t& size) {
            if (offset <= 0) return;
            offset += by;
            size = static_cast<uint32_t>(std::max<int64_t>(0, int64_t{size} - by));
        };
        shift(scissor.offset.x, scissor.extent.width);
        shift(scissor.offset.y, scissor.extent.height);
        return true;
    });
}

bool testsDepths(const Scene& scene) {
    return std::ranges::any_of(scene.pipelines, [](const ScenePipeline& p) { return p.depthTest; });
}

bool snap(const Scene&, OracleRules& rules, int bits) {
    rules.subPixelBits = bits;
    return true;
}

bool giveTies(const Scene& scene, OracleRules& rules, TieRule ties) {
    rules.ties = ties;
    return std::ranges::any_of(scene.pipelines, [](const ScenePipeline& pipeline) {
        return pipeline.topology >= VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST && pipeline.polygonMode == VK_POLYGON_MODE_FILL;
    });
}

constexpr Hypothesis kHypotheses[] = {
    {"majorAxis", "attributes of Bresenham lines follow the major axis alone, not the projection on the segment",
     [](Scene& scene, OracleRules& rules) {
         rules.majorAxisLines = true;
         return std::ranges::any_of(scene.pipelines, [](const ScenePipeline& pipeline) {
             return isLines(pipeline) && pipeline.lineMode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
         });
     }},
    {"weights7", "weights of linear filters have 7 bits",
     [](Scene& scene, OracleRules& rules) { return weightsOf(scene, rules, 7); }},
    {"weights6", "weights of linear filters have 6 bits",
     [](Scene& scene, OracleRules& rules) { return weightsOf(scene, rules, 6); }},
    {"weights4", "weights of linear filters have 4 bits",
     [](Scene& scene, OracleRules& rules) { return weightsOf(scene, rules, 4); }},
    {"level4", "levels of detail have 4 fraction bits",
     [](Scene& scene, OracleRules& rules) {
         rules.levelSlack = 0x1p-4 + 0.03;
         return hasLevels(scene);
     }},
    {"level", "the level of detail is up to half a level off",
     [](Scene& scene, OracleRules& rules) {
         rules.levelSlack = 0.5;
         return hasLevels(scene);
     }},
    {"snap4", "vertices are snapped to 4 sub-pixel bits",
     [](Scene& scene, OracleRules& rules) { return snap(scene, rules, 4); }},
    {"tiesInclusive", "the fill rule is missing: samples on an edge belong to both triangles",
     [](Scene& scene, OracleRules& rules) { return giveTies(scene, rules, TieRule::both); }},
    {"tiesExclusive", "samples on an edge belong to neither triangle",
     [](Scene& scene, OracleRules& rules) { return giveTies(scene, rules, TieRule::neither); }},
    // Permitted: it explains departures from declared rules alone.
    {"tiesBottomRight", "samples on an edge belong to the triangle whose bottom or right edge it is",
     [](Scene& scene, OracleRules& rules) { return giveTies(scene, rules, TieRule::bottomRight); }},
    // SwiftShader, PixelRoutine::quad, subtracts a sample's x where its edges and its y are added.
    {"mirroredDepths", "depths of samples are taken at places mirrored from left to right in the pixel",
     [](Scene& scene, OracleRules& rules) {
         rules.mirroredDepths = true;
         return testsDepths(scene) && std::ranges::any_of(scene.pipelines, [](const ScenePipeline& pipeline) {
                    return pipeline.samples != VK_SAMPLE_COUNT_1_BIT;
                });
     }},
    // SwiftShader sets planes up from the projected vertices, those behind the eye too.
    {"planesBehindEye", "depths and inputs of triangles through the eye plane follow all three snapped vertices",
     [](Scene& scene, OracleRules& rules) {
         rules.planesBehindEye = true;
         return !scene.pipelines.empty();
     }},
    // SwiftShader, Blitter::blit, clamps linear blits only when its coordinates at the destination's origin are small.
    {"truncatedBlits", "linear blits that are mirrored in x and y go on beyond the first texels' centres",
     [](Scene& scene, OracleRules& rules) {
         rules.truncatedBlits = true;
         return std::ranges::any_of(scene.steps, [](const SceneStep& step) {
             const auto* blit = std::get_if<SceneBlitImage>(&step);
             return blit != nullptr && blit->filter == VK_FILTER_LINEAR;
         });
     }},
    {"scissorWide", "scissors reach one pixel too far to the right and down",
     [](Scene& scene, OracleRules&) { return moveScissors(scene, 1); }},
    {"scissorNarrow", "scissors end one pixel too early at the right and below",
     [](Scene& scene, OracleRules&) { return moveScissors(scene, -1); }},
    {"scissorLate", "scissors begin one pixel too late",
     [](Scene& scene, OracleRules&) { return startScissors(scene, 1); }},
    {"scissorEarly", "scissors begin one pixel too early",
     [](Scene& scene, OracleRules&) { return startScissors(scene, -1); }},
    {"provoking", "flat values come from the other provoking vertex",
     [](Scene& scene, OracleRules&) {
         return forPipelines(scene, [](ScenePipeline& pipeline) {
             pipeline.provokingVertexLast = !pipeline.provokingVertexLast;
             return true;
         });
     }},
    {"facing", "front and back are swapped",
     [](Scene& scene, OracleRules&) {
         return forPipelines(scene, [](ScenePipeline& pipeline) {
             const bool clockwise = pipeline.frontFace == VK_FRONT_FACE_CLOCKWISE;
             pipeline.frontFace = clockwise ? VK_FRONT_FACE_COUNTER_CLOCKWISE : VK_FRONT_FACE_CLOCKWISE;
             return true;
         });
     }},
    {"depthEqual", "equal depths are decided the other way",
     [](Scene& scene, OracleRules&) {
         return forPipelines(scene, [](ScenePipeline& pipeline) {
             constexpr std::pair<VkCompareOp, VkCompareOp> kOthers[] = {
                 {VK_COMPARE_OP_LESS, VK_COMPARE_OP_LESS_OR_EQUAL},
                 {VK_COMPARE_OP_LESS_OR_EQUAL, VK_COMPARE_OP_LESS},
                 {VK_COMPARE_OP_GREATER, VK_COMPARE_OP_GREATER_OR_EQUAL},
                 {VK_COMPARE_OP_GREATER_OR_EQUAL, VK_COMPARE_OP_GREATER}};
             for (const auto& [from, to] : kOthers) {
                 if (!pipeline.depthTest || pipeline.depthCompare != from) continue;
                 pipeline.depthCompare = to;
                 return true;
             }
             return false;
         });
     }},
    {"noBias", "depth bias is not applied",
     [](Scene& scene, OracleRules&) {
         return forPipelines(scene, [](ScenePipeline& pipeline) { return std::exchange(pipeline.depthBias, false); });
     }},
    {"clipWhenClamped", "near and far clip although depth clamping turns that off",
     [](Scene& scene, OracleRules&) {
         return forPipelines(scene, [](ScenePipeline& pipeline) {
             const bool changes = !pipeline.depthClip.value_or(!pipeline.depthClamp);
             pipeline.depthClip = true;
             return changes;
         });
     }},
    {"noClip", "near and far do not clip although depth clamping leaves that on",
     [](Scene& scene, OracleRules&) {
         return forPipelines(scene, [](ScenePipeline& pipeline) {
             const bool changes = pipeline.depthClip.value_or(!pipeline.depthClamp);
             pipeline.depthClip = false;
             return changes;
         });
     }},
};

}  // namespace

std::span<const Hypothesis> allHypotheses() {
    return kHypotheses;
}

const Hypothesis* findHypothesis(std::string_view name) {
    const auto found = std::ranges::find(kHypotheses, name, &Hypothesis::name);
    return found == std::end(kHypotheses) ? nullptr : &*found;
}

}  // namespace vernier::conformance
