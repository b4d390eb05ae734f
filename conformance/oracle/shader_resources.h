// The world outside a shader for the reference interpreter: a draw's buffers, push constants and textures.
//
// A texture read has a range of permitted values. A run of the shader sees one end of it: `end` selects
// nominal values, all lower ends or all upper ends, and the caller compares the outcomes.
#pragma once

#include "conformance/oracle/image_store.h"
#include "conformance/oracle/texture_unit.h"
#include "conformance/scene/scene.h"
#include "spirv_interp/reference/interpreter.h"

#include <vector>

namespace vernier::conformance::exact {

enum class RangeEnd : uint8_t { nominal, low, high };

class ShaderResources : public reference::Resources<double> {
  public:
    ShaderResources(const Scene& scene, const std::vector<ImageStore>& images, const SceneDraw& draw,
                    const OracleRules& rules = {});

    RangeEnd end = RangeEnd::nominal;
    bool sawRange = false;  // a texture read had more than one permitted value; sticky until reset by the caller
    OracleFlags flags = 0;  // of OracleFlag, from the texels read; sticky
    bool wrote = false;     // a storage buffer or image was asked for; sticky

    std::span<std::byte> buffer(reference::BufferKind kind, const reference::Descriptor& descriptor) override;
    reference::Texel<double> sample(const reference::ImageRequest<double>& request) override;
    reference::Texel<double> gather(const reference::ImageRequest<double>& request) override;
    reference::Texel<double> fetch(const reference::ImageRequest<double>& request) override;
    void write(const reference::ImageRequest<double>&, const reference::Texel<double>&) override { wrote = true; }
    std::array<int32_t, 4> querySize(const reference::Descriptor& descriptor, const reference::ImageShape& shape,
                                     int32_t lod) override;
    int32_t queryLevels(const reference::Descriptor& descriptor, const reference::ImageShape&) override;
    std::array<double, 2> queryLod(const reference::ImageRequest<double>& request) override;

  private:
    SampleQuery queryOf(const reference::ImageRequest<double>& request) const;
    const SceneBinding* find(const reference::Descriptor& descriptor) const;
    const ImageStore* imageOf(const reference::Descriptor& descriptor) const;
    const SceneSampler* samplerOf(const reference::Descriptor& descriptor) const;
    reference::Texel<double> deliver(const SampleResult& result, const reference::ImageShape& shape);

    const Scene& scene_;
    const std::vector<ImageStore>& images_;
    const SceneDraw& draw_;
    const OracleRules rules_;
    std::vector<Bytes> buffers_;  // private copies of what the draw binds, by binding
    Bytes pushConstants_;
};

}  // namespace vernier::conformance::exact
