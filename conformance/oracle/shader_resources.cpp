#include "conformance/oracle/shader_resources.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

namespace vernier::conformance::exact {

namespace {

/// Whether a shader's image type can be bound to such an image.
bool fits(spv::Dim dim, ImageKind kind) {
    switch (kind) {
        case ImageKind::volume:
            return dim == spv::Dim3D;
        case ImageKind::cube:
            return dim == spv::DimCube;
        default:
            return dim == spv::Dim2D || dim == spv::Dim1D;
    }
}

}  // namespace

ShaderResources::ShaderResources(const Scene& scene, const Memory& memory, const SceneDraw& draw,
                                 const OracleRules& rules)
    : scene_(scene), memory_(memory), draw_(draw), rules_(rules), pushConstants_(draw.pushConstants) {
    for (const SceneBinding& binding : draw.bindings) {
        Bound bound;
        const bool texels = binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER ||
                            binding.type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
        if (texels && binding.buffer < scene.buffers.size())
            texelBuffers_.emplace(&binding, TexelBuffer::of(binding, scene.buffers[binding.buffer].data));
        if (!texels && binding.buffer < scene.buffers.size()) {
            const auto stored = memory.buffers.find(binding.buffer);
            const bool isStored = stored != memory.buffers.end();
            const Bytes& data = isStored ? stored->second.bytes : scene.buffers[binding.buffer].data;
            if (isStored) bound.stored = &stored->second;
            if (isStored && binding.type != VK_DESCRIPTOR_TYPE_STORAGE_BUFFER && !stored->second.open.empty())
                refusal = "a uniform buffer that shaders have stored to";
            const size_t begin = std::min<size_t>(binding.offset, data.size());
            const size_t length = std::min<size_t>(binding.range, data.size() - begin);
            bound.bytes.assign(data.begin() + static_cast<ptrdiff_t>(begin),
                               data.begin() + static_cast<ptrdiff_t>(begin + length));
        }
        if (texels && memory.buffers.contains(binding.buffer))
            refusal = "texels of a buffer that shaders have stored words to";
        buffers_.push_back(std::move(bound));
    }
}

SampleQuery ShaderResources::queryOf(const reference::ImageRequest<double>& r) const {
    SampleQuery q;
    q.s = r.coordinates[0];
    q.t = r.shape.dim == spv::Dim1D ? 0.5 : r.coordinates[1];
    const bool three = r.shape.dim == spv::Dim3D || r.shape.dim == spv::DimCube;
    if (three) q.r = r.coordinates[2];
    if (r.shape.arrayed) q.layer = r.coordinates[r.shape.dim == spv::Dim1D ? 1 : three ? 3 : 2];
    for (size_t i = 0; i < 3; ++i) {
        q.ddx[i] = r.ddx[i];
        q.ddy[i] = r.ddy[i];
        q.offset[i] = r.offset[i];
    }
    if (r.lodMode == reference::LodMode::explicitLod) q.lod = r.lod;
    q.bias = r.bias;
    if (r.minLod) q.minLod = *r.minLod;
    q.dref = r.dref;
    q.weightSlack = std::ldexp(1.0, -rules_.weightBits);
    q.levelSlack = rules_.levelSlack;
    return q;
}

const SceneBinding* ShaderResources::find(const reference::Descriptor& descriptor) const {
    const auto found = std::ranges::find_if(draw_.bindings, [&](const SceneBinding& b) {
        return b.set == descriptor.set && b.binding == descriptor.binding;
    });
    return found == draw_.bindings.end() || descriptor.arrayIndex != 0 ? nullptr : &*found;
}

const ImageStore* ShaderResources::imageOf(const reference::Descriptor& descriptor) const {
    const SceneBinding* binding = find(descriptor);
    return binding && binding->image < memory_.images.size() ? &memory_.images[binding->image] : nullptr;
}

const SceneSampler* ShaderResources::samplerOf(const reference::Descriptor& descriptor) const {
    const SceneBinding* binding = find(descriptor);
    return binding && binding->sampler < scene_.samplers.size() ? &scene_.samplers[binding->sampler] : nullptr;
}

std::span<std::byte> ShaderResources::buffer(reference::BufferKind kind, const reference::Descriptor& descriptor) {
    if (kind == reference::BufferKind::pushConstants) return pushConstants_;
    const SceneBinding* binding = find(descriptor);
    if (!binding) return {};
    return buffers_[static_cast<size_t>(binding - draw_.bindings.data())].bytes;
}

void ShaderResources::resetRuns() {
    runs.clear();
    wordRuns.clear();
}

void ShaderResources::startRun() {
    runs.emplace_back();
    wordRuns.emplace_back();
    // Backwards: of a word that has changed twice the oldest value is the last one put back.
    for (auto change = changed_.rbegin(); change != changed_.rend(); ++change)
        std::memcpy(change->first, &change->second, sizeof change->second);
    changed_.clear();
    if (shown_ == end) return;
    shown_ = end;
    for (size_t i = 0; i < buffers_.size(); ++i) {
        Bound& bound = buffers_[i];
        if (bound.stored == nullptr) continue;
        const uint64_t first = draw_.bindings[i].offset;
        for (const auto& [offset, word] : bound.stored->open) {
            if (offset < first || offset - first + 4 > bound.bytes.size()) continue;
            const uint32_t bits = wordOf(word.kind, atEnd(word.value));
            std::memcpy(bound.bytes.data() + (offset - first), &bits, sizeof bits);
        }
    }
}

std::optional<ShaderResources::Word> ShaderResources::wordAt(const reference::BufferAccess& access) {
    const SceneBinding* binding = find(access.buffer);
    if (binding == nullptr) return std::nullopt;
    Bound& bound = buffers_[static_cast<size_t>(binding - draw_.bindings.data())];
    if (access.offset > bound.bytes.size() || bound.bytes.size() - access.offset < access.bytes) return std::nullopt;
    return Word{bound, binding->buffer, binding->offset + access.offset};
}

void ShaderResources::loaded(const reference::BufferAccess& access) {
    const auto word = wordAt(access);
    if (!word) return;
    const auto own = [&](const RunWord& w) {
        return w.invocation == access.invocation && w.buffer == word->buffer && w.offset == word->offset;
    };
    if (!wordRuns.empty() && std::ranges::any_of(wordRuns.back(), own)) return;
    for (uint64_t at = word->offset / 4; at <= (word->offset + access.bytes - 1) / 4; ++at)
        loadedWords.insert({word->buffer, at * 4});
    if (word->bound.stored == nullptr) return;
    const auto& open = word->bound.stored->open;
    const auto found = open.upper_bound(word->offset + access.bytes - 1);
    if (found == open.begin() || std::prev(found)->first + 4 <= word->offset) return;
    const auto& [offset, value] = *std::prev(found);
    if (offset != word->offset || access.bytes != 4 || access.floating != (value.kind == WordKind::floating)) {
        refusal = "an open word of a buffer that is read in parts or as another type";
        return;
    }
    sawRange = sawRange || !value.value.isExact();
    sawZero = sawZero || (value.value.low < 0 && value.value.high > 0);
    flags |= value.flags;
}

void ShaderResources::note(const reference::BufferAccess& access, spv::Op op, const reference::Scalar<double>& value) {
    const auto word = wordAt(access);
    if (!word) return;
    if (access.bytes != 4 || word->offset % 4 != 0 || wordRuns.empty()) {
        refusal = "stores to buffers of other sizes than 32 bits";
        return;
    }
    const WordKind kind = access.floating   ? WordKind::floating
                          : access.isSigned ? WordKind::signedInteger
                                            : WordKind::unsignedInteger;
    const double number = access.floating ? value.number : numberOf(kind, static_cast<uint32_t>(value.bits));
    wordRuns.back().push_back({word->buffer, word->offset, kind, op, access.invocation, number});
    std::byte* const bytes = word->bound.bytes.data() + access.offset;
    uint32_t before = 0;
    std::memcpy(&before, bytes, sizeof before);
    changed_.emplace_back(bytes, before);
}

void ShaderResources::stored(const reference::BufferAccess& access, const reference::Scalar<double>& value) {
    note(access, spv::OpStore, value);
}

void ShaderResources::combined(const reference::BufferAccess& access, spv::Op op,
                               const reference::Scalar<double>& value) {
    note(access, op, value);
}

double ShaderResources::atEnd(const Interval& v) const {
    return end == RangeEnd::nominal ? v.value
           : end == RangeEnd::low   ? v.low
           : end == RangeEnd::high  ? v.high
                                    : std::clamp(0.0, v.low, v.high);
}

reference::Texel<double> ShaderResources::deliver(const SampleResult& result, const reference::ImageShape& shape) {
    flags |= result.flags;
    reference::Texel<double> texel;
    for (size_t c = 0; c < 4; ++c) {
        const Interval& v = result.color[c];
        sawRange = sawRange || !v.isExact();
        sawZero = sawZero || (v.low < 0 && v.high > 0);
        const double number = atEnd(v);
        texel[c] = shape.floating
                       ? reference::Scalar<double>::ofNumber(number)
                       : reference::Scalar<double>::ofBits(static_cast<uint32_t>(static_cast<int64_t>(number)));
    }
    return texel;
}

reference::Texel<double> ShaderResources::sample(const reference::ImageRequest<double>& request) {
    const ImageStore* image = imageOf(request.image);
    const SceneSampler* sampler = samplerOf(request.sampler);
    if (!image || !sampler || !fits(request.shape.dim, image->kind())) {
        flags |= kOracleUnknown;
        return {};
    }
    return deliver(sampleImage(*image, *sampler, queryOf(request)), request.shape);
}

reference::Texel<double> ShaderResources::gather(const reference::ImageRequest<double>& request) {
    const ImageStore* image = imageOf(request.image);
    const SceneSampler* sampler = samplerOf(request.sampler);
    if (!image || !sampler || request.shape.dim != spv::Dim2D || request.gatherOffsets) {
        flags |= kOracleUnknown;
        return {};
    }
    return deliver(gatherImage(*image, *sampler, queryOf(request), request.component), request.shape);
}

SampleResult ShaderResources::fetchTexelBuffer(const SceneBinding& binding, int64_t at) const {
    const auto written = memory_.texelBuffers.find(binding.buffer);
    const bool isWritten = written != memory_.texelBuffers.end();
    const TexelBuffer& buffer = isWritten ? written->second : texelBuffers_.at(&binding);
    SampleResult unknown;
    unknown.flags = kOracleUnknown;
    if (buffer.format == nullptr || !buffer.isSeenBy(binding)) return unknown;
    if (at < 0 || at >= static_cast<int64_t>(buffer.texels.size())) return {};
    const StoredTexel& texel = buffer.texels[static_cast<size_t>(at)];
    return {texel.channels, texel.flags};
}

void ShaderResources::write(const reference::ImageRequest<double>& request, const reference::Texel<double>& value) {
    const SceneBinding* binding = find(request.image);
    if (runs.empty() || binding == nullptr) {
        refusal = "texels that vertex shaders store";
        return;
    }
    // One coordinate of buffers, two or three of images; a 1D array's layer is its second.
    std::array<int32_t, 3> at{request.texel[0], request.texel[1], request.texel[2]};
    if (request.shape.dim == spv::Dim1D) at = {at[0], 0, request.shape.arrayed ? at[1] : 0};
    if (request.shape.dim == spv::Dim2D && !request.shape.arrayed) at[2] = 0;
    runs.back().push_back({binding, request.invocation, at, value});
}

reference::Texel<double> ShaderResources::fetch(const reference::ImageRequest<double>& request) {
    const SceneBinding* binding = find(request.image);
    if (binding != nullptr && request.shape.storage && std::ranges::find(loads, binding) == loads.end())
        loads.push_back(binding);
    if (binding != nullptr && request.shape.dim == spv::DimBuffer)
        return deliver(fetchTexelBuffer(*binding, request.texel[0]), request.shape);
    const ImageStore* image = imageOf(request.image);
    if (image && request.shape.storage && request.shape.dim == spv::DimCube && image->kind() == ImageKind::cube) {
        // Vulkan, Texel Coordinate Systems: faces and layers are one coordinate.
        return deliver(fetchImage(*image, request.texel[0], request.texel[1], request.texel[2], 0, 0), request.shape);
    }
    if (!image || request.shape.dim == spv::DimCube || !fits(request.shape.dim, image->kind())) {
        flags |= kOracleUnknown;
        return {};
    }
    if (image->kind() == ImageKind::volume) {
        return deliver(fetchImage(*image, int64_t{request.texel[0]} + request.offset[0],
                                  int64_t{request.texel[1]} + request.offset[1],
                                  int64_t{request.texel[2]} + request.offset[2], request.texelLod, 0),
                       request.shape);
    }
    const bool oneDimensional = request.shape.dim == spv::Dim1D;
    const int64_t y = oneDimensional ? 0 : int64_t{request.texel[1]} + request.offset[1];
    const int64_t layer = request.shape.arrayed ? request.texel[oneDimensional ? 1 : 2] : 0;
    return deliver(fetchImage(*image, int64_t{request.texel[0]} + request.offset[0], y, layer, request.texelLod,
                              static_cast<uint32_t>(request.sample)),
                   request.shape);
}

std::array<int32_t, 4> ShaderResources::querySize(const reference::Descriptor& descriptor,
                                                  const reference::ImageShape& shape, int32_t lod) {
    const SceneBinding* binding = find(descriptor);
    if (binding != nullptr && shape.dim == spv::DimBuffer)
        return {static_cast<int32_t>(texelBuffers_.at(binding).texels.size())};
    const ImageStore* image = imageOf(descriptor);
    if (!image || lod < 0 || static_cast<uint32_t>(lod) >= image->mipLevels()) return {};
    const VkExtent2D extent = image->level(static_cast<uint32_t>(lod), 0).extent;
    const auto mip = static_cast<uint32_t>(lod);
    const auto layers = static_cast<int32_t>(image->kind() == ImageKind::volume ? image->depth(mip)
                                             : image->kind() == ImageKind::cube ? image->arrayLayers() / 6
                                                                                : image->arrayLayers());
    if (shape.dim == spv::Dim1D) return {static_cast<int32_t>(extent.width), layers};
    return {static_cast<int32_t>(extent.width), static_cast<int32_t>(extent.height), layers};
}

int32_t ShaderResources::queryLevels(const reference::Descriptor& descriptor, const reference::ImageShape&) {
    const ImageStore* image = imageOf(descriptor);
    return image ? static_cast<int32_t>(image->mipLevels()) : 0;
}

std::array<double, 2> ShaderResources::queryLod(const reference::ImageRequest<double>& request) {
    const ImageStore* image = imageOf(request.image);
    const SceneSampler* sampler = samplerOf(request.sampler);
    if (!image || !sampler || !fits(request.shape.dim, image->kind())) {
        flags |= kOracleUnknown;
        return {};
    }
    const std::optional<Interval> queried = queriedLevel(*image, *sampler, queryOf(request));
    if (!queried) {
        flags |= kOracleUndefined;
        return {};
    }
    const Interval& lambda = *queried;
    sawRange = sawRange || !lambda.isExact();
    const double at = end == RangeEnd::nominal ? lambda.value : end == RangeEnd::low ? lambda.low : lambda.high;
    const double last = image->mipLevels() - 1;
    const double clamped =
        std::clamp(std::clamp<double>(at, sampler->minLod, std::max(sampler->minLod, sampler->maxLod)), 0.0, last);
    const bool nearest = sampler->mipmapMode == VK_SAMPLER_MIPMAP_MODE_NEAREST;
    return {nearest ? std::clamp(std::ceil(clamped + 0.5) - 1, 0.0, last) : clamped, at};
}

}  // namespace vernier::conformance::exact
