// What a pass does to an attachment before and after its draws.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace vernier {

struct AttachmentOps {
    VkAttachmentLoadOp loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;  // of colours and of depth
    VkAttachmentStoreOp storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkAttachmentLoadOp stencilLoadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    VkAttachmentStoreOp stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkClearValue clear{};
    uint32_t loadViews = ~0u;  // with multiview: the views that the load operations are for; the others are kept
};

}  // namespace vernier
