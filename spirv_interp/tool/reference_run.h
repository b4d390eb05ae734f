// The reference interpreter over what the command line told.
#pragma once

#include "spirv_interp/reference/interpreter.h"
#include "spirv_interp/tool/invocation_resources.h"
#include "spirv_interp/tool/module_input.h"

namespace vernier::tool {

inline spv::ExecutionModel modelOf(ir::Stage stage) {
    return stage == ir::Stage::vertex     ? spv::ExecutionModelVertex
           : stage == ir::Stage::fragment ? spv::ExecutionModelFragment
                                          : spv::ExecutionModelGLCompute;
}

inline size_t entryPointIndex(const reference::Module& module, const ModuleInput& input) {
    for (size_t k = 0; k < module.entryPoints().size(); ++k) {
        const reference::EntryPoint& e = module.entryPoints()[k];
        if (e.name == input.entryPoint && e.model == modelOf(input.stage)) return k;
    }
    return 0;
}

/// Runs one invocation, or all work-groups; buffers of `invocation` are written to.
template <class Number>
Result<reference::Outcome<Number>> runReference(const ModuleInput& input, const reference::Module& module,
                                                Invocation& invocation, const reference::Options& options) {
    const auto interpreter =
        reference::Interpreter<Number>::create(module, modelOf(input.stage), input.entryPoint, options);
    if (!interpreter) return interpreter.error();
    InvocationResources<Number> resources(invocation);
    if (input.stage != ir::Stage::compute) {
        const auto inputs = interfaceValues<Number>(invocation, module, entryPointIndex(module, input));
        if (!inputs) return inputs.error();
        return interpreter->run(*inputs, resources);
    }
    reference::WorkGroup group;
    group.count = invocation.groups;
    for (group.id[2] = 0; group.id[2] < group.count[2]; ++group.id[2]) {
        for (group.id[1] = 0; group.id[1] < group.count[1]; ++group.id[1]) {
            for (group.id[0] = 0; group.id[0] < group.count[0]; ++group.id[0]) {
                if (const Status status = interpreter->runWorkGroup(group, resources); !status.ok()) {
                    return status.error();
                }
            }
        }
    }
    return reference::Outcome<Number>{};
}

}  // namespace vernier::tool
