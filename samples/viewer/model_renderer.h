// A scene on the device, and the ways to draw it: lit, counted, as edges.
#pragma once

#include <map>
#include <optional>

#include "samples/common/app.h"
#include "samples/viewer/dial.h"
#include "samples/viewer/scene.h"
#include "samples/viewer/shaders.h"

namespace samples {

struct ModelLook {
    glm::mat4 transform;
    glm::vec3 eye;
};

class ModelRenderer {
  public:
    explicit ModelRenderer(App& app);
    ~ModelRenderer() { release(); }
    ModelRenderer(const ModelRenderer&) = delete;
    ModelRenderer& operator=(const ModelRenderer&) = delete;

    /// Replaces what is drawn. Textures that the device cannot hold are left out and noted in `scene`.
    void setScene(Scene& scene);
    /// Draws the parts of that scene where they are now.
    void moveParts(const Scene& scene);

    // Inside a pass with a depth image.
    /// What is opaque first, then masked, then blended from far to near. `explained` gets what the first draw runs.
    void drawLit(const ModelLook& look, const DialPosition& dial, std::string* explained = nullptr);
    enum class Count { kSurfaces, kRuns, kCost };
    /// Adds into a colour image of one float: 1 for every fragment, hidden ones too (surfaces); how often the fragment
    /// program runs per pixel, without those that fail the depth test when their turn comes (runs); that times what a
    /// run costs, in additions (cost).
    void drawCounts(const ModelLook& look, const DialPosition& dial, Count count);
    void drawEdges(const ModelLook& look, const DialPosition& dial, const glm::vec3& color);
    /// One colour.
    void drawPlain(const ModelLook& look, const DialPosition& dial, const glm::vec3& color);

  private:
    struct Programs {
        VnProgram lit{}, litMasked{}, mapped{}, mappedMasked{}, count{}, countMasked{}, plain{};
        std::optional<float> cost[2][3];  // without and with extras, by Alpha
    };
    struct Part {
        Mesh mesh;
        VnBuffer extras;  // VertexExtras, if there are some
        size_t material;
        glm::vec3 center;
    };
    struct Texture {
        VnImage image{};
        VnView view{};
    };
    Programs& programsOf(const DialPosition& dial);
    VnProgram link(VnShader vertex, VnShader fragment, const DialPosition& dial);
    VnSampler samplerOf(const MaterialTexture& texture);
    Texture upload(const SceneTexture& from);
    void release();
    std::vector<const Part*> inOrder(const glm::vec3& eye) const;
    /// Binds all that a part is drawn with but the program.
    void bind(const Part& part);
    void bindTexture(uint32_t binding, const MaterialTexture& texture, const Texture& otherwise);
    void bindLit(const Part& part, const Programs& programs);
    /// What a run of the fragment program that lights a part costs, in additions, as vnExplain says it. Inside a pass.
    float costOf(const Part& part, const DialPosition& dial);
    void push(const Part& part, const ModelLook& look, float weight);
    std::string explain(VnExplainFormat format);

    App& app_;
    VnShader vertex_, lit_, litMasked_, mappedVertex_, mapped_, mappedMasked_, count_, countMasked_, plain_;
    std::map<std::string, Programs> programs_;
    std::map<uint32_t, VnSampler> samplers_;
    VnVertexLayout layout_, mappedLayout_;
    VnDepthStencilState writeDepth_, readDepth_, edgeDepth_;
    VnRasterState twoSided_{}, oneSided_{}, edges_{};
    VnBlendState over_{}, add_{};
    Texture white_, straight_;  // straight: normals as they are
    std::vector<Part> parts_;
    std::vector<Texture> textures_;
    std::vector<SceneMaterial> materials_;
};

}  // namespace samples
