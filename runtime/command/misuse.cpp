#include "runtime/command/misuse.h"

#include <iterator>

#include "spirv_interp/needs_descriptor.h"

namespace vernier {

std::string missingDescriptor(const ir::Program& program, const BoundDescriptors& bound) {
    for (const ir::Resource& resource : program.resources) {
        if (!needsDescriptor(resource)) continue;
        const std::string name =
            "set " + std::to_string(resource.set) + ", binding " + std::to_string(resource.binding);
        if (resource.set >= std::size(bound.sets) || bound.sets[resource.set] == nullptr)
            return "the shader uses " + name + ", but no descriptor set is bound there";
        if (bound.sets[resource.set]->layout().find(resource.binding) == nullptr)
            return "the shader uses " + name + ", which the descriptor set bound there does not have";
    }
    return {};
}

}  // namespace vernier
