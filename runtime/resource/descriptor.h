// Descriptor set layouts and descriptor sets: what a (set, binding, index) names.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/arena.h"
#include "base/simd.h"
#include "runtime/accuracy.h"
#include "runtime/resource/image.h"
#include "runtime/resource/texture_unit.h"
#include "spirv_interp/resources.h"

namespace vernier {

struct DescriptorBinding {
    uint32_t binding = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_SAMPLER;
    uint32_t count = 0;       // of an inline uniform block: 1, or 0 without bytes
    uint32_t blockBytes = 0;  // of an inline uniform block
    uint32_t blockOffset = 0;
    bool variable = false;      // sets have descriptors, or bytes, of their own number, up to these
    bool mayBeInvalid = false;  // what programs do not use may name objects that are gone
    bool mayChange = false;     // what programs do not use may be written while they run
    uint32_t firstSlot = 0;     // into DescriptorSet::slots
    uint32_t firstDynamic = 0;  // into the dynamic offsets of the set, for *_DYNAMIC types
    std::vector<const SamplerState*> immutableSamplers;  // empty or `count`
    bool operator==(const DescriptorBinding&) const = default;
};

struct DescriptorSetLayout {
    std::vector<DescriptorBinding> bindings;  // sorted by binding
    uint32_t slotCount = 0;
    uint32_t dynamicCount = 0;
    uint32_t blockBytes = 0;  // of all inline uniform blocks
    bool mayChange = false;   // some binding

    static DescriptorSetLayout create(std::vector<DescriptorBinding> bindings);
    const DescriptorBinding* find(uint32_t binding) const;
};

/// One descriptor; plain data, copied freely. Which fields count follows from the type of its binding.
struct Descriptor {
    BufferBinding buffer;              // uniform and storage buffers
    VkDeviceSize bufferBytesLeft = 0;  // from buffer.data to the end of the buffer, for dynamic offsets
    const SamplerState* sampler = nullptr;
    TextureUnit texture;  // images, combined image samplers, texel buffers
};

class DescriptorSet {
  public:
    /// `variableCount`: of the binding that is variable.
    explicit DescriptorSet(const DescriptorSetLayout& layout, uint32_t variableCount = ~0u);

    const DescriptorSetLayout& layout() const { return *layout_; }
    std::span<const Descriptor> slots() const { return slots_; }
    /// Descriptors of a binding that the set has.
    uint32_t countOf(const DescriptorBinding& binding) const;
    /// The bytes of an inline uniform block.
    std::span<std::byte> block(const DescriptorBinding& binding);
    /// Held while descriptors are written, and while they are read for work: nothing, unless the layout says that both
    /// may happen at a time.
    std::unique_lock<std::mutex> lock() const;
    /// As in `from`, a set of the same layout that will not be written any more and lives as long.
    void takeSlot(uint32_t slot, const DescriptorSet& from) { slots_[slot] = from.slots_[slot]; }
    /// As slot `fromSlot` of `from`, but with the immutable sampler if there is one.
    Status copySlot(uint32_t slot, const DescriptorSet& from, uint32_t fromSlot, const SamplerState* immutable,
                    Isa isa);

    /// `buffer` nullptr: an empty binding. `range` may be VK_WHOLE_SIZE.
    void writeBuffer(uint32_t slot, const Buffer* buffer, VkDeviceSize offset, VkDeviceSize range);
    /// Either may be nullptr (separate images and samplers; null descriptors). Both must outlive the descriptor.
    /// Resolves image and sampler to their routines; fails, leaving an empty binding, if the pair cannot be sampled.
    Status writeImage(uint32_t slot, const TextureView* view, const SamplerState* sampler, Isa isa);
    /// `view`: of a BufferView, which must outlive the descriptor; nullptr: an empty binding.
    void writeTexelBuffer(uint32_t slot, const TextureView* view, Isa isa);

  private:
    /// What a descriptor names, where the objects may go before it does.
    struct Kept {
        TextureView view;
        std::unique_ptr<PlanarView> planes;  // of a view that has several
        SamplerState sampler;
    };
    bool keeps(uint32_t slot) const;
    /// Copies what the descriptor names, and lets it name the copies.
    void keep(uint32_t slot);

    const DescriptorSetLayout* layout_;
    uint32_t variableCount_;
    std::vector<Descriptor> slots_;
    std::vector<std::unique_ptr<Kept>> kept_;  // by slot; empty where no binding asks for it
    std::vector<uint64_t> blocks_;             // of inline uniform blocks
    std::unique_ptr<std::mutex> mutex_;        // nullptr: the layout does not ask for it
};

/// An attachment whose samples are in memory of their own while a pass draws: there input attachments find them.
struct SampledInput {
    const ImageView* single = nullptr;   // of the attachment
    const ImageView* samples = nullptr;  // ImageView::withSamples()
};

/// What is bound while a draw or dispatch runs.
struct BoundDescriptors {
    const DescriptorSet* sets[8] = {};
    std::span<const uint32_t> dynamicOffsets[8];
    std::span<const std::byte> pushConstants;
    std::span<const SampledInput> sampledInputs;
};

/// The descriptors a resource of a program stands for, and the dynamic offsets of its set.
struct BoundDescriptorRange {
    std::span<const Descriptor> slots;  // empty: none are bound
    const DescriptorBinding* binding = nullptr;
    std::span<const uint32_t> dynamicOffsets;
    std::unique_lock<std::mutex> lock;  // of the set
};
BoundDescriptorRange findDescriptors(const ir::Resource& resource, const BoundDescriptors& bound);
/// The buffer of descriptor `index` < slots.size(), with its dynamic offset.
BufferBinding boundBuffer(const BoundDescriptorRange& found, uint32_t index);

/// The bindings of one program: looks up every resource of `program` in `bound` and lays the results out in `arena`.
/// Unbound or missing descriptors become empty bindings, which read as zero. Samplers filter as `accuracy` allows. The
/// result lives as long as the arena.
ResourceBindings resolveBindings(const ir::Program& program, const BoundDescriptors& bound, const Accuracy& accuracy,
                                 Arena& arena);

}  // namespace vernier
