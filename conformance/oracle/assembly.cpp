#include "conformance/oracle/assembly.h"

#include "conformance/oracle/geometry_stage.h"
#include "conformance/oracle/quantise.h"
#include "conformance/oracle/tessellation_stage.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

namespace vernier::conformance::exact {

namespace {

using Interpreter = reference::Interpreter<double>;
using Values = reference::InterfaceValues<double>;

struct VertexFetcher {
    const Scene& scene;
    const SceneDraw& draw;
    const ScenePipeline& pipeline;

    // Reads outside the buffer give 0, as with robust access.
    Values fetch(uint32_t vertexIndex, uint32_t instance) const {
        Values values;
        for (const VkVertexInputAttributeDescription& attribute : pipeline.vertexAttributes) {
            const PixelFormat* format = findPixelFormat(attribute.format);
            reference::Texel<double> texel = defaults(format);
            const std::byte* bytes = address(attribute, vertexIndex, instance, format);
            if (bytes) {
                for (const Component& c : format->all()) {
                    const uint64_t code = extractBits(bytes, c.offset, c.bits);
                    const double number = decodeNumber(c, code);
                    texel[c.channel] =
                        format->isInteger() ? integer(number) : reference::Scalar<double>::ofNumber(number);
                }
            }
            values.locations[attribute.location] = texel;
        }
        return values;
    }

    static reference::Scalar<double> integer(double number) {
        return reference::Scalar<double>::ofBits(static_cast<uint32_t>(static_cast<int64_t>(number)));
    }

    static reference::Texel<double> defaults(const PixelFormat* format) {
        reference::Texel<double> texel{};
        texel[3] = format && format->isInteger() ? integer(1) : reference::Scalar<double>::ofNumber(1);
        return texel;
    }

    const std::byte* address(const VkVertexInputAttributeDescription& attribute, uint32_t vertexIndex,
                             uint32_t instance, const PixelFormat* format) const {
        if (!format) return nullptr;
        for (const VkVertexInputBindingDescription& binding : pipeline.vertexBindings) {
            if (binding.binding != attribute.binding) continue;
            for (const SceneVertexBuffer& source : draw.vertexBuffers) {
                if (source.binding != binding.binding || source.buffer >= scene.buffers.size()) continue;
                const Bytes& data = scene.buffers[source.buffer].data;
                const uint64_t element = binding.inputRate == VK_VERTEX_INPUT_RATE_INSTANCE ? instance : vertexIndex;
                const uint64_t offset = source.offset + element * binding.stride + attribute.offset;
                return offset + format->bytes <= data.size() ? data.data() + offset : nullptr;
            }
        }
        return nullptr;
    }
};

// The draw's vertex numbers in order; nothing marks a primitive restart.
std::vector<std::optional<uint32_t>> vertexOrder(const Scene& scene, const SceneDraw& draw,
                                                 const ScenePipeline& pipeline) {
    std::vector<std::optional<uint32_t>> order;
    for (uint32_t i = 0; i < draw.count; ++i) {
        if (draw.indexBuffer == kNone) {
            order.push_back(draw.first + i);
            continue;
        }
        const size_t size = draw.indexType == VK_INDEX_TYPE_UINT32      ? 4
                            : draw.indexType == VK_INDEX_TYPE_UINT8_EXT ? 1
                                                                        : 2;
        const Bytes& data = scene.buffers[draw.indexBuffer].data;
        const uint64_t offset = draw.indexOffset + (uint64_t{draw.first} + i) * size;
        const uint64_t index =
            offset + size <= data.size() ? extractBits(data.data() + offset, 0, static_cast<unsigned>(size * 8)) : 0;
        const bool restart = pipeline.primitiveRestart && index == (uint64_t{1} << (size * 8)) - 1;
        if (restart) {
            order.push_back(std::nullopt);
        } else {
            order.push_back(static_cast<uint32_t>(index) + static_cast<uint32_t>(draw.vertexOffset));
        }
    }
    return order;
}

Result<Values> shadeVertex(const Interpreter& shader, Values inputs, uint32_t vertexIndex, uint32_t instance,
                           const SceneDraw& draw, ShaderResources& resources, uint32_t viewIndex) {
    const auto set = [&inputs](spv::BuiltIn builtin, uint32_t value) {
        inputs.setInt(builtin, static_cast<int32_t>(value));
    };
    set(spv::BuiltInVertexIndex, vertexIndex);
    set(spv::BuiltInInstanceIndex, instance);
    set(spv::BuiltInBaseVertex, draw.indexBuffer == kNone ? draw.first : static_cast<uint32_t>(draw.vertexOffset));
    set(spv::BuiltInBaseInstance, draw.firstInstance);
    set(spv::BuiltInDrawIndex, 0);
    set(spv::BuiltInViewIndex, viewIndex);
    const auto outcome = runAlone(shader, inputs, resources);
    if (!outcome) return outcome.error();
    return outcome->outputs;
}

}  // namespace

ShadedVertex shadedVertex(const Values& outputs, const ScenePipeline& pipeline) {
    ShadedVertex vertex;
    const auto& builtins = outputs.builtins;
    if (const auto position = builtins.find(spv::BuiltInPosition); position != builtins.end()) {
        for (size_t i = 0; i < 4 && i < position->second.size(); ++i) vertex.position[i] = position->second[i].number;
    }
    if (const auto clip = builtins.find(spv::BuiltInClipDistance); clip != builtins.end()) {
        for (const auto& distance : clip->second) vertex.clipDistances.push_back(distance.number);
    }
    const auto first = [&](spv::BuiltIn builtin) -> const reference::Scalar<double>* {
        const auto found = builtins.find(builtin);
        return found == builtins.end() || found->second.empty() ? nullptr : &found->second[0];
    };
    if (const auto* size = first(spv::BuiltInPointSize)) vertex.pointSize = size->number;
    if (const auto* layer = first(spv::BuiltInLayer)) vertex.layer = static_cast<uint32_t>(layer->bits);
    if (const auto* id = first(spv::BuiltInPrimitiveId)) vertex.primitiveId = static_cast<uint32_t>(id->bits);
    if (const auto* viewport = first(spv::BuiltInViewportIndex))
        vertex.viewport = static_cast<uint32_t>(viewport->bits);
    vertex.varyings = outputs.locations;
    // VK_EXT_depth_clip_control: depths from -w to w end up where (z + w) / 2 from 0 to w would.
    if (pipeline.depthNegativeOneToOne) vertex.position[2] = (vertex.position[2] + vertex.position[3]) / 2;
    return vertex;
}

namespace {

/// What the run that has ended stores, invocation by invocation.
void keepStores(ShaderResources& resources, size_t invocations) {
    for (uint32_t invocation = 0; invocation < invocations; ++invocation) {
        for (const WordWrite& write : combineWords(resources.wordRuns, invocation, ValueError{}, resources.flags))
            resources.wordWrites.push_back(write);
    }
    resources.flags = 0;
}

}  // namespace

Result<reference::Outcome<double>> runAlone(const Interpreter& shader, const Values& inputs,
                                            ShaderResources& resources) {
    resources.resetRuns();
    resources.startRun();
    auto outcome = shader.run(inputs, resources);
    if (outcome) keepStores(resources, 1);
    return outcome;
}

Result<Values> runPatch(const Interpreter& shader, const Values& inputs, ShaderResources& resources) {
    resources.resetRuns();
    resources.startRun();
    auto outputs = shader.runPatch(inputs, resources);
    if (outputs) keepStores(resources, outputs->vertices.size());
    return outputs;
}

Result<reference::Interpreter<double>> createStage(const SceneShader& shader, spv::ExecutionModel model) {
    const auto module = parseShader(shader);
    if (!module) return module.error();
    if (usesAtomicResults(shader.spirv)) return unsupported("oracle: what atomic operations return");
    return Interpreter::create(*module, model);
}

Result<reference::Module> parseShader(const SceneShader& shader) {
    reference::Module::Specialization specialization;
    for (const VkSpecializationMapEntry& entry : shader.specialization) {
        if (entry.offset + entry.size > shader.specializationData.size() || entry.size > 8) {
            return invalidArgument("oracle: specialization constant " + std::to_string(entry.constantID) +
                                   " reaches outside its data");
        }
        uint64_t value = 0;
        std::memcpy(&value, shader.specializationData.data() + entry.offset, entry.size);
        specialization[entry.constantID] = value;
    }
    return reference::Module::parse(shader.spirv, specialization);
}

std::vector<std::array<uint32_t, 3>> trianglesOf(VkPrimitiveTopology topology, uint32_t count) {
    std::vector<std::array<uint32_t, 3>> result;
    switch (topology) {
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
            for (uint32_t i = 0; i + 2 < count; i += 3) result.push_back({i, i + 1, i + 2});
            break;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP:
            for (uint32_t i = 0; i + 2 < count; ++i) result.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
            break;
        default:  // fan
            for (uint32_t i = 0; i + 2 < count; ++i) result.push_back({i + 1, i + 2, 0});
            break;
    }
    return result;
}

namespace {

/// The primitives of vertices that follow each other without a restart, by vertex number.
std::vector<AssembledPrimitive> primitivesOf(VkPrimitiveTopology topology, uint32_t count) {
    std::vector<AssembledPrimitive> result;
    switch (topology) {
        case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
            for (uint32_t i = 0; i < count; ++i) result.push_back({{i}, 1});
            break;
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
            for (uint32_t i = 0; i + 1 < count; i += 2) result.push_back({{i, i + 1}, 2});
            break;
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
            for (uint32_t i = 0; i + 1 < count; ++i) result.push_back({{i, i + 1}, 2});
            break;
        // With adjacency: the other vertices are read past.
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
            for (uint32_t i = 0; i + 3 < count; i += 4) result.push_back({{i + 1, i + 2}, 2});
            break;
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
            for (uint32_t i = 0; i + 3 < count; ++i) result.push_back({{i + 1, i + 2}, 2});
            break;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
            for (uint32_t i = 0; i + 5 < count; i += 6) result.push_back({{i, i + 2, i + 4}, 3});
            break;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY:
            for (uint32_t i = 0; 2 * i + 5 < count; ++i) {
                result.push_back({{2 * i, 2 * (i + 1 + i % 2), 2 * (i + 2 - i % 2)}, 3});
            }
            break;
        default:
            for (const auto& triangle : trianglesOf(topology, count)) result.push_back({triangle, 3});
            break;
    }
    const bool lineStrip =
        topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP || topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY;
    for (AssembledPrimitive& primitive : result) {
        primitive.startsStrip = !lineStrip || primitive.vertices[0] == result.front().vertices[0];
    }
    return result;
}

}  // namespace

Result<DrawGeometry> assembleDraw(const Scene& scene, const SceneDraw& draw, ShaderResources& resources,
                                  uint32_t viewIndex) {
    const ScenePipeline& pipeline = scene.pipelines[draw.pipeline];
    for (const VkVertexInputAttributeDescription& attribute : pipeline.vertexAttributes) {
        if (!findPixelFormat(attribute.format)) {
            return unsupported("oracle: vertex attribute at location " + std::to_string(attribute.location) +
                               " has format " + std::to_string(attribute.format) +
                               ", which is not in the oracle's table");
        }
    }
    const auto shader = createStage(scene.shaders[pipeline.vertexShader], spv::ExecutionModelVertex);
    if (!shader) return shader.error();
    std::optional<GeometryStage> stage;
    if (pipeline.geometryShader != kNone) {
        auto made = GeometryStage::create(scene.shaders[pipeline.geometryShader], pipeline, resources, viewIndex);
        if (!made) return made.error();
        stage = std::move(*made);
    }
    std::optional<TessellationStage> tessellation;
    if (pipeline.topology == VK_PRIMITIVE_TOPOLOGY_PATCH_LIST) {
        auto made = TessellationStage::create(scene, pipeline, resources, viewIndex);
        if (!made) return made.error();
        tessellation = std::move(*made);
    }
    const bool further = stage || tessellation;  // stages between vertices and rasterisation

    const VertexFetcher fetcher{scene, draw, pipeline};
    const auto order = vertexOrder(scene, draw, pipeline);
    DrawGeometry geometry;
    for (uint32_t i = 0; i < draw.instances; ++i) {
        const uint32_t instance = draw.firstInstance + i;
        std::map<uint32_t, uint32_t> shaded;  // vertex number -> index into geometry.vertices, or into `outputs`
        std::vector<Values> outputs;          // of vertices for further stages
        std::vector<uint32_t> run;            // vertices since the last restart
        uint32_t primitiveId = 0;
        const auto flush = [&]() -> Status {
            if (further) {
                const Status status =
                    tessellation ? tessellation->run(outputs, run, primitiveId, stage ? &*stage : nullptr, geometry)
                                 : stage->run(outputs, run, primitiveId, geometry);
                run.clear();
                return status;
            }
            for (AssembledPrimitive primitive : primitivesOf(pipeline.topology, static_cast<uint32_t>(run.size()))) {
                // Vulkan, Provoking Vertex: the first one in the order of the topology, or the vertex that comes last.
                const auto end = primitive.vertices.begin() + primitive.count;
                const uint32_t last = *std::max_element(primitive.vertices.begin(), end);
                primitive.provoking = run[pipeline.provokingVertexLast ? last : primitive.vertices[0]];
                std::for_each(primitive.vertices.begin(), end, [&](uint32_t& vertex) { vertex = run[vertex]; });
                primitive.id = primitiveId++;
                geometry.primitives.push_back(primitive);
            }
            run.clear();
            return {};
        };
        for (const std::optional<uint32_t>& number : order) {
            if (!number) {
                if (Status status = flush(); !status) return status.error();
                continue;
            }
            const size_t next = further ? outputs.size() : geometry.vertices.size();
            const auto [entry, fresh] = shaded.try_emplace(*number, static_cast<uint32_t>(next));
            if (fresh) {
                auto vertex = shadeVertex(*shader, fetcher.fetch(*number, instance), *number, instance, draw, resources,
                                          viewIndex);
                if (!vertex) return vertex.error();
                if (further) {
                    outputs.push_back(std::move(*vertex));
                } else {
                    geometry.vertices.push_back(shadedVertex(*vertex, pipeline));
                }
            }
            run.push_back(entry->second);
        }
        if (Status status = flush(); !status) return status.error();
    }
    return geometry;
}

}  // namespace vernier::conformance::exact
