// A textured cube with its edges drawn over it: depth test, culling, two programs, index buffers, lines with depth
// bias.
#include <array>

#include "samples/common/app.h"

namespace {

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 textureCoordinate;
layout(location = 0) out vec2 uv;
void main() {
    uv = textureCoordinate;
    gl_Position = transform * vec4(position, 1);
})";

constexpr const char* kTextured = R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(image, uv); })";

constexpr const char* kEdges = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(1, 0.85, 0.2, 1); })";

struct Vertex {
    glm::vec3 position;
    glm::vec2 uv;
};

/// Six faces of four vertices each, counter-clockwise seen from outside.
std::vector<Vertex> cubeVertices() {
    std::vector<Vertex> vertices;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f})
            for (int corner = 0; corner < 4; ++corner) {
                const glm::vec2 uv(corner & 1, corner >> 1);
                glm::vec3 position;
                position[axis] = side;
                position[(axis + 1) % 3] = (uv.x * 2 - 1) * side;
                position[(axis + 2) % 3] = uv.y * 2 - 1;
                vertices.push_back({position, uv});
            }
    return vertices;
}

/// `pattern` once per face.
template <size_t Count>
std::vector<uint16_t> faceIndices(const std::array<uint16_t, Count>& pattern) {
    std::vector<uint16_t> indices;
    for (uint16_t face = 0; face < 6; ++face)
        for (const uint16_t index : pattern) indices.push_back(static_cast<uint16_t>(face * 4 + index));
    return indices;
}

}  // namespace

int main(int argc, char** argv) {
    samples::App app(argc, argv, "Textured cube");
    VnDevice device = app.device();
    const VnProgram textured = app.program(kVertex, kTextured), edges = app.program(kVertex, kEdges);
    const VnView texture = app.texture(128, 128, samples::checkerTexels(128, 8, 0xFF2060C0, 0xFFF0F0F0));
    const VnBuffer vertices = app.buffer(cubeVertices());
    const std::vector<uint16_t> triangleIndices = faceIndices(std::array<uint16_t, 6>{0, 1, 2, 2, 1, 3});
    const std::vector<uint16_t> lineIndices = faceIndices(std::array<uint16_t, 8>{0, 1, 1, 3, 3, 2, 2, 0});
    const VnBuffer triangles = app.buffer(triangleIndices), lines = app.buffer(lineIndices);

    VnSamplerDesc samplerDesc{};
    samplerDesc.magFilter = samplerDesc.minFilter = VK_FILTER_LINEAR;
    samplerDesc.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    VnSampler sampler{};
    vnCreateSampler(device, &samplerDesc, &sampler);

    const VnVertexAttribute attributes[] = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                                            {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv)}};
    const VnVertexBinding binding{sizeof(Vertex), 0};
    VnVertexLayoutDesc layoutDesc{};
    layoutDesc.attributes = attributes;
    layoutDesc.attributeCount = 2;
    layoutDesc.bindings = &binding;
    layoutDesc.bindingCount = 1;
    VnVertexLayout layout{};
    vnCreateVertexLayout(device, &layoutDesc, &layout);

    VnDepthStencilStateDesc depthDesc{};
    depthDesc.depthTest = depthDesc.depthWrite = 1;
    depthDesc.depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
    VnDepthStencilState depth{};
    vnCreateDepthStencilState(device, &depthDesc, &depth);

    return app.run({0.02f, 0.02f, 0.03f, 1}, [&](const samples::Frame& frame) {
        const glm::mat4 view = glm::lookAt(glm::vec3(0, 2.2f, 4.2f), glm::vec3(0), glm::vec3(0, 1, 0));
        const glm::mat4 model = samples::rotation(frame.seconds * 0.8 + 0.6, {0, 1, 0});
        const glm::mat4 transform = samples::perspective(0.9f, app.aspect(), 0.1f, 100) * view * model;
        // The edges lie in the faces: a slightly larger cube lifts them off.
        const glm::mat4 lifted = transform * glm::scale(glm::mat4(1), glm::vec3(1.003f));

        VnContext context = app.context();
        vnBindVertexLayout(context, layout);
        vnBindVertexBuffer(context, 0, vertices, 0);
        vnBindDepthStencilState(context, depth);
        vnBindProgram(context, textured);
        vnBindTexture(context, 0, 0, 0, texture, sampler);
        vnPushConstants(context, 0, &transform, sizeof transform);
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 0);
        vnBindIndexBuffer(context, triangles, 0, VK_INDEX_TYPE_UINT16);
        vnDrawIndexed(context, static_cast<uint32_t>(triangleIndices.size()), 1, 0, 0, 0);

        vnBindProgram(context, edges);
        vnPushConstants(context, 0, &lifted, sizeof lifted);
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 0);
        vnBindIndexBuffer(context, lines, 0, VK_INDEX_TYPE_UINT16);
        vnDrawIndexed(context, static_cast<uint32_t>(lineIndices.size()), 1, 0, 0, 0);
    });
}
