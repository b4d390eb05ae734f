// What the samples share: a window or a file to draw to, a frame loop, and short words for creating things. It is a
// sample itself: read it to see how a C++ program wraps the C API.
#pragma once

#include <vernier/vernier.h>

#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace samples {

struct AppOptions {
    std::string title;
    uint32_t width = 800, height = 600;
    std::string headless;  // path of a PNG; empty: a window
    double time = 0;       // seconds at which the headless picture is taken
};

/// Reads --headless OUT.png, --size WxH and --time SECONDS; prints help and exits when asked to or when something is
/// wrong.
AppOptions parseOptions(int argc, char** argv, const std::string& title);

/// A device, a context, and a colour and a depth image of the window's size. Any Vernier call that fails ends the
/// program with the message.
class App {
  public:
    explicit App(const AppOptions& options);
    ~App();
    App(const App&) = delete;
    App& operator=(const App&) = delete;

    VnDevice device() const { return device_; }
    VnContext context() const { return context_; }
    float aspect() const { return static_cast<float>(options_.width) / static_cast<float>(options_.height); }

    /// Draws frames until the window is closed, or one frame into the file. `frame` gets the time in seconds since the
    /// start and draws inside a pass that has been cleared to `background`. Returns the exit status for main().
    int run(const glm::vec4& background, const std::function<void(double seconds)>& frame);

    // Creation in one line each.
    VnProgram program(const std::string& vertexGlsl, const std::string& fragmentGlsl);
    VnBuffer buffer(const void* data, size_t bytes);
    template <class T>
    VnBuffer buffer(const std::vector<T>& elements) {
        return buffer(elements.data(), elements.size() * sizeof(T));
    }
    /// RGBA8 texels, sRGB, with all mip levels.
    VnView texture(uint32_t width, uint32_t height, const std::vector<uint32_t>& texels);

  private:
    void drawFrame(const glm::vec4& background, const std::function<void(double)>& frame, double seconds);
    int runHeadless(const glm::vec4& background, const std::function<void(double)>& frame);
    int runWindow(const glm::vec4& background, const std::function<void(double)>& frame);

    AppOptions options_;
    VnDevice device_ = nullptr;
    VnContext context_ = nullptr;
    VnImage color_{}, depth_{};
    std::vector<uint32_t> pixels_;
};

/// A checkerboard of two colours, `cells` cells on a side.
std::vector<uint32_t> checkerTexels(uint32_t size, uint32_t cells, uint32_t first, uint32_t second);

/// A perspective with depth 0..1 and y down, as Vulkan and Vernier have it; `fieldOfView` vertical, in radians.
glm::mat4 perspective(float fieldOfView, float aspect, float nearPlane, float farPlane);

}  // namespace samples
