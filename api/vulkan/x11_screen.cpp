// Showing images on a window of an X server: through shared memory, which the server reads where the image was
// rendered, or, to servers that have none in common with this process, as requests with the texels in them.
#include <sys/ipc.h>
#include <sys/shm.h>
#include <xcb/shm.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "api/vulkan/screen.h"
#include "api/vulkan/x11_window.h"

namespace vernier::vulkan {
namespace {

constexpr uint32_t kTexelBytes = 4;

bool hasSharedMemory(xcb_connection_t* connection) {
    const xcb_query_extension_reply_t* extension = xcb_get_extension_data(connection, &xcb_shm_id);
    if (extension == nullptr || extension->present == 0) return false;
    const XcbReply<xcb_shm_query_version_reply_t> version(
        xcb_shm_query_version_reply(connection, xcb_shm_query_version(connection), nullptr));
    return version != nullptr;
}

class X11Screen final : public Screen {
  public:
    X11Screen(xcb_connection_t* connection, xcb_window_t window, uint8_t depth)
        : connection_(connection),
          window_(window),
          depth_(depth),
          context_(xcb_generate_id(connection)),
          shared_(hasSharedMemory(connection)) {
        // Copies to a window would otherwise be answered with an event each.
        const uint32_t exposures = 0;
        const auto made = xcb_create_gc_checked(connection_, context_, window_, XCB_GC_GRAPHICS_EXPOSURES, &exposures);
        xcb_discard_reply(connection_, made.sequence);
    }
    ~X11Screen() override {
        const auto freed = xcb_free_gc_checked(connection_, context_);
        xcb_discard_reply(connection_, freed.sequence);
        xcb_flush(connection_);
    }

    Result<std::unique_ptr<Memory>> allocate(VkDeviceSize size) override {
        if (shared_) {
            segments_.reserve(segments_.size() + 1);
            Result<std::unique_ptr<Memory>> made = Memory::create({this, &allocateSegment, &releaseSegment}, size);
            if (made) return made;
            shared_ = false;
        }
        return Memory::create({}, size);
    }

    VkResult show(const Image& image, Done done) noexcept override {
        const VkExtent3D extent = image.info().extent;
        const std::byte* texels = image.address(0, 0);
        const uint32_t pitch = image.level(0).rowPitch;
        const auto segment = std::ranges::find(segments_, texels, &Segment::address);
        const xcb_void_cookie_t put =
            segment != segments_.end()
                ? xcb_shm_put_image_checked(connection_, window_, context_, static_cast<uint16_t>(pitch / kTexelBytes),
                                            static_cast<uint16_t>(extent.height), 0, 0,
                                            static_cast<uint16_t>(extent.width), static_cast<uint16_t>(extent.height),
                                            0, 0, depth_, XCB_IMAGE_FORMAT_Z_PIXMAP, 0, segment->id, 0)
                : putTexels(texels, pitch, extent);
        // The server answers one request after the other: with this reply it has read the texels, too.
        const XcbReply<xcb_get_geometry_reply_t> now(
            xcb_get_geometry_reply(connection_, xcb_get_geometry(connection_, window_), nullptr));
        const XcbReply<xcb_generic_error_t> error(xcb_request_check(connection_, put));
        done();
        if (!now || error) return VK_ERROR_SURFACE_LOST_KHR;
        return now->width == extent.width && now->height == extent.height ? VK_SUCCESS : VK_ERROR_OUT_OF_DATE_KHR;
    }

  private:
    struct Segment {
        const std::byte* address;
        xcb_shm_seg_t id;
    };

    /// HostAllocator::allocate. The segment has no name any more once both sides are attached: nothing is left behind
    /// by a process that dies.
    static void* allocateSegment(void* user, size_t bytes, size_t) {
        auto& self = *static_cast<X11Screen*>(user);
        const int segment = shmget(IPC_PRIVATE, bytes, IPC_CREAT | 0600);
        if (segment < 0) return nullptr;
        void* address = shmat(segment, nullptr, 0);
        const xcb_shm_seg_t id = xcb_generate_id(self.connection_);
        const bool mapped = address != reinterpret_cast<void*>(-1);
        bool attached = false;
        if (mapped) {
            const auto attach =
                xcb_shm_attach_checked(self.connection_, id, static_cast<uint32_t>(segment), /*read_only=*/1);
            attached = XcbReply<xcb_generic_error_t>(xcb_request_check(self.connection_, attach)) == nullptr;
        }
        shmctl(segment, IPC_RMID, nullptr);
        if (!attached) {
            if (mapped) shmdt(address);
            return nullptr;
        }
        self.segments_.push_back({static_cast<const std::byte*>(address), id});
        return address;
    }

    static void releaseSegment(void* user, void* memory, size_t) {
        auto& self = *static_cast<X11Screen*>(user);
        const auto segment =
            std::ranges::find(self.segments_, static_cast<const std::byte*>(memory), &Segment::address);
        const auto detached = xcb_shm_detach_checked(self.connection_, segment->id);
        xcb_discard_reply(self.connection_, detached.sequence);
        self.segments_.erase(segment);
        shmdt(memory);
    }

    /// As many rows a request as the server takes.
    xcb_void_cookie_t putTexels(const std::byte* texels, uint32_t pitch, const VkExtent3D& extent) noexcept {
        constexpr size_t kHead = 64;  // more than a request has beside its texels
        const size_t rowBytes = size_t{extent.width} * kTexelBytes;
        const size_t room = std::max<size_t>(size_t{xcb_get_maximum_request_length(connection_)} * 4, kHead) - kHead;
        const auto rows = static_cast<uint32_t>(std::clamp<size_t>(room / rowBytes, 1, extent.height));
        xcb_void_cookie_t put{};
        for (uint32_t y = 0; y < extent.height; y += rows) {
            const uint32_t count = std::min(rows, extent.height - y);
            const std::byte* first = texels + size_t{y} * pitch;
            if (pitch != rowBytes) first = packRows(first, pitch, rowBytes, count);
            if (first == nullptr) return put;
            if (y != 0) xcb_discard_reply(connection_, put.sequence);
            put = xcb_put_image_checked(connection_, XCB_IMAGE_FORMAT_Z_PIXMAP, window_, context_,
                                        static_cast<uint16_t>(extent.width), static_cast<uint16_t>(count), 0,
                                        static_cast<int16_t>(y), 0, depth_, static_cast<uint32_t>(rowBytes * count),
                                        reinterpret_cast<const uint8_t*>(first));
        }
        return put;
    }

    /// nullptr when out of memory: that frame is not shown.
    const std::byte* packRows(const std::byte* from, uint32_t pitch, size_t rowBytes, uint32_t count) noexcept {
        try {
            packed_.resize(rowBytes * count);
        } catch (const std::bad_alloc&) {
            return nullptr;
        }
        for (uint32_t y = 0; y < count; ++y) std::memcpy(&packed_[y * rowBytes], from + size_t{y} * pitch, rowBytes);
        return packed_.data();
    }

    xcb_connection_t* connection_;
    xcb_window_t window_;
    uint8_t depth_;
    xcb_gcontext_t context_;
    bool shared_;
    std::vector<Segment> segments_;
    std::vector<std::byte> packed_;
};

}  // namespace

std::unique_ptr<Screen> makeX11Screen(const Surface& surface) {
    const std::optional<X11Window> window = findWindow(surface.connection, surface.window);
    if (!window || window->visual.depth == 0) return nullptr;
    return std::make_unique<X11Screen>(surface.connection, surface.window, window->visual.depth);
}

}  // namespace vernier::vulkan
