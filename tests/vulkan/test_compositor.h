// A Wayland compositor of a few lines, in the test's own process: it shows surfaces to the test alone, when the test
// says so.
#pragma once

#include <vulkan/vulkan_core.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

struct wl_client;
struct wl_display;
struct wl_resource;

namespace vernier::test {

/// What a surface shows: words of 0xAARRGGBB, row by row.
struct ShownPicture {
    VkExtent2D extent{};
    uint32_t format = 0;  // of wl_shm
    std::vector<uint32_t> texels;
};

/// Has wl_compositor and wl_shm. A buffer that a surface shows is held until it shows another. Thread-safe.
class TestCompositor {
  public:
    TestCompositor();
    TestCompositor(const TestCompositor&) = delete;
    TestCompositor& operator=(const TestCompositor&) = delete;
    ~TestCompositor();

    /// A connection for a client, or -1. Belongs to the caller.
    int connect();
    /// Whether surfaces show what is committed at once (as at first), or only when refresh() is called.
    void setAutomatic(bool automatic);
    /// Shows what was committed last, and tells clients that it is time for the next.
    void refresh();
    /// Ends all connections, as a compositor that dies.
    void hangUp();

    /// Waits until so many buffers have been committed; false after ten seconds.
    bool awaitCommits(uint32_t count);
    uint32_t commits();
    /// What was shown last.
    ShownPicture shown();

  private:
    struct Surface;
    friend struct Requests;

    void main();
    void show();
    void committed(Surface& surface);

    std::mutex mutex_;
    std::condition_variable changed_;
    wl_display* display_;
    std::vector<wl_client*> clients_;
    std::vector<Surface*> surfaces_;
    ShownPicture shown_;
    uint32_t commits_ = 0;
    bool automatic_ = true;
    std::atomic<bool> stopped_ = false;
    std::thread thread_;  // last: it uses everything above
};

}  // namespace vernier::test
