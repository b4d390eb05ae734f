// Draws under transform feedback: what is captured, what counters and queries say.
#pragma once

#include <array>
#include <optional>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {

class FeedbackTest : public DrawTest {
  protected:
    std::vector<const char*> moreExtensions() override;
    void* moreFeatures() override;

    struct FeedbackDraw {
        uint32_t count = 0, instances = 1, first = 0, firstInstance = 0;
        int32_t vertexOffset = 0;
        bool resumes = false;  // pauses before it, and goes on
    };
    struct Feedback {
        VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        bool lastProvokes = false, restart = false, discard = true;
        std::vector<uint16_t> indices;    // empty: not indexed
        std::string vertex;               // GLSL
        std::string control, evaluation;  // GLSL; empty: none
        uint32_t patchControlPoints = 0;
        bool domainLowerLeft = false;
        std::string geometry;                   // GLSL; empty: none
        uint32_t stream = 0;                    // that queries count
        std::string fragment;                   // GLSL; none where rasteriser discard is on
        std::vector<VkDeviceSize> sizes{1024};  // by buffer
        VkDeviceSize offset = 0;                // of the bound ranges in their buffers
        std::vector<FeedbackDraw> draws;
    };
    struct Captured {
        std::vector<std::vector<uint8_t>> bytes;  // by buffer, from the begin of the buffer; 0xEE where nothing is
        std::vector<uint32_t> counters;           // by buffer
        std::array<uint64_t, 2> primitives{};     // written, needed
        uint64_t generated = 0;
        bool operator==(const Captured&) const = default;
        /// The words of a buffer from a byte on.
        template <class T>
        std::vector<T> as(size_t buffer, size_t first, size_t count) const {
            std::vector<T> values(count);
            if (count != 0) std::memcpy(values.data(), bytes[buffer].data() + first, count * sizeof(T));
            return values;
        }
    };
    static constexpr VkDeviceSize kMargin = 64;  // behind the bound ranges
    /// Every pause ends the render pass, so that barriers can stand between.
    Captured capture(const Feedback& feedback);
    TestBuffer makeFeedbackBuffer(VkDeviceSize size, VkBufferUsageFlags more = 0);

    struct Commands {
        PFN_vkCmdBindTransformFeedbackBuffersEXT bind;
        PFN_vkCmdBeginTransformFeedbackEXT begin;
        PFN_vkCmdEndTransformFeedbackEXT end;
        PFN_vkCmdBeginQueryIndexedEXT beginQuery;
        PFN_vkCmdEndQueryIndexedEXT endQuery;
        PFN_vkCmdDrawIndirectByteCountEXT drawByteCount;
    };
    Commands feedbackCommands() const;

  private:
    VkPhysicalDeviceTransformFeedbackFeaturesEXT feedback_ = make<VkPhysicalDeviceTransformFeedbackFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TRANSFORM_FEEDBACK_FEATURES_EXT);
    VkPhysicalDeviceProvokingVertexFeaturesEXT provoking_ = make<VkPhysicalDeviceProvokingVertexFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROVOKING_VERTEX_FEATURES_EXT);
    VkPhysicalDevicePrimitivesGeneratedQueryFeaturesEXT generated_ =
        make<VkPhysicalDevicePrimitivesGeneratedQueryFeaturesEXT>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PRIMITIVES_GENERATED_QUERY_FEATURES_EXT);
};

}  // namespace vernier::test
