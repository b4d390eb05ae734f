// VK_EXT_debug_marker: names, tags and markers go with whatever they are about, and change nothing.
#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

class DebugMarkerTest : public DrawTest {
  protected:
    std::vector<const char*> moreInstanceExtensions() override { return {VK_EXT_DEBUG_REPORT_EXTENSION_NAME}; }
    std::vector<const char*> moreExtensions() override { return {VK_EXT_DEBUG_MARKER_EXTENSION_NAME}; }
};

TEST_F(DebugMarkerTest, aMarkedDrawIsDrawn) {
    constexpr VkExtent2D kExtent{16, 16};
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    auto name = make<VkDebugMarkerObjectNameInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_MARKER_OBJECT_NAME_INFO_EXT);
    name.objectType = VK_DEBUG_REPORT_OBJECT_TYPE_IMAGE_EXT;
    name.object = reinterpret_cast<uint64_t>(color.image);
    name.pObjectName = "picture";
    auto tag = make<VkDebugMarkerObjectTagInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_MARKER_OBJECT_TAG_INFO_EXT);
    tag.objectType = name.objectType;
    tag.object = name.object;
    tag.tagName = 7;
    tag.tagSize = 4;
    tag.pTag = "tag";
    EXPECT_EQ(command<PFN_vkDebugMarkerSetObjectNameEXT>("vkDebugMarkerSetObjectNameEXT")(device, &name), VK_SUCCESS);
    EXPECT_EQ(command<PFN_vkDebugMarkerSetObjectTagEXT>("vkDebugMarkerSetObjectTagEXT")(device, &tag), VK_SUCCESS);

    const Pass pass = makePass(color);
    PipelineDesc desc;
    desc.extent = kExtent;
    desc.vertex = fullScreen();
    desc.fragment = constantColor("1, 0, 0, 1");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    auto marker = make<VkDebugMarkerMarkerInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_MARKER_MARKER_INFO_EXT);
    marker.pMarkerName = "draw";
    const VkCommandBuffer commands = begin();
    command<PFN_vkCmdDebugMarkerBeginEXT>("vkCmdDebugMarkerBeginEXT")(commands, &marker);
    beginPass(commands, pass);
    command<PFN_vkCmdDebugMarkerInsertEXT>("vkCmdDebugMarkerInsertEXT")(commands, &marker);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    command<PFN_vkCmdDebugMarkerEndEXT>("vkCmdDebugMarkerEndEXT")(commands);
    submit(commands);
    EXPECT_EQ(pixelAt(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4), color, 5, 5), 0xFF0000FFu);
}

}  // namespace
}  // namespace vernier::test
