#include "bench/effects/effects.h"

#include <functional>

#include "bench/scenes/full_screen.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

namespace vernier::bench {
namespace {

using namespace conformance;

constexpr VkExtent2D kExtent{160, 160};
constexpr uint32_t kTriangles = 96;

using Change = std::function<void(Scene&)>;

/// Makes variants of one scene: a background and triangles over it, into a colour and a depth/stencil attachment.
class EffectMaker {
  public:
    Status start();

    /// Without a `needed` change the effect has no such column.
    void add(const char* name, const char* idleText, const Change& off, const Change& idle, const Change& needed,
             bool visible = true) {
        Effect effect{name, idleText, {}, visible};
        for (const Change* change : {&off, &idle, &needed}) {
            if (!*change && change == &needed) break;
            Scene scene = base_;
            if (change != &off && off) off(scene);
            if (*change) (*change)(scene);
            scene.name = std::string(name) + "_" + std::to_string(effect.scenes.size());
            effect.scenes.push_back(std::move(scene));
        }
        effects_.push_back(std::move(effect));
    }
    /// One scene, whose queries are none, around nothing, and around its pass.
    void addQueries() {
        add(
            "queries", "of occlusion, statistics and time, around nothing", {}, {}, [](Scene&) {}, false);
        effects_.back().queries = true;
    }
    std::vector<Effect> take() { return std::move(effects_); }

    /// Shaders that were compiled for one effect or another.
    struct Shaders {
        uint32_t clipOne, clipCut, cullOne, cullCut, unreadOutputs, pointSize, viewports;
        uint32_t killed, killing, texture, stretched, derivatives, unreadDerivatives, twoOutputs, eightOutputs;
    } shaders{};
    uint32_t texture = 0, sampler = 0, restartIndices = 0, plainIndices = 0;

  private:
    Scene base_;
    std::vector<Effect> effects_;
};

constexpr const char* kVertexHead = R"(#version 450
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 shade;
)";
constexpr const char* kFragmentHead = R"(#version 450
layout(location = 0) in vec4 shade;
layout(location = 0) out vec4 color;
)";

Status EffectMaker::start() {
    SceneRecorder record("effects", "A background and triangles.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT_S8_UINT, kExtent);
    struct Vertex {
        float x, y, z;
        uint32_t color;
    };
    // The background first, then triangles whose corners go round clockwise in the framebuffer, all front-facing.
    std::vector<Vertex> vertices{{-1, -1, 0.9f, 0xFF803020}, {3, -1, 0.9f, 0xFF306080}, {-1, 3, 0.9f, 0xFF208050}};
    SceneRandom random(17);
    for (uint32_t i = 0; i < kTriangles; ++i) {
        const float x = random.between(-0.9f, 0.6f), y = random.between(-0.9f, 0.6f), z = random.between(0.1f, 0.8f);
        const float w = random.between(0.1f, 0.4f), h = random.between(0.1f, 0.4f);
        const uint32_t color = random.next() | 0xFF000000u;
        vertices.push_back({x, y, z, color});
        vertices.push_back({x + w, y + h * 0.2f, z + 0.05f, color ^ 0x00404040u});
        vertices.push_back({x + w * 0.3f, y + h, z + 0.1f, color ^ 0x00202000u});
    }
    const auto count = static_cast<uint32_t>(vertices.size());
    const auto vertex = [&](const std::string& more, const char* body) {
        return record.vertex(kVertexHead + more + "void main() { gl_Position = vec4(position, 1.0); shade = color; " +
                             body + "}");
    };
    const auto fragment = [&](const std::string& more, const char* body) {
        return record.fragment(kFragmentHead + more + "void main() { " + body + " }");
    };
    const uint32_t pipeline = record.pipeline(vertex("", ""), fragment("", "color = shade;"))
                                  .binding(sizeof(Vertex))
                                  .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, x))
                                  .attribute(kRgba8, offsetof(Vertex, color));
    shaders.clipOne = vertex("out float gl_ClipDistance[1];\n", "gl_ClipDistance[0] = 1.0;");
    shaders.clipCut = vertex("out float gl_ClipDistance[1];\n", "gl_ClipDistance[0] = position.x + position.y;");
    shaders.cullOne = vertex("out float gl_CullDistance[1];\n", "gl_CullDistance[0] = 1.0;");
    shaders.cullCut = vertex("out float gl_CullDistance[1];\n", "gl_CullDistance[0] = position.x + position.y;");
    shaders.unreadOutputs =
        vertex("layout(location = 1) out vec4 a;\nlayout(location = 2) out vec4 b;\nlayout(location = 3) out vec4 c;\n",
               "a = color * 2.0; b = sin(color); c = position.xyzz;");
    shaders.viewports = record.vertex(
        "#version 450\n#extension GL_ARB_shader_viewport_layer_array : require\n"
        "layout(location = 0) in vec3 position;\nlayout(location = 1) in vec4 color;\n"
        "layout(location = 0) out vec4 shade;\n"
        "void main() { gl_Position = vec4(position, 1.0); shade = color; gl_ViewportIndex = gl_VertexIndex / 3 % 4; }");
    shaders.pointSize = vertex("", "gl_PointSize = 4.0;");
    shaders.killed = fragment("layout(constant_id = 0) const bool kill = false;\n",
                              "color = shade; if (kill && shade.r > 0.5) discard;");
    shaders.killing = fragment("", "color = shade; if (shade.r > 0.5) discard;");
    shaders.texture = fragment("layout(set = 0, binding = 0) uniform sampler2D image;\n",
                               "color = shade * texture(image, shade.xy * 3.0);");
    // Eight texels of 16 to the right for half a texel down.
    shaders.stretched = fragment("layout(set = 0, binding = 0) uniform sampler2D image;\n",
                                 "color = shade * texture(image, gl_FragCoord.xy * vec2(0.5, 0.03));");
    shaders.derivatives = fragment("", "color = shade + 16.0 * fwidth(shade);");
    shaders.unreadDerivatives = fragment("", "vec4 width = fwidth(shade); color = shade; if (false) color = width;");
    shaders.twoOutputs = fragment("layout(location = 1) out vec4 more;\n", "color = shade; more = shade * shade;");
    std::string outputs, writes = "color = shade;";
    for (int i = 1; i < 8; ++i) {
        outputs += "layout(location = " + std::to_string(i) + ") out vec4 c" + std::to_string(i) + ";\n";
        writes += " c" + std::to_string(i) + " = shade;";
    }
    shaders.eightOutputs = fragment(outputs, writes.c_str());
    texture = record.texture("checker", kRgba8, {16, 16},
                             {checkerPicture({16, 16}, 3, {255, 200, 90, 255}, {30, 60, 120, 255})});
    sampler = record.sampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    std::vector<uint16_t> plain, restart;
    for (uint16_t i = 0; i < count; ++i) {
        plain.push_back(i);
        restart.push_back(i);
        if (i % 3 == 2 && i + 1u < count) restart.push_back(0xFFFF);
    }
    restartIndices = record.indexBuffer("strips of one triangle", restart);
    plainIndices = record.indexBuffer("one strip", plain);
    record.pass(kExtent).color(target, {0, 0, 0, 1}).depthStencil(depth);
    record.draw(pipeline, count).vertices(record.vertexBuffer("triangles", vertices));
    record.output(target);
    Result<Scene> scene = record.finish();
    if (!scene) return scene.error();
    base_ = std::move(scene).value();
    return {};
}

ScenePipeline& pipelineOf(Scene& scene) {
    return scene.pipelines[0];
}

ScenePass& passOf(Scene& scene) {
    return std::get<ScenePass>(scene.steps.back());
}

SceneDraw& drawOf(Scene& scene) {
    return passOf(scene).draws[0];
}

Change withVertex(uint32_t shader) {
    return [=](Scene& scene) { pipelineOf(scene).vertexShader = shader; };
}

Change withFragment(uint32_t shader) {
    return [=](Scene& scene) { pipelineOf(scene).fragmentShader = shader; };
}

void testDepth(Scene& scene) {
    ScenePipeline& pipeline = pipelineOf(scene);
    pipeline.depthTest = pipeline.depthWrite = true;
    pipeline.depthCompare = VK_COMPARE_OP_LESS;
}

/// Four samples per pixel, resolved into what was the target.
void fourSamples(Scene& scene) {
    SceneImage many = scene.images[0];
    many.name = "samples";
    many.samples = VK_SAMPLE_COUNT_4_BIT;
    scene.images.push_back(many);
    SceneAttachment& color = passOf(scene).colors[0];
    color.resolveImage = color.image;
    color.image = static_cast<uint32_t>(scene.images.size() - 1);
    scene.images[passOf(scene).depthStencil.image].samples = VK_SAMPLE_COUNT_4_BIT;
    pipelineOf(scene).samples = VK_SAMPLE_COUNT_4_BIT;
}

void bindTexture(Scene& scene, uint32_t image, uint32_t sampler) {
    SceneBinding binding;
    binding.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    binding.image = image;
    binding.sampler = sampler;
    drawOf(scene).bindings.push_back(binding);
}

/// Seven more targets like the first, not loaded; `mask` is theirs.
void moreTargets(Scene& scene, VkColorComponentFlags mask) {
    for (int i = 1; i < 8; ++i) {
        scene.images.push_back(scene.images[0]);
        SceneAttachment attachment = passOf(scene).colors[0];
        attachment.image = static_cast<uint32_t>(scene.images.size() - 1);
        attachment.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
        passOf(scene).colors.push_back(attachment);
        pipelineOf(scene).blend.push_back(pipelineOf(scene).blend[0]);
        pipelineOf(scene).blend.back().colorWriteMask = mask;
    }
}

/// A viewport over a quarter of the target, with the scissor of all of it.
SceneView quarterView(int quarter) {
    constexpr float kHalf = kExtent.width / 2.0f;
    return {{kHalf * static_cast<float>(quarter % 2), kHalf * static_cast<float>(quarter / 2), kHalf, kHalf, 0, 1},
            {{0, 0}, kExtent}};
}

void stencil(Scene& scene, VkStencilOp pass, VkCompareOp compare) {
    VkStencilOpState state{};
    state.passOp = pass;
    state.compareOp = compare;
    state.compareMask = state.writeMask = 0xFF;
    pipelineOf(scene).stencilTest = true;
    pipelineOf(scene).front = pipelineOf(scene).back = state;
}

void addColorEffects(EffectMaker& make) {
    make.add(
        "blending", "enabled, source x 1 + destination x 0", {},
        [](Scene& scene) {
            VkPipelineColorBlendAttachmentState& blend = pipelineOf(scene).blend[0];
            blend.blendEnable = VK_TRUE;
            blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        },
        [](Scene& scene) {
            VkPipelineColorBlendAttachmentState& blend = pipelineOf(scene).blend[0];
            blend.blendEnable = VK_TRUE;
            blend.srcColorBlendFactor = blend.dstColorBlendFactor = VK_BLEND_FACTOR_SRC_COLOR;
            blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        });
    make.add(
        "logic_op", "enabled, COPY", {}, [](Scene& scene) { pipelineOf(scene).logicOpEnable = true; },
        [](Scene& scene) {
            pipelineOf(scene).logicOpEnable = true;
            pipelineOf(scene).logicOp = VK_LOGIC_OP_XOR;
        });
    make.add(
        "targets", "eight attachments, seven with empty write masks", {}, [](Scene& scene) { moreTargets(scene, 0); },
        [&make](Scene& scene) {
            moreTargets(scene, 0xF);
            pipelineOf(scene).fragmentShader = make.shaders.eightOutputs;
        },
        false);
    make.add("unattached_output", "a second output without an attachment", {}, withFragment(make.shaders.twoOutputs),
             {});
}

void addDepthEffects(EffectMaker& make) {
    make.add(
        "depth_attachment", "attached, neither tested nor loaded",
        [](Scene& scene) { passOf(scene).depthStencil.image = kNone; },
        [](Scene& scene) {
            passOf(scene).depthStencil.image = 1;
            passOf(scene).depthStencil.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
        },
        {});
    make.add(
        "depth_test", "ALWAYS without writing", {},
        [](Scene& scene) {
            pipelineOf(scene).depthTest = true;
            pipelineOf(scene).depthCompare = VK_COMPARE_OP_ALWAYS;
        },
        testDepth);
    make.add(
        "depth_bias", "enabled, constant and slope 0", testDepth,
        [](Scene& scene) { pipelineOf(scene).depthBias = true; },
        [](Scene& scene) {
            pipelineOf(scene).depthBias = true;
            pipelineOf(scene).depthBiasSlope = -40;
        });
    make.add("depth_clamp", "enabled, everything inside", testDepth,
             [](Scene& scene) { pipelineOf(scene).depthClamp = true; }, {});
    make.add(
        "depth_bounds", "0 to 1", testDepth, [](Scene& scene) { pipelineOf(scene).depthBoundsTest = true; },
        [](Scene& scene) {
            pipelineOf(scene).depthBoundsTest = true;
            pipelineOf(scene).minDepthBounds = 0.5f;
        });
    make.add(
        "stencil", "always passes and keeps", {},
        [](Scene& scene) { stencil(scene, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS); },
        [](Scene& scene) { stencil(scene, VK_STENCIL_OP_INCREMENT_AND_CLAMP, VK_COMPARE_OP_EQUAL); });
    make.add("stencil_state", "operations, but the test is off", {},
             [](Scene& scene) {
                 stencil(scene, VK_STENCIL_OP_INCREMENT_AND_CLAMP, VK_COMPARE_OP_EQUAL);
                 pipelineOf(scene).stencilTest = false;
             },
             {});
}

void addSampleEffects(EffectMaker& make) {
    make.add(
        "samples", "one sample, its mask and sample shading said", {},
        [](Scene& scene) {
            pipelineOf(scene).sampleMask = 1;
            pipelineOf(scene).sampleShading = true;
            pipelineOf(scene).minSampleShading = 1;
        },
        fourSamples);
    make.add(
        "sample_mask", "all four samples", fourSamples, [](Scene& scene) { pipelineOf(scene).sampleMask = 0xF; },
        [](Scene& scene) { pipelineOf(scene).sampleMask = 0x6; });
    make.add(
        "sample_shading", "enabled, a quarter of four", fourSamples,
        [](Scene& scene) {
            pipelineOf(scene).sampleShading = true;
            pipelineOf(scene).minSampleShading = 0.25f;
        },
        [](Scene& scene) {
            pipelineOf(scene).sampleShading = true;
            pipelineOf(scene).minSampleShading = 1;
        },
        false);
}

void addGeometryEffects(EffectMaker& make) {
    const auto strips = [&make](Scene& scene) {
        drawOf(scene).indexBuffer = make.plainIndices;
        pipelineOf(scene).topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    };
    make.add(
        "scissor", "as large as the pass", {},
        [](Scene& scene) {
            drawOf(scene).scissor = {{0, 0}, {kExtent.width + 9, kExtent.height + 9}};
        },
        [](Scene& scene) {
            drawOf(scene).scissor = {{21, 13}, {97, 103}};
        });
    make.add(
        "culling", "of back faces, where there are none", {},
        [](Scene& scene) {
            pipelineOf(scene).cullMode = VK_CULL_MODE_BACK_BIT;
            pipelineOf(scene).frontFace = VK_FRONT_FACE_CLOCKWISE;
        },
        [](Scene& scene) {
            pipelineOf(scene).cullMode = VK_CULL_MODE_FRONT_BIT;
            pipelineOf(scene).frontFace = VK_FRONT_FACE_CLOCKWISE;
        });
    make.add(
        "restart", "enabled, no index restarts", strips,
        [](Scene& scene) { pipelineOf(scene).primitiveRestart = true; },
        [&make](Scene& scene) {
            pipelineOf(scene).primitiveRestart = true;
            drawOf(scene).indexBuffer = make.restartIndices;
            drawOf(scene).count = drawOf(scene).count / 3 * 4 - 1;
        });
    make.add("clip_distance", "written, 1 everywhere", {}, withVertex(make.shaders.clipOne),
             withVertex(make.shaders.clipCut));
    make.add("cull_distance", "written, 1 everywhere", {}, withVertex(make.shaders.cullOne),
             withVertex(make.shaders.cullCut));
    make.add(
        "viewports", "four, of which only the first is chosen", {},
        [](Scene& scene) {
            for (int i = 0; i < 3; ++i) drawOf(scene).moreViews.push_back(quarterView(i));
        },
        [&make](Scene& scene) {
            for (int i = 0; i < 3; ++i) drawOf(scene).moreViews.push_back(quarterView(i));
            pipelineOf(scene).vertexShader = make.shaders.viewports;
        });
    const auto lines = [](Scene& scene) {
        pipelineOf(scene).topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
        pipelineOf(scene).lineMode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    };
    const auto stipple = [](Scene& scene, uint16_t pattern) {
        pipelineOf(scene).stippleFactor = 1;
        pipelineOf(scene).stipplePattern = pattern;
    };
    make.add(
        "stipple", "enabled, a pattern without gaps", lines, [=](Scene& scene) { stipple(scene, 0xFFFF); },
        [=](Scene& scene) { stipple(scene, 0x0F33); });
    make.addQueries();
    make.add("point_size", "written, but triangles are drawn", {}, withVertex(make.shaders.pointSize), {});
    make.add("unread_outputs", "three vectors nobody reads", {}, withVertex(make.shaders.unreadOutputs), {});
    make.add("unread_attribute", "an attribute the shader lacks", {},
             [](Scene& scene) {
                 auto& attributes = pipelineOf(scene).vertexAttributes;
                 attributes.push_back({2, 0, VK_FORMAT_R32G32B32_SFLOAT, 0});
             },
             {});
}

void addShaderEffects(EffectMaker& make) {
    make.add("discard", "behind a constant that is false", {}, withFragment(make.shaders.killed),
             withFragment(make.shaders.killing));
    make.add("derivatives", "taken, but not used", {}, withFragment(make.shaders.unreadDerivatives),
             withFragment(make.shaders.derivatives));
    make.add(
        "texture", "bound, but not read", {}, [&make](Scene& scene) { bindTexture(scene, make.texture, make.sampler); },
        [&make](Scene& scene) {
            bindTexture(scene, make.texture, make.sampler);
            pipelineOf(scene).fragmentShader = make.shaders.texture;
        });
    make.add(
        "anisotropy", "enabled, at most 1",
        [&make](Scene& scene) {
            bindTexture(scene, make.texture, make.sampler);
            pipelineOf(scene).fragmentShader = make.shaders.stretched;
        },
        [&make](Scene& scene) { scene.samplers[make.sampler].maxAnisotropy = 1; },
        [&make](Scene& scene) { scene.samplers[make.sampler].maxAnisotropy = 16; });
    make.add("push_constants", "set, but not read", {},
             [](Scene& scene) {
                 pipelineOf(scene).pushConstantBytes = 64;
                 drawOf(scene).pushConstants.resize(64);
             },
             {});
}

}  // namespace

Result<std::vector<Effect>> makeEffects() {
    EffectMaker make;
    if (Status status = make.start(); !status) return status.error();
    addColorEffects(make);
    addDepthEffects(make);
    addSampleEffects(make);
    addGeometryEffects(make);
    addShaderEffects(make);
    return make.take();
}

}  // namespace vernier::bench
