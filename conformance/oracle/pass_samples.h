// The samples of a pass's attachments while it is rendered: loaded or cleared, stored and resolved as the attachments
// ask (Vulkan, Render Pass Load and Store Operations; Multisample Resolve).
#pragma once

#include "base/result.h"
#include "conformance/oracle/image_store.h"
#include "conformance/oracle/sample_states.h"
#include "conformance/scene/scene.h"

#include <cstdint>
#include <vector>

namespace vernier::conformance::exact {

class PassSamples {
  public:
    /// `layer`: of the attachments' layers the one to render.
    PassSamples(const ScenePass& pass, std::vector<ImageStore>& images, uint32_t layer)
        : pass_(pass), images_(images), layer_(layer) {}

    Status load();
    /// What the pass leaves in its attachments.
    void store();
    void resolve();

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    /// Per pixel.
    uint32_t samples() const { return samples_; }
    /// The attachments' formats, without a pipeline.
    const OutputState& output() const { return output_; }

    Sample& at(uint32_t x, uint32_t y, uint32_t s) {
        return state_[(static_cast<size_t>(y) * width_ + x) * samples_ + s];
    }
    /// All samples, row by row, those of a pixel together.
    std::vector<Sample>& all() { return state_; }

  private:
    ImageLevel* attachment(const SceneAttachment& attachment);
    Sample loadStates(uint32_t x, uint32_t y, uint32_t s);
    SampleState loadSample(uint32_t x, uint32_t y, uint32_t s);
    void storeSample(uint32_t x, uint32_t y, uint32_t s);

    const ScenePass& pass_;
    std::vector<ImageStore>& images_;
    const uint32_t layer_;
    uint32_t width_ = 0, height_ = 0, samples_ = 1;
    OutputState output_;
    std::vector<Sample> state_;
};

}  // namespace vernier::conformance::exact
