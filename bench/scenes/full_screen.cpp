#include "bench/scenes/full_screen.h"

namespace vernier::bench {

using namespace conformance;

const char* const kQuadVertex = R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(uv * 2.0 - 1.0, 0.5, 1.0);
})";

const char* const kGradientFragment = R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(uv, 0.5, 1.0); })";

VkPipelineColorBlendAttachmentState alphaBlending() {
    VkPipelineColorBlendAttachmentState state{};
    state.blendEnable = VK_TRUE;
    state.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    state.colorWriteMask = 0xF;
    return state;
}

Result<Scene> fullScreen(const char* name, const char* description, const char* fragment, uint32_t times, bool blend,
                         VkExtent2D extent) {
    SceneRecorder record(name, description);
    const uint32_t target = record.colorTarget("color", kRgba8, extent);
    PipelineRecorder pipeline = record.pipeline(record.vertex(kQuadVertex), record.fragment(fragment));
    pipeline.topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
    if (blend) pipeline.blend(alphaBlending());
    record.pass(extent).color(target, {0, 0, 0, 1});
    for (uint32_t i = 0; i < times; ++i) record.draw(pipeline, 4);
    record.output(target);
    return record.finish();
}

}  // namespace vernier::bench
