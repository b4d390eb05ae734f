#include "api/vulkan/x11_window.h"

namespace vernier::vulkan {
namespace {

/// Whether texels of this depth take four bytes, the lowest first.
bool isFourBytes(const xcb_setup_t* setup, uint8_t depth) {
    if (setup->image_byte_order != XCB_IMAGE_ORDER_LSB_FIRST) return false;
    for (auto it = xcb_setup_pixmap_formats_iterator(setup); it.rem > 0; xcb_format_next(&it)) {
        if (it.data->depth == depth) return it.data->bits_per_pixel == 32 && it.data->scanline_pad == 32;
    }
    return false;
}

std::optional<X11Visual> describe(const xcb_setup_t* setup, uint8_t depth, const xcb_visualtype_t& visual) {
    if ((depth != 24 && depth != 32) || !isFourBytes(setup, depth)) return std::nullopt;
    if (visual._class != XCB_VISUAL_CLASS_TRUE_COLOR && visual._class != XCB_VISUAL_CLASS_DIRECT_COLOR) {
        return std::nullopt;
    }
    const bool redFirst = visual.red_mask == 0xFF && visual.blue_mask == 0xFF0000;
    const bool blueFirst = visual.red_mask == 0xFF0000 && visual.blue_mask == 0xFF;
    if (visual.green_mask != 0xFF00 || !(redFirst || blueFirst)) return std::nullopt;
    return X11Visual{depth, redFirst, depth == 32};
}

}  // namespace

std::optional<X11Visual> findVisual(xcb_connection_t* connection, xcb_visualid_t id) {
    if (xcb_connection_has_error(connection) != 0) return std::nullopt;
    const xcb_setup_t* setup = xcb_get_setup(connection);
    for (auto screen = xcb_setup_roots_iterator(setup); screen.rem > 0; xcb_screen_next(&screen)) {
        for (auto depth = xcb_screen_allowed_depths_iterator(screen.data); depth.rem > 0; xcb_depth_next(&depth)) {
            for (auto it = xcb_depth_visuals_iterator(depth.data); it.rem > 0; xcb_visualtype_next(&it)) {
                if (it.data->visual_id == id) return describe(setup, depth.data->depth, *it.data);
            }
        }
    }
    return std::nullopt;
}

std::optional<X11Window> findWindow(xcb_connection_t* connection, xcb_window_t window) {
    const auto geometryCookie = xcb_get_geometry(connection, window);
    const auto attributesCookie = xcb_get_window_attributes(connection, window);
    const XcbReply<xcb_get_geometry_reply_t> geometry(xcb_get_geometry_reply(connection, geometryCookie, nullptr));
    const XcbReply<xcb_get_window_attributes_reply_t> attributes(
        xcb_get_window_attributes_reply(connection, attributesCookie, nullptr));
    if (!geometry || !attributes) return std::nullopt;
    X11Window result{{geometry->width, geometry->height}, {}};
    if (const auto visual = findVisual(connection, attributes->visual)) result.visual = *visual;
    return result;
}

}  // namespace vernier::vulkan
