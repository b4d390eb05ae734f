// What the samples share: a window or a file to draw to, a frame loop, and short words for creating things. It is a
// sample itself: read it to see how a C++ program wraps the C API.
#pragma once

#include <vernier/vernier.h>

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "samples/common/input.h"
#include "samples/common/mesh.h"
#include "samples/common/options.h"
#include "samples/common/transform.h"

namespace samples {

struct Frame {
    double seconds;  // since the start; without a window as the command line says
    double elapsed;  // since the last frame, even where time stands still; 0 for the first
    Input input;
    float pixelRatio = 1;  // of the window: 2 on many screens of high density
};

/// An image to draw to and read from.
struct Target {
    VnImage image{};
    VnView view{};
    uint32_t width = 0, height = 0;
};

/// A mesh in buffers.
struct Mesh {
    VnBuffer vertices{}, indices{};
    uint32_t indexCount = 0;
};

/// A device, a context, and a colour and a depth image of the window's size. Any Vernier call of this class that fails
/// ends the program with the message; what other calls have to say is printed, too.
class App {
  public:
    explicit App(const AppOptions& options);
    App(int argc, char** argv, const std::string& title, const std::vector<Option>& options = {})
        : App(parseOptions(argc, argv, title, options)) {}
    ~App();
    App(const App&) = delete;
    App& operator=(const App&) = delete;

    VnDevice device() const { return device_; }
    VnContext context() const { return context_; }
    uint32_t width() const { return options_.width; }
    uint32_t height() const { return options_.height; }
    float aspect() const { return static_cast<float>(options_.width) / static_cast<float>(options_.height); }
    const AppOptions& options() const { return options_; }
    bool hasWindow() const { return options_.window(); }
    /// The picture that is shown or written: RGBA8, sRGB. And a depth image of 32-bit floats beside it. They, and what
    /// width() and height() say, change from one frame to the next when the window is resized.
    const Target& color() const { return *color_; }
    const Target& depth() const { return *depth_; }
    /// Writes color() to a file, in the format by the end of its name; says so when it cannot.
    bool save(const std::string& path);

    /// Draws frames until the window is closed, or those that the command line asks for. `frame` draws to color() in
    /// passes of its own. Returns the exit status for main().
    int run(const std::function<void(const Frame&)>& frame);
    /// The same, inside a pass that has been cleared to `background`.
    int run(const glm::vec4& background, const std::function<void(const Frame&)>& frame);

    /// Starts a pass to color() and depth().
    void beginPass(const glm::vec4& background);
    /// Starts a pass to other targets, all cleared: colours to `background`, depth to 1.
    void beginPass(const std::vector<Target>& colors, const Target& depth, const glm::vec4& background);
    void endPass();

    // Creation in one line each.
    VnShader shader(VkShaderStageFlagBits stage, const std::string& glsl);
    VnProgram program(const std::string& vertexGlsl, const std::string& fragmentGlsl);
    VnProgram computeProgram(const std::string& glsl);
    VnBuffer buffer(const void* data, size_t bytes);
    template <class T>
    VnBuffer buffer(const std::vector<T>& elements) {
        return buffer(elements.data(), elements.size() * sizeof(T));
    }
    /// RGBA8 texels, sRGB, with all mip levels.
    VnView texture(uint32_t width, uint32_t height, const std::vector<uint32_t>& texels);
    Target target(VkFormat format, uint32_t width, uint32_t height);
    /// As big as color(), or what `sizeOf` makes of that; made anew, with a view of its own, when the window is
    /// resized.
    const Target& windowTarget(VkFormat format, std::function<VkExtent2D(VkExtent2D)> sizeOf = {});
    /// Filtered in a level, and between levels where the filter is linear.
    VnSampler sampler(VkFilter filter, VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_REPEAT);
    VnVertexLayout layout(const std::vector<VnVertexAttribute>& attributes,
                          const std::vector<VnVertexBinding>& bindings);
    VnDepthStencilState depthState(bool write = true, VkCompareOp compare = VK_COMPARE_OP_LESS);
    VnRasterState rasterState(VkCullModeFlags cull, VkPolygonMode mode = VK_POLYGON_MODE_FILL);
    VnBlendState blendState(VkBlendFactor source, VkBlendFactor destination);

    Mesh mesh(const MeshData& data);
    /// Of MeshVertex in binding 0: position, normal, uv at locations 0, 1, 2.
    VnVertexLayout meshLayout();
    void draw(const Mesh& mesh, uint32_t instances = 1);
    template <class T>
    void push(const T& constants) {
        vnPushConstants(context_, 0, &constants, sizeof constants);
    }
    /// Changes a buffer, in order with the draws; outside a pass.
    template <class T>
    void update(VnBuffer target, const std::vector<T>& elements) {
        vnUpdateBuffer(context_, target, 0, elements.data(), elements.size() * sizeof(T));
    }

  private:
    void readPixels();
    bool writePixels(const std::string& path);
    int runHeadless(const std::function<void(const Frame&)>& frame);
    int runFrames(const std::function<void(const Frame&)>& frame);
    int runWindow(const std::function<void(const Frame&)>& frame);

    struct WindowTarget {
        VkFormat format;
        std::function<VkExtent2D(VkExtent2D)> sizeOf;
        Target target;
    };
    void make(WindowTarget& target);
    void resize(uint32_t width, uint32_t height);

    AppOptions options_;
    VnDevice device_ = nullptr;
    VnContext context_ = nullptr;
    std::deque<WindowTarget> windowTargets_;  // which does not move them
    const Target *color_ = nullptr, *depth_ = nullptr;
    std::vector<uint32_t> pixels_;
};

/// Ends the program if `result` is an error; Vernier has already told what was wrong through the message callback.
void must(VnResult result);

/// A checkerboard of two colours, `cells` cells on a side.
std::vector<uint32_t> checkerTexels(uint32_t size, uint32_t cells, uint32_t first, uint32_t second);

/// A vertex shader without vertex buffers, for three vertices: covers everything, `uv` at location 0 is 0..1.
extern const char* const kFullScreenVertex;

}  // namespace samples
