// Joins the image instructions of spirv_interp to the texture routines: an image and a sampler resolved to functions.
#pragma once

#include "base/result.h"
#include "base/simd.h"
#include "runtime/texture/texture.h"
#include "spirv_interp/resources.h"

namespace vernier {

/// A view and, where there is one, a sampler, with the routines chosen for the pair. Plain data.
struct TextureUnit {
    const TextureView* view = nullptr;  // nullptr: nothing bound
    const SamplerState* sampler = nullptr;
    Isa isa = kLowestIsa;
    SampleFn sample = nullptr, gather = nullptr, queryLod = nullptr;
    FetchFn fetch = nullptr;
};

/// Either pointer may be nullptr. Fails if the view, or the pair, is one that runtime/texture cannot handle.
Result<TextureUnit> makeTextureUnit(const TextureView* view, const SamplerState* sampler, Isa isa);

/// Of BufferView::texture(); nullptr: nothing bound. Texels are fetched, read and written, never sampled.
TextureUnit makeTexelBufferUnit(const TextureView* view, Isa isa);

/// The binding through which a program reaches `unit`, which must outlive it.
ImageBinding bindingOf(const TextureUnit& unit);

/// Whether something that is sampled with an implicit level of detail depends on it: all has one level and one filter
/// otherwise. `program`: whose resources `bindings` are.
bool needsLevels(const ir::Program& program, const ResourceBindings& bindings);

/// ResourceBindings::combine: an image and a sampler from two descriptors.
ImageBinding combineBinding(const ImageBinding& image, const void* sampler);

}  // namespace vernier
