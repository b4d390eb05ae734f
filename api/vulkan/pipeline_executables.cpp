// VK_KHR_pipeline_executable_properties: what explain() knows of a pipeline, for tools. Programs are kept with their
// pipelines anyway, so that all of it is told whether or not it was asked for when the pipeline was created.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "api/vulkan/entry_points.h"
#include "api/vulkan/enumerate.h"
#include "api/vulkan/pipeline.h"
#include "runtime/plan/plan.h"
#include "runtime/plan/program_facts.h"

namespace vernier::vulkan {
namespace {

struct Executable {
    const char *name, *description;
    VkShaderStageFlags stages;
    const BatchProgram* program;
};

Executable executableOf(const StageProgram& stage) {
    const BatchProgram* program = stage.program.get();
    switch (stage.stage) {
        case ir::Stage::control:
            return {"control", "The tessellation control program, once per vertex of a patch that comes out",
                    VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, program};
        case ir::Stage::evaluation:
            return {"evaluation", "The tessellation evaluation program, once per point of a patch",
                    VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, program};
        case ir::Stage::geometry:
            return {"geometry", "The geometry program, once per primitive and invocation", VK_SHADER_STAGE_GEOMETRY_BIT,
                    program};
        default:
            return {"vertex", "The vertex program, once per vertex in each chunk of primitives",
                    VK_SHADER_STAGE_VERTEX_BIT, program};
    }
}

/// None of a library: what runs belongs to the pipelines that are linked from it.
std::vector<Executable> executablesOf(const Pipeline& pipeline) {
    if (pipeline.library) return {};
    if (pipeline.compute)
        return {{"compute", "The compute program, a batch of invocations at a time", VK_SHADER_STAGE_COMPUTE_BIT,
                 pipeline.compute->program().get()}};
    const GraphicsPipeline& graphics = *pipeline.graphics;
    std::vector<Executable> list;
    for (const StageProgram& stage : graphics.program().stages()) list.push_back(executableOf(stage));
    if (!graphics.plan().runsFragments) return list;
    constexpr VkShaderStageFlags kFragment = VK_SHADER_STAGE_FRAGMENT_BIT;
    if (graphics.plan().splitSamples) {
        list.push_back({"fragment, per pixel", "What all samples of a pixel share of the fragment program", kFragment,
                        graphics.program().pixelPart().get()});
        list.push_back({"fragment, per sample", "What samples do not share of the fragment program", kFragment,
                        graphics.program().samplePart().get()});
    } else {
        list.push_back({"fragment",
                        graphics.plan().perSample ? "The fragment program, once per sample"
                                                  : "The fragment program, once per pixel",
                        kFragment, graphics.fragmentProgram().get()});
    }
    return list;
}

std::string factsOf(const Pipeline& pipeline) {
    return pipeline.compute ? factsText(pipeline.compute->explain()) : factsText(pipeline.graphics->plan().facts);
}

template <size_t kSize>
void copyText(char (&to)[kSize], const std::string& from) {
    std::snprintf(to, kSize, "%s", from.c_str());
}

class Statistics {
  public:
    explicit Statistics(OutputArray<VkPipelineExecutableStatisticKHR>& out) : out_(out) {}
    void add(const std::string& name, const std::string& description, uint64_t value) {
        VkPipelineExecutableStatisticKHR* const slot = out_.next();
        if (slot == nullptr) return;
        copyText(slot->name, name);
        copyText(slot->description, description);
        slot->format = VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR;
        slot->value.u64 = value;
    }

  private:
    OutputArray<VkPipelineExecutableStatisticKHR>& out_;
};

/// `text` into a representation's data, zero included. Returns false when it does not fit.
bool fillText(VkPipelineExecutableInternalRepresentationKHR& to, const std::string& text) {
    const size_t size = text.size() + 1, room = to.dataSize;
    to.isText = VK_TRUE;
    to.dataSize = to.pData == nullptr ? size : std::min(size, room);
    if (to.pData == nullptr || room == 0) return to.pData == nullptr;
    std::memcpy(to.pData, text.c_str(), to.dataSize);
    static_cast<char*>(to.pData)[to.dataSize - 1] = '\0';
    return size <= room;
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL GetPipelineExecutablePropertiesKHR(VkDevice, const VkPipelineInfoKHR* pPipelineInfo,
                                                                  uint32_t* pExecutableCount,
                                                                  VkPipelineExecutablePropertiesKHR* pProperties) {
    return guarded([&] {
        OutputArray<VkPipelineExecutablePropertiesKHR> out(pExecutableCount, pProperties);
        for (const Executable& executable : executablesOf(*object(pPipelineInfo->pipeline))) {
            VkPipelineExecutablePropertiesKHR* const slot = out.next();
            if (slot == nullptr) continue;
            slot->stages = executable.stages;
            copyText(slot->name, executable.name);
            copyText(slot->description, executable.description);
            slot->subgroupSize = ir::kSubgroupSize;
        }
        return out.result();
    });
}

VKAPI_ATTR VkResult VKAPI_CALL GetPipelineExecutableStatisticsKHR(VkDevice,
                                                                  const VkPipelineExecutableInfoKHR* pExecutableInfo,
                                                                  uint32_t* pStatisticCount,
                                                                  VkPipelineExecutableStatisticKHR* pStatistics) {
    return guarded([&] {
        const BatchProgram& program =
            *executablesOf(*object(pExecutableInfo->pipeline)).at(pExecutableInfo->executableIndex).program;
        const BatchStatistics& statistics = program.statistics();
        OutputArray<VkPipelineExecutableStatisticKHR> out(pStatisticCount, pStatistics);
        Statistics to(out);
        to.add("lanes", "Invocations that run at a time", statistics.lanes);
        to.add("registers", "Registers of a 32-bit word per lane", statistics.registers);
        to.add("instructions", "Instructions per batch of lanes", statistics.instructions);
        to.add("instructions per draw", "Instructions that run once per draw or dispatch and thread",
               statistics.drawRateInstructions);
        to.add("instructions per work-group", "Instructions that run once per work-group",
               statistics.workGroupRateInstructions);
        for (const RateShare& share : rateShares(program)) {
            to.add("operations, " + share.rate, "Operations whose values can change with every " + share.rate,
                   share.operations);
            to.add("cost, " + share.rate, "What these operations cost, in additions", share.cost);
        }
        return out.result();
    });
}

VKAPI_ATTR VkResult VKAPI_CALL GetPipelineExecutableInternalRepresentationsKHR(
    VkDevice, const VkPipelineExecutableInfoKHR* pExecutableInfo, uint32_t* pInternalRepresentationCount,
    VkPipelineExecutableInternalRepresentationKHR* pInternalRepresentations) {
    return guarded([&] {
        const Pipeline& pipeline = *object(pExecutableInfo->pipeline);
        const Executable executable = executablesOf(pipeline).at(pExecutableInfo->executableIndex);
        OutputArray<VkPipelineExecutableInternalRepresentationKHR> out(pInternalRepresentationCount,
                                                                       pInternalRepresentations);
        bool whole = true;
        const auto add = [&](const char* name, const char* description, const std::string& text) {
            VkPipelineExecutableInternalRepresentationKHR* const slot = out.next();
            if (slot == nullptr) return;
            copyText(slot->name, name);
            copyText(slot->description, description);
            whole &= fillText(*slot, text);
        };
        add("plan", "What the pipeline runs and leaves out, at what rate, and why", factsOf(pipeline));
        add("IR", "The program after linking and optimisation", irText(*executable.program));
        const VkResult result = out.result();
        return result == VK_SUCCESS && !whole ? VK_INCOMPLETE : result;
    });
}

}  // namespace vernier::vulkan
