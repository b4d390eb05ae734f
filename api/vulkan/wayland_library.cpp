#include "api/vulkan/wayland_library.h"

#include <dlfcn.h>

#include <optional>
#include <type_traits>

namespace vernier::vulkan {
namespace {

std::optional<WaylandLibrary> load() {
    // Never closed: displays, which are the application's, need it as long as they live.
    void* const library = dlopen("libwayland-client.so.0", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return std::nullopt;
    WaylandLibrary loaded;
    bool whole = true;
    const auto find = [&](auto& member, const char* name) {
        member = reinterpret_cast<std::remove_reference_t<decltype(member)>>(dlsym(library, name));
        whole = whole && member != nullptr;
    };
#define VERNIER_FIND(name) find(loaded.name, #name);
    VERNIER_WAYLAND_FUNCTIONS(VERNIER_FIND)
    VERNIER_WAYLAND_INTERFACES(VERNIER_FIND)
#undef VERNIER_FIND
    if (!whole) return std::nullopt;
    return loaded;
}

}  // namespace

const WaylandLibrary* WaylandLibrary::get() {
    static const std::optional<WaylandLibrary> library = load();
    return library ? &*library : nullptr;
}

}  // namespace vernier::vulkan
