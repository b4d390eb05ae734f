#include "runtime/plan/plan.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "runtime/plan/facts.h"
#include "runtime/plan/plan_stages.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/primitive_inputs.h"
#include "spirv_interp/ir/split_samples.h"

namespace vernier {
namespace {

bool isFloat(const FormatInfo& info) {
    return info.color.type == ValueType::floating;
}

/// All components are whole 32-bit words that need no conversion.
bool isWords(const TexelLayout& layout, uint32_t components) {
    for (uint32_t c = 0; c < components; ++c) {
        const Component& component = layout.rgba[c];
        const bool plain = component.kind == ComponentKind::sfloat || component.kind == ComponentKind::uint ||
                           component.kind == ComponentKind::sint;
        if (component.bits != 32 || component.offset != 32 * c || !plain) return false;
    }
    return true;
}

void planAttributes(const GraphicsState& state, const ir::Program& vertex, Isa isa, Plan& plan) {
    for (const VkVertexInputAttributeDescription& description : state.vertexAttributes) {
        AttributeFetch fetch;
        bool used = false;
        for (uint32_t slot = 0; slot < vertex.inputs.size(); ++slot) {
            const ir::InterfaceSlot& input = vertex.inputs[slot];
            if (input.builtin != ir::Builtin::user || input.location != description.location || input.component > 3)
                continue;
            fetch.slots[input.component] = slot;
            used = true;
        }
        if (!used) continue;
        const FormatInfo& info = *findFormat(description.format);
        fetch.ops = formatOps(description.format, isa);
        fetch.components = info.componentCount;
        fetch.words = isWords(info.color, info.componentCount);
        fetch.texelBytes = info.bytesPerTexel;
        fetch.alphaBits = isFloat(info) ? std::bit_cast<uint32_t>(1.0f) : 1u;
        fetch.binding = description.binding;
        fetch.offset = description.offset;
        for (const auto& binding : state.vertexBindings) {
            if (binding.binding != description.binding) continue;
            fetch.stride = binding.stride;
            fetch.perInstance = binding.inputRate == VK_VERTEX_INPUT_RATE_INSTANCE;
            fetch.divisor = state.instanceDivisors[binding.binding];
        }
        plan.attributes.push_back(fetch);
    }
    for (uint32_t slot = 0; slot < vertex.inputs.size(); ++slot)
        if (vertex.inputs[slot].builtin != ir::Builtin::user)
            plan.vertexBuiltins.push_back({vertex.inputs[slot].builtin, vertex.inputs[slot].component, slot});
}

void planVertexOutputs(const ir::Program& vertex, Plan& plan) {
    const auto distanceSlot = [](std::vector<uint32_t>& slots, uint32_t component, uint32_t slot) {
        if (slots.size() <= component) slots.resize(component + 1, slot);
        slots[component] = slot;
    };
    for (uint32_t slot = 0; slot < vertex.outputs.size(); ++slot) {
        const ir::InterfaceSlot& output = vertex.outputs[slot];
        switch (output.builtin) {
            case ir::Builtin::position:
                plan.positionSlots[output.component & 3] = slot;
                break;
            case ir::Builtin::pointSize:
                plan.pointSizeSlot = slot;
                break;
            case ir::Builtin::layer:
                plan.layerSlot = slot;
                break;
            case ir::Builtin::viewportIndex:
                plan.viewportIndexSlot = slot;
                break;
            case ir::Builtin::primitiveId:
                plan.primitiveIdSlot = slot;
                break;
            case ir::Builtin::vertexFlags:
                plan.vertexFlagsSlot = slot;
                break;
            case ir::Builtin::clipDistance:
                distanceSlot(plan.clipDistanceSlots, output.component, slot);
                break;
            case ir::Builtin::cullDistance:
                distanceSlot(plan.cullDistanceSlots, output.component, slot);
                break;
            default:
                break;
        }
    }
}

bool drawsLines(const GraphicsState& state, VkPrimitiveTopology topology) {
    switch (topology) {
        case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
            return false;
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
            return true;
        default:
            return state.polygonMode == VK_POLYGON_MODE_LINE;
    }
}

/// Inputs that come from a primitive's vertices; the others are made by the rasteriser.
bool isInterpolated(ir::Builtin builtin) {
    return builtin == ir::Builtin::user || builtin == ir::Builtin::clipDistance ||
           builtin == ir::Builtin::cullDistance || ir::isBaryCoord(builtin);
}

/// The varying of an input; made if there is none.
Varying& varyingOf(const ir::Program& vertex, const ir::InterfaceSlot& input, Plan& plan) {
    Varying varying;
    varying.interpolation = input.interpolation;
    varying.sampling = input.sampling;
    if (ir::isBaryCoord(input.builtin)) {
        varying.source = Varying::Source::weight;
        varying.number = input.component;
    } else if (ir::isPerVertex(input)) {
        varying.source = Varying::Source::ofVertex;
        varying.number = static_cast<uint8_t>(ir::vertexNumber(input));
    }
    for (uint32_t out = 0; out < vertex.outputs.size(); ++out) {
        const ir::InterfaceSlot& output = vertex.outputs[out];
        if (output.builtin == input.builtin && output.location == input.location && output.component == input.component)
            varying.vertexSlot = out;
    }
    const auto found = std::find_if(plan.varyings.begin(), plan.varyings.end(), [&](const Varying& v) {
        const bool known = varying.vertexSlot != kNoSlot || varying.source != Varying::Source::vertex;
        return known && v.vertexSlot == varying.vertexSlot && v.interpolation == varying.interpolation &&
               v.sampling == varying.sampling && v.source == varying.source && v.number == varying.number;
    });
    if (found != plan.varyings.end()) return *found;
    plan.ownVertices |= varying.source != Varying::Source::vertex;
    return plan.varyings.emplace_back(varying);
}

/// `pixel`: the part of the fragment program that runs per pixel, if it is split.
void planVaryings(const ir::Program& vertex, const ir::Program& fragment, const ir::Program* pixel, Plan& plan) {
    for (uint32_t slot = 0; slot < fragment.inputs.size(); ++slot) {
        const ir::InterfaceSlot& input = fragment.inputs[slot];
        if (pixel != nullptr && ir::isCarried(input)) {
            for (uint32_t out = 0; out < pixel->outputs.size(); ++out)
                if (pixel->outputs[out].location == input.location && pixel->outputs[out].component == input.component)
                    plan.carried.push_back({out, slot});
        } else if (isInterpolated(input.builtin)) {
            varyingOf(vertex, input, plan).fragmentSlot = slot;
        } else {
            plan.fragmentBuiltins.push_back({input.builtin, input.component, slot});
        }
    }
    for (uint32_t slot = 0; pixel != nullptr && slot < pixel->inputs.size(); ++slot) {
        const ir::InterfaceSlot& input = pixel->inputs[slot];
        if (isInterpolated(input.builtin)) {
            varyingOf(vertex, input, plan).pixelSlot = slot;
        } else {
            plan.pixelBuiltins.push_back({input.builtin, input.component, slot});
        }
    }
    std::stable_sort(plan.varyings.begin(), plan.varyings.end(), [](const Varying& a, const Varying& b) {
        return static_cast<int>(a.interpolation) < static_cast<int>(b.interpolation);
    });
    for (const Varying& varying : plan.varyings) {
        plan.smoothCount += varying.interpolation == ir::Interpolation::smooth;
        plan.linearCount += varying.interpolation == ir::Interpolation::noPerspective;
        if (varying.interpolation != ir::Interpolation::flat) {
            plan.needsBarycentrics = true;
            plan.needsCentroid |= varying.sampling == ir::Sampling::centroid && plan.samples > 1;
        }
    }
}

bool changesStencil(const VkStencilOpState& face) {
    return face.failOp != VK_STENCIL_OP_KEEP || face.passOp != VK_STENCIL_OP_KEEP ||
           face.depthFailOp != VK_STENCIL_OP_KEEP;
}

/// The test passes always, and nothing that then happens changes the stencil.
bool isIdle(const VkStencilOpState& face) {
    return face.compareOp == VK_COMPARE_OP_ALWAYS && face.passOp == VK_STENCIL_OP_KEEP &&
           face.depthFailOp == VK_STENCIL_OP_KEEP;
}

bool writesStencilRef(const ir::Program& fragment) {
    return std::any_of(fragment.outputs.begin(), fragment.outputs.end(),
                       [](const ir::InterfaceSlot& output) { return output.builtin == ir::Builtin::fragStencilRef; });
}

bool readsAttachments(const ir::Program& fragment, const AttachmentReads& reads) {
    return std::any_of(fragment.resources.begin(), fragment.resources.end(), [&](const ir::Resource& resource) {
        if (resource.kind == ir::ResourceKind::inputAttachment) return reads.asInputs || reads.asTextures;
        return reads.asTextures && !ir::isBuffer(resource.kind) && resource.kind != ir::ResourceKind::sampler;
    });
}

void planDepth(const GraphicsState& state, const ir::Program* fragment, Plan& plan) {
    DepthPlan& depth = plan.depth;
    const FormatInfo* info = findFormat(state.depthStencilFormat);
    depth.storage = depthStorage(state.depthStencilFormat);
    depth.hasStencil = info != nullptr && (info->aspects & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
    depth.clampToViewport = state.depthClampEnable;
    depth.unrestricted = state.depthUnrestricted && !isFixedPoint(depth.storage);
    const bool hasDepth = depth.storage != DepthStorage::none;
    depth.test = hasDepth && state.depthTest;
    depth.write = depth.test && state.depthWrite;
    depth.bounds = hasDepth && state.depthBoundsTest;
    const bool skipIdle = plan.skips.has(Skip::idleState);
    depth.stencil =
        depth.hasStencil && state.stencilTest && !(skipIdle && isIdle(state.stencilFront) && isIdle(state.stencilBack));
    depth.compare = static_cast<uint8_t>(state.depthCompare & 7);
    if (skipIdle && state.depthCompare == VK_COMPARE_OP_ALWAYS && !depth.write) depth.test = false;
    if (fragment == nullptr || fragment->earlyFragmentTests) return;
    // Testing early must not be visible: not through writes for fragments that the program then drops, nor
    // through side effects of fragments that should have run, nor to fragments that read what is tested.
    const bool writes =
        depth.write || (depth.stencil && (changesStencil(state.stencilFront) || changesStencil(state.stencilBack)));
    const bool dropsFragments = fragment->canDiscard || fragment->writesSampleMask || state.alphaToCoverage;
    const bool exportsStencil = depth.stencil && writesStencilRef(*fragment);
    const bool isRead = readsAttachments(*fragment, state.readsDepthStencil);
    depth.early = !fragment->writesDepth && !exportsStencil && !fragment->hasSideEffects &&
                  !(writes && dropsFragments) && !(writes && isRead);
    // Fragments of the draw that are yet to be tested can but move the depth away from those that fail; unless they
    // pass where depths differ.
    constexpr uint8_t kNotEqual = 5;
    depth.rejects = !depth.early && depth.test && !depth.bounds && !depth.stencil && !fragment->writesDepth &&
                    !fragment->hasSideEffects && depth.compare != kNotEqual && plan.skips.has(Skip::coarseDepth);
}

/// src * 1 + dst * 0: the source itself.
bool isReplace(const VkPipelineColorBlendAttachmentState& blend) {
    return blend.colorBlendOp == VK_BLEND_OP_ADD && blend.alphaBlendOp == VK_BLEND_OP_ADD &&
           blend.srcColorBlendFactor == VK_BLEND_FACTOR_ONE && blend.dstColorBlendFactor == VK_BLEND_FACTOR_ZERO &&
           blend.srcAlphaBlendFactor == VK_BLEND_FACTOR_ONE && blend.dstAlphaBlendFactor == VK_BLEND_FACTOR_ZERO;
}

void planColor(const GraphicsState& state, const ir::Program& fragment, uint32_t attachment, Isa isa, Plan& plan) {
    const VkFormat format = state.colorFormats[attachment];
    const VkPipelineColorBlendAttachmentState& blend = state.blend[attachment];
    if (format == VK_FORMAT_UNDEFINED || blend.colorWriteMask == 0) return;
    ColorPlan color;
    bool written = false;
    for (uint32_t slot = 0; slot < fragment.outputs.size(); ++slot) {
        const ir::InterfaceSlot& output = fragment.outputs[slot];
        if (output.builtin != ir::Builtin::user || output.component > 3) continue;
        if (output.location == attachment && output.index == 0) {
            color.slots[output.component] = slot;
            written = true;
        }
        if (output.location == attachment && output.index == 1) color.dualSlots[output.component] = slot;
    }
    if (!written) return;  // undefined by the specification: left as it is
    const FormatInfo& info = *findFormat(format);
    const bool skipIdle = plan.skips.has(Skip::idleState);
    color.attachment = attachment;
    color.format = format;
    color.ops = formatOps(format, isa);
    color.texelBytes = info.bytesPerTexel;
    color.blend = blend;
    const bool isSrgb = info.color.rgba[0].kind == ComponentKind::srgb;
    if (state.logicOpEnable && (!isFloat(info) || (!isSrgb && info.color.rgba[0].kind == ComponentKind::unorm) ||
                                info.color.rgba[0].kind == ComponentKind::snorm)) {
        if (skipIdle && state.logicOp == VK_LOGIC_OP_NO_OP) return;
        color.logicOp = state.logicOp;
        if (!skipIdle || state.logicOp != VK_LOGIC_OP_COPY) color.path = ColorPath::logic;
    } else if (blend.blendEnable && !state.logicOpEnable && isFloat(info) && !(skipIdle && isReplace(blend))) {
        color.path = ColorPath::blend;
    }
    const ComponentKind kind = info.color.rgba[0].kind;
    color.clampInputs = kind == ComponentKind::unorm || kind == ComponentKind::srgb || kind == ComponentKind::snorm;
    color.clampLow = kind == ComponentKind::snorm ? -1.0f : 0.0f;
    std::array<std::byte, 16> all{};
    componentBits(info, blend.colorWriteMask, color.writeBits.data());
    componentBits(info, 0xF, all.data());
    color.partialMask = std::memcmp(all.data(), color.writeBits.data(), info.bytesPerTexel) != 0;
    color.readsDestination = color.partialMask || color.path != ColorPath::store;
    plan.colors.push_back(color);
}

/// The program itself asks for inputs at other places (interpolateAtCentroid, -Sample, -Offset).
bool interpolates(const ir::Program& fragment) {
    const auto asks = [](const ir::Inst& inst) {
        return inst.op == ir::Op::interpolateAtCentroid || inst.op == ir::Op::interpolateAtSample ||
               inst.op == ir::Op::interpolateAtOffset;
    };
    return std::any_of(fragment.blocks.begin(), fragment.blocks.end(), [&](const ir::Block& block) {
        return std::any_of(block.insts.begin(), block.insts.end(), asks);
    });
}

bool readsSampleMask(const Plan& plan) {
    return std::any_of(plan.fragmentBuiltins.begin(), plan.fragmentBuiltins.end(),
                       [](const BuiltinSlot& slot) { return slot.builtin == ir::Builtin::sampleMaskIn; });
}

bool coverageIsFull(const Plan& plan) {
    return plan.samples == 1 && plan.keepsCoverage && !plan.usesQuads && !readsSampleMask(plan);
}

/// "If the fragment shader additionally specifies the PostDepthCoverage execution mode, the value of a variable
/// decorated with the SampleMask built-in reflects the coverage after the early fragment tests. Otherwise, it reflects
/// the coverage before the early fragment tests" (specification, "Early Fragment Test"). Of programs that run once per
/// sample, each run has a sample that is left.
bool maskBeforeTests(const Plan& plan, const ir::Program& fragment) {
    return plan.samples > 1 && !plan.perSample && (plan.depth.any() || plan.depth.write) &&
           !(fragment.earlyFragmentTests && fragment.postDepthCoverage) && readsSampleMask(plan);
}

/// Whether the neighbours of a pixel matter for nothing but the level of detail of an image.
bool quadsForLevels(const ir::Program& fragment) {
    const auto looksAround = [&](const ir::Inst& inst) {
        switch (inst.op) {
            case ir::Op::ddxFine:
            case ir::Op::ddyFine:
            case ir::Op::ddxCoarse:
            case ir::Op::ddyCoarse:
                return true;
            case ir::Op::image:
                return fragment.imageOps[inst.imm].kind == ir::ImageKind::queryLod;
            default:
                return false;
        }
    };
    return fragment.usesQuads && !fragment.usesSubgroups &&
           std::none_of(fragment.blocks.begin(), fragment.blocks.end(), [&](const ir::Block& block) {
               return std::any_of(block.insts.begin(), block.insts.end(), looksAround);
           });
}

void planFragments(const GraphicsState& state, const ir::Program& fragment, Isa isa, Plan& plan) {
    for (uint32_t n = 0; n < state.colorCount; ++n) planColor(state, fragment, n, isa, plan);
    for (uint32_t slot = 0; slot < fragment.outputs.size(); ++slot) {
        if (fragment.outputs[slot].builtin == ir::Builtin::fragDepth) plan.fragDepthSlot = slot;
        if (fragment.outputs[slot].builtin == ir::Builtin::fragStencilRef) plan.stencilRefSlot = slot;
        if (fragment.outputs[slot].builtin == ir::Builtin::sampleMask && fragment.outputs[slot].component == 0)
            plan.sampleMaskSlot = slot;
        if (fragment.outputs[slot].builtin == ir::Builtin::user && fragment.outputs[slot].location == 0 &&
            fragment.outputs[slot].component == 3 && fragment.outputs[slot].index == 0)
            plan.alphaSlot = slot;
    }
    const bool decidesTests = (plan.depth.any() || plan.depth.write) && !plan.depth.early;
    plan.runsFragments = !plan.colors.empty() || fragment.hasSideEffects || decidesTests || fragment.canDiscard ||
                         !plan.skips.has(Skip::unkeptFragments);
    plan.usesQuads = fragment.usesQuads || !plan.skips.has(Skip::helperInvocations);
    plan.quadsForLevels =
        plan.runsFragments && plan.skips.has(Skip::helperInvocations) && !plan.perSample && quadsForLevels(fragment);
    plan.keepsCoverage =
        !fragment.canDiscard && plan.sampleMaskSlot == kNoSlot && !plan.alphaToCoverage && !decidesTests;
    plan.countsEarly = fragment.earlyFragmentTests;
    for (const BuiltinSlot& builtin : plan.fragmentBuiltins)
        plan.usesFragCoord |= builtin.builtin == ir::Builtin::fragCoord;
    plan.coverageIsFull = coverageIsFull(plan);
    plan.maskBeforeTests = maskBeforeTests(plan, fragment);
    plan.interpolates = interpolates(fragment);
    plan.readsAttachments =
        readsAttachments(fragment, state.readsColors) || readsAttachments(fragment, state.readsDepthStencil);
    plan.ordered = plan.readsAttachments || std::any_of(plan.colors.begin(), plan.colors.end(),
                                                        [](const ColorPlan& color) { return color.readsDestination; });
}

/// Programs that know single pixels or decide about them, and samples, keep a run for each.
bool canShadeCoarsely(const Plan& plan, const ir::Program& fragment) {
    const auto isOfPixel = [](const BuiltinSlot& slot) {
        return slot.builtin == ir::Builtin::sampleMaskIn || slot.builtin == ir::Builtin::pointCoord ||
               slot.builtin == ir::Builtin::sampleId || slot.builtin == ir::Builtin::samplePosition;
    };
    return plan.samples == 1 && plan.runsFragments && plan.keepsCoverage && !plan.smoothLines &&
           !plan.readsAttachments && !fragment.writesDepth && plan.stencilRefSlot == kNoSlot &&
           !fragment.hasSideEffects && !plan.interpolates &&
           std::none_of(plan.fragmentBuiltins.begin(), plan.fragmentBuiltins.end(), isOfPixel);
}

bool packsSmall(const Plan& plan) {
    if (plan.coarse || plan.ownVertices) return false;
    if (plan.samples != 1 || (plan.sampleMask & 1) == 0 || plan.preciseInterpolation || plan.smoothLines) return false;
    if (plan.depth.bounds || plan.depth.stencil || (plan.depth.any() && !plan.depth.early)) return false;
    return !plan.runsFragments || (plan.coverageIsFull && plan.fragmentBuiltins.empty() && !plan.interpolates);
}

}  // namespace

DepthStorage depthStorage(VkFormat format) {
    switch (format) {
        case VK_FORMAT_D16_UNORM:
            return DepthStorage::d16;
        case VK_FORMAT_X8_D24_UNORM_PACK32:
        case VK_FORMAT_D24_UNORM_S8_UINT:
            return DepthStorage::d24;
        case VK_FORMAT_D32_SFLOAT:
            return DepthStorage::d32f;
        case VK_FORMAT_D32_SFLOAT_S8_UINT:
            return DepthStorage::d32fs8;
        default:
            return DepthStorage::none;
    }
}

bool isFixedPoint(DepthStorage storage) {
    return storage == DepthStorage::d16 || storage == DepthStorage::d24;
}

Plan makePlan(const GraphicsState& state, const ShaderProgram& program) {
    const ir::Program &vertex = program.vertexIr(), &last = program.lastIr();
    // Nothing behind a rasteriser that discards everything: the fragment program cannot run.
    const ir::Program* fragment = state.rasterizerDiscard ? nullptr : program.fragmentIr();
    const Accuracy& accuracy = program.accuracy();
    Plan plan;
    plan.skips = program.skips();
    plan.samples = state.samples;
    plan.sampleMask = state.sampleMask;
    plan.alphaToCoverage = state.alphaToCoverage && fragment != nullptr;
    plan.alphaToOne = state.alphaToOne;
    planStages(state, program, plan);
    plan.smoothLines =
        state.lineMode == VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT && drawsLines(state, plan.rasterTopology);
    plan.preciseInterpolation = accuracy.interpolation == InterpolationArithmetic::doubleFloat;
    // minSampleShading asks for "a minimum number" of shaded samples: all of them are shaded where more than one is.
    const bool shadesSamples = state.sampleShading && state.minSampleShading * static_cast<float>(state.samples) > 1;
    plan.perSample = state.samples > 1 && fragment != nullptr && (fragment->perSample || shadesSamples);
    plan.allAtSample = plan.perSample && shadesSamples;
    plan.splitSamples = plan.perSample && !shadesSamples && program.samplePart() != nullptr;
    const ir::Program* pixel = plan.splitSamples ? &program.pixelPart()->source() : nullptr;
    if (plan.splitSamples) fragment = &program.samplePart()->source();
    planAttributes(state, vertex, program.isa(), plan);
    planVertexOutputs(last, plan);
    if (!state.rasterizerDiscard) {
        planDepth(state, fragment, plan);
        if (fragment != nullptr) {
            planVaryings(last, *fragment, pixel, plan);
            planFragments(state, *fragment, program.isa(), plan);
            plan.usesQuads = plan.usesQuads || (pixel != nullptr && pixel->usesQuads);
            plan.coarse = accuracy.shading == ShadingRate::twoByTwo && canShadeCoarsely(plan, *fragment);
        }
    }
    // Flat inputs have no arithmetic, and nobody else asks the planes.
    if (plan.smoothCount + plan.linearCount == 0 && !plan.usesFragCoord && !plan.depth.any() && !plan.depth.write)
        plan.preciseInterpolation = false;
    plan.packsSmall = packsSmall(plan);
    collectFacts(state, program, plan);
    return plan;
}

Plan planWithoutQuads(Plan plan) {
    plan.usesQuads = plan.quadsForLevels = false;
    plan.coverageIsFull = coverageIsFull(plan);
    plan.packsSmall = packsSmall(plan);
    return plan;
}

}  // namespace vernier
