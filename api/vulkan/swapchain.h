// Swapchains: images of their own and the presenter that shows them.
#pragma once

#include <deque>
#include <memory>

#include "api/vulkan/presenter.h"
#include "api/vulkan/private_data.h"

namespace vernier::vulkan {

struct SwapchainImage {
    SwapchainImage(Image made, std::unique_ptr<Memory> of) : image(std::move(made)), memory(std::move(of)) {}
    /// Before anybody knows the handle.
    SwapchainImage(SwapchainImage&& other) noexcept : SwapchainImage(std::move(other.image), std::move(other.memory)) {}
    ~SwapchainImage() {
        if (PrivateData* data = header.data) data->forgetObject(&image);
    }
    ObjectHeader header;  // of the image behind it
    Image image;
    static_assert(alignof(Image) <= sizeof(ObjectHeader));
    std::unique_ptr<Memory> memory;
};

struct Swapchain {
    Swapchain(std::shared_ptr<Screen> shownOn, std::deque<SwapchainImage> made, std::shared_ptr<Presenter> shows)
        : screen(std::move(shownOn)), images(std::move(made)), presenter(std::move(shows)) {}
    Swapchain(Swapchain&&) = default;
    ~Swapchain() {
        if (!presenter) return;  // moved from
        presenter->stop();
        images.clear();
        presenter->closeScreen();
    }

    std::shared_ptr<Screen> screen;     // outlives its memory
    std::deque<SwapchainImage> images;  // whose addresses are the handles
    /// Shared with presentations that are still in the queue.
    std::shared_ptr<Presenter> presenter;
};

}  // namespace vernier::vulkan
