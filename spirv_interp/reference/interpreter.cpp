// The public classes: modules are parsed, programs prepared, quads driven; every Failure ends here as an
// Error.
#include "spirv_interp/reference/interpreter.h"

#include <limits>
#include <new>

#include "spirv_interp/reference/drive.h"
#include "spirv_interp/reference/machine.h"
#include "spirv_interp/reference/work_group.h"

namespace vernier::reference {
namespace {

/// Calls f and turns what it throws into an Error.
template <class T, class F>
Result<T> guarded(const F& f) {
    try {
        return f();
    } catch (const Failure& failure) {
        return failure.error;
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::outOfHostMemory, "SPIR-V reference interpreter: out of memory"};
    }
}

template <class Number>
Value<Number> constantValue(const ModuleData& module, const Constant& constant) {
    Value<Number> value;
    if (const Type& type = module.types[constant.type]; type.kind == TypeKind::pointer) {
        // Only null is a constant.
        value.pointer.emplace();
        value.pointer->type = type.element;
        value.pointer->outside = true;
        value.pointer->isBuffer = value.pointer->isPhysical = type.storage == spv::StorageClassPhysicalStorageBuffer;
        value.pointer->kind = BufferKind::storage;
    }
    for (const ConstantScalar& s : constant.scalars) value.scalars.push_back({static_cast<Number>(s.number), s.bits});
    value.defined = true;
    return value;
}

bool isSupported(spv::ExecutionModel model) {
    switch (model) {
        case spv::ExecutionModelVertex:
        case spv::ExecutionModelTessellationControl:
        case spv::ExecutionModelTessellationEvaluation:
        case spv::ExecutionModelGeometry:
        case spv::ExecutionModelFragment:
        case spv::ExecutionModelGLCompute:
            return true;
        default:
            return false;
    }
}

}  // namespace

Result<Module> Module::parse(std::span<const uint32_t> words, const Specialization& specialization) {
    return guarded<Module>([&] {
        auto data = std::make_shared<ModuleData>();
        data->words.assign(words.begin(), words.end());
        data->specialization = specialization;
        parseModule(*data);
        reflect(*data);
        return Module(std::move(data));
    });
}

const std::vector<EntryPoint>& Module::entryPoints() const {
    return data_->entryPoints;
}
const std::vector<InterfaceVariable>& Module::interfaceVariables(size_t entryPoint) const {
    return data_->entryPointData.at(entryPoint).variables;
}
const std::vector<DescriptorBinding>& Module::descriptorBindings() const {
    return data_->bindings;
}
uint64_t Module::pushConstantSize() const {
    return data_->pushConstantSize;
}

template <class Number>
struct Interpreter<Number>::State {
    Program<Number> program;
};

template <class Number>
Result<Interpreter<Number>> Interpreter<Number>::create(const Module& module, spv::ExecutionModel model,
                                                        std::string_view entryPoint, const Options& options) {
    return guarded<Interpreter>([&]() -> Result<Interpreter> {
        if (!isSupported(model))
            return unsupported("SPIR-V reference interpreter: execution model " +
                               std::to_string(static_cast<uint32_t>(model)));
        const auto& entries = module.entryPoints();
        for (size_t k = 0; k < entries.size(); ++k) {
            if (entries[k].model != model || entries[k].name != entryPoint) continue;
            auto state = std::make_shared<State>();
            state->program.module = module.shared();
            state->program.entryPoint = k;
            state->program.options = options;
            for (const Constant& constant : module.data().constants)
                state->program.constants.push_back(constantValue<Number>(module.data(), constant));
            return Interpreter(std::move(state));
        }
        return invalidArgument("SPIR-V: no entry point \"" + std::string(entryPoint) + "\" of execution model " +
                               std::to_string(static_cast<uint32_t>(model)));
    });
}

template <class Number>
Result<Outcome<Number>> Interpreter<Number>::run(const InterfaceValues<Number>& inputs,
                                                 Resources<Number>& resources) const {
    return guarded<Outcome<Number>>([&] {
        std::vector<std::optional<Machine<Number>>> machines(4);
        machines[0].emplace(state_->program, inputs, resources, 0, false);
        driveAlone(machines);
        return machines[0]->outcome();
    });
}

template <class Number>
Result<std::array<Outcome<Number>, 4>> Interpreter<Number>::runQuad(
    const std::array<InterfaceValues<Number>, 4>& inputs, const std::array<bool, 4>& helper,
    Resources<Number>& resources) const {
    return guarded<std::array<Outcome<Number>, 4>>([&] {
        std::vector<std::optional<Machine<Number>>> machines(4);
        for (uint32_t k = 0; k < 4; ++k) machines[k].emplace(state_->program, inputs[k], resources, k, helper[k]);
        driveAlone(machines);
        std::array<Outcome<Number>, 4> outcomes;
        for (size_t k = 0; k < 4; ++k) outcomes[k] = machines[k]->outcome();
        return outcomes;
    });
}

template <class Number>
Result<std::vector<Outcome<Number>>> Interpreter<Number>::runSubgroup(
    std::span<const std::optional<InterfaceValues<Number>>> inputs, const std::vector<bool>& helper,
    Resources<Number>& resources) const {
    return guarded<std::vector<Outcome<Number>>>(
        [&] { return reference::runSubgroup(state_->program, inputs, helper, resources); });
}

template <class Number>
Result<InterfaceValues<Number>> Interpreter<Number>::runPatch(const InterfaceValues<Number>& inputs,
                                                              Resources<Number>& resources) const {
    return guarded<InterfaceValues<Number>>([&] { return reference::runPatch(state_->program, inputs, resources); });
}

template <class Number>
Status Interpreter<Number>::runWorkGroup(const WorkGroup& group, Resources<Number>& resources) const {
    const Result<bool> result = guarded<bool>([&] {
        reference::runWorkGroup(state_->program, group, resources);
        return true;
    });
    return result ? Status() : Status(result.error());
}

template <class Number>
std::array<uint32_t, 3> Interpreter<Number>::localSize() const {
    return workGroupSize(*state_->program.module, state_->program.entryPoint);
}

template class Interpreter<float>;
template class Interpreter<double>;
template class Interpreter<Real>;

}  // namespace vernier::reference
