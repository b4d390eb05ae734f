#include "tests/spirv_interp/compute_harness.h"

#include <bit>
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/front_support.h"

namespace vernier::test {
namespace {

Result<ir::Program> tryLoad(std::string_view glsl, const Specialization& specialization, VnGlslTarget target) {
    const Words words = compileGlsl(ir::Stage::compute, glsl, false, target);
    ShaderSource source;
    source.words = words;
    source.stage = ir::Stage::compute;
    source.specialization = specialization;
    return loadShader(source);
}

}  // namespace

ir::Program loadCompute(std::string_view glsl, const Specialization& specialization, VnGlslTarget target) {
    Result<ir::Program> program = tryLoad(glsl, specialization, target);
    if (!program) {
        ADD_FAILURE() << program.error().message << "\n" << glsl;
        std::abort();
    }
    return std::move(program).value();
}

std::string refusalOf(std::string_view glsl) {
    const Result<ir::Program> program = tryLoad(glsl, {}, VN_GLSL_TARGET_VULKAN_1_2);
    return program.ok() ? "" : program.error().message;
}

std::shared_ptr<const BatchProgram> compileCompute(const ir::Program& program, Isa isa, uint32_t lanes) {
    auto compiled = BatchProgram::compile(program, {isa, MathTier::standard, lanes});
    if (!compiled) {
        ADD_FAILURE() << compiled.error().message;
        std::abort();
    }
    return std::move(compiled).value();
}

DispatchResult dispatch(const ir::Program& program, const std::shared_ptr<const BatchProgram>& compiled,
                        const WorkGroupContext::Grid& grid, BufferContents buffers, uint32_t chunk,
                        const std::vector<uint32_t>& pushConstants) {
    std::vector<uint32_t> constants = pushConstants;
    std::vector<BufferBinding> bindings;
    std::vector<uint32_t> base, count;
    for (const ir::Resource& resource : program.resources) {
        base.push_back(static_cast<uint32_t>(bindings.size()));
        count.push_back(1);
        std::vector<uint32_t>& words =
            resource.kind == ir::ResourceKind::pushConstants ? constants : buffers[resource.binding];
        if (resource.kind == ir::ResourceKind::workgroupMemory) count.back() = 0;
        bindings.push_back({reinterpret_cast<std::byte*>(words.data()), static_cast<uint32_t>(words.size() * 4)});
    }
    ResourceBindings resources;
    resources.buffers = bindings.data();
    resources.base = base.data();
    resources.count = count.data();
    WorkGroupContext context(compiled);
    context.beginDispatch(resources, grid);
    DispatchResult result;
    const uint64_t share = chunk != 0 ? chunk : grid.size();
    for (uint64_t first = 0; first < grid.size() && result.ok; first += share) {
        result.ok = context.run(first, static_cast<uint32_t>(std::min(share, grid.size() - first)));
    }
    result.buffers = std::move(buffers);
    return result;
}

BufferContents dispatchEverywhere(const ir::Program& program, const WorkGroupContext::Grid& grid,
                                  const BufferContents& buffers, const std::vector<uint32_t>& pushConstants,
                                  uint32_t leastLanes) {
    const DispatchResult first =
        dispatch(program, compileCompute(program, kLowestIsa, 0), grid, buffers, 0, pushConstants);
    EXPECT_TRUE(first.ok);
    for (const Isa isa : isas()) {
        for (const uint32_t lanes : {0u, 16u, 32u, 64u}) {
            if (lanes != 0 && lanes < leastLanes) continue;
            const auto compiled = compileCompute(program, isa, lanes);
            for (const uint32_t chunk : {0u, 1u, 3u}) {
                const DispatchResult other = dispatch(program, compiled, grid, buffers, chunk, pushConstants);
                EXPECT_TRUE(other == first) << isaName(isa) << ", " << lanes << " lanes, chunks of " << chunk;
            }
        }
    }
    return first.buffers;
}

std::vector<uint32_t> wordsOf(const std::vector<float>& values) {
    std::vector<uint32_t> words;
    for (const float value : values) words.push_back(std::bit_cast<uint32_t>(value));
    return words;
}

std::vector<float> floatsOf(const std::vector<uint32_t>& words) {
    std::vector<float> values;
    for (const uint32_t word : words) values.push_back(std::bit_cast<float>(word));
    return values;
}

}  // namespace vernier::test
