#include "tests/vulkan/test_compositor.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <wayland-server-core.h>
#include <wayland-server-protocol.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

namespace vernier::test {
namespace {

/// A buffer as long as its client keeps it. Stays where it is.
struct BufferReference {
    BufferReference() = default;
    BufferReference(const BufferReference&) = delete;
    BufferReference& operator=(const BufferReference&) = delete;
    ~BufferReference() { set(nullptr); }

    void set(wl_resource* to) {
        if (buffer != nullptr) wl_list_remove(&destroyed.link);
        buffer = to;
        destroyed.notify = &forget;
        if (buffer != nullptr) wl_resource_add_destroy_listener(buffer, &destroyed);
    }
    wl_resource* take() {
        wl_resource* const was = buffer;
        set(nullptr);
        return was;
    }
    static void forget(wl_listener* listener, void*) { reinterpret_cast<BufferReference*>(listener)->buffer = nullptr; }

    wl_listener destroyed{};  // first: it stands for the whole
    wl_resource* buffer = nullptr;
};

}  // namespace

/// State is double-buffered: what is attached and asked for counts from the next commit on (wayland.xml, wl_surface).
struct TestCompositor::Surface {
    TestCompositor* compositor = nullptr;
    BufferReference attached;  // not committed yet
    bool isAttached = false;
    BufferReference committed;  // not shown yet
    BufferReference shown;
    std::vector<wl_resource*> asked, frames;  // callbacks, before and after the commit
};

/// All are called by the compositor's thread with its mutex locked.
struct Requests {
    using Surface = TestCompositor::Surface;

    static Surface& of(wl_resource* resource) { return *static_cast<Surface*>(wl_resource_get_user_data(resource)); }
    static void destroy(wl_client*, wl_resource* resource) { wl_resource_destroy(resource); }
    static void attach(wl_client*, wl_resource* resource, wl_resource* buffer, int32_t, int32_t) {
        of(resource).attached.set(buffer);
        of(resource).isAttached = true;
    }
    static void damage(wl_client*, wl_resource*, int32_t, int32_t, int32_t, int32_t) {}
    static void frame(wl_client* client, wl_resource* resource, uint32_t id) {
        wl_resource* const callback = wl_resource_create(client, &wl_callback_interface, 1, id);
        wl_resource_set_implementation(callback, nullptr, &of(resource), &forgetCallback);
        of(resource).asked.push_back(callback);
    }
    static void forgetCallback(wl_resource* callback) {
        auto* const surface = static_cast<Surface*>(wl_resource_get_user_data(callback));
        if (surface == nullptr) return;
        std::erase(surface->asked, callback);
        std::erase(surface->frames, callback);
    }
    static void setRegion(wl_client*, wl_resource*, wl_resource*) {}
    static void setNumber(wl_client*, wl_resource*, int32_t) {}
    static void offset(wl_client*, wl_resource*, int32_t, int32_t) {}
    static void commit(wl_client*, wl_resource* resource) {
        Surface& surface = of(resource);
        surface.frames.insert(surface.frames.end(), surface.asked.begin(), surface.asked.end());
        surface.asked.clear();
        if (!std::exchange(surface.isAttached, false)) return;
        // What was never shown is not needed any more.
        if (wl_resource* const buffer = surface.committed.take()) wl_buffer_send_release(buffer);
        surface.committed.set(surface.attached.take());
        surface.compositor->committed(surface);
    }
    static void forgetSurface(wl_resource* resource) {
        Surface* const surface = &of(resource);
        for (const auto* list : {&surface->asked, &surface->frames}) {
            for (wl_resource* const callback : *list) wl_resource_set_user_data(callback, nullptr);
        }
        std::erase(surface->compositor->surfaces_, surface);
        delete surface;
    }
    static void createSurface(wl_client* client, wl_resource* resource, uint32_t id) {
        auto* const compositor = static_cast<TestCompositor*>(wl_resource_get_user_data(resource));
        static const struct wl_surface_interface kSurface = {&destroy,   &attach,    &damage, &frame,
                                                             &setRegion, &setRegion, &commit, &setNumber,
                                                             &setNumber, &damage,    &offset};
        auto* const surface = new Surface;
        surface->compositor = compositor;
        compositor->surfaces_.push_back(surface);
        wl_resource* const made =
            wl_resource_create(client, &wl_surface_interface, wl_resource_get_version(resource), id);
        wl_resource_set_implementation(made, &kSurface, surface, &forgetSurface);
    }
    static void createRegion(wl_client* client, wl_resource*, uint32_t id) {
        static const struct wl_region_interface kRegion = {
            &destroy, [](wl_client*, wl_resource*, int32_t, int32_t, int32_t, int32_t) {},
            [](wl_client*, wl_resource*, int32_t, int32_t, int32_t, int32_t) {}};
        wl_resource_set_implementation(wl_resource_create(client, &wl_region_interface, 1, id), &kRegion, nullptr,
                                       nullptr);
    }
    static void bind(wl_client* client, void* compositor, uint32_t version, uint32_t id) {
        static const struct wl_compositor_interface kCompositor = {&createSurface, &createRegion};
        wl_resource* const made = wl_resource_create(client, &wl_compositor_interface, static_cast<int>(version), id);
        wl_resource_set_implementation(made, &kCompositor, compositor, nullptr);
    }
};

TestCompositor::TestCompositor() : display_(wl_display_create()) {
    wl_display_init_shm(display_);
    wl_global_create(display_, &wl_compositor_interface, 4, this, &Requests::bind);
    thread_ = std::thread([this] { main(); });
}

TestCompositor::~TestCompositor() {
    stopped_ = true;
    thread_.join();
    wl_display_destroy_clients(display_);
    wl_display_destroy(display_);
}

int TestCompositor::connect() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return -1;
    const std::lock_guard lock(mutex_);
    wl_client* const client = wl_client_create(display_, ends[0]);
    if (client == nullptr) return -1;
    clients_.push_back(client);
    return ends[1];
}

void TestCompositor::setAutomatic(bool automatic) {
    const std::lock_guard lock(mutex_);
    automatic_ = automatic;
}

void TestCompositor::refresh() {
    const std::lock_guard lock(mutex_);
    show();
    wl_display_flush_clients(display_);
}

void TestCompositor::hangUp() {
    const std::lock_guard lock(mutex_);
    for (wl_client* const client : std::exchange(clients_, {})) wl_client_destroy(client);
}

bool TestCompositor::awaitCommits(uint32_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(10), [&] { return commits_ >= count; });
}

uint32_t TestCompositor::commits() {
    const std::lock_guard lock(mutex_);
    return commits_;
}

ShownPicture TestCompositor::shown() {
    const std::lock_guard lock(mutex_);
    return shown_;
}

void TestCompositor::committed(Surface&) {
    ++commits_;
    changed_.notify_all();
}

void TestCompositor::show() {
    for (Surface* const surface : surfaces_) {
        if (wl_resource* const buffer = surface->committed.take()) {
            wl_shm_buffer* const pixels = wl_shm_buffer_get(buffer);
            shown_.extent = {static_cast<uint32_t>(wl_shm_buffer_get_width(pixels)),
                             static_cast<uint32_t>(wl_shm_buffer_get_height(pixels))};
            shown_.format = wl_shm_buffer_get_format(pixels);
            shown_.texels.resize(size_t{shown_.extent.width} * shown_.extent.height);
            wl_shm_buffer_begin_access(pixels);
            const auto* row = static_cast<const std::byte*>(wl_shm_buffer_get_data(pixels));
            for (uint32_t y = 0; y < shown_.extent.height; ++y, row += wl_shm_buffer_get_stride(pixels))
                std::memcpy(&shown_.texels[size_t{y} * shown_.extent.width], row, size_t{4} * shown_.extent.width);
            wl_shm_buffer_end_access(pixels);
            if (wl_resource* const before = surface->shown.take()) wl_buffer_send_release(before);
            surface->shown.set(buffer);
        }
        for (wl_resource* const callback : std::exchange(surface->frames, {})) {
            wl_callback_send_done(callback, 0);
            wl_resource_destroy(callback);
        }
    }
}

void TestCompositor::main() {
    wl_event_loop* const loop = wl_display_get_event_loop(display_);
    while (!stopped_) {
        pollfd ready{wl_event_loop_get_fd(loop), POLLIN, 0};
        (void)poll(&ready, 1, 2);
        const std::lock_guard lock(mutex_);
        wl_event_loop_dispatch(loop, 0);
        if (automatic_) show();
        wl_display_flush_clients(display_);
    }
}

}  // namespace vernier::test
