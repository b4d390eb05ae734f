// What the files of TextureLab share.
#pragma once

#include <gtest/gtest.h>

#include "tests/peers/texture_lab.h"
#include "tests/vulkan/structures.h"

#define LAB_CHECK(call) EXPECT_EQ(call, VK_SUCCESS)

namespace vernier::test {

struct TextureLab::Block {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint8_t* data = nullptr;
};

struct TextureLab::Texture {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkSampler sampler = VK_NULL_HANDLE;
};

}  // namespace vernier::test
