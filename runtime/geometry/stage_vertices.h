// What passes from stage to stage before the rasteriser: vertices, and which of them make up primitives.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/raw_vector.h"
#include "spirv_interp/ir/geometry_modes.h"

namespace vernier {

/// What the vertices at hand have been given by one stage: a plane of words for each of its program's outputs.
class StageVertices {
  public:
    /// None, of a program with so many outputs.
    void reset(size_t outputs) {
        if (planes_.size() < outputs) planes_.resize(outputs);
        for (RawVector<uint32_t>& plane : planes_) plane.clear();
        outputs_ = outputs;
        count_ = 0;
    }
    /// Adds vertices without values. Returns the number of the first.
    uint32_t add(uint32_t count) {
        const uint32_t first = count_;
        count_ += count;
        for (size_t k = 0; k < outputs_; ++k) planes_[k].resize(count_);
        return first;
    }
    uint32_t count() const { return count_; }
    size_t outputs() const { return outputs_; }
    uint32_t* plane(size_t output) { return planes_[output].data(); }
    const uint32_t* plane(size_t output) const { return planes_[output].data(); }
    /// The same as BatchContext gives it.
    const float* output(uint32_t slot) const { return reinterpret_cast<const float*>(planes_[slot].data()); }

  private:
    std::vector<RawVector<uint32_t>> planes_;
    size_t outputs_ = 0;
    uint32_t count_ = 0;
};

/// The primitives that a stage gets.
struct StagePrimitives {
    StageVertices vertices;
    uint32_t verticesPerPrimitive = 0;
    std::vector<uint32_t> numbers;  // of their vertices, `verticesPerPrimitive` for each
    std::vector<uint32_t> ids;      // PrimitiveId
};

/// Vertices by the stream that a geometry stage put them into, where they are points. Those of the first are none of
/// them: they make up primitives.
using VertexStreams = std::array<std::vector<uint32_t>, ir::kVertexStreams>;

/// A primitive that reaches the rasteriser.
struct LocalPrimitive {
    std::array<uint32_t, 3> vertex;  // indices into the shaded vertices
    uint32_t provoking;              // position
    uint32_t primitiveId;
    bool startsStrip;
};

}  // namespace vernier
