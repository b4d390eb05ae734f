// One thread of the soak: buffers and images with a model of what is in them. Every round records some
// random commands, submits them, changes the model alike, and later, when they have run, compares. Resources are
// replaced all the time; what a round uses lives until the round is done.
#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <memory>

#include "tests/vulkan/soak/workshop.h"

namespace vernier::soak {
namespace {

constexpr uint32_t kBuffers = 6, kImages = 4, kMostRounds = 3;
constexpr uint64_t kLong = 120'000'000'000;

/// What was submitted and is not known to be done.
struct Round {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    uint64_t point = 0;  // of the timeline
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
    std::vector<std::shared_ptr<SoakBuffer>> buffers;
    std::vector<std::shared_ptr<SoakImage>> images;
    std::shared_ptr<SoakBuffer> readBack;  // compared when the round is done
};

class Worker {
  public:
    Worker(Context& context, uint32_t seed);
    ~Worker();
    uint64_t run();

  private:
    void recordSomething(Round& round);
    void fill(Round& round);
    void copyBuffers(Round& round);
    void compute(Round& round);
    void clear(Round& round);
    void draw(Round& round);
    void copyImages(Round& round);
    void readBack(Round& round);
    void barrier(const Round& round);
    void submit(Round round);
    void finish(Round& round);

    SoakBuffer& use(Round& round, const std::shared_ptr<SoakBuffer>& buffer) {
        round.buffers.push_back(buffer);
        return *buffer;
    }
    SoakImage& use(Round& round, const std::shared_ptr<SoakImage>& image);
    const std::shared_ptr<SoakBuffer>& anyBuffer() { return buffers_[below(random_, kBuffers)]; }
    const std::shared_ptr<SoakImage>& anyImage() { return images_[below(random_, kImages)]; }

    Context& context_;
    Verdict& verdict_;
    VkDevice device_;
    Random random_;
    Workshop workshop_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkSemaphore timeline_ = VK_NULL_HANDLE;
    uint64_t point_ = 0, submissions_ = 0;
    std::array<std::shared_ptr<SoakBuffer>, kBuffers> buffers_;
    std::array<std::shared_ptr<SoakImage>, kImages> images_;
    std::deque<Round> rounds_;
};

Worker::Worker(Context& context, uint32_t seed)
    : context_(context),
      verdict_(context.verdict),
      device_(context.device),
      random_(seed),
      workshop_(context, random_) {
    auto poolInfo = make<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    poolInfo.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    SOAK_CHECK(verdict_, vkCreateCommandPool, device_, &poolInfo, nullptr, &pool_);
    auto type = make<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    auto semaphore = make<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    semaphore.pNext = &type;
    SOAK_CHECK(verdict_, vkCreateSemaphore, device_, &semaphore, nullptr, &timeline_);
    if (verdict_.failed()) return;
    for (auto& buffer : buffers_) buffer = workshop_.makeBuffer(1 + below(random_, 5000));
    for (auto& image : images_) image = workshop_.makeImage();
}

Worker::~Worker() {
    for (Round& round : rounds_) finish(round);
    buffers_ = {};
    images_ = {};
    vkDestroySemaphore(device_, timeline_, nullptr);
    vkDestroyCommandPool(device_, pool_, nullptr);
}

SoakImage& Worker::use(Round& round, const std::shared_ptr<SoakImage>& image) {
    round.images.push_back(image);
    if (!image->fresh) return *image;
    image->fresh = false;
    auto barrier = make<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image->image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(round.commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &barrier);
    const VkClearColorValue black{};
    vkCmdClearColorImage(round.commands, image->image, VK_IMAGE_LAYOUT_GENERAL, &black, 1, &barrier.subresourceRange);
    this->barrier(round);
    return *image;
}

void Worker::barrier(const Round& round) {
    auto all = make<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    all.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    all.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    vkCmdPipelineBarrier(round.commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &all, 0, nullptr, 0,
                         nullptr);
}

void Worker::fill(Round& round) {
    SoakBuffer& buffer = use(round, anyBuffer());
    const auto size = static_cast<uint32_t>(buffer.model.size());
    const uint32_t first = below(random_, size), count = 1 + below(random_, size - first), value = random_();
    vkCmdFillBuffer(round.commands, buffer.buffer, VkDeviceSize{first} * 4, VkDeviceSize{count} * 4, value);
    std::fill_n(buffer.model.begin() + first, count, value);
}

void Worker::copyBuffers(Round& round) {
    SoakBuffer& from = use(round, anyBuffer());
    SoakBuffer& to = use(round, anyBuffer());
    if (&from == &to) return;
    const auto count = static_cast<uint32_t>(std::min(from.model.size(), to.model.size()));
    const uint32_t words = 1 + below(random_, count);
    const auto source = below(random_, static_cast<uint32_t>(from.model.size()) - words + 1);
    const auto target = below(random_, static_cast<uint32_t>(to.model.size()) - words + 1);
    const VkBufferCopy region{VkDeviceSize{source} * 4, VkDeviceSize{target} * 4, VkDeviceSize{words} * 4};
    vkCmdCopyBuffer(round.commands, from.buffer, to.buffer, 1, &region);
    std::copy_n(from.model.begin() + source, words, to.model.begin() + target);
}

void Worker::compute(Round& round) {
    if (round.descriptors != VK_NULL_HANDLE || round.pipeline != VK_NULL_HANDLE) return;  // one of them a round
    SoakBuffer& buffer = use(round, anyBuffer());
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    auto poolInfo = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.maxSets = poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    SOAK_CHECK(verdict_, vkCreateDescriptorPool, device_, &poolInfo, nullptr, &round.descriptors);
    auto allocation = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocation.descriptorPool = round.descriptors;
    allocation.descriptorSetCount = 1;
    allocation.pSetLayouts = &workshop_.setLayout();
    VkDescriptorSet set = VK_NULL_HANDLE;
    SOAK_CHECK(verdict_, vkAllocateDescriptorSets, device_, &allocation, &set);
    round.pipeline = workshop_.makeCompute();
    if (verdict_.failed()) return;
    const VkDescriptorBufferInfo info{buffer.buffer, 0, VK_WHOLE_SIZE};
    auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &info;
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
    const std::array<uint32_t, 2> factors = {static_cast<uint32_t>(random_()), static_cast<uint32_t>(random_())};
    vkCmdBindPipeline(round.commands, VK_PIPELINE_BIND_POINT_COMPUTE, round.pipeline);
    vkCmdBindDescriptorSets(round.commands, VK_PIPELINE_BIND_POINT_COMPUTE, workshop_.computeLayout(), 0, 1, &set, 0,
                            nullptr);
    vkCmdPushConstants(round.commands, workshop_.computeLayout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, 8, factors.data());
    const auto words = static_cast<uint32_t>(buffer.model.size());
    vkCmdDispatch(round.commands, (words + 63) / 64, 1, 1);
    for (uint32_t i = 0; i < words; ++i) buffer.model[i] = buffer.model[i] * factors[0] + factors[1] + i;
}

void Worker::clear(Round& round) {
    SoakImage& image = use(round, anyImage());
    const VkClearColorValue white{.float32 = {1, 0, 1, 1}};
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(round.commands, image.image, VK_IMAGE_LAYOUT_GENERAL, &white, 1, &range);
    std::fill(image.model.begin(), image.model.end(), 0xFFFF00FF);
}

void Worker::draw(Round& round) {
    if (round.pipeline != VK_NULL_HANDLE) return;
    SoakImage& image = use(round, anyImage());
    round.pipeline = workshop_.makeDrawing();
    if (verdict_.failed()) return;
    const VkExtent2D extent = image.extent;
    VkRect2D scissor{};
    scissor.offset = {static_cast<int32_t>(below(random_, extent.width)),
                      static_cast<int32_t>(below(random_, extent.height))};
    const auto left = static_cast<uint32_t>(scissor.offset.x), top = static_cast<uint32_t>(scissor.offset.y);
    scissor.extent = {1 + below(random_, extent.width - left), 1 + below(random_, extent.height - top)};
    auto info = make<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    info.renderPass = workshop_.pass();
    info.framebuffer = image.framebuffer;
    info.renderArea.extent = extent;
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    const uint32_t color = random_();
    vkCmdBeginRenderPass(round.commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(round.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, round.pipeline);
    vkCmdSetViewport(round.commands, 0, 1, &viewport);
    vkCmdSetScissor(round.commands, 0, 1, &scissor);
    vkCmdPushConstants(round.commands, workshop_.drawLayout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, 4, &color);
    vkCmdDraw(round.commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(round.commands);
    for (uint32_t y = top; y < top + scissor.extent.height; ++y)
        for (uint32_t x = left; x < left + scissor.extent.width; ++x)
            image.model[size_t{y} * extent.width + x] = color + x + (y << 8);
}

void Worker::copyImages(Round& round) {
    SoakImage& from = use(round, anyImage());
    SoakImage& to = use(round, anyImage());
    if (&from == &to) return;
    VkImageCopy region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.extent = {std::min(from.extent.width, to.extent.width), std::min(from.extent.height, to.extent.height), 1};
    vkCmdCopyImage(round.commands, from.image, VK_IMAGE_LAYOUT_GENERAL, to.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
    for (uint32_t y = 0; y < region.extent.height; ++y)
        std::copy_n(from.model.begin() + static_cast<ptrdiff_t>(size_t{y} * from.extent.width), region.extent.width,
                    to.model.begin() + static_cast<ptrdiff_t>(size_t{y} * to.extent.width));
}

/// A whole image to a buffer of its own, which nobody else writes: what is in it can be compared at any time later.
void Worker::readBack(Round& round) {
    if (round.readBack) return;
    SoakImage& image = use(round, anyImage());
    round.readBack = workshop_.makeBuffer(static_cast<uint32_t>(image.model.size()));
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {image.extent.width, image.extent.height, 1};
    vkCmdCopyImageToBuffer(round.commands, image.image, VK_IMAGE_LAYOUT_GENERAL, round.readBack->buffer, 1, &region);
    round.readBack->model = image.model;
}

void Worker::recordSomething(Round& round) {
    using Step = void (Worker::*)(Round&);
    constexpr Step kSteps[] = {&Worker::fill, &Worker::copyBuffers, &Worker::compute, &Worker::clear,
                               &Worker::draw, &Worker::copyImages,  &Worker::readBack};
    (this->*kSteps[below(random_, static_cast<uint32_t>(std::size(kSteps)))])(round);
    barrier(round);
}

void Worker::submit(Round round) {
    SOAK_CHECK(verdict_, vkEndCommandBuffer, round.commands);
    const auto fenceInfo = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    SOAK_CHECK(verdict_, vkCreateFence, device_, &fenceInfo, nullptr, &round.fence);
    round.point = ++point_;
    auto values = make<VkTimelineSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO);
    const uint64_t before = round.point - 1;
    values.waitSemaphoreValueCount = values.signalSemaphoreValueCount = 1;
    values.pWaitSemaphoreValues = &before;
    values.pSignalSemaphoreValues = &round.point;
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    auto info = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    info.pNext = &values;
    info.waitSemaphoreCount = info.signalSemaphoreCount = info.commandBufferCount = 1;
    info.pWaitSemaphores = info.pSignalSemaphores = &timeline_;
    info.pWaitDstStageMask = &stage;
    info.pCommandBuffers = &round.commands;
    {
        const std::lock_guard lock(context_.queueMutex);
        SOAK_CHECK(verdict_, vkQueueSubmit, context_.queue, 1, &info, round.fence);
    }
    ++submissions_;
    rounds_.push_back(std::move(round));
}

void Worker::finish(Round& round) {
    const VkResult done = vkWaitForFences(device_, 1, &round.fence, VK_TRUE, kLong);
    if (done != VK_SUCCESS) verdict_.fail("vkWaitForFences gave " + std::to_string(done));
    const SoakBuffer* read = round.readBack.get();
    if (read != nullptr && std::memcmp(read->words, read->model.data(), read->model.size() * 4) != 0)
        verdict_.fail("an image is not what it should be");
    vkDestroyFence(device_, round.fence, nullptr);
    vkDestroyPipeline(device_, round.pipeline, nullptr);
    vkDestroyDescriptorPool(device_, round.descriptors, nullptr);
    vkFreeCommandBuffers(device_, pool_, 1, &round.commands);
}

uint64_t Worker::run() {
    while (!verdict_.stopped()) {
        Round round;
        auto allocation = make<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
        allocation.commandPool = pool_;
        allocation.commandBufferCount = 1;
        SOAK_CHECK(verdict_, vkAllocateCommandBuffers, device_, &allocation, &round.commands);
        const auto begin = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
        SOAK_CHECK(verdict_, vkBeginCommandBuffer, round.commands, &begin);
        if (verdict_.failed()) break;
        for (uint32_t steps = 1 + below(random_, 12); steps > 0; --steps) recordSomething(round);
        submit(std::move(round));
        while (rounds_.size() > below(random_, kMostRounds + 1)) {
            finish(rounds_.front());
            rounds_.pop_front();
        }
        // With nothing in flight the buffers can be looked at where they lie.
        for (const auto& buffer : buffers_) {
            if (rounds_.empty() && std::memcmp(buffer->words, buffer->model.data(), buffer->model.size() * 4) != 0)
                verdict_.fail("a buffer is not what it should be");
        }
        if (below(random_, 3) == 0) buffers_[below(random_, kBuffers)] = workshop_.makeBuffer(1 + below(random_, 5000));
        if (below(random_, 3) == 0) images_[below(random_, kImages)] = workshop_.makeImage();
    }
    return submissions_;
}

}  // namespace

uint64_t work(Context& context, uint32_t seed) {
    return Worker(context, seed).run();
}

}  // namespace vernier::soak
