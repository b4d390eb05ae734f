// A library to preload into a program that draws with vernier.h:
//   LD_PRELOAD=libvernier_capture.so VERNIER_CAPTURE=api|vulkan gears --frames 2 --size 1280x720
// It hands every call on to Vernier, makes a scene of what lies between the first picture that the program reads and
// the second (so that what is made once before the first frame stays out), draws that on Vernier's API or on the Vulkan
// driver that the loader finds, prints one line and ends the program:
//   <ms per frame> <share of the pixels that differ from the program's own by more than 8 of 255> <driver>
// or, to the error output, why the frame is no scene.
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "bench/capture/capture.h"
#include "conformance/drivers/api_driver.h"
#include "conformance/drivers/vulkan_driver.h"

namespace vernier::bench {
namespace {

using namespace conformance;

Capture capture;
bool capturing = true;  // not while this library draws itself
int pictures = 0;

[[noreturn]] void stop(const std::string& reason) {
    std::fprintf(stderr, "no scene: %s\n", reason.c_str());
    std::_Exit(3);
}

/// The median time of a frame on a driver, and the picture.
[[noreturn]] void drawScene(const Scene& scene, const std::vector<uint8_t>& own) {
    const char* chosen = std::getenv("VERNIER_CAPTURE");
    std::unique_ptr<Driver> driver;
    if (chosen && std::strcmp(chosen, "vulkan") == 0) {
        auto made = VulkanDriver::create({});
        if (!made) stop(made.error().message);
        driver = std::move(made).value();
    } else {
        auto made = ApiDriver::create({});
        if (!made) stop(made.error().message);
        driver = std::move(made).value();
    }
    Timing timing;
    const auto images = driver->render(scene, &timing);
    if (!images) stop(images.error().message);
    const Bytes& texels = images.value().at(0).texels;
    size_t differing = 0;
    for (size_t i = 0; i + 3 < own.size() && own.size() == texels.size(); i += 4)
        for (size_t c = 0; c < 3; ++c)
            if (std::abs(int{own[i + c]} - static_cast<int>(texels[i + c])) > 8) {
                ++differing;
                break;
            }
    if (own.size() != texels.size()) stop("the picture has another size");
    std::printf("%.3f %.5f %s\n", timing.frame, static_cast<double>(differing) * 4 / static_cast<double>(own.size()),
                driver->name().c_str());
    std::fflush(stdout);
    std::_Exit(0);
}

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace
}  // namespace vernier::bench

using vernier::bench::capture;
using vernier::bench::capturing;
using State = vernier::bench::Capture::State;

#define NEXT(name) static const auto real = vernier::bench::next<decltype(&name)>(#name)

// Making an object: noted when it was made.
#define MAKE(name, Desc, Handle, note)                                                 \
    extern "C" VN_API VnResult name(VnDevice device, const Desc* desc, Handle* made) { \
        NEXT(name);                                                                    \
        const VnResult result = real(device, desc, made);                              \
        if (capturing && result == VN_SUCCESS) capture.note(*made, *desc);             \
        return result;                                                                 \
    }
MAKE(vnCreateImage, VnImageDesc, VnImage, image)
MAKE(vnCreateView, VnViewDesc, VnView, view)
MAKE(vnCreateBuffer, VnBufferDesc, VnBuffer, buffer)
MAKE(vnCreateSampler, VnSamplerDesc, VnSampler, sampler)
MAKE(vnCreateShader, VnShaderDesc, VnShader, shader)
MAKE(vnCreateProgram, VnProgramDesc, VnProgram, program)
MAKE(vnCreateVertexLayout, VnVertexLayoutDesc, VnVertexLayout, layout)
MAKE(vnCreateRasterState, VnRasterStateDesc, VnRasterState, raster)
MAKE(vnCreateDepthStencilState, VnDepthStencilStateDesc, VnDepthStencilState, depthStencil)
MAKE(vnCreateBlendState, VnBlendStateDesc, VnBlendState, blend)

extern "C" VN_API VnResult vnGetImageView(VnDevice device, VnImage image, VnView* view) {
    NEXT(vnGetImageView);
    const VnResult result = real(device, image, view);
    if (capturing && result == VN_SUCCESS) {
        VnViewDesc whole{};
        whole.image = image;
        capture.view(*view, whole);
    }
    return result;
}

// Everything in a context: the effect at the end is had when the call has succeeded.
#define CALL(name, parameters, arguments, ...)             \
    extern "C" VN_API VnResult name parameters {           \
        NEXT(name);                                        \
        const VnResult result = real arguments;            \
        if (capturing && result == VN_SUCCESS) {           \
            [[maybe_unused]] State& state = capture.bound; \
            __VA_ARGS__;                                   \
        }                                                  \
        return result;                                     \
    }
CALL(vnBeginPass, (VnContext context, const VnPassDesc* desc), (context, desc), capture.beginPass(*desc))
CALL(vnEndPass, (VnContext context), (context), capture.endPass())
CALL(vnBindProgram, (VnContext context, VnProgram program), (context, program), state.program = program)
CALL(vnBindVertexLayout, (VnContext context, VnVertexLayout layout), (context, layout), state.layout = layout)
CALL(vnBindRasterState, (VnContext context, VnRasterState raster), (context, raster), state.raster = raster)
CALL(vnBindDepthStencilState, (VnContext context, VnDepthStencilState depth), (context, depth),
     state.depthStencil = depth)
CALL(vnBindBlendState, (VnContext context, VnBlendState blend), (context, blend), state.blend = blend)
CALL(vnBindVertexBuffer, (VnContext context, uint32_t binding, VnBuffer buffer, uint64_t offset),
     (context, binding, buffer, offset), state.vertexBuffers[binding] = {buffer, offset})
CALL(vnBindIndexBuffer, (VnContext context, VnBuffer buffer, uint64_t offset, VkIndexType type),
     (context, buffer, offset, type), state.indices = buffer;
     state.indexOffset = offset; state.indexType = type)
CALL(vnBindBuffer,
     (VnContext context, uint32_t set, uint32_t binding, uint32_t element, VnBuffer buffer, uint64_t offset,
      uint64_t size),
     (context, set, binding, element, buffer, offset, size),
     state.bindings[std::make_pair(set, binding)] = {{}, {}, buffer, offset, size})
CALL(vnBindTexture,
     (VnContext context, uint32_t set, uint32_t binding, uint32_t element, VnView view, VnSampler sampler),
     (context, set, binding, element, view, sampler),
     state.bindings[std::make_pair(set, binding)] = {view, sampler, {}, 0, 0})
CALL(vnPushConstants, (VnContext context, uint32_t offset, const void* data, uint32_t size),
     (context, offset, data, size), state.push.resize(std::max<size_t>(state.push.size(), offset + size));
     std::memcpy(&state.push[offset], data, size))
CALL(vnSetViewport, (VnContext context, const VkViewport* viewport), (context, viewport), state.viewport = *viewport)
CALL(vnSetScissor, (VnContext context, const VkRect2D* scissor), (context, scissor), state.scissor = *scissor)
CALL(vnSetTopology, (VnContext context, VkPrimitiveTopology topology, int restart), (context, topology, restart),
     state.topology = topology;
     state.restart = restart != 0)
CALL(vnSetPatchVertices, (VnContext context, uint32_t vertices), (context, vertices), state.patchVertices = vertices)
CALL(vnDraw, (VnContext context, uint32_t count, uint32_t instances, uint32_t first, uint32_t firstInstance),
     (context, count, instances, first, firstInstance), capture.draw(count, instances, first, 0, firstInstance, false))
CALL(vnDrawIndexed,
     (VnContext context, uint32_t count, uint32_t instances, uint32_t first, int32_t vertexOffset,
      uint32_t firstInstance),
     (context, count, instances, first, vertexOffset, firstInstance),
     capture.draw(count, instances, first, vertexOffset, firstInstance, true))
CALL(vnClearColor, (VnContext context, uint32_t attachment, const VkClearColorValue* value, const VkRect2D* rect),
     (context, attachment, value, rect), capture.cannot("clears inside a pass"))
CALL(vnClearDepthStencil,
     (VnContext context, VkImageAspectFlags aspects, float depth, uint32_t stencil, const VkRect2D* rect),
     (context, aspects, depth, stencil, rect), capture.cannot("clears inside a pass"))
CALL(vnDispatch, (VnContext context, uint32_t x, uint32_t y, uint32_t z), (context, x, y, z),
     capture.cannot("compute programs"))
CALL(vnGenerateMips, (VnContext context, VnImage image), (context, image), capture.generateMips(image))
CALL(vnCopyImage, (VnContext context, VnImage from, const VnRegion* fromRegion, VnImage to, const VnRegion* toRegion),
     (context, from, fromRegion, to, toRegion), capture.copyImage(from, fromRegion, to, toRegion))
CALL(vnBlitImage,
     (VnContext context, VnImage from, const VnRegion* fromRegion, VnImage to, const VnRegion* toRegion,
      VkFilter filter),
     (context, from, fromRegion, to, toRegion, filter), capture.blitImage(from, fromRegion, to, toRegion, filter))
CALL(vnUpdateBuffer, (VnContext context, VnBuffer buffer, uint64_t offset, const void* data, uint64_t size),
     (context, buffer, offset, data, size), capture.updateBuffer(buffer))
CALL(vnUpdateImage, (VnContext context, VnImage image, const VnRegion* region, const void* data, uint64_t size),
     (context, image, region, data, size), if (vernier::bench::pictures) capture.cannot("images that change"))

extern "C" VN_API VnResult vnReadImage(VnContext context, VnImage image, const VnRegion* region, void* data,
                                       uint64_t size) {
    NEXT(vnReadImage);
    const VnResult result = real(context, image, region, data, size);
    if (!capturing || result != VN_SUCCESS) return result;
    // A part of an image is no picture.
    if (region) {
        capture.cannot("images read within a frame");
        return result;
    }
    if (++vernier::bench::pictures == 1) {
        capture.startFrame();
        return result;
    }
    capturing = false;
    vernier::conformance::Scene scene;
    if (const std::string reason = capture.finish(context, image, scene); !reason.empty()) vernier::bench::stop(reason);
    const auto* own = static_cast<const uint8_t*>(data);
    vernier::bench::drawScene(scene, {own, own + size});
}
