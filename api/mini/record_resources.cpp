// Descriptor sets for what is bound, as a draw or dispatch needs them.
#include <algorithm>

#include "api/mini/context_guard.h"
#include "spirv_interp/needs_descriptor.h"

using namespace vernier;
using namespace vernier::mini;

namespace {

std::string elementText(uint32_t set, uint32_t binding, size_t element) {
    return "the program uses set " + std::to_string(set) + ", binding " + std::to_string(binding) + ", element " +
           std::to_string(element);
}

/// What a program's resource needs to find at its binding.
bool isBound(const BoundResource& bound, ir::ResourceKind kind) {
    switch (kind) {
        case ir::ResourceKind::uniformBuffer:
        case ir::ResourceKind::storageBuffer:
            return bound.buffer && !bound.texels;
        case ir::ResourceKind::uniformTexelBuffer:
        case ir::ResourceKind::storageTexelBuffer:
            return bound.texels != nullptr;
        case ir::ResourceKind::sampler:
            return bound.sampler != nullptr;
        case ir::ResourceKind::combinedImageSampler:
            return bound.view && bound.sampler;
        default:
            return bound.view != nullptr;
    }
}

VnResult checkBound(VnContext context, const char* function, const ir::Program& program) {
    for (const ir::Resource& resource : program.resources) {
        if (!needsDescriptor(resource)) continue;
        const auto found = context->resources.find({resource.set, resource.binding});
        const uint32_t needed = std::max(resource.arraySize, 1u);
        uint32_t bound = 0;
        if (found != context->resources.end())
            while (bound < std::min<size_t>(needed, found->second.size()) &&
                   isBound(found->second[bound], resource.kind))
                ++bound;
        if (bound < needed)
            return wrongState(
                context, function,
                elementText(resource.set, resource.binding, bound) + ", but nothing of its type is bound there");
    }
    return VN_SUCCESS;
}

/// What an image instruction takes, or a view is, in words.
std::string kindOf(ir::ImageDim dim, bool arrayed, bool multisampled) {
    constexpr const char* kNames[] = {"1D", "2D", "3D", "cube", "texel buffer"};
    return std::string(kNames[static_cast<size_t>(dim)]) + (arrayed ? " array" : "") +
           (multisampled ? " multisampled" : "");
}

bool isArrayed(const ImageView& view) {
    const VkImageViewType type = view.info().type;
    return type == VK_IMAGE_VIEW_TYPE_1D_ARRAY || type == VK_IMAGE_VIEW_TYPE_2D_ARRAY ||
           type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
}

std::string kindOf(const ImageView& view) {
    const VkImageViewType type = view.info().type;
    const auto dim = type == VK_IMAGE_VIEW_TYPE_1D || type == VK_IMAGE_VIEW_TYPE_1D_ARRAY       ? ir::ImageDim::d1
                     : type == VK_IMAGE_VIEW_TYPE_3D                                            ? ir::ImageDim::d3
                     : type == VK_IMAGE_VIEW_TYPE_CUBE || type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY ? ir::ImageDim::cube
                                                                                                : ir::ImageDim::d2;
    return kindOf(dim, isArrayed(view), view.image().info().samples > 1);
}

/// The views that image instructions reach must be of the dimension that the instructions were made for.
VnResult checkViews(VnContext context, const char* function, const ir::Program& program) {
    for (const ir::ImageOp& op : program.imageOps) {
        const ir::Resource& resource = program.resources[op.imageResource];
        const auto found = context->resources.find({resource.set, resource.binding});
        if (found == context->resources.end()) continue;
        for (size_t element = 0; element < found->second.size(); ++element) {
            const auto& view = found->second[element].view;
            if (!view || element >= std::max(resource.arraySize, 1u)) continue;
            // An input attachment is a 2D image, of one layer or more.
            const bool attachment = op.dim == ir::ImageDim::subpass;
            const std::string wanted = kindOf(attachment ? ir::ImageDim::d2 : op.dim,
                                              attachment ? isArrayed(view->view) : op.arrayed, op.multisampled);
            if (const std::string given = kindOf(view->view); given != wanted)
                return wrongState(context, function,
                                  elementText(resource.set, resource.binding, element) + " as a " + wanted +
                                      " image, but a " + given + " view is bound there");
        }
    }
    return VN_SUCCESS;
}

DescriptorSetLayout layoutOf(const VnContext_T& context, uint32_t set) {
    std::vector<DescriptorBinding> bindings;
    for (const auto& [place, elements] : context.resources) {
        if (place.first != set) continue;
        DescriptorBinding binding;
        binding.binding = place.second;
        binding.count = static_cast<uint32_t>(elements.size());
        bindings.push_back(std::move(binding));
    }
    return DescriptorSetLayout::create(std::move(bindings));
}

/// A descriptor set with everything bound in `set`; the recording keeps it and what it names.
const DescriptorSet* snapshot(VnContext context, uint32_t set) {
    const auto made = std::make_shared<SnapshotSet>(layoutOf(*context, set));
    context->recording->keep(made);
    for (const auto& [place, elements] : context->resources) {
        if (place.first != set) continue;
        const uint32_t first = made->layout.find(place.second)->firstSlot;
        for (uint32_t i = 0; i < elements.size(); ++i) {
            const BoundResource& bound = elements[i];
            for (const std::shared_ptr<const void>& object :
                 {std::shared_ptr<const void>(bound.buffer), std::shared_ptr<const void>(bound.texels),
                  std::shared_ptr<const void>(bound.view), std::shared_ptr<const void>(bound.sampler)})
                if (object) context->recording->alive.push_back(object);
            if (bound.texels)
                made->set.writeTexelBuffer(first + i, &bound.texels->texture(), context->device->runtime->isa());
            else if (bound.buffer)
                made->set.writeBuffer(first + i, &bound.buffer->buffer, bound.offset,
                                      bound.size ? bound.size : VK_WHOLE_SIZE);
            // The pair was checked when it was bound: this cannot fail.
            if (bound.view || bound.sampler)
                static_cast<void>(made->set.writeImage(first + i, bound.view ? &bound.view->view.texture() : nullptr,
                                                       bound.sampler ? &bound.sampler->state : nullptr,
                                                       context->device->runtime->isa()));
        }
    }
    return &made->set;
}

}  // namespace

VnResult vernier::mini::recordResources(VnContext context, const char* function, command::BindPoint bindPoint,
                                        std::span<const ir::Program* const> programs) {
    uint32_t usedSets = 0;
    for (const ir::Program* program : programs) {
        if (!program) continue;
        if (VnResult result = checkBound(context, function, *program)) return result;
        if (VnResult result = checkViews(context, function, *program)) return result;
        for (const ir::Resource& resource : program->resources)
            if (needsDescriptor(resource)) usedSets |= 1u << resource.set;
    }
    CommandBuffer& commands = context->recording->commands;
    for (uint32_t set = 0; set < kMaxDescriptorSets; ++set) {
        if (!(usedSets >> set & 1u)) continue;
        const DescriptorSet* made = snapshot(context, set);
        commands.record(command::BindDescriptorSets{
            bindPoint, set, commands.copy(std::span<const DescriptorSet* const>(&made, 1)), {}});
    }
    return VN_SUCCESS;
}
