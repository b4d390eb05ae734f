// The buffers and images of an invocation as the reference interpreter asks for them. What is not there reads as zero.
#pragma once

#include "spirv_interp/reference/number_ops.h"
#include "spirv_interp/tool/invocation.h"

namespace vernier::tool {

template <class Number>
class InvocationResources final : public reference::Resources<Number> {
  public:
    using Request = reference::ImageRequest<Number>;
    using Texel = reference::Texel<Number>;

    explicit InvocationResources(Invocation& invocation) : invocation_(invocation) {}

    std::span<std::byte> buffer(reference::BufferKind kind, const reference::Descriptor& descriptor) override {
        if (kind == reference::BufferKind::pushConstants) return invocation_.pushConstants;
        const auto found = invocation_.buffers.find({descriptor.set, descriptor.binding});
        if (found == invocation_.buffers.end() || descriptor.arrayIndex > 0) return {};
        return found->second;
    }
    Texel sample(const Request& request) override {
        const Image* image = find(request.image);
        return image == nullptr ? Texel{} : texel(*image, tool::sample(*image, formOf(request.shape), place(request)));
    }
    Texel gather(const Request& request) override {
        const Image* image = find(request.image);
        if (image == nullptr) return {};
        const ImageForm form = formOf(request.shape);
        ImagePlace at = place(request);
        if (!request.gatherOffsets) return texel(*image, tool::gather(*image, form, at, request.component));
        // Texel (i0, j0) of four footprints, which a gather has last.
        Words4 words{};
        for (size_t k = 0; k < 4; ++k) {
            at.offset = {(*request.gatherOffsets)[k][0], (*request.gatherOffsets)[k][1], 0};
            words[k] = tool::gather(*image, form, at, request.component)[3];
        }
        return texel(*image, words);
    }
    Texel fetch(const Request& request) override {
        const Image* image = find(request.image);
        const Words4* words = wordsAt(request);
        return words == nullptr ? Texel{} : texel(*image, *words);
    }
    void write(const Request& request, const Texel& value) override {
        Words4* words = wordsAt(request);
        if (words == nullptr) return;
        for (size_t k = 0; k < 4; ++k) {
            (*words)[k] = request.shape.floating
                              ? std::bit_cast<uint32_t>(static_cast<float>(static_cast<double>(value[k].number)))
                              : static_cast<uint32_t>(value[k].bits);
        }
    }
    std::array<int32_t, 4> querySize(const reference::Descriptor& descriptor, const reference::ImageShape& shape,
                                     int32_t lod) override {
        const Image* image = find(descriptor);
        return image == nullptr || lod != 0 ? std::array<int32_t, 4>{} : tool::querySize(*image, formOf(shape));
    }
    int32_t queryLevels(const reference::Descriptor& descriptor, const reference::ImageShape&) override {
        return find(descriptor) == nullptr ? 0 : 1;
    }
    int32_t querySamples(const reference::Descriptor& descriptor, const reference::ImageShape&) override {
        return find(descriptor) == nullptr ? 0 : 1;
    }

  private:
    static ImageForm formOf(const reference::ImageShape& shape) {
        ImageForm form;
        form.dimensions = shape.dim == spv::Dim1D || shape.dim == spv::DimBuffer ? 1 : shape.dim == spv::Dim3D ? 3 : 2;
        form.cube = shape.dim == spv::DimCube;
        form.arrayed = shape.arrayed;
        form.subpass = shape.dim == spv::DimSubpassData;
        return form;
    }
    static ImagePlace place(const Request& request) {
        ImagePlace at;
        for (size_t k = 0; k < 4; ++k) at.coordinates[k] = static_cast<double>(request.coordinates[k]);
        at.offset = request.offset;
        if (request.dref) at.dref = static_cast<double>(*request.dref);
        return at;
    }
    static Texel texel(const Image& image, const Words4& words) {
        Texel result;
        for (size_t k = 0; k < 4; ++k) {
            result[k].bits = words[k];
            if (image.floating) result[k].number = Number(std::bit_cast<float>(words[k]));
        }
        return result;
    }
    Image* find(const reference::Descriptor& descriptor) {
        const auto found = invocation_.images.find({descriptor.set, descriptor.binding});
        return found == invocation_.images.end() || descriptor.arrayIndex > 0 ? nullptr : &found->second;
    }
    Words4* wordsAt(const Request& request) {
        Image* image = find(request.image);
        if (image == nullptr || request.texelLod != 0) return nullptr;
        std::array<int32_t, 4> at = request.texel;
        for (size_t k = 0; k < 3; ++k) at[k] = moved(at[k], request.offset[k]);
        return texelAt(*image, formOf(request.shape), at);
    }

    Invocation& invocation_;
};

}  // namespace vernier::tool
