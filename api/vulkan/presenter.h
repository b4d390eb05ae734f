// The presentation engine of a swapchain: which images the application has, which wait to be shown, and the thread that
// shows them, so that neither the queue nor the application waits for a window system.
#pragma once

#include <vulkan/vulkan_core.h>

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "api/vulkan/screen.h"

namespace vernier::vulkan {

/// An image goes round: free, acquired by the application, enqueued for presentation, waiting (rendered, to be shown),
/// free. Thread-safe.
class Presenter {
  public:
    using Clock = std::chrono::steady_clock;

    /// `images` stay alive until stop(). `period`: between two images in the modes that wait for the next refresh, on
    /// screens that do not set the pace; 0: not at all. Throws std::bad_alloc or std::system_error.
    Presenter(std::shared_ptr<Screen> screen, std::vector<const Image*> images, VkPresentModeKHR mode,
              Clock::duration period);
    ~Presenter() { stop(); }

    /// As vkAcquireNextImageKHR; the image that has been free for longest. Nanoseconds; UINT64_MAX: for ever.
    VkResult acquire(uint64_t timeout, uint32_t& index);
    /// Of an image that is acquired: it goes to the queue. False: it is not acquired.
    bool enqueue(uint32_t index);
    /// The queue did not take it.
    void takeBack(uint32_t index);
    /// Everything the image waited for is done: it is shown when its turn comes. Or it is left out, when the swapchain
    /// has an error.
    void present(uint32_t index) noexcept;

    /// What is known to be wrong with the surface.
    VkResult status() const;
    /// Another swapchain took over the surface: no image can be acquired any more, and what waits is not shown, for it
    /// may have another size than the surface now has.
    void retire();
    bool active() const;
    /// Ends the thread; what was not shown stays so.
    void stop();
    /// After stop(): presentations that are still in the queue hold on to the presenter, but not to its screen.
    void closeScreen() { screen_.reset(); }

  private:
    enum class State : uint8_t { free, acquired, enqueued, waiting };

    void main();
    /// Sleeps until an image is to be shown; false: stopped.
    bool awaitTurn(std::unique_lock<std::mutex>& lock);
    void release(uint32_t index);

    std::shared_ptr<Screen> screen_;
    std::vector<const Image*> images_;
    VkPresentModeKHR mode_;
    Clock::duration period_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<State> states_;
    // Oldest first, each with room for all images.
    std::vector<uint32_t> free_, waiting_;
    Clock::time_point nextRefresh_;
    VkResult status_ = VK_SUCCESS;
    bool retired_ = false, stopped_ = false;
    std::thread thread_;  // last: it uses everything above
};

}  // namespace vernier::vulkan
