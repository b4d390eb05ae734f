// Descriptors: which resource a variable stands for.
#include <algorithm>

#include "spirv_interp/front/lowering.h"

namespace vernier {

ir::ResourceKind Lowering::resourceKindOf(uint32_t variable, spv::StorageClass storage, uint32_t typeId) const {
    const SpirvType* type = &typeInfo(typeId);
    switch (storage) {
        case spv::StorageClass::PushConstant:
            return ir::ResourceKind::pushConstants;
        case spv::StorageClass::StorageBuffer:
            return ir::ResourceKind::storageBuffer;
        case spv::StorageClass::Uniform:
            return module_.hasDecoration(typeId, spv::Decoration::BufferBlock) ? ir::ResourceKind::storageBuffer
                                                                               : ir::ResourceKind::uniformBuffer;
        default:
            break;
    }
    bool sampled = false;
    if (type->kind == SpirvType::Kind::sampler) return ir::ResourceKind::sampler;
    if (type->kind == SpirvType::Kind::sampledImage) {
        sampled = true;
        type = &typeInfo(type->element);
    }
    if (type->kind != SpirvType::Kind::image) refuseId(variable, "is no image, sampler or buffer");
    if (type->image.dim == spv::Dim::SubpassData) return ir::ResourceKind::inputAttachment;
    if (type->image.dim == spv::Dim::Buffer) {
        return type->image.storage ? ir::ResourceKind::storageTexelBuffer : ir::ResourceKind::uniformTexelBuffer;
    }
    if (sampled) return ir::ResourceKind::combinedImageSampler;
    return type->image.storage ? ir::ResourceKind::storageImage : ir::ResourceKind::sampledImage;
}

uint32_t Lowering::resourceOf(uint32_t variable) {
    uint32_t& index = resourceOfId_[variable];
    if (index != ir::kNoIndex) return index;
    const SpirvType& pointer = typeInfo(module_.definition(variable)[1]);
    if (pointer.storage == spv::StorageClass::Workgroup) return index = workgroupResourceOf(variable);
    ir::Resource resource;
    uint32_t type = pointer.element;
    for (const SpirvType* info = &typeInfo(type);
         info->kind == SpirvType::Kind::array || info->kind == SpirvType::Kind::runtimeArray; info = &typeInfo(type)) {
        const uint64_t count = info->kind == SpirvType::Kind::runtimeArray ? 0 : info->count;
        resource.arraySize = static_cast<uint32_t>(std::min<uint64_t>(resource.arraySize * count, ~0u));
        type = info->element;
    }
    resource.kind = resourceKindOf(variable, pointer.storage, type);
    if (resource.kind == ir::ResourceKind::pushConstants) {
        resource.byteSize = byteSizeOf(type, 0, false);
    } else {
        resource.set = module_.decorationOr(variable, spv::Decoration::DescriptorSet, Decoration::kNoMember, 0);
        resource.binding = module_.decorationOr(variable, spv::Decoration::Binding, Decoration::kNoMember, 0);
    }
    resource.aliased = module_.hasDecoration(variable, spv::Decoration::Aliased);
    // Two variables of one binding are one resource: a store through either makes it written for both.
    const auto same = std::find_if(program_.resources.begin(), program_.resources.end(), [&](const ir::Resource& r) {
        return r.kind == resource.kind && r.set == resource.set && r.binding == resource.binding;
    });
    index = static_cast<uint32_t>(same - program_.resources.begin());
    if (same == program_.resources.end()) {
        program_.resources.push_back(resource);
    } else {
        same->arraySize =
            same->arraySize == 0 || resource.arraySize == 0 ? 0 : std::max(same->arraySize, resource.arraySize);
        same->byteSize = std::max(same->byteSize, resource.byteSize);
        same->aliased = same->aliased || resource.aliased;
    }
    return index;
}

/// All variables of a work-group share one resource. Blocks, whose layout is told by decorations, lie one on the other
/// (SPV_KHR_workgroup_memory_explicit_layout); others stand in line in the order of their first use.
uint32_t Lowering::workgroupResourceOf(uint32_t variable) {
    const auto found = std::find_if(program_.resources.begin(), program_.resources.end(),
                                    [](const ir::Resource& r) { return r.kind == ir::ResourceKind::workgroupMemory; });
    const auto index = static_cast<uint32_t>(found - program_.resources.begin());
    if (found == program_.resources.end()) {
        program_.resources.emplace_back().kind = ir::ResourceKind::workgroupMemory;
    }
    ir::Resource& resource = program_.resources[index];
    const uint32_t type = typeInfo(module_.definition(variable)[1]).element;
    const bool block = module_.hasDecoration(type, spv::Decoration::Block);
    const uint64_t bytes = block ? byteSizeOf(type, 0, false) : uint64_t{typeInfo(type).words} * 4;
    const uint64_t first = block ? 0 : resource.byteSize;
    if (first + bytes > ir::kMaxWorkgroupMemory) {
        refuseId(variable, "makes the work-group's memory " + std::to_string(first + bytes) +
                               " bytes large; the limit is " + std::to_string(ir::kMaxWorkgroupMemory));
    }
    workgroupOffset_[variable] = static_cast<uint32_t>(first);
    resource.byteSize = std::max(resource.byteSize, static_cast<uint32_t>(first + bytes + 3) & ~3u);
    return index;
}

/// Where a variable begins in its resource.
uint32_t Lowering::bufferOffsetOf(uint32_t variable) {
    resourceOf(variable);
    return workgroupOffset_[variable];
}

uint32_t Lowering::byteSizeOf(uint32_t typeId, uint32_t matrixStride, bool rowMajor) const {
    const SpirvType& type = typeInfo(typeId);
    switch (type.kind) {
        case SpirvType::Kind::structure: {
            uint32_t size = 0;
            for (uint32_t m = 0; m < type.members.size(); ++m) {
                const uint32_t offset = module_.decorationOr(typeId, spv::Decoration::Offset, m, 0);
                const uint32_t stride = module_.decorationOr(typeId, spv::Decoration::MatrixStride, m, matrixStride);
                const bool rows = module_.hasDecoration(typeId, spv::Decoration::RowMajor, m);
                size = std::max(size, offset + byteSizeOf(type.members[m], stride, rows));
            }
            return size;
        }
        case SpirvType::Kind::array: {
            const uint32_t stride =
                module_.decorationOr(typeId, spv::Decoration::ArrayStride, Decoration::kNoMember, 0);
            const uint32_t count = std::max(type.count, 1u);
            return stride * (count - 1) + byteSizeOf(type.element, matrixStride, rowMajor);
        }
        case SpirvType::Kind::matrix: {
            const SpirvType& column = typeInfo(type.element);
            const uint32_t lines = rowMajor ? column.count : type.count;
            const uint32_t along = rowMajor ? type.count : column.count;
            return matrixStride * (lines - 1) + along * column.scalar.bytes();
        }
        default:
            return type.scalar.bytes() * std::max(type.count, 1u);
    }
}

}  // namespace vernier
