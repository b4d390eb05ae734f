#include "runtime/plan/compute_pipeline.h"

#include "runtime/limits.h"
#include "runtime/plan/facts.h"
#include "runtime/plan/program_facts.h"

namespace vernier {
namespace {

constexpr char kAxes[] = "xyz";
static_assert(kMaxWorkGroupInvocations <= ir::kMaxWorkgroupInvocations);
static_assert(kMaxWorkGroupMemory <= ir::kMaxWorkgroupMemory);

uint32_t sharedBytes(const ir::Program& program) {
    uint32_t bytes = 0;
    for (const ir::Resource& resource : program.resources)
        if (resource.kind == ir::ResourceKind::workgroupMemory) bytes += resource.byteSize;
    return bytes;
}

Status checkWorkGroup(const ir::Program& program) {
    uint64_t invocations = 1;
    for (size_t axis = 0; axis < 3; ++axis) {
        const uint32_t size = program.localSize[axis];
        if (size < 1 || size > kMaxWorkGroupSize[axis])
            return invalidArgument("compute shader: the work-group's size in " + std::string(1, kAxes[axis]) + " is " +
                                   std::to_string(size) + "; it must be from 1 to " +
                                   std::to_string(kMaxWorkGroupSize[axis]));
        invocations *= size;
    }
    if (invocations > kMaxWorkGroupInvocations)
        return invalidArgument("compute shader: a work-group has " + std::to_string(invocations) +
                               " invocations; the limit is " + std::to_string(kMaxWorkGroupInvocations));
    if (const uint32_t bytes = sharedBytes(program); bytes > kMaxWorkGroupMemory)
        return invalidArgument("compute shader: a work-group shares " + std::to_string(bytes) +
                               " bytes; the limit is " + std::to_string(kMaxWorkGroupMemory));
    return {};
}

}  // namespace

Result<std::shared_ptr<const ComputePipeline>> ComputePipeline::create(const ComputePipelineDesc& desc) {
    if (desc.program == nullptr || desc.program->stage != ir::Stage::compute)
        return invalidArgument("ComputePipelineDesc::program is no compute program");
    if (Status status = checkWorkGroup(*desc.program); !status) return status.error();
    std::shared_ptr<ComputePipeline> pipeline(new ComputePipeline);
    pipeline->accuracy_ = desc.accuracy;
    pipeline->isa_ = desc.isa;
    BatchOptions options{desc.isa, desc.accuracy.math};
    options.verified = true;
    auto compiled = BatchProgram::compile(*desc.program, options);
    if (!compiled) return Error{compiled.error().code, "compute shader: " + compiled.error().message};
    pipeline->program_ = std::move(compiled).value();
    return std::shared_ptr<const ComputePipeline>(std::move(pipeline));
}

std::vector<Fact> ComputePipeline::explain() const {
    std::vector<Fact> facts;
    const auto add = [&](bool runs, const std::string& what, const std::string& why) {
        facts.push_back({.runs = runs, .what = what, .why = why, .rates = {}});
    };
    const BatchStatistics& statistics = program_->statistics();
    const auto& size = ir().localSize;
    add(true, "compute program, once per invocation, " + std::to_string(statistics.lanes) + " at a time",
        "work-groups of " + std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
            std::to_string(size[2]) + "; " + std::to_string(statistics.instructions) + " instructions; " +
            tierName(accuracy_.math) + " maths");
    facts.back().instructions = statistics.instructions;
    facts.back().lanes = statistics.lanes;
    if (std::optional<Fact> rates = rateFact("compute program", *program_)) facts.push_back(*std::move(rates));
    if (statistics.drawRateInstructions > 0)
        add(true, std::to_string(statistics.drawRateInstructions) + " instructions, once per dispatch and thread",
            "their values are the same for all invocations");
    if (statistics.workGroupRateInstructions > 0)
        add(true, std::to_string(statistics.workGroupRateInstructions) + " instructions, once per work-group",
            "their values are the same for its invocations");
    if (!ir().hasBarriers) add(false, "waiting at barriers", "there are none");
    if (const uint32_t bytes = sharedBytes(ir()); bytes > 0)
        add(true, "memory of the work-group, " + std::to_string(bytes) + " bytes", "the invocations share variables");
    else
        add(false, "memory of the work-group", "no variable is shared");
    if (!ir().hasSideEffects) add(false, "the whole program", "it writes nothing that can be read");
    return facts;
}

Status checkGroupCounts(const std::array<uint32_t, 3>& counts) {
    for (size_t axis = 0; axis < 3; ++axis)
        if (counts[axis] > kMaxWorkGroupCount[axis])
            return invalidArgument("the number of work-groups in " + std::string(1, kAxes[axis]) + " is " +
                                   std::to_string(counts[axis]) + "; the limit is " +
                                   std::to_string(kMaxWorkGroupCount[axis]));
    return {};
}

}  // namespace vernier
