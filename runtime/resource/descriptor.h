// Descriptor set layouts and descriptor sets: what a (set, binding, index) names.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/arena.h"
#include "base/simd.h"
#include "runtime/resource/image.h"
#include "spirv_interp/resources.h"

namespace vernier {

/// A sampler, resolved once from VkSamplerCreateInfo.
struct Sampler {
    SamplerState state;
};

struct DescriptorBinding {
    uint32_t binding = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_SAMPLER;
    uint32_t count = 0;
    uint32_t firstSlot = 0;      // into DescriptorSet::slots
    uint32_t firstDynamic = 0;   // into the dynamic offsets of the set, for *_DYNAMIC types
    std::vector<const Sampler*> immutableSamplers;
};

struct DescriptorSetLayout {
    std::vector<DescriptorBinding> bindings;  // sorted by binding
    uint32_t slotCount = 0;
    uint32_t dynamicCount = 0;

    static DescriptorSetLayout create(std::vector<DescriptorBinding> bindings);
    const DescriptorBinding* find(uint32_t binding) const;
};

/// One descriptor. Which fields count follows from the type of its binding.
struct Descriptor {
    BufferBinding buffer;                 // uniform and storage buffers
    const ImageView* view = nullptr;
    const Sampler* sampler = nullptr;
    ImageBinding image;                   // view and sampler resolved to a routine when written
    TextureView texelBuffer;              // texel buffers: a view of one row
};

class DescriptorSet {
  public:
    explicit DescriptorSet(const DescriptorSetLayout& layout);

    const DescriptorSetLayout& layout() const { return *layout_; }
    std::span<Descriptor> slots() { return slots_; }
    std::span<const Descriptor> slots() const { return slots_; }

    void writeBuffer(uint32_t slot, const Buffer* buffer, VkDeviceSize offset, VkDeviceSize range);
    /// Any of the two may be nullptr (separate images and samplers). Resolves the sampling routine for `isa`.
    void writeImage(uint32_t slot, const ImageView* view, const Sampler* sampler, Isa isa);

  private:
    const DescriptorSetLayout* layout_;
    std::vector<Descriptor> slots_;
};

/// What is bound while a draw or dispatch runs.
struct BoundDescriptors {
    const DescriptorSet* sets[8] = {};
    std::span<const uint32_t> dynamicOffsets[8];
    std::span<const std::byte> pushConstants;
};

/// The bindings of one program: looks up every resource of `program` in `bound` and lays the results out in `arena`.
/// Unbound or missing descriptors become empty bindings, which read as zero. The result lives as long as the arena.
ResourceBindings resolveBindings(const ir::Program& program, const BoundDescriptors& bound, Arena& arena);

/// The routine that joins an image call of spirv_interp to a view and a sampler of runtime/texture.
ImageBinding makeImageBinding(const TextureView* view, const SamplerState* sampler, Isa isa, Arena* arena);

}  // namespace vernier
