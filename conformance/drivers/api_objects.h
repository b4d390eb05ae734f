// A scene's objects on Vernier's C API: one per thing the scene names, made once, destroyed with the device
// or here.
#pragma once

#include "base/result.h"
#include "conformance/scene/scene.h"

#include <vernier/vernier.h>

#include <string_view>
#include <vector>

namespace vernier::conformance {

/// The error for a call of the API that failed: what was called, and what the device says about it.
Error apiError(VnDevice device, std::string_view call, VnResult result);

/// Leaves the calling function with an Error unless the call succeeds; needs a `device_`.
#define VERNIER_TRY_API(call)                                                   \
    do {                                                                        \
        if (const VnResult tryResult = (call); tryResult != VN_SUCCESS)         \
            return ::vernier::conformance::apiError(device_, #call, tryResult); \
    } while (false)

struct ApiPipeline {
    VnProgram program{};
    VnVertexLayout layout{};
    VnRasterState raster{};
    VnDepthStencilState depthStencil{};
    VnBlendState blend{};
};

class ApiObjects {
  public:
    ApiObjects(VnDevice device, VnContext context) : device_(device), context_(context) {}
    ~ApiObjects();
    ApiObjects(const ApiObjects&) = delete;
    ApiObjects& operator=(const ApiObjects&) = delete;

    Status createResources(const Scene& scene);
    Status createPipelines(const Scene& scene);

    VnBuffer buffer(uint32_t index) const { return buffers_[index]; }
    VnImage image(uint32_t index) const { return images_[index]; }
    const ApiPipeline& pipeline(uint32_t index) const { return pipelines_[index]; }

    /// A view of one level of some layers, all aspects. Made once for each.
    Result<VnView> attachmentView(const Scene& scene, uint32_t image, uint32_t mipLevel, uint32_t layer,
                                  uint32_t layerCount);
    /// The view of a binding of a texture or storage image.
    Result<VnView> sampledView(const Scene& scene, const SceneBinding& binding);
    VnSampler sampler(uint32_t index) const { return samplers_[index]; }

  private:
    Status createImage(const SceneImage& scene);
    Status createSampler(const SceneSampler& scene);
    Status createShader(const SceneShader& scene);
    Result<ApiPipeline> createPipeline(const ScenePipeline& scene);
    Status createVertexLayout(const ScenePipeline& scene, VnVertexLayout& made);
    Result<VnView> view(const VnViewDesc& desc);

    VnDevice device_;
    VnContext context_;
    std::vector<VnBuffer> buffers_;
    std::vector<VnImage> images_;
    std::vector<VnSampler> samplers_;
    std::vector<VnShader> shaders_;
    std::vector<ApiPipeline> pipelines_;
    std::vector<std::pair<VnViewDesc, VnView>> views_;
};

}  // namespace vernier::conformance
