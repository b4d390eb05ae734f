// How the memory and images of a draw reach a running program. spirv_interp knows nothing of image layouts or filters:
// an image instruction is one call for a whole batch of lanes through a function pointer that was resolved when the
// descriptor was written or the draw was planned.
#pragma once

#include <cstddef>
#include <cstdint>

#include "spirv_interp/ir/ir.h"

namespace vernier {

/// What lies further behind in a buffer is outside.
inline constexpr uint32_t kMaxBufferBytes = 1u << 30;

struct BufferBinding {
    std::byte* data = nullptr;  // 4-byte aligned (8 for 64-bit atomics); nullptr with size 0 for an unbound descriptor
    uint32_t size = 0;          // bytes, at most kMaxBufferBytes; every access is checked against it
};

/// One image instruction over a batch. Lane arrays hold `lanes` 32-bit values (a multiple of 4, quads in order); absent
/// operands are nullptr. Inactive lanes (mask 0) hold arbitrary bits: they must not fault, their results do not matter.
struct ImageCall {
    const ir::ImageOp* op = nullptr;
    uint32_t lanes = 0;
    const uint32_t* mask = nullptr;       // ~0 or 0 per lane; nullptr: all are active
    const uint32_t* coord[4] = {};        // f32 bits, or i32 for fetch/read/store
    const uint32_t* dref = nullptr;       // f32 bits
    const uint32_t* lodOrBias = nullptr;  // f32 bits; i32 for fetch
    const uint32_t* ddx[3] = {};          // f32 bits
    const uint32_t* ddy[3] = {};
    const uint32_t* offset[3] = {};    // i32
    const uint32_t* sample = nullptr;  // i32
    const uint32_t* minLod = nullptr;  // f32 bits
    const uint32_t* texel[4] = {};     // store: value; atomic: value, comparator
    uint32_t* result[4] = {};          // where to put the results; nullptr: not wanted
};

struct ImageBinding {
    const void* image = nullptr;    // runtime's view; nullptr = unbound: reads give 0
    const void* sampler = nullptr;  // runtime's sampler
    void (*call)(const ImageBinding& binding, const ImageCall& call) = nullptr;
};

/// A piece of device memory that shaders may reach by its address.
struct AddressRange {
    std::byte* data = nullptr;  // nullptr: no memory
    uint64_t address = 0;       // of data[0]; a multiple of 4, as `data` is aligned to 4 bytes (8 for 64-bit atomics)
    uint64_t size = 0;          // bytes
};

/// Tells the range of device memory that holds an address, or one without memory. Called by many threads at once.
struct AddressResolver {
    void* self = nullptr;
    AddressRange (*find)(void* self, uint64_t address) = nullptr;
};

/// The descriptors of one draw or dispatch for one program, in the order of Program::resources: descriptor `index` of
/// resource r is buffers[bufferBase[r] + index] or images[imageBase[r] + index], index < count[r]. For an image
/// instruction whose sampler is another resource, the sampler is samplers[samplerBase[r] + index].
struct ResourceBindings {
    const BufferBinding* buffers = nullptr;
    const ImageBinding* images = nullptr;
    const void* const* samplers = nullptr;
    const uint32_t* base = nullptr;   // by resource: first element in buffers, images or samplers (by the kind)
    const uint32_t* count = nullptr;  // by resource
    /// Finds the routine for an image and a sampler that come from two descriptors; called once per batch and pair.
    ImageBinding (*combine)(const ImageBinding& image, const void* sampler) = nullptr;
    AddressResolver addresses{};  // for physical storage buffers
};

}  // namespace vernier
