// Frames that only move texels: copies, blits, mip chains, clears and resolves.
#include <vector>

#include "bench/scenes/bench_scenes.h"
#include "bench/scenes/full_screen.h"
#include "conformance/scenes/shapes.h"

namespace vernier::bench::transfer {

using namespace conformance;

namespace {

constexpr VkExtent2D kLarge{2048, 2048}, kSmall{1024, 1024};
constexpr VkImageSubresourceLayers kColor{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

VkOffset3D corner(VkExtent2D extent) {
    return {static_cast<int32_t>(extent.width), static_cast<int32_t>(extent.height), 1};
}

/// A blit of a whole picture to the whole of a large target; `mirrored` from right to left.
Result<Scene> blit(const char* name, const char* description, VkExtent2D from, VkFormat format, VkFilter filter,
                   bool mirrored) {
    SceneRecorder record(name, description);
    const uint32_t source = record.texture("source", kRgba8, from, {noisePicture(from, 3)});
    const uint32_t target = record.colorTarget("color", format, kLarge);
    SceneBlitImage step{
        source, target, {kColor, {{0, 0, 0}, corner(from)}, kColor, {{0, 0, 0}, corner(kLarge)}}, filter};
    if (mirrored) std::swap(step.region.srcOffsets[0].x, step.region.srcOffsets[1].x);
    record.blit(step);
    record.output(target);
    return record.finish();
}

}  // namespace

Result<Scene> transfer_copy() {
    SceneRecorder record("transfer_copy", "A copy of 2048 x 2048 texels.");
    const uint32_t source = record.texture("source", kRgba8, kLarge, {noisePicture(kLarge, 3)});
    const uint32_t target = record.colorTarget("color", kRgba8, kLarge);
    record.copy({source, target, {kColor, {}, kColor, {}, {kLarge.width, kLarge.height, 1}}});
    record.output(target);
    return record.finish();
}

Result<Scene> transfer_nearest() {
    return blit("transfer_nearest", "1024 x 1024 texels to 2048 x 2048, nearest.", kSmall, kRgba8, VK_FILTER_NEAREST,
                false);
}

Result<Scene> transfer_linear() {
    return blit("transfer_linear", "1024 x 1024 texels to 2048 x 2048, linear.", kSmall, kRgba8, VK_FILTER_LINEAR,
                false);
}

Result<Scene> transfer_mirror() {
    return blit("transfer_mirror", "2048 x 2048 texels mirrored.", kLarge, kRgba8, VK_FILTER_NEAREST, true);
}

Result<Scene> transfer_convert() {
    return blit("transfer_convert", "2048 x 2048 texels of 8 bits to halves.", kLarge, VK_FORMAT_R16G16B16A16_SFLOAT,
                VK_FILTER_NEAREST, false);
}

Result<Scene> transfer_mips() {
    SceneRecorder record("transfer_mips", "All mip levels of 2048 x 2048 texels.");
    const uint32_t image = record.mipmappedTexture("mips", kRgba8, kLarge, noisePicture(kLarge, 3));
    record.output(image);
    return record.finish();
}

Result<Scene> transfer_clear() {
    SceneRecorder record("transfer_clear", "A pass over 2048 x 2048 pixels that only clears.");
    const uint32_t target = record.colorTarget("color", kRgba8, kLarge);
    record.pass(kLarge).color(target, {0.25f, 0.5f, 0.75f, 1});
    record.output(target);
    return record.finish();
}

Result<Scene> transfer_resolve() {
    SceneRecorder record("transfer_resolve", "Four samples of 1024 x 1024 pixels cleared and resolved.");
    const uint32_t many = record.colorTarget("samples", kRgba8, kSmall, VK_SAMPLE_COUNT_4_BIT);
    const uint32_t target = record.colorTarget("color", kRgba8, kSmall);
    record.pass(kSmall).color(many, {0.25f, 0.5f, 0.75f, 1}, target);
    record.output(target);
    return record.finish();
}

}  // namespace vernier::bench::transfer
