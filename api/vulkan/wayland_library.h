// libwayland-client, loaded by whoever first has a Wayland display, which is one of that library's: programs without
// one do not need it.
#pragma once

#include <wayland-client-core.h>

namespace vernier::vulkan {

#define VERNIER_WAYLAND_FUNCTIONS(X)     \
    X(wl_display_cancel_read)            \
    X(wl_display_create_queue)           \
    X(wl_display_dispatch_queue_pending) \
    X(wl_display_flush)                  \
    X(wl_display_get_fd)                 \
    X(wl_display_prepare_read_queue)     \
    X(wl_display_read_events)            \
    X(wl_display_roundtrip_queue)        \
    X(wl_event_queue_destroy)            \
    X(wl_proxy_add_listener)             \
    X(wl_proxy_create_wrapper)           \
    X(wl_proxy_destroy)                  \
    X(wl_proxy_get_version)              \
    X(wl_proxy_marshal_flags)            \
    X(wl_proxy_set_queue)                \
    X(wl_proxy_wrapper_destroy)
#define VERNIER_WAYLAND_INTERFACES(X) \
    X(wl_buffer_interface)            \
    X(wl_callback_interface)          \
    X(wl_registry_interface)          \
    X(wl_shm_interface)               \
    X(wl_shm_pool_interface)

/// What the driver uses of it, by the library's names.
struct WaylandLibrary {
#define VERNIER_MEMBER(name) decltype(&::name) name = nullptr;
    VERNIER_WAYLAND_FUNCTIONS(VERNIER_MEMBER)
#undef VERNIER_MEMBER
#define VERNIER_MEMBER(name) const wl_interface* name = nullptr;
    VERNIER_WAYLAND_INTERFACES(VERNIER_MEMBER)
#undef VERNIER_MEMBER

    /// nullptr when it is not there, or older than 1.20. Thread-safe.
    static const WaylandLibrary* get();
};

}  // namespace vernier::vulkan
