// Showing images on a surface of a Wayland compositor: each lies in a memory file that the compositor maps, too, and
// reads where it was rendered (wl_shm). The compositor says when it is done with an image, and, in the modes that wait
// for it, when it is time for the next one (wl_surface.frame). A thread listens to it, so that images come back while
// nothing is presented.
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>
#include <wayland-client-protocol.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "api/vulkan/screen.h"
#include "api/vulkan/wayland_library.h"

namespace vernier::vulkan {
namespace {

class WaylandScreen final : public Screen {
  public:
    WaylandScreen(const WaylandLibrary& library, const Surface& surface, bool opaque, bool paced)
        : library_(library), display_(surface.display), opaque_(opaque), paced_(paced) {
        queue_ = library_.wl_display_create_queue(display_);
        if (queue_ != nullptr) surface_ = wrap(surface.waylandSurface);
    }
    /// False: the connection is gone, or the system has no descriptors left.
    bool start() {
        if (surface_ == nullptr || !findShm()) return false;
        wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
        if (wake_ < 0) return false;
        listener_ = std::thread([this] { listen(); });
        return true;
    }
    ~WaylandScreen() override {
        stop();
        if (frame_ != nullptr) library_.wl_proxy_destroy(frame_);
        for (const Picture& picture : pictures_) {
            if (picture.buffer != nullptr) destroy(picture.buffer, WL_BUFFER_DESTROY);
            destroy(picture.pool, WL_SHM_POOL_DESTROY);
        }
        if (shm_ != nullptr) library_.wl_proxy_destroy(shm_);
        if (surface_ != nullptr) library_.wl_proxy_wrapper_destroy(surface_);
        if (queue_ != nullptr) library_.wl_event_queue_destroy(queue_);
        library_.wl_display_flush(display_);
        if (wake_ >= 0) close(wake_);
    }

    Result<std::unique_ptr<Memory>> allocate(VkDeviceSize size) override {
        const auto failed = [](const char* what) { return Error{ErrorCode::outOfDeviceMemory, what}; };
        if (size > INT32_MAX) return failed("Wayland shares less than 2 GiB a picture");
        const std::lock_guard lock(mutex_);
        pictures_.reserve(pictures_.size() + 1);
        Result<std::unique_ptr<Memory>> memory = Memory::createShared(size);
        if (!memory) return memory;
        const int fd = (*memory)->exportFd();
        if (fd < 0) return failed("no file descriptor is left");
        wl_proxy* const pool =
            request(shm_, WL_SHM_CREATE_POOL, library_.wl_shm_pool_interface, nullptr, fd, static_cast<int32_t>(size));
        close(fd);  // libwayland sends a duplicate
        if (pool == nullptr) return failed("the Wayland connection takes no more memory");
        pictures_.push_back({(*memory)->data(), pool, nullptr, nullptr});
        return memory;
    }

    bool setsPace() const override { return true; }

    VkResult show(const Image& image, Done done) noexcept override {
        std::unique_lock lock(mutex_);
        Picture& picture = *std::ranges::find(pictures_, image.address(0, 0), &Picture::texels);
        if (lost_ || !prepare(picture, image)) {
            lock.unlock();
            done();
            return VK_ERROR_SURFACE_LOST_KHR;
        }
        picture.done = std::move(done);
        if (paced_) {
            static constexpr wl_callback_listener kShown = {&nextFrame};
            frame_ = request(surface_, WL_SURFACE_FRAME, library_.wl_callback_interface, nullptr);
            if (frame_ != nullptr) listenTo(frame_, kShown, this);
        }
        request(surface_, WL_SURFACE_ATTACH, nullptr, picture.buffer, 0, 0);
        const uint32_t damage = library_.wl_proxy_get_version(surface_) >= WL_SURFACE_DAMAGE_BUFFER_SINCE_VERSION
                                    ? WL_SURFACE_DAMAGE_BUFFER
                                    : WL_SURFACE_DAMAGE;
        request(surface_, damage, nullptr, 0, 0, INT32_MAX, INT32_MAX);
        request(surface_, WL_SURFACE_COMMIT, nullptr);
        // What the socket has no room for goes when it has.
        if (library_.wl_display_flush(display_) < 0) wakeListener();
        changed_.wait(lock, [&] { return frame_ == nullptr || lost_ || stopped_; });
        return lost_ ? VK_ERROR_SURFACE_LOST_KHR : VK_SUCCESS;
    }

    void stop() noexcept override {
        {
            const std::lock_guard lock(mutex_);
            stopped_ = true;
            changed_.notify_all();
        }
        if (!listener_.joinable()) return;
        wakeListener();
        listener_.join();
    }

  private:
    /// The memory of an image, and what the compositor knows of it.
    struct Picture {
        const std::byte* texels;
        wl_proxy* pool;
        wl_proxy* buffer;  // once its extent is known
        Done done;         // as long as the compositor has it
    };

    template <class... Arguments>
    wl_proxy* request(wl_proxy* of, uint32_t opcode, const wl_interface* makes, Arguments... arguments) const {
        return library_.wl_proxy_marshal_flags(of, opcode, makes, library_.wl_proxy_get_version(of), 0, arguments...);
    }
    void destroy(wl_proxy* proxy, uint32_t opcode) const {
        library_.wl_proxy_marshal_flags(proxy, opcode, nullptr, library_.wl_proxy_get_version(proxy),
                                        WL_MARSHAL_FLAG_DESTROY);
    }
    /// A listener is a table of functions, one an event.
    template <class Listener>
    void listenTo(wl_proxy* proxy, const Listener& listener, void* data) const {
        library_.wl_proxy_add_listener(proxy, reinterpret_cast<void (**)()>(const_cast<Listener*>(&listener)), data);
    }
    /// The application's object, whose answers to us come to our own queue.
    wl_proxy* wrap(void* proxy) const {
        auto* const wrapper = static_cast<wl_proxy*>(library_.wl_proxy_create_wrapper(proxy));
        if (wrapper != nullptr) library_.wl_proxy_set_queue(wrapper, queue_);
        return wrapper;
    }

    bool findShm() {
        static constexpr wl_registry_listener kGlobals = {&global, [](void*, wl_registry*, uint32_t) {}};
        wl_proxy* const display = wrap(display_);
        if (display == nullptr) return false;
        wl_proxy* const registry = request(display, WL_DISPLAY_GET_REGISTRY, library_.wl_registry_interface, nullptr);
        if (registry != nullptr) {
            listenTo(registry, kGlobals, this);
            library_.wl_display_roundtrip_queue(display_, queue_);
            library_.wl_proxy_destroy(registry);
        }
        library_.wl_proxy_wrapper_destroy(display);
        return shm_ != nullptr;
    }

    bool prepare(Picture& picture, const Image& image) {
        static constexpr wl_buffer_listener kRelease = {&released};
        if (picture.buffer != nullptr) return true;
        const VkExtent3D extent = image.info().extent;
        // Every compositor takes these two: 32-bit words of 0xAARRGGBB.
        picture.buffer = request(picture.pool, WL_SHM_POOL_CREATE_BUFFER, library_.wl_buffer_interface, nullptr, 0,
                                 static_cast<int32_t>(extent.width), static_cast<int32_t>(extent.height),
                                 static_cast<int32_t>(image.level(0).rowPitch),
                                 opaque_ ? WL_SHM_FORMAT_XRGB8888 : WL_SHM_FORMAT_ARGB8888);
        if (picture.buffer == nullptr) return false;
        listenTo(picture.buffer, kRelease, &picture);
        return true;
    }

    // Events; listen() holds the mutex.
    static void global(void* self, wl_registry* registry, uint32_t name, const char* interface, uint32_t) {
        auto& screen = *static_cast<WaylandScreen*>(self);
        if (screen.shm_ != nullptr || std::strcmp(interface, "wl_shm") != 0) return;
        screen.shm_ = screen.library_.wl_proxy_marshal_flags(reinterpret_cast<wl_proxy*>(registry), WL_REGISTRY_BIND,
                                                             screen.library_.wl_shm_interface, 1, 0, name, interface,
                                                             1u, nullptr);
    }
    static void nextFrame(void* self, wl_callback*, uint32_t) {
        auto& screen = *static_cast<WaylandScreen*>(self);
        screen.library_.wl_proxy_destroy(screen.frame_);
        screen.frame_ = nullptr;
        screen.changed_.notify_all();
    }
    static void released(void* picture, wl_buffer*) { giveBack(*static_cast<Picture*>(picture)); }
    static void giveBack(Picture& picture) {
        if (picture.done) std::exchange(picture.done, nullptr)();
    }

    void wakeListener() const noexcept {
        const uint64_t one = 1;
        // Fails only when it is awake already.
        [[maybe_unused]] const ssize_t written = write(wake_, &one, sizeof one);
    }

    /// The thread's. As wl_display_prepare_read_queue() tells: the application may read from the same connection.
    void listen() noexcept {
        for (;;) {
            while (library_.wl_display_prepare_read_queue(display_, queue_) != 0) {
                if (!dispatch()) return;
            }
            const bool full = library_.wl_display_flush(display_) < 0 && errno == EAGAIN;
            const auto events = static_cast<short>(POLLIN | (full ? POLLOUT : 0));
            pollfd ready[] = {{library_.wl_display_get_fd(display_), events, 0}, {wake_, POLLIN, 0}};
            (void)poll(ready, std::size(ready), -1);
            if (ready[1].revents != 0) {
                uint64_t count = 0;
                [[maybe_unused]] const ssize_t got = read(wake_, &count, sizeof count);
            }
            if ((ready[0].revents & ~POLLOUT) != 0) {
                (void)library_.wl_display_read_events(display_);
            } else {
                library_.wl_display_cancel_read(display_);
            }
            if (!dispatch()) return;
        }
    }
    /// False: there is nothing to listen to any more.
    bool dispatch() noexcept {
        const std::lock_guard lock(mutex_);
        if (stopped_) return false;
        if (library_.wl_display_dispatch_queue_pending(display_, queue_) >= 0) return true;
        lost_ = true;
        // Nobody else gives them back, and who waits for one must get to see the error.
        for (Picture& picture : pictures_) giveBack(picture);
        changed_.notify_all();
        return false;
    }

    const WaylandLibrary& library_;
    wl_display* display_;
    bool opaque_, paced_;
    wl_event_queue* queue_ = nullptr;
    wl_proxy* surface_ = nullptr;
    wl_proxy* shm_ = nullptr;
    int wake_ = -1;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Picture> pictures_;
    wl_proxy* frame_ = nullptr;  // answered when it is time for the next image
    bool lost_ = false, stopped_ = false;
    std::thread listener_;  // last: it uses everything above
};

}  // namespace

std::unique_ptr<Screen> makeWaylandScreen(const Surface& surface, bool opaque, bool paced) {
    const WaylandLibrary* const library = WaylandLibrary::get();
    if (library == nullptr) return nullptr;
    auto screen = std::make_unique<WaylandScreen>(*library, surface, opaque, paced);
    if (!screen->start()) return nullptr;
    return screen;
}

}  // namespace vernier::vulkan
