#include "spirv_interp/tool/bindings.h"

#include <algorithm>
#include <bit>

#include "spirv_interp/atomic.h"

namespace vernier::tool {
namespace {

using ir::ImageDim;
using ir::ImageKind;

ImageForm formOf(const ir::ImageOp& op) {
    ImageForm form;
    form.dimensions = op.dim == ImageDim::d1 || op.dim == ImageDim::buffer ? 1 : op.dim == ImageDim::d3 ? 3 : 2;
    form.cube = op.dim == ImageDim::cube;
    form.arrayed = op.arrayed;
    form.subpass = op.dim == ImageDim::subpass;
    return form;
}

/// The operands of one lane of an image instruction.
class LaneOf {
  public:
    LaneOf(const ImageCall& call, uint32_t lane) : call_(call), lane_(lane) {}

    ImagePlace place() const {
        ImagePlace place;
        for (size_t k = 0; k < 4; ++k) place.coordinates[k] = floating(call_.coord[k]);
        for (size_t k = 0; k < 3; ++k) place.offset[k] = integer(call_.offset[k]);
        if (call_.dref != nullptr) place.dref = floating(call_.dref);
        return place;
    }
    std::array<int32_t, 4> texel() const {
        std::array<int32_t, 4> texel{};
        for (size_t k = 0; k < 4; ++k) texel[k] = integer(call_.coord[k]);
        for (size_t k = 0; k < 3; ++k) texel[k] = moved(texel[k], integer(call_.offset[k]));
        return texel;
    }
    /// The texel's own level; others are not there.
    bool onFirstLevel() const { return integer(call_.lodOrBias) == 0; }
    Words4 value() const {
        Words4 value{};
        for (size_t k = 0; k < 4; ++k) value[k] = static_cast<uint32_t>(integer(call_.texel[k]));
        return value;
    }

  private:
    double floating(const uint32_t* row) const {
        return row == nullptr ? 0 : static_cast<double>(std::bit_cast<float>(row[lane_]));
    }
    int32_t integer(const uint32_t* row) const { return row == nullptr ? 0 : static_cast<int32_t>(row[lane_]); }

    const ImageCall& call_;
    uint32_t lane_;
};

Words4 runLane(Image& image, const ImageCall& call, uint32_t lane) {
    const ir::ImageOp& op = *call.op;
    const ImageForm form = formOf(op);
    const LaneOf operands(call, lane);
    switch (op.kind) {
        case ImageKind::sampleImplicit:
        case ImageKind::sampleLod:
        case ImageKind::sampleGrad:
            return sample(image, form, operands.place());
        case ImageKind::gather:
            return gather(image, form, operands.place(), op.component);
        case ImageKind::querySize: {
            const std::array<int32_t, 4> size =
                operands.onFirstLevel() ? querySize(image, form) : std::array<int32_t, 4>{};
            return std::bit_cast<Words4>(size);
        }
        case ImageKind::queryLevels:
        case ImageKind::querySamples:
            return {1, 0, 0, 0};
        case ImageKind::queryLod:
            return {};
        default:
            break;
    }
    Words4* texel =
        op.kind != ImageKind::fetch || operands.onFirstLevel() ? texelAt(image, form, operands.texel()) : nullptr;
    if (texel == nullptr) return {};
    const Words4 old = *texel, value = operands.value();
    if (op.kind == ImageKind::store) *texel = value;
    // The formats that have atomics have one component.
    if (op.kind == ImageKind::atomic) *texel = {atomicCombined(op.atomicOp, old[0], value[0], value[1]), 0, 0, 0};
    return old;
}

void runImage(const ImageBinding& binding, const ImageCall& call) {
    // The invocation's images are its own to write to.
    Image& image = *static_cast<Image*>(const_cast<void*>(binding.image));
    for (uint32_t lane = 0; lane < call.lanes; ++lane) {
        if (call.mask != nullptr && call.mask[lane] == 0) continue;
        const Words4 result = runLane(image, call, lane);
        for (size_t k = 0; k < 4; ++k)
            if (call.result[k] != nullptr) call.result[k][lane] = result[k];
    }
}

}  // namespace

Bindings::Bindings(const ir::Program& program, Invocation& invocation) {
    for (const ir::Resource& r : program.resources) {
        const bool isBuffer = r.kind == ir::ResourceKind::pushConstants || r.kind == ir::ResourceKind::uniformBuffer ||
                              r.kind == ir::ResourceKind::storageBuffer;
        const bool isSampler = r.kind == ir::ResourceKind::sampler;
        const uint32_t descriptors = r.kind == ir::ResourceKind::workgroupMemory ? 0 : std::max(1u, r.arraySize);
        count_.push_back(descriptors);
        base_.push_back(static_cast<uint32_t>(isBuffer    ? buffers_.size()
                                              : isSampler ? samplers_.size()
                                                          : images_.size()));
        const auto image = invocation.images.find({r.set, r.binding});
        // The command line tells the first descriptor of an array.
        for (uint32_t k = 0; k < descriptors; ++k) {
            if (isBuffer) {
                buffers_.push_back(k == 0 ? bufferOf(r, invocation) : BufferBinding{});
            } else if (isSampler) {
                samplers_.push_back(nullptr);
            } else {
                images_.push_back(k > 0 || image == invocation.images.end()
                                      ? ImageBinding{}
                                      : ImageBinding{&image->second, nullptr, runImage});
            }
        }
    }
}

BufferBinding Bindings::bufferOf(const ir::Resource& resource, Invocation& invocation) const {
    std::vector<std::byte>* bytes = nullptr;
    if (resource.kind == ir::ResourceKind::pushConstants) {
        bytes = &invocation.pushConstants;
    } else if (const auto found = invocation.buffers.find({resource.set, resource.binding});
               found != invocation.buffers.end()) {
        bytes = &found->second;
    }
    return bytes == nullptr ? BufferBinding{} : BufferBinding{bytes->data(), static_cast<uint32_t>(bytes->size())};
}

ResourceBindings Bindings::get() const {
    ResourceBindings bindings;
    bindings.buffers = buffers_.data();
    bindings.images = images_.data();
    bindings.samplers = samplers_.data();
    bindings.base = base_.data();
    bindings.count = count_.data();
    bindings.combine = [](const ImageBinding& image, const void*) { return image; };
    return bindings;
}

}  // namespace vernier::tool
