#include "tests/spirv_interp/batch_harness.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include <gtest/gtest.h>

#include "spirv_interp/ir/builder.h"
#include "spirv_interp/ir/parse.h"

namespace vernier::test {

bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](float x, float y) {
               return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y) || (std::isnan(x) && std::isnan(y));
           });
}

ir::Program parseProgram(const std::string& text) {
    auto program = ir::parse(text);
    if (!program) {
        ADD_FAILURE() << program.error().message;
        std::abort();
    }
    return std::move(program).value();
}

namespace {

std::shared_ptr<const BatchProgram> compileOrDie(const ir::Program& program, const BatchOptions& options) {
    auto compiled = BatchProgram::compile(program, options);
    if (!compiled) {
        ADD_FAILURE() << compiled.error().message;
        std::abort();
    }
    return *compiled;
}

}  // namespace

std::vector<float> evaluate(ir::Op op, const std::vector<std::vector<float>>& operands, Isa isa, MathTier tier) {
    ir::Program program;
    program.stage = ir::Stage::fragment;
    ir::Builder builder(program);
    builder.setBlock(builder.newBlock());
    std::vector<ir::ValueId> values;
    for (uint16_t k = 0; k < operands.size(); ++k) {
        ir::InterfaceSlot slot;
        slot.location = k;
        program.inputs.push_back(slot);
        values.push_back(builder.append(ir::Op::input, ir::Type::f32, {}, k));
    }
    program.outputs.emplace_back();
    builder.append(ir::Op::storeOutput, ir::Type::none, {builder.append(op, ir::Type::f32, values)}, 0);
    builder.ret();

    const auto compiled = compileOrDie(program, {isa, tier, 64});
    BatchContext context(compiled);
    context.beginDraw({});
    const uint32_t lanes = compiled->lanes();
    const std::vector<uint32_t> mask(lanes, ~0u);
    std::vector<float> result;
    for (size_t first = 0; first < operands[0].size(); first += lanes) {
        const size_t count = std::min<size_t>(lanes, operands[0].size() - first);
        for (uint32_t k = 0; k < operands.size(); ++k) {
            std::copy_n(operands[k].begin() + static_cast<ptrdiff_t>(first), count, context.input(k));
        }
        EXPECT_TRUE(context.run(lanes, mask.data(), mask.data()));
        result.insert(result.end(), context.output(0), context.output(0) + count);
    }
    return result;
}

RunResult runBatch(const ir::Program& program, const std::vector<std::vector<uint32_t>>& inputs,
                   const RunSetup& setup) {
    const auto compiled = compileOrDie(program, {setup.isa, setup.tier, setup.capacity});
    BatchContext context(compiled);
    context.setInterpolator(setup.interpolator);
    context.beginDraw(setup.bindings);
    RunResult result;
    result.outputs.assign(program.outputs.size(), std::vector<uint32_t>(setup.lanes));
    const auto part = [](const std::vector<uint32_t>& mask, uint32_t first, uint32_t lanes) {
        std::vector<uint32_t> words(lanes, mask.empty() ? ~0u : 0u);
        if (first < mask.size())
            std::copy_n(mask.begin() + first, std::min<size_t>(lanes, mask.size() - first), words.begin());
        return words;
    };
    // A batch has as many lanes as the instruction set allows: what is more goes through the next.
    for (uint32_t first = 0; first < setup.lanes; first += compiled->lanes()) {
        const uint32_t lanes = std::min(compiled->lanes(), setup.lanes - first);
        for (uint32_t slot = 0; slot < program.inputs.size(); ++slot) {
            float* row = context.input(slot);
            if (row != nullptr) std::memcpy(row, inputs[slot].data() + first, lanes * sizeof(uint32_t));
        }
        const auto exec = part(setup.exec, first, compiled->lanes()),
                   store = part(setup.store, first, compiled->lanes());
        result.ok = context.run(lanes, exec.data(), store.data()) && result.ok;
        for (uint32_t slot = 0; slot < program.outputs.size(); ++slot) {
            const auto* row = reinterpret_cast<const uint32_t*>(context.output(slot));
            if (row != nullptr) std::memcpy(result.outputs[slot].data() + first, row, lanes * sizeof(uint32_t));
        }
        result.live.insert(result.live.end(), context.liveMask(), context.liveMask() + lanes);
    }
    return result;
}

}  // namespace vernier::test
