// The world outside a shader for the reference interpreter: a draw's buffers, push constants and textures.
//
// A texture read has a range of permitted values. A run of the shader sees one end of it: `end` selects
// nominal values, all lower ends, all upper ends, or what is nearest to zero, where abs() turns; and the caller
// compares the outcomes.
#pragma once

#include "conformance/oracle/memory.h"
#include "conformance/oracle/texture_unit.h"
#include "conformance/scene/scene.h"
#include "spirv_interp/reference/interpreter.h"

#include <array>
#include <map>
#include <vector>

namespace vernier::conformance::exact {

enum class RangeEnd : uint8_t { nominal, low, high, nearZero };

/// A texel that one run of a shader stores.
struct RunWrite {
    const SceneBinding* binding = nullptr;
    uint32_t invocation = 0;
    std::array<int32_t, 3> at{};
    reference::Texel<double> value{};
};

class ShaderResources : public reference::Resources<double> {
  public:
    ShaderResources(const Scene& scene, const Memory& memory, const SceneDraw& draw, const OracleRules& rules = {});

    RangeEnd end = RangeEnd::nominal;
    bool sawRange = false;  // a texture read had more than one permitted value; sticky until reset by the caller
    bool sawZero = false;   // zero was strictly inside of such a range; the same
    OracleFlags flags = 0;  // of OracleFlag, from the texels read; sticky
    bool wrote = false;     // a storage buffer was asked for, or a texel stored outside of runs; sticky
    std::vector<std::vector<RunWrite>> runs;  // what each run since the caller's last reset stored
    std::vector<TexelWrite> writes;           // what fragments have left, for the caller to keep
    std::vector<const SceneBinding*> loads;   // storage images and texel buffers loaded from; sticky

    const Memory& sceneMemory() const { return memory_; }

    std::span<std::byte> buffer(reference::BufferKind kind, const reference::Descriptor& descriptor) override;
    reference::Texel<double> sample(const reference::ImageRequest<double>& request) override;
    reference::Texel<double> gather(const reference::ImageRequest<double>& request) override;
    reference::Texel<double> fetch(const reference::ImageRequest<double>& request) override;
    void write(const reference::ImageRequest<double>& request, const reference::Texel<double>& value) override;
    std::array<int32_t, 4> querySize(const reference::Descriptor& descriptor, const reference::ImageShape& shape,
                                     int32_t lod) override;
    int32_t queryLevels(const reference::Descriptor& descriptor, const reference::ImageShape&) override;
    std::array<double, 2> queryLod(const reference::ImageRequest<double>& request) override;

  private:
    SampleQuery queryOf(const reference::ImageRequest<double>& request) const;
    const SceneBinding* find(const reference::Descriptor& descriptor) const;
    const ImageStore* imageOf(const reference::Descriptor& descriptor) const;
    const SceneSampler* samplerOf(const reference::Descriptor& descriptor) const;
    SampleResult fetchTexelBuffer(const SceneBinding& binding, int64_t at) const;
    reference::Texel<double> deliver(const SampleResult& result, const reference::ImageShape& shape);

    const Scene& scene_;
    const Memory& memory_;
    const SceneDraw& draw_;
    const OracleRules rules_;
    std::vector<Bytes> buffers_;                               // private copies of what the draw binds, by binding
    std::map<const SceneBinding*, TexelBuffer> texelBuffers_;  // as the scene gives their bytes
    Bytes pushConstants_;
};

}  // namespace vernier::conformance::exact
