// Owners of what the C interface of SPIRV-Tools hands out.
#pragma once

#include <memory>
#include <type_traits>

#include <spirv-tools/libspirv.h>

namespace vernier {

template <auto kDestroy>
struct SpirvToolsDelete {
    template <class T>
    void operator()(T* object) const {
        kDestroy(object);
    }
};

template <class Handle, auto kDestroy>
using SpirvToolsOwner = std::unique_ptr<std::remove_pointer_t<Handle>, SpirvToolsDelete<kDestroy>>;

using SpirvContext = SpirvToolsOwner<spv_context, spvContextDestroy>;
using SpirvText = SpirvToolsOwner<spv_text, spvTextDestroy>;
using SpirvDiagnostic = SpirvToolsOwner<spv_diagnostic, spvDiagnosticDestroy>;
using SpirvValidatorOptions = SpirvToolsOwner<spv_validator_options, spvValidatorOptionsDestroy>;

}  // namespace vernier
