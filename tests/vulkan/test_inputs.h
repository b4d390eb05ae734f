// For tests of input attachments.
#pragma once

#include <vector>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {

class InputsTest : public DrawTest {
  protected:
    struct Input {
        VkImageView view;
        VkImageLayout layout;
    };
    /// A set with an input attachment per binding.
    VkDescriptorSet makeInputs(const std::vector<Input>& inputs, VkDescriptorSetLayout* layout) {
        const auto count = static_cast<uint32_t>(inputs.size());
        std::vector<VkDescriptorSetLayoutBinding> bindings;
        for (uint32_t i = 0; i < count; ++i)
            bindings.push_back({i, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
        *layout = makeSetLayout(bindings);
        const VkDescriptorSet set = makeEmptySet(*layout, {{VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, count}});
        for (uint32_t i = 0; i < count; ++i) {
            const VkDescriptorImageInfo image{VK_NULL_HANDLE, inputs[i].view, inputs[i].layout};
            auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
            write.dstSet = set;
            write.dstBinding = i;
            write.descriptorCount = 1;
            write.descriptorType = VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT;
            write.pImageInfo = &image;
            vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
        }
        return set;
    }
};

}  // namespace vernier::test
