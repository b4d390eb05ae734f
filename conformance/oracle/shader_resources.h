// The world outside a shader for the reference interpreter: a draw's buffers, push constants and textures.
//
// A texture read has a range of permitted values. A run of the shader sees one end of it: `end` selects
// nominal values, all lower ends, all upper ends, or what is nearest to zero, where abs() turns; and the caller
// compares the outcomes.
#pragma once

#include "conformance/oracle/memory.h"
#include "conformance/oracle/texture_unit.h"
#include "conformance/oracle/word_writes.h"
#include "conformance/scene/scene.h"
#include "spirv_interp/reference/interpreter.h"

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
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
    std::string refusal;    // why what a shader has done is not modelled; sticky
    std::vector<std::vector<RunWrite>> runs;     // what each run since the caller's last reset stored
    std::vector<std::vector<RunWord>> wordRuns;  // the same of storage buffers
    std::vector<TexelWrite> writes;              // what fragments have left, for the caller to keep
    std::vector<WordWrite> wordWrites;
    std::vector<const SceneBinding*> loads;               // storage images and texel buffers loaded from; sticky
    std::set<std::pair<uint32_t, uint64_t>> loadedWords;  // of storage buffers, by buffer and offset; sticky

    const Memory& sceneMemory() const { return memory_; }
    const OracleRules& rules() const { return rules_; }

    /// Before each run of a shader: its stores are kept apart, and it sees nothing of what others have stored.
    void startRun();
    void resetRuns();

    std::span<std::byte> buffer(reference::BufferKind kind, const reference::Descriptor& descriptor) override;
    reference::Texel<double> sample(const reference::ImageRequest<double>& request) override;
    reference::Texel<double> gather(const reference::ImageRequest<double>& request) override;
    reference::Texel<double> fetch(const reference::ImageRequest<double>& request) override;
    void write(const reference::ImageRequest<double>& request, const reference::Texel<double>& value) override;
    std::array<int32_t, 4> querySize(const reference::Descriptor& descriptor, const reference::ImageShape& shape,
                                     int32_t lod) override;
    int32_t queryLevels(const reference::Descriptor& descriptor, const reference::ImageShape&) override;
    std::array<double, 2> queryLod(const reference::ImageRequest<double>& request) override;
    void loaded(const reference::BufferAccess& access) override;
    void stored(const reference::BufferAccess& access, const reference::Scalar<double>& value) override;
    void combined(const reference::BufferAccess& access, spv::Op op, const reference::Scalar<double>& value) override;

  private:
    SampleQuery queryOf(const reference::ImageRequest<double>& request) const;
    const SceneBinding* find(const reference::Descriptor& descriptor) const;
    const ImageStore* imageOf(const reference::Descriptor& descriptor) const;
    const SceneSampler* samplerOf(const reference::Descriptor& descriptor) const;
    SampleResult fetchTexelBuffer(const SceneBinding& binding, int64_t at) const;
    reference::Texel<double> deliver(const SampleResult& result, const reference::ImageShape& shape);

    /// What the draw binds of a buffer, for this object's runs alone.
    struct Bound {
        Bytes bytes;
        const StoredBuffer* stored = nullptr;  // whose open words are among the bytes
    };
    /// A word inside of what is bound, in the buffer of the scene.
    struct Word {
        Bound& bound;
        uint32_t buffer;
        uint64_t offset;
    };
    std::optional<Word> wordAt(const reference::BufferAccess& access);
    void note(const reference::BufferAccess& access, spv::Op op, const reference::Scalar<double>& value);
    double atEnd(const Interval& v) const;

    const Scene& scene_;
    const Memory& memory_;
    const SceneDraw& draw_;
    const OracleRules rules_;
    std::vector<Bound> buffers_;                               // by binding
    std::vector<std::pair<std::byte*, uint32_t>> changed_;     // words that the run has changed, as they were
    RangeEnd shown_ = RangeEnd::nominal;                       // of open words
    std::map<const SceneBinding*, TexelBuffer> texelBuffers_;  // as the scene gives their bytes
    Bytes pushConstants_;
};

}  // namespace vernier::conformance::exact
