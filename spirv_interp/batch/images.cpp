// Image instructions and interpolation at other places: calls out to the owner of images and planes, one per
// batch where descriptors do not vary between lanes.
#include <algorithm>
#include <array>
#include <cstring>

#include "spirv_interp/batch/handlers.h"

namespace vernier::batch {
namespace {

/// The image of a descriptor index, joined with the sampler of another descriptor where the instruction names
/// one. Without a call when there is no such descriptor.
ImageBinding bindingOf(const Frame& frame, const ir::ImageOp& op, uint32_t imageIndex, uint32_t samplerIndex) {
    const ResourceBindings& bindings = *frame.bindings;
    if (bindings.images == nullptr || imageIndex >= bindings.count[op.imageResource]) return {};
    const ImageBinding& image = bindings.images[bindings.base[op.imageResource] + imageIndex];
    if (op.samplerResource == ir::kNoIndex || op.samplerResource == op.imageResource) return image;
    if (bindings.samplers == nullptr || bindings.combine == nullptr) return {};
    if (samplerIndex >= bindings.count[op.samplerResource]) return {};
    return bindings.combine(image, bindings.samplers[bindings.base[op.samplerResource] + samplerIndex]);
}

/// The lanes of a mask as words, four bits at a time.
constexpr auto kMaskWords = [] {
    std::array<std::array<uint32_t, 4>, 16> words{};
    for (uint32_t bits = 0; bits < 16; ++bits)
        for (uint32_t k = 0; k < 4; ++k) words[bits][k] = (bits >> k & 1) != 0 ? ~0u : 0u;
    return words;
}();

class ImageRunner {
  public:
    ImageRunner(Frame& frame, const ImageSite& site)
        : frame_(frame),
          site_(site),
          op_(frame.program->imageOps[site.op]),
          active_(site.effects ? frame.masks[kCurrentMask] & frame.live : frame.masks[kCurrentMask]) {
        call_.op = &op_;
        call_.lanes = frame.lanes;
        set(call_.coord, site.coord);
        set(call_.ddx, site.ddx);
        set(call_.ddy, site.ddy);
        set(call_.offset, site.offset);
        set(call_.texel, site.texel);
        call_.dref = rowAt(site.dref);
        call_.lodOrBias = rowAt(site.lodOrBias);
        call_.sample = rowAt(site.sample);
        call_.minLod = rowAt(site.minLod);
    }

    void run() {
        LaneMask left = active_;
        bool first = true;
        while (!left.empty() || first) {
            const LaneMask group = groupOf(left);
            callFor(group, first && group == active_);
            left = left.without(group);
            first = false;
        }
    }

  private:
    const uint32_t* rowAt(uint32_t offset) const {
        return offset == ImageSite::kNone ? nullptr : frame_.row<uint32_t>(offset);
    }
    template <size_t kCount>
    void set(const uint32_t* (&pointers)[kCount], const uint32_t (&offsets)[kCount]) const {
        for (size_t k = 0; k < kCount; ++k) pointers[k] = rowAt(offsets[k]);
    }
    static uint32_t laneOf(const LaneMask& mask) {
        return mask.empty() ? 0 : static_cast<uint32_t>(std::countr_zero(mask.bits));
    }
    uint32_t indexAt(uint32_t offset, uint32_t lane) const {
        return offset == ImageSite::kNone ? 0 : frame_.row<uint32_t>(offset)[lane];
    }

    /// All lanes hold the same word.
    bool isUniform(uint32_t offset) const {
        if (offset == ImageSite::kNone) return true;
        const uint32_t* row = frame_.row<uint32_t>(offset);
        uint32_t differences = 0;
        for (uint32_t lane = 1; lane < frame_.lanes; ++lane) differences |= row[lane] ^ row[0];
        return differences == 0;
    }

    /// The lanes of `left` that use the same descriptors as its first.
    LaneMask groupOf(const LaneMask& left) const {
        if (isUniform(site_.imageIndex) && isUniform(site_.samplerIndex)) return left;
        const uint32_t first = laneOf(left);
        LaneMask group;
        left.forEach([&](uint32_t lane) {
            const bool same = indexAt(site_.imageIndex, lane) == indexAt(site_.imageIndex, first) &&
                              indexAt(site_.samplerIndex, lane) == indexAt(site_.samplerIndex, first);
            group.set(lane, same ? 1 : 0);
        });
        return group;
    }

    void callFor(const LaneMask& group, bool whole) {
        const uint32_t lane = laneOf(group);
        const ImageBinding binding =
            bindingOf(frame_, op_, indexAt(site_.imageIndex, lane), indexAt(site_.samplerIndex, lane));
        if (group == LaneMask::first(frame_.lanes)) {
            call_.mask = nullptr;
        } else {
            call_.mask = frame_.imageScratch;
            for (uint32_t k = 0; k < frame_.lanes; k += 4)
                std::memcpy(frame_.imageScratch + k, kMaskWords[group.bits >> k & 15].data(), sizeof kMaskWords[0]);
        }
        for (uint32_t k = 0; k < 4; ++k) {
            uint32_t* row = const_cast<uint32_t*>(rowAt(site_.result[k]));
            call_.result[k] = row == nullptr || whole ? row : frame_.imageScratch + (k + 1) * kMaxLanes;
        }
        if (binding.call != nullptr && !group.empty()) {
            binding.call(binding, call_);
        } else {
            for (uint32_t* result : call_.result) {
                if (result != nullptr) std::fill_n(result, frame_.lanes, 0u);
            }
        }
        if (whole) return;
        for (uint32_t k = 0; k < 4; ++k) {
            if (call_.result[k] == nullptr) continue;
            auto* row = frame_.row<uint32_t>(site_.result[k]);
            group.forEach([&](uint32_t l) { row[l] = call_.result[k][l]; });
        }
    }

    Frame& frame_;
    const ImageSite& site_;
    const ir::ImageOp& op_;
    const LaneMask active_;
    ImageCall call_;
};

}  // namespace

const Inst* runImage(Frame& frame, const Inst* inst) {
    ImageRunner(frame, frame.imageSites[inst->operand[0]]).run();
    return inst + 1;
}

const Inst* runInterpolation(Frame& frame, const Inst* inst) {
    const auto rowAt = [&](uint32_t offset) -> const float* {
        return offset == ImageSite::kNone ? nullptr : frame.row<float>(offset);
    };
    const Inst& in = *inst;
    auto* result = frame.row<float>(in[0]);
    if (frame.interpolator.at == nullptr) {
        std::fill_n(result, frame.lanes, 0.0f);
    } else {
        frame.interpolator.at(frame.interpolator.self, in[3], in[4], frame.lanes, rowAt(in[1]), rowAt(in[2]), result);
    }
    return inst + instsFor(5);
}

}  // namespace vernier::batch
