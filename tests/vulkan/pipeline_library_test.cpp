// Pipelines linked from libraries (VK_EXT_graphics_pipeline_library) draw the same pictures, bit for bit, as those that
// are made whole, however they are cut.
#include "tests/vulkan/test_library.h"

namespace vernier::test {
namespace {

TEST_F(PipelineLibraryTest, everyCutOfEveryState) {
    struct Variant {
        const char* name;
        std::function<void(const PipelineStates&)> change;
        bool samples = false;
    };
    const auto stencil = [](const PipelineStates& states) {
        states.depth.stencilTestEnable = VK_TRUE;
        states.depth.front = {VK_STENCIL_OP_KEEP,
                              VK_STENCIL_OP_INCREMENT_AND_CLAMP,
                              VK_STENCIL_OP_KEEP,
                              VK_COMPARE_OP_EQUAL,
                              0xFF,
                              0xFF,
                              1};
        states.depth.back = states.depth.front;
        states.depth.back.compareOp = VK_COMPARE_OP_ALWAYS;
        states.depth.depthBoundsTestEnable = VK_TRUE;
        states.depth.minDepthBounds = 0.5f;
        states.depth.maxDepthBounds = 1;
    };
    const auto blend = [](const PipelineStates& states) {
        states.blends[0] = {VK_TRUE,
                            VK_BLEND_FACTOR_SRC_ALPHA,
                            VK_BLEND_FACTOR_CONSTANT_COLOR,
                            VK_BLEND_OP_ADD,
                            VK_BLEND_FACTOR_ONE,
                            VK_BLEND_FACTOR_ONE,
                            VK_BLEND_OP_MAX,
                            VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_A_BIT};
        const float constants[] = {0.5f, 0.25f, 1, 1};
        std::copy_n(constants, 4, states.colors.blendConstants);
        states.depth.depthTestEnable = VK_FALSE;
    };
    const auto raster = [](const PipelineStates& states) {
        states.raster.polygonMode = VK_POLYGON_MODE_LINE;
        states.raster.lineWidth = 3;
        states.raster.cullMode = VK_CULL_MODE_BACK_BIT;
        states.raster.frontFace = VK_FRONT_FACE_CLOCKWISE;
    };
    const auto bias = [](const PipelineStates& states) {
        states.raster.depthBiasEnable = VK_TRUE;
        states.raster.depthBiasConstantFactor = -1;
        states.raster.depthBiasSlopeFactor = 3;
        static constexpr VkViewport kSmaller{5, 70, 80, -60, 0, 0.9f};
        static constexpr VkRect2D kScissor{{10, 10}, {70, 50}};
        states.viewport.pViewports = &kSmaller;
        states.viewport.pScissors = &kScissor;
    };
    const auto input = [](const PipelineStates& states) {
        states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN;
        states.raster.depthClampEnable = VK_TRUE;
        states.colors.logicOpEnable = VK_TRUE;
        states.colors.logicOp = VK_LOGIC_OP_XOR;
    };
    const auto samples = [](const PipelineStates& states) {
        static constexpr VkSampleMask kMask = 0xD;
        states.multisample.pSampleMask = &kMask;
        states.multisample.alphaToCoverageEnable = VK_TRUE;
    };
    const auto shadedSamples = [](const PipelineStates& states) {
        states.multisample.sampleShadingEnable = VK_TRUE;
        states.multisample.minSampleShading = 1;
    };
    std::vector<Texels> pictures;
    for (const Variant& variant :
         {Variant{"plain", [](const PipelineStates&) {}}, Variant{"stencil", stencil}, Variant{"blending", blend},
          Variant{"rasterisation", raster}, Variant{"bias", bias}, Variant{"input", input},
          Variant{"samples", samples, true}, Variant{"shaded samples", shadedSamples, true}}) {
        SCOPED_TRACE(variant.name);
        PipelineDesc desc = triangles();
        desc.change = variant.change;
        desc.samples = variant.samples ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
        pictures.push_back(sameForAllCuts(desc, variant.samples ? samplesPass : pass));
    }
    for (size_t n = 0; n < pictures.size(); ++n) {
        EXPECT_TRUE(pictures[n] != Texels(pictures[n].size(), 0)) << n << " is empty";
        EXPECT_EQ(std::count(pictures.begin(), pictures.end(), pictures[n]), 1) << n << " is like another";
    }
}

TEST_F(PipelineLibraryTest, everyCutOfMoreStages) {
    PipelineDesc desc = triangles();
    const Texels plain = draw(makePipeline(pass.pass, desc), pass);
    desc.geometry = shader(VK_SHADER_STAGE_GEOMETRY_BIT, R"(#version 450
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec4 fromTint[];
layout(location = 1) in vec4 fromFlat[];
layout(location = 0) out vec4 smoothTint;
layout(location = 1) out vec4 flatTint;
void main() {
    for (int n = 0; n < 3; ++n) {
        gl_Position = gl_in[n].gl_Position * vec4(0.7, 0.8, 1, 1);
        smoothTint = fromTint[n].yzxw;
        flatTint = fromFlat[0];
        EmitVertex();
    }
})");
    const Texels geometry = sameForAllCuts(desc, pass);
    desc.geometry = VK_NULL_HANDLE;
    desc.control = shader(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, R"(#version 450
layout(vertices = 3) out;
layout(location = 0) in vec4 fromTint[];
layout(location = 1) in vec4 fromFlat[];
layout(location = 0) out vec4 tint[];
layout(location = 1) out vec4 flats[];
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    tint[gl_InvocationID] = fromTint[gl_InvocationID];
    flats[gl_InvocationID] = fromFlat[gl_InvocationID];
    gl_TessLevelOuter = float[](3, 2, 4, 1);
    gl_TessLevelInner = float[](3, 1);
})");
    desc.evaluation = shader(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, R"(#version 450
layout(triangles, cw) in;
layout(location = 0) in vec4 tint[];
layout(location = 1) in vec4 flats[];
layout(location = 0) out vec4 smoothTint;
layout(location = 1) out vec4 flatTint;
void main() {
    vec3 c = gl_TessCoord;
    gl_Position = c.x * gl_in[0].gl_Position + c.y * gl_in[1].gl_Position + c.z * gl_in[2].gl_Position;
    gl_Position.xy += 0.1 * sin(c.xy * 9.0);
    smoothTint = tint[0] * c.x + tint[1] * c.y + tint[2] * c.z;
    flatTint = flats[int(c.x * 2.5)];
})");
    desc.patchControlPoints = 3;
    const auto cullFront = [](const PipelineStates& states) {
        states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
        states.raster.cullMode = VK_CULL_MODE_FRONT_BIT;
    };
    desc.change = cullFront;
    const Texels upper = sameForAllCuts(desc, pass);
    desc.domainLowerLeft = true;
    const Texels lower = sameForAllCuts(desc, pass);
    EXPECT_NE(geometry, plain);
    EXPECT_NE(upper, plain);
    EXPECT_NE(upper, lower);
}

TEST_F(PipelineLibraryTest, withoutAFragmentStage) {
    PipelineDesc desc = triangles();
    desc.fragment = VK_NULL_HANDLE;
    const auto depths = [&] {
        (void)draw(makePipeline(pass.pass, desc), pass);
        return readImage(depth, VK_IMAGE_ASPECT_DEPTH_BIT, sizeof(float));
    };
    const Texels expected = depths();
    EXPECT_NE(std::count(expected.begin(), expected.end(), expected[0]), std::ssize(expected)) << "nothing is drawn";
    for (const Cut& each : allCuts()) {
        cut = each;
        EXPECT_EQ(depths(), expected) << testing::PrintToString(each);
    }
}

TEST_F(PipelineLibraryTest, withoutRasterisation) {
    // Two libraries are a whole pipeline then, and the others count for nothing.
    const TestBuffer seen = makeBuffer(64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const VkDescriptorSetLayout sets =
        makeSetLayout({{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_VERTEX_BIT, nullptr}});
    const VkDescriptorSet set = makeEmptySet(sets, {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}});
    const VkDescriptorBufferInfo info{seen.buffer, 0, VK_WHOLE_SIZE};
    auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &info;
    vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    layout = makeLayout({sets}, 16);
    PipelineDesc desc = triangles();
    desc.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
layout(location = 0) in vec2 place;
layout(set = 0, binding = 0) buffer Seen { float places[]; };
layout(location = 0) out vec4 smoothTint;
layout(location = 1) flat out vec4 flatTint;
void main() {
    places[gl_VertexIndex] = place.x;
    smoothTint = flatTint = vec4(1);
    gl_Position = vec4(place, 0, 1);
})");
    desc.layout = layout;
    desc.attributes.resize(1);
    desc.change = [](const PipelineStates& states) { states.raster.rasterizerDiscardEnable = VK_TRUE; };
    for (const Cut& each : {Cut{kInput, kBefore, kFragment | kOutput}, Cut{kInput, kBefore}, Cut{kInput | kBefore}}) {
        if (validated() && each.size() < 3) continue;  // the layer (1.3.239) takes a pipeline to have all parts
        cut = each;
        std::memset(seen.data, 0, seen.size);
        const Texels texels = draw(makePipeline(pass.pass, desc), pass, [&](VkCommandBuffer commands) {
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
        });
        EXPECT_EQ(texels, Texels(texels.size(), 0));
        for (uint32_t n = 0; n < 12; ++n) EXPECT_EQ(static_cast<const float*>(seen.data)[n], kTriangles[6 * n]);
    }
}

TEST_F(PipelineLibraryTest, interpolationIsAsTheFragmentShaderSays) {
    // The vertex shader says the opposite of what the fragment shader does; the two need not match.
    std::string vertex = kVertex;
    vertex.replace(vertex.find("out vec4 smoothTint"), 0, "flat ");
    vertex.replace(vertex.find("flat out vec4 flatTint"), 5, "");
    const PipelineDesc desc = triangles();
    const Texels matching = draw(makePipeline(pass.pass, desc), pass);
    PipelineDesc opposite = desc;
    opposite.vertex = shader(VK_SHADER_STAGE_VERTEX_BIT, vertex);
    EXPECT_EQ(sameForAllCuts(opposite, pass), matching);
}

TEST_F(PipelineLibraryTest, dynamicStateBelongsToItsPart) {
    const auto setAll = [](VkCommandBuffer commands) {
        const VkViewport area{20, 10, 60, 60, 0, 1};
        const VkRect2D scissor{{24, 14}, {48, 50}};
        const float constants[] = {1, 0.5f, 0.25f, 1};
        vkCmdSetViewport(commands, 0, 1, &area);
        vkCmdSetScissor(commands, 0, 1, &scissor);
        vkCmdSetBlendConstants(commands, constants);
        vkCmdSetStencilReference(commands, VK_STENCIL_FACE_FRONT_AND_BACK, 0);
        vkCmdSetCullMode(commands, VK_CULL_MODE_BACK_BIT);
        vkCmdSetDepthCompareOp(commands, VK_COMPARE_OP_ALWAYS);
        vkCmdSetPrimitiveTopology(commands, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
    };
    PipelineDesc desc = triangles();
    desc.change = [](const PipelineStates& states) {
        states.blends[0] = {VK_TRUE,
                            VK_BLEND_FACTOR_ONE,
                            VK_BLEND_FACTOR_CONSTANT_COLOR,
                            VK_BLEND_OP_ADD,
                            VK_BLEND_FACTOR_ONE,
                            VK_BLEND_FACTOR_ZERO,
                            VK_BLEND_OP_ADD,
                            0xF};
        states.depth.stencilTestEnable = VK_TRUE;
        states.depth.front = states.depth.back = {VK_STENCIL_OP_KEEP,
                                                  VK_STENCIL_OP_INCREMENT_AND_CLAMP,
                                                  VK_STENCIL_OP_KEEP,
                                                  VK_COMPARE_OP_GREATER_OR_EQUAL,
                                                  0xFF,
                                                  0xFF,
                                                  1};
        states.depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    };
    const Texels fixed = sameForAllCuts(desc, pass, setAll);
    std::vector<Texels> pictures{fixed};
    const VkDynamicState all[] = {VK_DYNAMIC_STATE_VIEWPORT,          VK_DYNAMIC_STATE_SCISSOR,
                                  VK_DYNAMIC_STATE_BLEND_CONSTANTS,   VK_DYNAMIC_STATE_STENCIL_REFERENCE,
                                  VK_DYNAMIC_STATE_CULL_MODE,         VK_DYNAMIC_STATE_DEPTH_COMPARE_OP,
                                  VK_DYNAMIC_STATE_PRIMITIVE_TOPOLOGY};
    for (const VkDynamicState state : all) {
        SCOPED_TRACE(state);
        desc.dynamic = {state};
        pictures.push_back(sameForAllCuts(desc, pass, setAll));
        EXPECT_TRUE(pictures.back() != fixed) << "what is set does not show";
    }
    desc.dynamic.assign(std::begin(all), std::end(all));
    pictures.push_back(sameForAllCuts(desc, pass, setAll));
    EXPECT_EQ(std::count(pictures.begin(), pictures.end(), pictures.back()), 1);
}

TEST_F(PipelineLibraryTest, dynamicStatesOfOtherPartsAreIgnored) {
    // The library of the outputs names states of the others, which stay as these say.
    const auto setAll = [](VkCommandBuffer commands) {
        vkCmdSetCullMode(commands, VK_CULL_MODE_FRONT_AND_BACK);
        vkCmdSetDepthCompareOp(commands, VK_COMPARE_OP_NEVER);
        vkCmdSetPrimitiveTopology(commands, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN);
    };
    PipelineDesc desc = triangles();
    const Texels expected = draw(makePipeline(pass.pass, desc), pass, setAll);
    dynamicOnlyIn = kOutput;
    desc.dynamic = {VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_DEPTH_COMPARE_OP, VK_DYNAMIC_STATE_PRIMITIVE_TOPOLOGY};
    cut = {kInput, kBefore, kFragment, kOutput};
    EXPECT_EQ(draw(makePipeline(pass.pass, desc), pass, setAll), expected);
}

TEST_F(PipelineLibraryTest, dynamicRenderingOfViews) {
    const TestImage layers = makeImage(kColor, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_1_BIT, 2);
    const TestImage depthLayers =
        makeImage(kDepth, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_SAMPLE_COUNT_1_BIT, 2);
    auto formats = make<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    formats.viewMask = 3;
    formats.colorAttachmentCount = 1;
    formats.pColorAttachmentFormats = &kColor;
    formats.depthAttachmentFormat = kDepth;
    auto views = make<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    views.viewMask = formats.viewMask;
    nextWithoutOutput = &views;
    PipelineDesc desc = triangles();
    desc.next = &formats;
    const auto picture = [&] {
        auto colors = make<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
        colors.imageView = layers.view;
        colors.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
        colors.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        colors.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        VkRenderingAttachmentInfo depths = colors;
        depths.imageView = depthLayers.view;
        depths.clearValue.depthStencil.depth = 1;
        auto info = make<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
        info.renderArea.extent = kExtent;
        info.layerCount = 1;
        info.viewMask = formats.viewMask;
        info.colorAttachmentCount = 1;
        info.pColorAttachments = &colors;
        info.pDepthAttachment = &depths;
        const VkPipeline pipeline = makePipeline(VK_NULL_HANDLE, desc);
        const VkCommandBuffer commands = begin();
        changeLayout(commands, layers.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED, colors.imageLayout);
        changeLayout(commands, depthLayers.image, VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT,
                     VK_IMAGE_LAYOUT_UNDEFINED, depths.imageLayout);
        vkCmdBeginRendering(commands, &info);
        drawAll(commands, pipeline);
        vkCmdEndRendering(commands);
        changeLayout(commands, layers.image, VK_IMAGE_ASPECT_COLOR_BIT, colors.imageLayout,
                     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        submit(commands);
        std::array<Texels, 2> pictures;
        for (uint32_t n = 0; n < 2; ++n) pictures[n] = readImage(layers, VK_IMAGE_ASPECT_COLOR_BIT, 4, n);
        return pictures;
    };
    const auto expected = picture();
    EXPECT_EQ(expected[0], draw(makePipeline(pass.pass, triangles()), pass));
    EXPECT_EQ(expected[1], expected[0]);
    for (const Cut& each : allCuts()) {
        // The layer (1.3.239) asks a library of these two parts for the depth state, which it does not have.
        constexpr Parts kMisjudged = kBefore | kOutput;
        const auto misjudged = [](Parts parts) { return (parts & (kMisjudged | kFragment)) == kMisjudged; };
        if (validated() && std::any_of(each.begin(), each.end(), misjudged)) continue;
        cut = each;
        EXPECT_EQ(picture(), expected) << testing::PrintToString(each);
    }
}

}  // namespace
}  // namespace vernier::test
