#include "tests/vulkan/formats_test.h"

#include <cmath>

namespace vernier::test {

TestImage FormatsTest::makeImage(const Case& of, VkImageUsageFlags usage, uint32_t size) {
    auto info = flatImage(of.info->format, {size, size},
                          usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    info.tiling = of.tiling;
    TestImage result = ComputeTest::makeImage(info);
    if (usage != 0) result.view = makeView(result.image, VK_IMAGE_VIEW_TYPE_2D, result.format, {of.aspect, 0, 1, 0, 1});
    return result;
}

namespace {

VkBufferImageCopy wholeImage(const TestImage& image, VkImageAspectFlags aspect) {
    VkBufferImageCopy region{};
    region.imageSubresource = {aspect, 0, 0, 1};
    region.imageExtent = {image.extent.width, image.extent.height, 1};
    return region;
}

/// All aspects of a combined format change their layout together.
VkImageMemoryBarrier toGeneralOf(const TestImage& image, VkImageAspectFlags aspects) {
    auto barrier = make<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.image;
    barrier.subresourceRange = {aspects, 0, 1, 0, 1};
    return barrier;
}

}  // namespace

void FormatsTest::upload(const TestImage& image, const Case& of, const std::vector<uint8_t>& bytes) {
    const TestBuffer buffer = makeBuffer(bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    std::memcpy(buffer.data, bytes.data(), bytes.size());
    const VkCommandBuffer commands = begin();
    const VkImageMemoryBarrier barrier = toGeneralOf(image, of.info->aspects);
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &barrier);
    const VkBufferImageCopy region = wholeImage(image, of.aspect);
    vkCmdCopyBufferToImage(commands, buffer.buffer, image.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
    makeVisible(commands);
    submit(commands);
}

std::vector<uint8_t> FormatsTest::download(const TestImage& image, const Case& of, VkImageLayout layout) {
    const VkDeviceSize texels = VkDeviceSize{of.info->columns(image.extent.width)} * of.info->rows(image.extent.height);
    const VkDeviceSize size = texels * bufferTexelBytes(*of.info, of.aspect);
    const TestBuffer buffer = makeBuffer(size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkCommandBuffer commands = begin();
    const VkBufferImageCopy region = wholeImage(image, of.aspect);
    vkCmdCopyImageToBuffer(commands, image.image, layout, buffer.buffer, 1, &region);
    makeVisible(commands);
    submit(commands);
    std::vector<uint8_t> bytes(size);
    std::memcpy(bytes.data(), buffer.data, size);
    return bytes;
}

std::vector<uint8_t> FormatsTest::randomTexels(const Case& of, uint32_t seed, uint32_t size) {
    std::mt19937 random(seed);
    const uint32_t bytes = bufferTexelBytes(*of.info, of.aspect);
    std::vector<uint8_t> result(size_t{of.info->columns(size)} * of.info->rows(size) * bytes);
    for (uint8_t& byte : result) byte = static_cast<uint8_t>(random() >> 24);
    // Buffers hold depths of 24 bits in the low bits of a word, with zeros above.
    if (of.aspect == VK_IMAGE_ASPECT_DEPTH_BIT && of.info->depth.rgba[0].bits == 24)
        for (size_t i = 3; i < result.size(); i += 4) result[i] = 0;
    // Depths that are floats are numbers.
    if (of.aspect == VK_IMAGE_ASPECT_DEPTH_BIT && of.info->depth.rgba[0].kind == ComponentKind::sfloat) {
        for (size_t i = 0; i < result.size(); i += 4) {
            const float depth = static_cast<float>(random() >> 8) / 0x1p24f;
            std::memcpy(&result[i], &depth, sizeof depth);
        }
    }
    return result;
}

VkClearColorValue FormatsTest::texelAt(const Case& of, const std::vector<uint8_t>& bytes, uint32_t x, uint32_t y,
                                       uint32_t size) {
    if (const BlockCodec* block = of.info->block) {
        const uint32_t texelBytes = of.layout().bytes;
        std::vector<std::byte> decoded(size_t{kMaxBlockTexels} * kMaxDecodedBytes);
        const size_t at = size_t{y / block->height} * of.info->columns(size) + x / block->width;
        block->decode(reinterpret_cast<const std::byte*>(bytes.data()) + at * block->bytes, decoded.data());
        return unpackTexel(of.layout(),
                           decoded.data() + size_t{y % block->height * block->width + x % block->width} * texelBytes);
    }
    const uint32_t texel = bufferTexelBytes(*of.info, of.aspect);
    uint8_t whole[16] = {};
    copyTexelsFromBuffer(*of.info, of.aspect, bytes.data() + (size_t{y} * size + x) * texel, 1, whole);
    return unpackTexel(of.layout(), whole);
}

VkClearColorValue FormatsTest::plainColor(const TexelLayout& layout) {
    if (layout.type == ValueType::uint) return {.uint32 = {2, 1, 3, 1}};
    if (layout.type == ValueType::sint) return {.int32 = {-2, 1, -1, 1}};
    if (layout.rgba[0].kind == ComponentKind::snorm) return {.float32 = {-0.3f, 0.6f, -0.8f, 0.4f}};
    return {.float32 = {0.3f, 0.6f, 0.8f, 0.4f}};
}

std::vector<uint8_t> FormatsTest::packed(const Case& of, const VkClearColorValue& value) {
    uint8_t whole[16] = {};
    packTexel(of.layout(), value, whole);
    std::vector<uint8_t> bytes(bufferTexelBytes(*of.info, of.aspect));
    copyTexelsToBuffer(*of.info, of.aspect, whole, 1, bytes.data());
    return bytes;
}

ComputeTest::Compute FormatsTest::computeFor(const std::string& glsl, const std::vector<TestDescriptor>& descriptors) {
    // Immutable samplers are part of the layout.
    std::pair<std::string, std::vector<VkSampler>> key{glsl, {}};
    for (const TestDescriptor& descriptor : descriptors) key.second.push_back(descriptor.sampler);
    const auto found = pipelines_.find(key);
    if (found == pipelines_.end()) return pipelines_[key] = makeCompute(glsl, descriptors);
    Compute compute = found->second;
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    compute.set = makeSet(descriptors, &layout);
    return compute;
}

VkSampler FormatsTest::makeSampler(VkFilter filter, VkSamplerReductionMode reduction) {
    auto mode = make<VkSamplerReductionModeCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO);
    mode.reductionMode = reduction;
    auto info = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    info.pNext = &mode;
    info.magFilter = info.minFilter = filter;
    info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    VkSampler sampler = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateSampler(device, &info, nullptr, &sampler), VK_SUCCESS);
    defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
    return sampler;
}

void expectSameColor(const VkClearColorValue& found, const VkClearColorValue& wanted, ValueType type) {
    for (int c = 0; c < 4; ++c) {
        if (type == ValueType::floating && std::isnan(found.float32[c]) && std::isnan(wanted.float32[c])) continue;
        EXPECT_EQ(found.uint32[c], wanted.uint32[c])
            << "component " << c << ": " << found.float32[c] << " and " << wanted.float32[c];
    }
}

}  // namespace vernier::test
