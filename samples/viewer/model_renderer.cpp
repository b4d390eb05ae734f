#include "samples/viewer/model_renderer.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace samples {
namespace {

/// The exponent of a highlight that is about as wide as the roughness says.
float exponentOf(float roughness) {
    const float r = roughness * roughness;
    return glm::clamp(2 / (r * r) - 2, 1.0f, 2000.0f);
}

glm::vec3 centerOf(const MeshData& mesh) {
    glm::vec3 sum(0);
    for (const MeshVertex& vertex : mesh.vertices) sum += vertex.position;
    return sum / static_cast<float>(mesh.vertices.size());
}

}  // namespace

ModelRenderer::ModelRenderer(App& app) : app_(app) {
    using namespace viewer_shaders;
    const auto fragment = [&](const std::string& glsl) { return app.shader(VK_SHADER_STAGE_FRAGMENT_BIT, glsl); };
    vertex_ = app.shader(VK_SHADER_STAGE_VERTEX_BIT, kModelVertex);
    lit_ = fragment(kModelFragment);
    litMasked_ = fragment(kModelMaskedFragment);
    mappedVertex_ = app.shader(VK_SHADER_STAGE_VERTEX_BIT, kMappedVertex);
    mapped_ = fragment(kMappedFragment);
    mappedMasked_ = fragment(kMappedMaskedFragment);
    count_ = fragment(kCountFragment);
    countMasked_ = fragment(kCountMaskedFragment);
    plain_ = fragment(kPlainFragment);
    layout_ = app.meshLayout();
    mappedLayout_ = app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(MeshVertex, position)},
                                {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(MeshVertex, normal)},
                                {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(MeshVertex, uv)},
                                {3, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(VertexExtras, color)},
                                {4, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(VertexExtras, tangent)}},
                               {{sizeof(MeshVertex), 0}, {sizeof(VertexExtras), 0}});
    writeDepth_ = app.depthState();
    readDepth_ = app.depthState(false);
    edgeDepth_ = app.depthState(false, VK_COMPARE_OP_LESS_OR_EQUAL);
    twoSided_ = app.rasterState(VK_CULL_MODE_NONE);
    oneSided_ = app.rasterState(VK_CULL_MODE_BACK_BIT);
    VnRasterStateDesc edges{};
    edges.polygonMode = VK_POLYGON_MODE_LINE;
    edges.depthBias = 1;
    edges.depthBiasConstant = -8;
    edges.depthBiasSlope = -1;
    must(vnCreateRasterState(app.device(), &edges, &edges_));
    VnBlendStateDesc over{};
    over.attachments[0].enable = 1;  // source over, which leaves an opaque picture opaque
    must(vnCreateBlendState(app.device(), &over, &over_));
    add_ = app.blendState(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE);
    white_ = upload({{1, 1, {0xFFFFFFFF}}});
    straight_ = upload({{1, 1, {0xFFFF8080}}, true});
}

void ModelRenderer::release() {
    for (const Part& part : parts_) {
        vnDestroyBuffer(app_.device(), part.mesh.vertices);
        vnDestroyBuffer(app_.device(), part.mesh.indices);
        if (part.extras.id) vnDestroyBuffer(app_.device(), part.extras);
    }
    for (const Texture& texture : textures_)
        if (texture.image.id) vnDestroyImage(app_.device(), texture.image);
    parts_.clear();
    textures_.clear();
}

ModelRenderer::Texture ModelRenderer::upload(const SceneTexture& from) {
    const Picture& picture = from.picture;
    VnImageDesc desc{};
    desc.format = from.linear ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_R8G8B8A8_SRGB;
    desc.width = picture.width;
    desc.height = picture.height;
    desc.mipLevels = VN_ALL_MIPS;
    Texture texture;
    if (vnCreateImage(app_.device(), &desc, &texture.image) != VN_SUCCESS) return {};
    must(vnUpdateImage(app_.context(), texture.image, nullptr, picture.texels.data(), picture.texels.size() * 4));
    if (picture.width > 1 || picture.height > 1) must(vnGenerateMips(app_.context(), texture.image));
    must(vnGetImageView(app_.device(), texture.image, &texture.view));
    return texture;
}

void ModelRenderer::setScene(Scene& scene) {
    release();
    materials_ = scene.materials;
    for (const SceneTexture& texture : scene.textures) {
        textures_.push_back(upload(texture));
        if (textures_.back().view.id == 0)
            scene.notes.push_back("a texture of " + std::to_string(texture.picture.width) + " x " +
                                  std::to_string(texture.picture.height) + " texels is too large for the device");
    }
    for (const ScenePart& from : scene.parts)
        parts_.push_back({app_.mesh(from.mesh), from.extras.empty() ? VnBuffer{} : app_.buffer(from.extras),
                          from.material, centerOf(from.mesh)});
}

void ModelRenderer::moveParts(const Scene& scene) {
    const auto update = [&](VnBuffer buffer, const auto& elements) {
        must(vnUpdateBuffer(app_.context(), buffer, 0, elements.data(), elements.size() * sizeof elements[0]));
    };
    for (size_t i = 0; i < parts_.size(); ++i) {
        const ScenePart& from = scene.parts[i];
        update(parts_[i].mesh.vertices, from.mesh.vertices);
        update(parts_[i].mesh.indices, from.mesh.indices);  // mirrored, perhaps
        if (!from.extras.empty()) update(parts_[i].extras, from.extras);
        parts_[i].center = centerOf(from.mesh);
    }
}

VnProgram ModelRenderer::link(VnShader vertex, VnShader fragment, const DialPosition& dial) {
    VnProgramDesc desc{};
    desc.vertex = vertex;
    desc.fragment = fragment;
    desc.profile = dial.profile;
    desc.axes = dial.axes.c_str();
    VnProgram program{};
    must(vnCreateProgram(app_.device(), &desc, &program));
    return program;
}

ModelRenderer::Programs& ModelRenderer::programsOf(const DialPosition& dial) {
    const std::string key = std::to_string(dial.profile) + " " + dial.axes;
    const auto found = programs_.find(key);
    if (found != programs_.end()) return found->second;
    Programs made;
    made.lit = link(vertex_, lit_, dial);
    made.litMasked = link(vertex_, litMasked_, dial);
    made.mapped = link(mappedVertex_, mapped_, dial);
    made.mappedMasked = link(mappedVertex_, mappedMasked_, dial);
    made.count = link(vertex_, count_, dial);
    made.countMasked = link(vertex_, countMasked_, dial);
    made.plain = link(vertex_, plain_, dial);
    return programs_.emplace(key, made).first->second;
}

VnSampler ModelRenderer::samplerOf(const MaterialTexture& texture) {
    const uint32_t key = static_cast<uint32_t>(texture.filter) | static_cast<uint32_t>(texture.addressU) << 8 |
                         static_cast<uint32_t>(texture.addressV) << 16;
    if (const auto found = samplers_.find(key); found != samplers_.end()) return found->second;
    VnSamplerDesc desc{};
    desc.magFilter = texture.filter;
    desc.minFilter = VK_FILTER_LINEAR;
    desc.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    desc.addressU = texture.addressU;
    desc.addressV = texture.addressV;
    // The dial's own axis says how many of them are taken. Anisotropic filters are linear ones.
    if (texture.filter == VK_FILTER_LINEAR) desc.maxAnisotropy = 16;
    VnSampler sampler{};
    must(vnCreateSampler(app_.device(), &desc, &sampler));
    return samplers_[key] = sampler;
}

std::vector<const ModelRenderer::Part*> ModelRenderer::inOrder(const glm::vec3& eye) const {
    std::vector<const Part*> order;
    for (const Part& part : parts_) order.push_back(&part);
    const auto alphaOf = [&](const Part* part) { return materials_[part->material].alpha; };
    const auto farness = [&](const Part* part) {
        const glm::vec3 to = part->center - eye;
        return alphaOf(part) == Alpha::kBlended ? glm::dot(to, to) : 0;
    };
    std::stable_sort(order.begin(), order.end(), [&](const Part* a, const Part* b) {
        return alphaOf(a) != alphaOf(b) ? alphaOf(a) < alphaOf(b) : farness(a) > farness(b);
    });
    return order;
}

void ModelRenderer::bind(const Part& part) {
    VnContext context = app_.context();
    const SceneMaterial& material = materials_[part.material];
    vnBindVertexLayout(context, layout_);
    vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 0);
    vnBindRasterState(context, material.twoSided ? twoSided_ : oneSided_);
    vnBindDepthStencilState(context, material.alpha == Alpha::kBlended ? readDepth_ : writeDepth_);
    bindTexture(0, material.texture, white_);
}

void ModelRenderer::bindTexture(uint32_t binding, const MaterialTexture& texture, const Texture& otherwise) {
    const bool textured = texture.texture >= 0 && textures_[static_cast<size_t>(texture.texture)].view.id != 0;
    const Texture& bound = textured ? textures_[static_cast<size_t>(texture.texture)] : otherwise;
    vnBindTexture(app_.context(), 0, binding, 0, bound.view, samplerOf(texture));
}

/// The program that lights a part, with what it wants beyond bind().
void ModelRenderer::bindLit(const Part& part, const Programs& programs) {
    const SceneMaterial& material = materials_[part.material];
    const bool masked = material.alpha == Alpha::kMasked;
    if (part.extras.id == 0) {
        vnBindProgram(app_.context(), masked ? programs.litMasked : programs.lit);
        return;
    }
    vnBindProgram(app_.context(), masked ? programs.mappedMasked : programs.mapped);
    vnBindVertexLayout(app_.context(), mappedLayout_);
    vnBindVertexBuffer(app_.context(), 1, part.extras, 0);
    bindTexture(1, material.surfaceTexture, white_);
    bindTexture(2, material.emissionTexture, white_);
    bindTexture(3, material.normalTexture, straight_);
}

void ModelRenderer::push(const Part& part, const ModelLook& look, float weight) {
    const SceneMaterial& material = materials_[part.material];
    // Smooth surfaces gather the light that rough ones spread.
    constexpr float kStrength = 1.6f;
    const glm::vec4 plain(material.metallic, exponentOf(material.roughness), (1 - material.roughness) * kStrength, 0);
    const glm::vec4 mapped(material.metallic, material.roughness, kStrength, material.normalScale);
    app_.push(viewer_shaders::ModelPush{look.transform, glm::vec4(look.eye, weight), material.color,
                                        glm::vec4(material.emission, material.cutoff),
                                        part.extras.id == 0 ? plain : mapped});
}

std::string ModelRenderer::explain(VnExplainFormat format) {
    size_t length = 0;
    must(vnExplain(app_.context(), format, nullptr, 0, &length));
    std::string text(length + 1, '\0');
    must(vnExplain(app_.context(), format, text.data(), text.size(), &length));
    text.resize(length);
    return text;
}

void ModelRenderer::drawLit(const ModelLook& look, const DialPosition& dial, std::string* explained) {
    const Programs& programs = programsOf(dial);
    for (const Part* part : inOrder(look.eye)) {
        const Alpha alpha = materials_[part->material].alpha;
        bind(*part);
        bindLit(*part, programs);
        vnBindBlendState(app_.context(), alpha == Alpha::kBlended ? over_ : VnBlendState{});
        push(*part, look, 0);
        if (explained) *std::exchange(explained, nullptr) = explain(VN_EXPLAIN_TEXT);
        app_.draw(part->mesh);
    }
    vnBindBlendState(app_.context(), VnBlendState{});
}

float ModelRenderer::costOf(const Part& part, const DialPosition& dial) {
    Programs& programs = programsOf(dial);
    const size_t alpha = static_cast<size_t>(materials_[part.material].alpha);
    std::optional<float>& cost = programs.cost[part.extras.id != 0][alpha];
    if (cost) return *cost;
    bindLit(part, programs);
    cost = 0.0f;
    for (const nlohmann::json& fact : nlohmann::json::parse(explain(VN_EXPLAIN_JSON))) {
        if (!fact.contains("rates") || fact["what"].get<std::string>().find("fragment program") == std::string::npos)
            continue;
        // All but what runs once per draw.
        for (const auto& [rate, share] : fact["rates"].items())
            if (rate != "constant" && rate != "draw") *cost += share["cost"].get<float>();
    }
    return *cost;
}

void ModelRenderer::drawCounts(const ModelLook& look, const DialPosition& dial, Count count) {
    vnBindBlendState(app_.context(), add_);
    for (const Part* part : inOrder(look.eye)) {
        const Alpha alpha = materials_[part->material].alpha;
        bind(*part);
        const float weight = count == Count::kCost ? costOf(*part, dial) : 1;
        const Programs& programs = programsOf(dial);
        vnBindProgram(app_.context(), alpha == Alpha::kMasked ? programs.countMasked : programs.count);
        if (count == Count::kSurfaces) vnBindDepthStencilState(app_.context(), VnDepthStencilState{});
        push(*part, look, weight);
        app_.draw(part->mesh);
    }
    vnBindBlendState(app_.context(), VnBlendState{});
}

void ModelRenderer::drawEdges(const ModelLook& look, const DialPosition& dial, const glm::vec3& color) {
    const VnProgram plain = programsOf(dial).plain;
    for (const Part& part : parts_) {
        bind(part);
        vnBindProgram(app_.context(), plain);
        vnBindRasterState(app_.context(), edges_);
        vnBindDepthStencilState(app_.context(), edgeDepth_);
        app_.push(viewer_shaders::ModelPush{look.transform, {}, glm::vec4(color, 1), {}, {}});
        app_.draw(part.mesh);
    }
}

void ModelRenderer::drawPlain(const ModelLook& look, const DialPosition& dial, const glm::vec3& color) {
    const VnProgram plain = programsOf(dial).plain;
    for (const Part& part : parts_) {
        bind(part);
        vnBindProgram(app_.context(), plain);
        vnBindDepthStencilState(app_.context(), writeDepth_);
        app_.push(viewer_shaders::ModelPush{look.transform, {}, glm::vec4(color, 1), {}, {}});
        app_.draw(part.mesh);
    }
}

}  // namespace samples
