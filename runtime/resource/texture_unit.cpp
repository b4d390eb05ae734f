#include "runtime/resource/texture_unit.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "runtime/texture/ycbcr.h"
#include "spirv_interp/atomic.h"

namespace vernier {
namespace {

const float* asFloat(const uint32_t* lanes) {
    return reinterpret_cast<const float*>(lanes);
}
const int32_t* asInt(const uint32_t* lanes) {
    return reinterpret_cast<const int32_t*>(lanes);
}
float* asFloat(uint32_t* lanes) {
    return reinterpret_cast<float*>(lanes);
}

void fill(uint32_t* lanes, uint32_t count, uint32_t value) {
    if (lanes) std::fill_n(lanes, count, value);
}

/// Puts the array layer, which SPIR-V passes last, into the fourth place. spatial = coordinates without the layer.
template <class Target, class Convert>
void placeCoordinates(const ImageCall& call, Target (&coord)[4], Convert convert) {
    const uint32_t spatial = call.op->coords - (call.op->arrayed ? 1u : 0u);
    for (uint32_t i = 0; i < std::min(spatial, 3u); ++i) coord[i] = convert(call.coord[i]);
    if (call.op->arrayed) coord[3] = convert(call.coord[spatial]);
}

/// Likewise of the instructions that name texels: the face of a cube is a layer.
void placeTexel(const ImageCall& call, const int32_t* (&coord)[4]) {
    placeCoordinates(call, coord, [](const uint32_t* lanes) { return asInt(lanes); });
    if (call.op->dim == ir::ImageDim::cube && !call.op->arrayed) coord[3] = asInt(call.coord[2]);
}

using TexelOffset = std::array<int32_t, 3>;

TexelOffset offsetOf(const ImageCall& call, uint32_t lane) {
    TexelOffset result{};
    for (size_t i = 0; i < 3; ++i)
        if (call.offset[i]) result[i] = asInt(call.offset[i])[lane];
    return result;
}

/// The texel offset of all lanes, if they have the same one.
std::optional<TexelOffset> commonOffset(const ImageCall& call) {
    uint32_t differences = 0;
    for (const uint32_t* offsets : call.offset) {
        if (!offsets) continue;
        for (uint32_t lane = 1; lane < call.lanes; ++lane) differences |= offsets[lane] ^ offsets[0];
    }
    return differences == 0 ? std::optional(offsetOf(call, 0)) : std::nullopt;
}

/// Calls run(mask, offset) once for every texel offset that occurs among the active lanes.
template <class Run>
void forEachOffset(const ImageCall& call, Run run) {
    std::array<uint32_t, kMaxSampleLanes> pending{}, group{};
    for (uint32_t lane = 0; lane < call.lanes; ++lane) pending[lane] = call.mask ? call.mask[lane] : ~0u;
    for (uint32_t first = 0; first < call.lanes; ++first) {
        if (!pending[first]) continue;
        const TexelOffset offset = offsetOf(call, first);
        for (uint32_t lane = 0; lane < call.lanes; ++lane) {
            group[lane] = pending[lane] && offsetOf(call, lane) == offset ? ~0u : 0u;
            if (group[lane]) pending[lane] = 0;
        }
        run(group.data(), offset);
    }
}

/// A routine may write lanes outside its mask: the results of each group of lanes go to a copy first.
void sampleWithOffsets(const TextureUnit& unit, SampleFn routine, const ImageCall& call, SampleRequest request) {
    std::array<std::array<float, kMaxSampleLanes>, 4> scratch;
    for (size_t i = 0; i < 4; ++i) request.out[i] = call.result[i] ? scratch[i].data() : nullptr;
    forEachOffset(call, [&](const uint32_t* mask, const TexelOffset& offset) {
        request.mask = mask;
        std::copy(offset.begin(), offset.end(), request.offset);
        routine(*unit.view, *unit.sampler, request);
        for (size_t i = 0; i < 4; ++i)
            for (uint32_t lane = 0; call.result[i] && lane < call.lanes; ++lane)
                if (mask[lane]) call.result[i][lane] = std::bit_cast<uint32_t>(scratch[i][lane]);
    });
}

/// Coordinates that the view has and the instruction does not know of are left out: 0.
void runSample(const TextureUnit& unit, SampleFn routine, const ImageCall& call, LodMode mode) {
    SampleRequest request;
    request.lanes = call.lanes;
    request.mask = call.mask;
    placeCoordinates(call, request.coord, [](const uint32_t* lanes) { return asFloat(lanes); });
    request.dref = asFloat(call.dref);
    request.lodMode = mode;
    request.lod = asFloat(call.lodOrBias);
    request.minLod = asFloat(call.minLod);
    if (mode == LodMode::gradients) {
        for (size_t i = 0; i < 3; ++i) {
            request.gradX[i] = asFloat(call.ddx[i]);
            request.gradY[i] = asFloat(call.ddy[i]);
        }
    }
    if (call.op->kind == ir::ImageKind::gather) request.component = call.op->component;
    if (call.offset[0]) {
        const std::optional<TexelOffset> offset = commonOffset(call);
        if (!offset) return sampleWithOffsets(unit, routine, call, request);
        std::copy(offset->begin(), offset->end(), request.offset);
    }
    for (size_t i = 0; i < 4; ++i) request.out[i] = asFloat(call.result[i]);
    routine(*unit.view, *unit.sampler, request);
}

void runFetch(const TextureUnit& unit, const ImageCall& call) {
    FetchRequest request;
    request.lanes = call.lanes;
    request.mask = call.mask;
    placeTexel(call, request.coord);
    request.lod = asInt(call.lodOrBias);
    request.sample = asInt(call.sample);
    for (size_t i = 0; i < 4; ++i) request.out[i] = asFloat(call.result[i]);
    if (!call.offset[0]) return unit.fetch(*unit.view, request);
    forEachOffset(call, [&](const uint32_t* mask, const TexelOffset& offset) {
        request.mask = mask;
        std::copy(offset.begin(), offset.end(), request.offset);
        unit.fetch(*unit.view, request);
    });
}

/// Components in the order of the coordinates of the instruction: sizes of the dimensions, then layers (or cubes).
void runQuerySize(const TextureUnit& unit, const ImageCall& call) {
    uint32_t level = call.lodOrBias ? call.lodOrBias[0] : 0;
    std::array<uint32_t, 4> size = querySize(*unit.view, level);
    for (uint32_t lane = 0; lane < call.lanes; ++lane) {
        if (call.lodOrBias && call.lodOrBias[lane] != level) {
            level = call.lodOrBias[lane];
            size = querySize(*unit.view, level);
        }
        for (size_t i = 0; i < 4; ++i)
            if (call.result[i]) call.result[i][lane] = size[i];
    }
}

/// The address of the texel a lane of a storage-image instruction names; nullptr outside the image.
std::byte* storageTexel(const TextureView& view, const ImageCall& call, uint32_t lane) {
    const int32_t* coord[4] = {};
    placeTexel(call, coord);
    const auto at = [&](size_t i) { return coord[i] ? static_cast<uint32_t>(coord[i][lane]) : 0u; };
    if (view.block != nullptr) return nullptr;  // blocks are read, never written
    const TextureLevel& level = view.levels[0];
    const uint32_t slice = call.op->dim == ir::ImageDim::d3 ? at(2) : at(3);
    const uint32_t slices = view.type == VK_IMAGE_VIEW_TYPE_3D ? level.depth : view.layerCount;
    if (at(0) >= level.width || at(1) >= level.height || slice >= slices) return nullptr;
    // Storage images are writable memory of the device; views keep read-only pointers for all the others.
    return const_cast<std::byte*>(level.data) + slice * level.slicePitch + uint64_t{at(1)} * level.rowPitch +
           uint64_t{at(0)} * view.texelPitch;
}

void runStore(const TextureUnit& unit, const ImageCall& call) {
    for (uint32_t lane = 0; lane < call.lanes; ++lane) {
        if (call.mask && !call.mask[lane]) continue;
        std::byte* texel = storageTexel(*unit.view, call, lane);
        if (!texel) continue;
        VkClearColorValue value{};
        for (size_t i = 0; i < 4; ++i) value.uint32[i] = call.texel[i] ? call.texel[i][lane] : 0;
        packTexel(unit.view->ops.layout, value, texel);
    }
}

void runAtomic(const TextureUnit& unit, const ImageCall& call) {
    for (uint32_t lane = 0; lane < call.lanes; ++lane) {
        if (call.mask && !call.mask[lane]) continue;
        std::byte* texel = unit.view->texelPitch == 4 ? storageTexel(*unit.view, call, lane) : nullptr;
        uint32_t old = 0;
        if (texel) {
            old = atomicApply(call.op->atomicOp, reinterpret_cast<uint32_t*>(texel),
                              call.texel[0] ? call.texel[0][lane] : 0, call.texel[1] ? call.texel[1][lane] : 0);
        }
        if (call.result[0]) call.result[0][lane] = old;
    }
}

void runUnit(const TextureUnit& unit, const ImageCall& call) {
    using Kind = ir::ImageKind;
    const bool needsSampler = call.op->kind == Kind::sampleImplicit || call.op->kind == Kind::sampleLod ||
                              call.op->kind == Kind::sampleGrad || call.op->kind == Kind::gather ||
                              call.op->kind == Kind::queryLod;
    if (!unit.view || (needsSampler && !unit.sampler)) {
        for (uint32_t* result : call.result) fill(result, call.lanes, 0);
        return;
    }
    switch (call.op->kind) {
        case Kind::sampleImplicit:
            return runSample(unit, unit.sample, call, LodMode::implicitLod);
        case Kind::sampleLod:
            return runSample(unit, unit.sample, call, LodMode::explicitLod);
        case Kind::sampleGrad:
            return runSample(unit, unit.sample, call, LodMode::gradients);
        case Kind::gather:
            return runSample(unit, unit.gather, call, LodMode::base);
        case Kind::queryLod:
            return runSample(unit, unit.queryLod, call, LodMode::implicitLod);
        case Kind::fetch:
        case Kind::read:
            return runFetch(unit, call);
        case Kind::store:
            return runStore(unit, call);
        case Kind::atomic:
            return runAtomic(unit, call);
        case Kind::querySize:
            return runQuerySize(unit, call);
        case Kind::queryLevels:
            return fill(call.result[0], call.lanes, unit.view->levelCount);
        case Kind::querySamples:
            return fill(call.result[0], call.lanes, unit.view->samples);
    }
}

void callUnit(const ImageBinding& binding, const ImageCall& call) {
    runUnit(*static_cast<const TextureUnit*>(binding.image), call);
}

/// The image of one descriptor with the sampler of another: the routines are looked up once per batch.
void callCombined(const ImageBinding& binding, const ImageCall& call) {
    const auto* image = static_cast<const TextureUnit*>(binding.image);
    const auto* sampler = static_cast<const SamplerState*>(binding.sampler);
    const Result<TextureUnit> unit = makeTextureUnit(image->view, sampler, image->isa);
    runUnit(unit ? *unit : TextureUnit{}, call);
}

}  // namespace

Result<TextureUnit> makeTextureUnit(const TextureView* view, const SamplerState* sampler, Isa isa) {
    TextureUnit unit{.view = view, .sampler = sampler, .isa = isa};
    if (!view) return unit;
    if (Status status = checkView(*view); !status) return status.error();
    unit.fetch = selectFetch(*view, isa);
    // Multisampled images have combined descriptors, too, but are fetched from alone.
    if (view->samples != 1) unit.sampler = nullptr;
    if (!unit.sampler) return unit;
    if (Status status = checkSampling(*view, *sampler); !status) return status.error();
    if (convertsYcbcr(*view, *sampler)) {
        if (Status status = checkYcbcr(*view, *sampler); !status) return status.error();
        unit.sample = sampleYcbcr;
    } else {
        unit.sample = selectSampler(*view, *sampler, isa);
    }
    unit.gather = selectGather(*view, *sampler, isa);
    unit.queryLod = selectQueryLod(*view, *sampler, isa);
    return unit;
}

TextureUnit makeTexelBufferUnit(const TextureView* view, Isa isa) {
    TextureUnit unit{.view = view, .isa = isa};
    if (view) unit.fetch = selectFetch(*view, isa);
    return unit;
}

ImageBinding bindingOf(const TextureUnit& unit) {
    return {&unit, unit.sampler, callUnit};
}

bool needsLevels(const ir::Program& program, const ResourceBindings& bindings) {
    const auto needs = [](const TextureUnit* unit, const SamplerState* sampler) {
        return unit != nullptr && unit->view != nullptr && sampler != nullptr &&
               (unit->view->levelCount > 1 || sampler->magFilter != sampler->minFilter || sampler->maxAnisotropy > 1);
    };
    return std::any_of(program.imageOps.begin(), program.imageOps.end(), [&](const ir::ImageOp& op) {
        if (op.kind != ir::ImageKind::sampleImplicit) return false;
        if (bindings.images == nullptr) return false;
        const bool apart = op.samplerResource != ir::kNoIndex && op.samplerResource != op.imageResource;
        if (apart && bindings.samplers == nullptr) return false;
        for (uint32_t i = 0; i < bindings.count[op.imageResource]; ++i) {
            const auto* unit =
                static_cast<const TextureUnit*>(bindings.images[bindings.base[op.imageResource] + i].image);
            if (!apart && needs(unit, unit == nullptr ? nullptr : unit->sampler)) return true;
            for (uint32_t s = 0; apart && s < bindings.count[op.samplerResource]; ++s) {
                const void* sampler = bindings.samplers[bindings.base[op.samplerResource] + s];
                if (needs(unit, static_cast<const SamplerState*>(sampler))) return true;
            }
        }
        return false;
    });
}

ImageBinding combineBinding(const ImageBinding& image, const void* sampler) {
    if (!image.image) return {};
    return {image.image, sampler, callCombined};
}

}  // namespace vernier
