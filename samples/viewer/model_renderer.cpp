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

}  // namespace

ModelRenderer::ModelRenderer(App& app) : app_(app) {
    using namespace viewer_shaders;
    const auto fragment = [&](const std::string& glsl) { return app.shader(VK_SHADER_STAGE_FRAGMENT_BIT, glsl); };
    vertex_ = app.shader(VK_SHADER_STAGE_VERTEX_BIT, kModelVertex);
    lit_ = fragment(kModelFragment);
    litMasked_ = fragment(kModelMaskedFragment);
    count_ = fragment(kCountFragment);
    countMasked_ = fragment(kCountMaskedFragment);
    plain_ = fragment(kPlainFragment);
    layout_ = app.meshLayout();
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
    white_ = upload({1, 1, {0xFFFFFFFF}});
}

void ModelRenderer::release() {
    for (const Part& part : parts_) {
        vnDestroyBuffer(app_.device(), part.mesh.vertices);
        vnDestroyBuffer(app_.device(), part.mesh.indices);
    }
    for (const Texture& texture : textures_)
        if (texture.image.id) vnDestroyImage(app_.device(), texture.image);
    parts_.clear();
    textures_.clear();
}

ModelRenderer::Texture ModelRenderer::upload(const Picture& picture) {
    VnImageDesc desc{};
    desc.format = VK_FORMAT_R8G8B8A8_SRGB;
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
    for (const Picture& picture : scene.textures) {
        textures_.push_back(upload(picture));
        if (textures_.back().view.id == 0)
            scene.notes.push_back("a texture of " + std::to_string(picture.width) + " x " +
                                  std::to_string(picture.height) + " texels is too large for the device");
    }
    for (const ScenePart& from : scene.parts) {
        glm::vec3 sum(0);
        for (const MeshVertex& vertex : from.mesh.vertices) sum += vertex.position;
        parts_.push_back({app_.mesh(from.mesh), from.material, sum / static_cast<float>(from.mesh.vertices.size())});
    }
}

VnProgram ModelRenderer::link(VnShader fragment, const DialPosition& dial) {
    VnProgramDesc desc{};
    desc.vertex = vertex_;
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
    made.lit = link(lit_, dial);
    made.litMasked = link(litMasked_, dial);
    made.count = link(count_, dial);
    made.countMasked = link(countMasked_, dial);
    made.plain = link(plain_, dial);
    return programs_.emplace(key, made).first->second;
}

VnSampler ModelRenderer::samplerOf(const SceneMaterial& material) {
    const uint32_t key = static_cast<uint32_t>(material.filter) | static_cast<uint32_t>(material.addressU) << 8 |
                         static_cast<uint32_t>(material.addressV) << 16;
    if (const auto found = samplers_.find(key); found != samplers_.end()) return found->second;
    VnSamplerDesc desc{};
    desc.magFilter = material.filter;
    desc.minFilter = VK_FILTER_LINEAR;
    desc.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    desc.addressU = material.addressU;
    desc.addressV = material.addressV;
    // The dial's own axis says how many of them are taken. Anisotropic filters are linear ones.
    if (material.filter == VK_FILTER_LINEAR) desc.maxAnisotropy = 16;
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
    const bool textured = material.texture >= 0 && textures_[static_cast<size_t>(material.texture)].view.id != 0;
    vnBindVertexLayout(context, layout_);
    vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 0);
    vnBindRasterState(context, material.twoSided ? twoSided_ : oneSided_);
    vnBindDepthStencilState(context, material.alpha == Alpha::kBlended ? readDepth_ : writeDepth_);
    vnBindTexture(context, 0, 0, 0, textured ? textures_[static_cast<size_t>(material.texture)].view : white_.view,
                  samplerOf(material));
}

void ModelRenderer::push(const Part& part, const ModelLook& look, float weight) {
    const SceneMaterial& material = materials_[part.material];
    const float exponent = exponentOf(material.roughness);
    // Smooth surfaces gather the light that rough ones spread.
    const float strength = (1 - material.roughness) * 1.6f;
    app_.push(viewer_shaders::ModelPush{look.transform, glm::vec4(look.eye, weight), material.color,
                                        glm::vec4(material.emission, material.cutoff),
                                        glm::vec4(material.metallic, exponent, strength, 0)});
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
        vnBindProgram(app_.context(), alpha == Alpha::kMasked ? programs.litMasked : programs.lit);
        vnBindBlendState(app_.context(), alpha == Alpha::kBlended ? over_ : VnBlendState{});
        push(*part, look, 0);
        if (explained) *std::exchange(explained, nullptr) = explain(VN_EXPLAIN_TEXT);
        app_.draw(part->mesh);
    }
    vnBindBlendState(app_.context(), VnBlendState{});
}

float ModelRenderer::costOf(const DialPosition& dial, Alpha alpha) {
    Programs& programs = programsOf(dial);
    std::optional<float>& cost = programs.cost[static_cast<size_t>(alpha)];
    if (cost) return *cost;
    vnBindProgram(app_.context(), alpha == Alpha::kMasked ? programs.litMasked : programs.lit);
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
        const float weight = count == Count::kCost ? costOf(dial, alpha) : 1;
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
