#include "runtime/resource/sample_views.h"

#include <algorithm>

namespace vernier {

Result<std::unique_ptr<SampleViews::Made>> SampleViews::make(const ImageView& single, uint32_t samples,
                                                             const HostAllocator& allocator, Isa isa) {
    const VkExtent2D extent = single.extent();
    ImageInfo info;
    info.format = single.info().format;
    info.extent = {extent.width, extent.height, 1};
    info.arrayLayers = single.info().range.layerCount;
    info.samples = samples;
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    Result<Image> image = Image::create(info);
    if (!image) return image.error();
    auto made = std::make_unique<Made>(std::move(image).value());
    Result<std::unique_ptr<Memory>> memory = Memory::create(allocator, made->image.memorySize());
    if (!memory) return memory.error();
    made->memory = std::move(memory).value();
    made->image.bind(*made->memory, 0);
    ImageViewInfo seen;
    seen.type = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    seen.format = info.format;
    seen.range = {made->image.format().aspects, 0, 1, 0, info.arrayLayers};
    Result<ImageView> view = ImageView::create(made->image, seen, isa);
    if (!view) return view.error();
    made->view = std::move(view).value();
    return made;
}

Result<const ImageView*> SampleViews::find(const ImageView& single, uint32_t samples, const HostAllocator& allocator,
                                           Isa isa) {
    const std::lock_guard lock(mutex_);
    const auto found =
        std::ranges::find_if(made_, [&](const auto& made) { return made->image.info().samples == samples; });
    if (found != made_.end()) return &(*found)->view;
    Result<std::unique_ptr<Made>> made = make(single, samples, allocator, isa);
    if (!made) return made.error();
    made_.push_back(std::move(made).value());
    return &made_.back()->view;
}

}  // namespace vernier
