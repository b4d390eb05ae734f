#include "tests/spirv_interp/shader_run.h"

#include <gtest/gtest.h>

#include "spirv_interp/ir/print.h"
#include "tests/spirv_interp/batch_harness.h"

namespace vernier::test {

bool ShaderRun::run(Isa isa) {
    ShaderSource source;
    source.words = words;
    source.stage = stage;
    source.specialization = specialization;
    Result<ir::Program> loaded = loadShader(source);
    if (!loaded) {
        ADD_FAILURE() << loaded.error().message;
        return false;
    }
    program = std::move(loaded).value();
    std::vector<BufferBinding> bindings;
    std::vector<uint32_t> base, count;
    for (const ir::Resource& resource : program.resources) {
        Bytes& bytes = resource.kind == ir::ResourceKind::pushConstants ? push : buffers[resource.binding];
        base.push_back(static_cast<uint32_t>(bindings.size()));
        count.push_back(std::max(resource.arraySize, 1u));
        for (uint32_t k = 0; k < count.back(); ++k) {
            Bytes& element = k == 0 ? bytes : buffers[resource.binding + k];
            bindings.push_back({element.data(), static_cast<uint32_t>(element.size())});
        }
    }
    RunSetup setup;
    setup.isa = isa;
    setup.capacity = setup.lanes = lanes;
    setup.exec = exec;
    setup.bindings.buffers = bindings.data();
    setup.bindings.base = base.data();
    setup.bindings.count = count.data();
    setup.bindings.addresses = addresses;
    std::vector<std::vector<uint32_t>> rows;
    for (const ir::InterfaceSlot& slot : program.inputs) {
        const uint32_t place = 4u * slot.location + slot.component;
        std::vector<uint32_t>& row =
            rows.emplace_back(inputs.contains(place) ? inputs[place] : std::vector<uint32_t>());
        for (auto lane = static_cast<uint32_t>(row.size()); lane < lanes; ++lane) row.push_back(place == 0 ? lane : 0);
    }
    const RunResult result = runBatch(program, rows, setup);
    EXPECT_TRUE(result.ok) << ir::print(program);
    outputs.clear();
    for (size_t i = 0; i < program.outputs.size(); ++i) {
        outputs[4u * program.outputs[i].location + program.outputs[i].component] = result.outputs[i];
    }
    live = result.live;
    return result.ok;
}

uint32_t ShaderRun::output(uint32_t place, uint32_t lane) const {
    const auto found = outputs.find(place);
    return found == outputs.end() ? 0xDEADu : found->second.at(lane);
}

Words laneShader(std::string_view extensions, std::string_view globals, std::string_view body, bool debug) {
    std::string text = "#version 460\n";
    text += extensions;
    text += "\nlayout(location = 0) flat in int lane;\n";
    text += globals;
    text += "\nvoid main() {\n";
    text += body;
    text += "\n}\n";
    return compileGlsl(ir::Stage::fragment, text, debug);
}

std::string loadError(const Words& words, ir::Stage stage) {
    ShaderSource source;
    source.words = words;
    source.stage = stage;
    const Result<ir::Program> program = loadShader(source);
    return program.ok() ? "" : program.error().message;
}

}  // namespace vernier::test
