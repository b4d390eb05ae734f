#include "runtime/geometry/topology.h"

#include <algorithm>
#include <cstring>

#include "runtime/geometry/draw_call.h"

namespace vernier {
namespace {

template <class T>
uint32_t loadIndex(const IndexStream& indices, uint64_t n) {
    T value = 0;
    if ((n + 1) * sizeof(T) <= indices.size) std::memcpy(&value, indices.data + n * sizeof(T), sizeof(T));
    return value;
}

uint32_t restartIndex(VkIndexType type) {
    switch (type) {
        case VK_INDEX_TYPE_UINT8_EXT:
            return 0xFF;
        case VK_INDEX_TYPE_UINT16:
            return 0xFFFF;
        default:
            return 0xFFFFFFFF;
    }
}

}  // namespace

uint32_t verticesPerPrimitive(VkPrimitiveTopology topology) {
    switch (topology) {
        case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
            return 1;
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
            return 2;
        default:
            return 3;
    }
}

uint32_t primitiveCount(VkPrimitiveTopology topology, uint32_t vertices, uint32_t patchVertices) {
    switch (topology) {
        case VK_PRIMITIVE_TOPOLOGY_PATCH_LIST:
            return vertices / patchVertices;
        case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
            return vertices;
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
            return vertices / 2;
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
            return vertices < 2 ? 0 : vertices - 1;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
            return vertices / 3;
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
            return vertices / 4;
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
            return vertices < 4 ? 0 : vertices - 3;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
            return vertices / 6;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY:
            return vertices < 6 ? 0 : (vertices - 4) / 2;
        default:
            return vertices < 3 ? 0 : vertices - 2;
    }
}

PrimitiveVertices primitiveVertices(VkPrimitiveTopology topology, uint32_t primitive) {
    const uint32_t p = primitive;
    switch (topology) {
        case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
            return {{p, p, p}, 0, 0};
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
            return {{2 * p, 2 * p + 1, 2 * p}, 0, 1};
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
            return {{p, p + 1, p}, 0, 1};
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
            return {{3 * p, 3 * p + 1, 3 * p + 2}, 0, 2};
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN:
            return {{p + 1, p + 2, 0}, 0, 1};
        // The adjacent vertices are for geometry shaders: without one they are read past.
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
            return {{4 * p + 1, 4 * p + 2, 4 * p + 1}, 0, 1};
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
            return {{p + 1, p + 2, p + 1}, 0, 1};
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
            return {{6 * p, 6 * p + 2, 6 * p + 4}, 0, 2};
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY:
            return {{2 * p, 2 * p + 2 + 2 * (p & 1), 2 * p + 4 - 2 * (p & 1)}, 0, 2 - (p & 1)};
        default:  // a strip: every other triangle swaps its last two vertices to keep the winding
            return {{p, p + 1 + (p & 1), p + 2 - (p & 1)}, 0, 2 - (p & 1)};
    }
}

void inputVertices(VkPrimitiveTopology topology, uint32_t primitive, uint32_t primitives, uint32_t* vertices) {
    const uint32_t p = primitive;
    const auto consecutive = [vertices](uint32_t first, uint32_t count) {
        for (uint32_t v = 0; v < count; ++v) vertices[v] = first + v;
    };
    switch (topology) {
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
            return consecutive(4 * p, 4);
        case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
            return consecutive(p, 4);
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
            return consecutive(6 * p, 6);
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY: {
            // "Triangle Strips With Adjacency": the first and the last triangle have neighbours of their own.
            const uint32_t first = 2 * p, before = p == 0 ? 1 : first - 2;
            const uint32_t behind = p + 1 == primitives ? first + 5 : first + 6;
            const uint32_t even[] = {first, before, first + 2, behind, first + 4, first + 3};
            const uint32_t odd[] = {first, first + 3, first + 4, behind, first + 2, before};
            std::copy_n(p % 2 == 0 ? even : odd, 6, vertices);
            return;
        }
        default:
            std::copy_n(primitiveVertices(topology, primitive).vertex.data(), verticesPerPrimitive(topology), vertices);
    }
}

uint32_t fetchIndex(const DrawCall& call, uint32_t n) {
    const uint64_t number = uint64_t{call.first} + n;
    switch (call.indices.type) {
        case VK_INDEX_TYPE_UINT8_EXT:
            return loadIndex<uint8_t>(call.indices, number);
        case VK_INDEX_TYPE_UINT16:
            return loadIndex<uint16_t>(call.indices, number);
        default:
            return loadIndex<uint32_t>(call.indices, number);
    }
}

std::vector<VertexRun> vertexRuns(const DrawCall& call, VkPrimitiveTopology topology, bool restart) {
    std::vector<VertexRun> runs;
    uint32_t primitives = 0;
    const auto add = [&](uint32_t first, uint32_t count) {
        const uint32_t n = primitiveCount(topology, count, call.pipeline->state().patchControlPoints);
        if (n == 0) return;
        runs.push_back({first, primitives, n, count});
        primitives += n;
    };
    if (!restart || call.indices.data == nullptr) {
        add(0, call.count);
        return runs;
    }
    const uint32_t marker = restartIndex(call.indices.type);
    uint32_t first = 0;
    for (uint32_t n = 0; n < call.count; ++n) {
        if (fetchIndex(call, n) != marker) continue;
        add(first, n - first);
        first = n + 1;
    }
    add(first, call.count - first);
    return runs;
}

}  // namespace vernier
