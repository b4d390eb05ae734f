#include "tests/samples/x_screen.h"

#include <X11/extensions/XTest.h>
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <chrono>
#include <thread>

namespace samples::test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPatience = std::chrono::seconds(30);

void rest() {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

Display* of(void* display) {
    return static_cast<Display*>(display);
}

/// Windows come and go: an answer about one that is gone is no reason to end.
int ignoreError(Display*, XErrorEvent*) {
    return 0;
}

void tell(Display* display, Window to, const char* type, Window from, long a, long b = 0, long c = 0, long d = 0) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = to;
    event.xclient.message_type = XInternAtom(display, type, False);
    event.xclient.format = 32;
    const long data[] = {static_cast<long>(from), a, b, c, d};
    for (int i = 0; i < 5; ++i) event.xclient.data.l[i] = data[i];
    XSendEvent(display, to, False, NoEventMask, &event);
    XFlush(display);
}

}  // namespace

XScreen::XScreen() : display_(XOpenDisplay(nullptr)) {
    int unused = 0;
    if (display_ && !XTestQueryExtension(of(display_), &unused, &unused, &unused, &unused)) {
        XCloseDisplay(of(display_));
        display_ = nullptr;
    }
    XSetErrorHandler(ignoreError);
}

XScreen::~XScreen() {
    if (display_) XCloseDisplay(of(display_));
}

XScreen::WindowId XScreen::find(const std::string& title) {
    for (const auto end = Clock::now() + kPatience; Clock::now() < end; rest()) {
        Window root = 0, parent = 0, *children = nullptr;
        unsigned int count = 0;
        if (!XQueryTree(of(display_), DefaultRootWindow(of(display_)), &root, &parent, &children, &count)) continue;
        Window found = 0;
        for (unsigned int i = 0; i < count; ++i) {
            char* name = nullptr;
            XWindowAttributes attributes{};
            if (XFetchName(of(display_), children[i], &name) && std::string(name).rfind(title, 0) == 0 &&
                XGetWindowAttributes(of(display_), children[i], &attributes) && attributes.map_state == IsViewable)
                found = children[i];
            if (name) XFree(name);
        }
        if (children) XFree(children);
        if (found) return found;
    }
    return 0;
}

ScreenPicture XScreen::look(WindowId window) {
    ScreenPicture picture;
    XWindowAttributes attributes{};
    if (!XGetWindowAttributes(of(display_), window, &attributes)) return picture;
    XImage* image = XGetImage(of(display_), window, 0, 0, static_cast<unsigned int>(attributes.width),
                              static_cast<unsigned int>(attributes.height), AllPlanes, ZPixmap);
    if (!image) return picture;
    picture.width = static_cast<uint32_t>(image->width);
    picture.height = static_cast<uint32_t>(image->height);
    for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x)
            picture.pixels.push_back(static_cast<uint32_t>(XGetPixel(image, x, y)) & 0xFFFFFF);
    XDestroyImage(image);
    return picture;
}

void XScreen::hold(WindowId window, const std::string& key, bool down) {
    // Without a window manager nobody else gives the window the keyboard.
    XSetInputFocus(of(display_), window, RevertToPointerRoot, CurrentTime);
    const KeyCode code = XKeysymToKeycode(of(display_), XStringToKeysym(key.c_str()));
    XTestFakeKeyEvent(of(display_), code, down ? True : False, CurrentTime);
    XSync(of(display_), False);
}

void XScreen::press(WindowId window, const std::string& key) {
    hold(window, key, true);
    rest();
    hold(window, key, false);
    // A key that comes back at once is taken for one that repeats itself.
    rest();
}

void XScreen::drag(WindowId window, int fromX, int fromY, int toX, int toY) {
    const auto move = [&](int x, int y) {
        int rootX = 0, rootY = 0;
        Window child = 0;
        XTranslateCoordinates(of(display_), window, DefaultRootWindow(of(display_)), x, y, &rootX, &rootY, &child);
        XTestFakeMotionEvent(of(display_), DefaultScreen(of(display_)), rootX, rootY, CurrentTime);
        XSync(of(display_), False);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));  // some frames see it there
    };
    const auto button = [&](bool down) {
        XTestFakeButtonEvent(of(display_), 1, down ? True : False, CurrentTime);
        XSync(of(display_), False);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
    };
    move(fromX, fromY);
    button(true);
    move(toX, toY);
    button(false);
}

void XScreen::resize(WindowId window, uint32_t width, uint32_t height) {
    XResizeWindow(of(display_), window, width, height);
    XSync(of(display_), False);
}

bool XScreen::drop(WindowId window, const std::string& path) {
    Display* display = of(display_);
    const auto atom = [&](const char* name) { return XInternAtom(display, name, False); };
    const Window source = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0);
    const Atom selection = atom("XdndSelection"), list = atom("text/uri-list");
    const std::string text = "file://" + path + "\r\n";
    XSetSelectionOwner(display, selection, source, CurrentTime);
    tell(display, window, "XdndEnter", source, 5L << 24, static_cast<long>(list));
    tell(display, window, "XdndPosition", source, 0, 10L << 16 | 10, CurrentTime,
         static_cast<long>(atom("XdndActionCopy")));
    tell(display, window, "XdndDrop", source, 0, CurrentTime);
    bool taken = false;
    for (const auto end = Clock::now() + kPatience; Clock::now() < end && !taken; rest())
        while (!taken && XPending(display) > 0) {
            XEvent event{};
            XNextEvent(display, &event);
            if (event.type == SelectionRequest) {
                const XSelectionRequestEvent& request = event.xselectionrequest;
                XChangeProperty(display, request.requestor, request.property, request.target, 8, PropModeReplace,
                                reinterpret_cast<const unsigned char*>(text.data()), static_cast<int>(text.size()));
                XEvent answer{};
                answer.xselection.type = SelectionNotify;
                answer.xselection.requestor = request.requestor;
                answer.xselection.selection = request.selection;
                answer.xselection.target = request.target;
                answer.xselection.property = request.property;
                answer.xselection.time = request.time;
                XSendEvent(display, request.requestor, False, NoEventMask, &answer);
                XFlush(display);
            }
            taken = event.type == ClientMessage && event.xclient.message_type == atom("XdndFinished");
        }
    XDestroyWindow(display, source);
    return taken;
}

}  // namespace samples::test
