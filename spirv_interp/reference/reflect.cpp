// What a module declares towards the outside: locations, built-ins, descriptors, push constants.
#include <algorithm>

#include "spirv_interp/reference/module_data.h"

namespace vernier::reference {
namespace {

/// Walks one input or output variable down to scalars, vectors, matrices and arrays of them, and gives each
/// its place.
class InterfaceWalker {
  public:
    InterfaceWalker(const ModuleData& module, spv::ExecutionModel model, EntryPointData& entry, InterfaceLayout& layout)
        : module_(module), model_(model), entry_(entry), layout_(layout) {}

    void run(const Variable& variable) {
        const Type& type = module_.types[module_.types[variable.pointerType].element];
        layout_.cells.resize(module_.valueScalars(type));
        InterfaceVariable place;
        place.output = variable.storage == spv::StorageClassOutput;
        if (const auto found = module_.names.find(variable.id); found != module_.names.end())
            place.name = found->second;
        apply(place, module_.decorationsOf(variable.id));
        next_ = place.location;
        if (isOverVertices(variable, type, place.output)) {
            const Type& ofVertex = module_.types[type.element];
            for (uint32_t vertex = 0; vertex < type.count; ++vertex) {
                place.vertex = vertex + 1;
                next_ = place.location;
                visit(ofVertex, place, vertex * ofVertex.scalars);
            }
            return;
        }
        const Type& element = module_.types[type.element];
        const bool ofMembers = element.kind == TypeKind::structure && module_.decorationsOf(element.id, 0).perVertex;
        if (place.output || type.kind != TypeKind::array || (!place.perVertex && !ofMembers)) {
            visit(type, place, 0);
            return;
        }
        // SPV_KHR_fragment_shader_barycentric: the first index is the vertex's and takes no locations.
        place.perVertex = true;
        for (uint32_t vertex = 0; vertex < type.count; ++vertex) {
            place.index = vertex;
            next_ = place.location;
            visit(element, place, vertex * element.scalars);
        }
    }

  private:
    /// Arrayed interfaces: "Interface Matching" in the Vulkan specification.
    bool isOverVertices(const Variable& variable, const Type& type, bool output) const {
        const bool control = model_ == spv::ExecutionModelTessellationControl;
        const bool arrayed = output ? control
                                    : control || model_ == spv::ExecutionModelTessellationEvaluation ||
                                          model_ == spv::ExecutionModelGeometry;
        if (!arrayed || type.kind != TypeKind::array || module_.decorationsOf(variable.id).patch) return false;
        const Type& element = module_.types[type.element];
        return element.kind != TypeKind::structure || !module_.decorationsOf(element.id, 0).patch;
    }

    void apply(InterfaceVariable& place, const Decorations& d) {
        if (d.builtin) {
            place.isBuiltin = true;
            place.builtin = enumerant<spv::BuiltIn>(*d.builtin);
        }
        if (d.location) place.location = *d.location;
        if (d.component) place.component = *d.component;
        if (d.index) place.index = *d.index;
        place.flat |= d.flat;
        place.noPerspective |= d.noPerspective;
        place.centroid |= d.centroid;
        place.perVertex |= d.perVertex;
        place.sample |= d.sample;
    }

    void visit(const Type& type, InterfaceVariable place, uint64_t firstCell) {
        if (type.kind == TypeKind::structure) {
            for (uint32_t m = 0; m < type.members.size(); ++m) {
                InterfaceVariable member = place;
                const auto found = module_.memberNames.find({type.id, m});
                member.name = found != module_.memberNames.end() ? found->second : std::string();
                const Decorations& d = module_.decorationsOf(type.id, m);
                apply(member, d);
                if (d.location) next_ = *d.location;
                member.location = next_;
                visit(module_.types[type.members[m]], member, firstCell + type.cellOffsets[m]);
            }
            return;
        }
        const Type* inner = &type;
        uint64_t elements = 1;
        while (inner->kind == TypeKind::array) {
            elements *= inner->count;
            inner = &module_.types[inner->element];
        }
        if (inner->kind == TypeKind::structure) {
            for (uint64_t e = 0; e < elements; ++e) {
                place.location = next_;
                visit(*inner, place, firstCell + e * inner->scalars);
            }
            return;
        }
        place.isArray = type.kind == TypeKind::array;
        place.elements = static_cast<uint32_t>(elements);
        leaf(*inner, std::move(place), firstCell);
    }

    void leaf(const Type& type, InterfaceVariable place, uint64_t firstCell) {
        place.columns = type.kind == TypeKind::matrix ? type.count : 1;
        place.components = static_cast<uint32_t>(type.scalars) / place.columns;
        const Type& scalar = module_.scalarType(type);
        place.kind = scalarKind(scalar);
        const uint32_t perColumn = place.locationsPerColumn();
        if (!place.isBuiltin && (place.component > 3 || (!isWide(place.kind) && perColumn == 2)))
            fail("input or output at location " + std::to_string(place.location) + " runs over component 3");
        place.locations = place.isBuiltin ? 0 : place.elements * place.columns * perColumn;
        for (uint32_t k = 0; k < place.elements * static_cast<uint32_t>(type.scalars); ++k) {
            InterfaceCell& cell = layout_.cells[firstCell + k];
            cell.cell = static_cast<uint32_t>(firstCell) + k;
            cell.type = static_cast<uint32_t>(&scalar - module_.types.data());
            cell.isBuiltin = place.isBuiltin;
            cell.builtin = place.builtin;
            cell.element = k;
            const InterfaceVariable::Place at = place.placeOf(k);
            cell.location = Location(at.location, place.index);
            cell.component = at.component;
            cell.vertex = place.vertex;
        }
        if (!place.isBuiltin) next_ = place.location + place.locations;
        entry_.variables.push_back(std::move(place));
    }

    const ModuleData& module_;
    const spv::ExecutionModel model_;
    EntryPointData& entry_;
    InterfaceLayout& layout_;
    uint32_t next_ = 0;  // location of the next member
};

void reflectEntryPoint(const ModuleData& module, spv::ExecutionModel model, EntryPointData& entry) {
    std::sort(entry.interface.begin(), entry.interface.end());
    entry.interface.erase(std::unique(entry.interface.begin(), entry.interface.end()), entry.interface.end());
    for (const Id id : entry.interface) {
        const IdInfo& info = module.info(id);
        if (info.kind != IdKind::variable) fail("interface entry " + name(id) + " is no variable");
        const Variable& variable = module.variables[info.index];
        if (variable.storage != spv::StorageClassInput && variable.storage != spv::StorageClassOutput) continue;
        InterfaceLayout layout;
        layout.variable = info.index;
        layout.output = variable.storage == spv::StorageClassOutput;
        InterfaceWalker(module, model, entry, layout).run(variable);
        entry.layouts.push_back(std::move(layout));
    }
}

DescriptorKind imageKind(const ImageShape& shape) {
    if (shape.dim == spv::DimSubpassData) return DescriptorKind::inputAttachment;
    if (shape.dim == spv::DimBuffer)
        return shape.storage ? DescriptorKind::storageTexelBuffer : DescriptorKind::uniformTexelBuffer;
    return shape.storage ? DescriptorKind::storageImage : DescriptorKind::sampledImage;
}

DescriptorBinding reflectBinding(const ModuleData& module, const Variable& variable) {
    DescriptorBinding binding;
    const Decorations& d = module.decorationsOf(variable.id);
    binding.set = d.set.value_or(0);
    binding.binding = d.binding.value_or(0);
    binding.inputAttachmentIndex = d.inputAttachmentIndex.value_or(0);
    if (const auto found = module.names.find(variable.id); found != module.names.end()) binding.name = found->second;
    const Type* type = &module.types[module.types[variable.pointerType].element];
    while (type->isArray()) {
        binding.count *= type->kind == TypeKind::runtimeArray ? 0 : type->count;
        type = &module.types[type->element];
    }
    switch (type->kind) {
        case TypeKind::structure:
            binding.kind =
                variable.storage == spv::StorageClassStorageBuffer || module.decorationsOf(type->id).bufferBlock
                    ? DescriptorKind::storageBuffer
                    : DescriptorKind::uniformBuffer;
            binding.byteSize = module.byteSize(*type, 0, false);
            break;
        case TypeKind::image:
            binding.shape = type->shape;
            binding.kind = imageKind(type->shape);
            break;
        case TypeKind::sampler:
            binding.kind = DescriptorKind::sampler;
            break;
        case TypeKind::sampledImage:
            binding.shape = module.types[type->element].shape;
            binding.kind = binding.shape.dim == spv::DimBuffer ? DescriptorKind::uniformTexelBuffer
                                                               : DescriptorKind::combinedImageSampler;
            break;
        default:
            failUnsupported("descriptor " + name(variable.id) + " of type " + name(type->id));
    }
    return binding;
}

}  // namespace

ScalarKind scalarKind(const Type& type) {
    const auto ofWidth = [&](ScalarKind w8, ScalarKind w16, ScalarKind w32, ScalarKind w64) {
        return type.width == 8 ? w8 : type.width == 16 ? w16 : type.width == 64 ? w64 : w32;
    };
    switch (type.kind) {
        case TypeKind::boolean:
            return ScalarKind::boolean;
        case TypeKind::integer:
            return type.isSigned
                       ? ofWidth(ScalarKind::int8, ScalarKind::int16, ScalarKind::int32, ScalarKind::int64)
                       : ofWidth(ScalarKind::uint8, ScalarKind::uint16, ScalarKind::uint32, ScalarKind::uint64);
        case TypeKind::floating:
            return ofWidth(ScalarKind::float16, ScalarKind::float16, ScalarKind::float32, ScalarKind::float64);
        default:
            fail("type " + name(type.id) + " cannot be an input or output");
    }
}

void reflect(ModuleData& module) {
    for (size_t k = 0; k < module.entryPoints.size(); ++k)
        reflectEntryPoint(module, module.entryPoints[k].model, module.entryPointData[k]);
    for (const Variable& variable : module.variables) {
        const Type& type = module.types[module.types[variable.pointerType].element];
        switch (variable.storage) {
            case spv::StorageClassUniformConstant:
            case spv::StorageClassUniform:
            case spv::StorageClassStorageBuffer:
                module.bindings.push_back(reflectBinding(module, variable));
                break;
            case spv::StorageClassPushConstant:
                module.pushConstantSize = std::max(module.pushConstantSize, module.byteSize(type, 0, false));
                break;
            default:
                break;
        }
    }
}

}  // namespace vernier::reference
