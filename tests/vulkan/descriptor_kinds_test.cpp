// Arrays of descriptors of every type, indexed by what differs between invocations and written after they are bound.
#include <array>

#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

constexpr uint32_t kCount = 5;

class DescriptorKindsTest : public ComputeTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_2; }
    void* moreFeatures() override {
        auto query = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &features_);
        vkGetPhysicalDeviceFeatures2(physicalDevice, &query);
        return &features_;
    }
    /// Binding 0: a storage buffer, binding 1: an array of the type. Both are written after the set is bound, and may
    /// name nothing.
    VkDescriptorSetLayout makeArrayLayout(VkDescriptorType type, VkDescriptorBindingFlags flags) {
        const VkShaderStageFlags stages =
            type == VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT ? VK_SHADER_STAGE_FRAGMENT_BIT : VK_SHADER_STAGE_ALL;
        const std::array<VkDescriptorSetLayoutBinding, 2> bindings{
            {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr},
             {1, type, kCount, stages, nullptr}}};
        const std::array<VkDescriptorBindingFlags, 2> both{flags, flags};
        auto more = make<VkDescriptorSetLayoutBindingFlagsCreateInfo>(
            VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO);
        more.bindingCount = 2;
        more.pBindingFlags = both.data();
        auto info = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &more);
        if ((flags & VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT) != 0)
            info.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT;
        info.bindingCount = 2;
        info.pBindings = bindings.data();
        VkDescriptorSetLayout layout = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout), VK_SUCCESS);
        defer([this, layout] { vkDestroyDescriptorSetLayout(device, layout, nullptr); });
        return layout;
    }
    VkDescriptorSet makeArraySet(VkDescriptorType type, VkDescriptorSetLayout layout) {
        return makeEmptySet(layout, {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 8}, {type, 8}},
                            VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT);
    }
    void write(VkDescriptorSet set, uint32_t binding, uint32_t element, VkDescriptorType type,
               const TestDescriptor& descriptor, VkSampler sampler, VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL) {
        const VkDescriptorBufferInfo buffer{descriptor.buffer, 0, VK_WHOLE_SIZE};
        const VkDescriptorImageInfo image{sampler, descriptor.image, layout};
        auto info = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        info.dstSet = set;
        info.dstBinding = binding;
        info.dstArrayElement = element;
        info.descriptorCount = 1;
        info.descriptorType = type;
        info.pBufferInfo = &buffer;
        info.pImageInfo = &image;
        info.pTexelBufferView = &descriptor.texels;
        vkUpdateDescriptorSets(device, 1, &info, 0, nullptr);
    }
    /// An image of one value in VK_IMAGE_LAYOUT_GENERAL.
    TestImage filled(VkFormat format, const VkClearColorValue& value, VkImageUsageFlags usage) {
        const TestImage image = makeImage(format, {4, 4}, usage);
        const VkCommandBuffer commands = begin();
        toGeneral(commands, image);
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &all);
        makeVisible(commands);
        submit(commands);
        return image;
    }

  private:
    VkPhysicalDeviceDescriptorIndexingFeatures features_ = make<VkPhysicalDeviceDescriptorIndexingFeatures>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_FEATURES);
};

TEST_F(DescriptorKindsTest, everyKindByAnyIndex) {
    const auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    VkSampler sampler = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
    defer([=, this] { vkDestroySampler(device, sampler, nullptr); });
    struct Kind {
        VkDescriptorType type;
        const char *declaration, *value;
    };
    for (const Kind& kind :
         {Kind{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, "uniform Block { uint x; } a[]", "a[I].x"},
          Kind{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, "buffer Block { uint x; } a[]", "a[I].x"},
          Kind{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, "uniform utexture2D a[]", "texelFetch(a[I], ivec2(1), 0).x"},
          Kind{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, "uniform usampler2D a[]",
               "textureLod(a[I], vec2(0.5), 0.0).x"},
          Kind{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, "uniform uimage2D a[]", "imageLoad(a[I], ivec2(1)).x"},
          Kind{VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, "uniform utextureBuffer a[]", "texelFetch(a[I], 0).x"},
          Kind{VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, "uniform uimageBuffer a[]", "imageLoad(a[I], 0).x"}}) {
        SCOPED_TRACE(kind.declaration);
        const VkDescriptorSetLayout setLayout = makeArrayLayout(
            kind.type, VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT | VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT);
        const VkDescriptorSet set = makeArraySet(kind.type, setLayout);
        std::string value = kind.value, same = kind.value;
        value.replace(value.find('I'), 1, "nonuniformEXT(i)");
        same.replace(same.find('I'), 1, "i");
        const bool isStorageImage = kind.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        const bool isStorageTexels = kind.type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
        const std::string format = isStorageImage || isStorageTexels ? ", r32ui" : "";
        auto info = make<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
        info.stage = make<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
        info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        info.stage.module = makeShader(VK_SHADER_STAGE_COMPUTE_BIT, R"(#version 450
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_samplerless_texture_functions : require
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer Out { uint v[34]; };
layout(set = 0, binding = 1)" + format + ") " + kind.declaration + R"(;
void main() {
    uint i = (gl_LocalInvocationIndex * 7) % 5;
    v[gl_LocalInvocationIndex] = )" + value + R"(;
    i = v[32];
    v[33] = )" + same + R"(;
})");
        info.stage.pName = "main";
        Compute compute;
        compute.set = set;
        info.layout = compute.layout = makeLayout({setLayout}, 0);
        ASSERT_EQ(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &compute.pipeline), VK_SUCCESS);
        defer([=, this] { vkDestroyPipeline(device, compute.pipeline, nullptr); });
        std::array<TestDescriptor, kCount> descriptors;
        for (uint32_t n = 0; n < kCount; ++n) {
            const TestBuffer buffer =
                makeBuffer(64, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                   VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
            *words(buffer) = 100 + n;
            descriptors[n].buffer = buffer.buffer;
            descriptors[n].texels = makeTexels(buffer, VK_FORMAT_R32_UINT);
            descriptors[n].image = filled(VK_FORMAT_R32_UINT, {.uint32 = {100 + n, 0, 0, 0}},
                                          VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT)
                                       .view;
        }
        const TestBuffer out = makeStorage(34);
        words(out)[32] = 3;  // the same for all invocations
        const VkCommandBuffer commands = begin();
        dispatch(commands, compute, 1);
        write(set, 0, 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, storageBuffer(out), VK_NULL_HANDLE);
        for (uint32_t n = 0; n < kCount; ++n) write(set, 1, n, kind.type, descriptors[n], sampler);
        submit(commands);
        for (uint32_t n = 0; n < 32; ++n) EXPECT_EQ(words(out)[n], 100 + n * 7 % 5) << n;
        EXPECT_EQ(words(out)[33], 103u);
    }
}

// Input attachments cannot be written late, but chosen by each pixel.
TEST_F(DescriptorKindsTest, inputAttachmentsByAnyIndex) {
    constexpr VkExtent2D kExtent{4, 4};
    constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT;
    std::vector<VkAttachmentDescription> attachments;
    std::vector<VkAttachmentReference> references;
    std::vector<VkImageView> views;
    const auto attach = [&](VkImageView view, VkAttachmentLoadOp load, VkImageLayout from, VkImageLayout during,
                            VkImageLayout to) {
        references.push_back({static_cast<uint32_t>(attachments.size()), during});
        attachments.push_back({0, VK_FORMAT_R8G8B8A8_UNORM, VK_SAMPLE_COUNT_1_BIT, load, VK_ATTACHMENT_STORE_OP_STORE,
                               VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_DONT_CARE, from, to});
        views.push_back(view);
    };
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    attach(color.view, VK_ATTACHMENT_LOAD_OP_CLEAR, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    const VkDescriptorSetLayout setLayout = makeArrayLayout(kType, VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT);
    const VkDescriptorSet set = makeArraySet(kType, setLayout);
    for (uint32_t n = 0; n < 2; ++n) {
        const VkClearColorValue value{{n == 0 ? 1.0f : 0.0f, n == 1 ? 1.0f : 0.0f, 0, 1}};
        TestDescriptor input;
        input.image = filled(VK_FORMAT_R8G8B8A8_UNORM, value,
                             VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)
                          .view;
        attach(input.image, VK_ATTACHMENT_LOAD_OP_LOAD, VK_IMAGE_LAYOUT_GENERAL,
               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
        write(set, 1, n, kType, input, VK_NULL_HANDLE, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = references.data();
    subpass.inputAttachmentCount = 2;
    subpass.pInputAttachments = references.data() + 1;
    auto passInfo = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    passInfo.attachmentCount = static_cast<uint32_t>(attachments.size());
    passInfo.pAttachments = attachments.data();
    passInfo.subpassCount = 1;
    passInfo.pSubpasses = &subpass;
    Pass pass;
    pass.extent = kExtent;
    pass.clears.resize(3);
    ASSERT_EQ(vkCreateRenderPass(device, &passInfo, nullptr, &pass.pass), VK_SUCCESS);
    makeFramebuffer(pass, views);
    PipelineDesc desc;
    desc.extent = kExtent;
    desc.vertex = fullScreen();
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
#extension GL_EXT_nonuniform_qualifier : require
layout(input_attachment_index = 0, set = 0, binding = 1) uniform subpassInput inputs[2];
layout(location = 0) out vec4 color;
layout(set = 0, binding = 0) readonly buffer In { uint one; };
void main() {
    color = subpassLoad(inputs[nonuniformEXT((int(gl_FragCoord.x) + int(gl_FragCoord.y)) & 1)]);
    color.b = subpassLoad(inputs[one]).g;
})");
    desc.layout = makeLayout({setLayout}, 0);
    const TestBuffer in = makeStorage(1);
    *words(in) = 1;
    write(set, 0, 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, storageBuffer(in), VK_NULL_HANDLE);
    drawTriangle(pass, makePipeline(pass.pass, desc), desc.layout, set);
    const auto texels = readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (uint32_t y = 0; y < 4; ++y)
        for (uint32_t x = 0; x < 4; ++x)
            EXPECT_EQ(pixelAt(texels, color, x, y), (x + y) % 2 != 0 ? 0xFFFFFF00u : 0xFFFF00FFu) << x << ", " << y;
}

TEST_F(DescriptorKindsTest, poolSizesAddUpToMoreThan32Bits) {
    constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const VkDescriptorSetLayout layout = makeSetLayout({{0, kType, 2, VK_SHADER_STAGE_ALL, nullptr}});
    EXPECT_NE(makeEmptySet(layout, {{kType, 0x80000000u}, {kType, 0x80000001u}}), VkDescriptorSet{VK_NULL_HANDLE});
}

}  // namespace
}  // namespace vernier::test
