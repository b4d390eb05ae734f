#include "conformance/oracle/pass_samples.h"

#include "conformance/oracle/quantise.h"
#include "conformance/oracle/sample_locations.h"

#include <string>

namespace vernier::conformance::exact {

ImageLevel* PassSamples::attachment(const SceneAttachment& a) {
    return a.image < images_.size() ? &images_[a.image].level(a.mipLevel, a.layer + layer_) : nullptr;
}

Status PassSamples::load() {
    if (pass_.colors.size() > kMaxColorAttachments) {
        return unsupported("oracle: a pass with " + std::to_string(pass_.colors.size()) + " colour attachments");
    }
    width_ = pass_.extent.width;
    height_ = pass_.extent.height;
    output_.colorCount = pass_.colors.size();
    const ImageLevel* depth = attachment(pass_.depthStencil);
    for (size_t i = 0; i < pass_.colors.size(); ++i) {
        if (const ImageLevel* color = attachment(pass_.colors[i])) {
            samples_ = color->samples;
            output_.colorFormats[i] = &images_[pass_.colors[i].image].format();
        }
    }
    if (depth) {
        samples_ = depth->samples;
        output_.depthFormat = &images_[pass_.depthStencil.image].format();
    }
    if (standardSampleLocations(samples_).empty())
        return unsupported("oracle: " + std::to_string(samples_) + " samples");
    state_.resize(static_cast<size_t>(width_) * height_ * samples_);
    for (uint32_t y = 0; y < height_; ++y) {
        for (uint32_t x = 0; x < width_; ++x) {
            for (uint32_t s = 0; s < samples_; ++s) at(x, y, s) = loadStates(x, y, s);
        }
    }
    return {};
}

/// A loaded stencil that may hold several codes is each of them in turn; the operations on it are on codes.
Sample PassSamples::loadStates(uint32_t x, uint32_t y, uint32_t s) {
    Sample states{loadSample(x, y, s)};
    const SceneAttachment& a = pass_.depthStencil;
    if (!output_.depthFormat || !output_.depthFormat->stencil || a.loadOp != VK_ATTACHMENT_LOAD_OP_LOAD) return states;
    const StoredTexel& texel = attachment(a)->at(x, y, s);
    constexpr OracleFlags kReasons = kOracleTie | kOracleSnap | kOracleOrder | kOraclePattern | kOracleSequence;
    for (double code = texel.channels[1].low; code <= texel.channels[1].high; ++code) {
        SampleState other = states[0];
        other.stencil = static_cast<uint8_t>(code);
        addAlternatives(states, {other}, texel.flags & kReasons);
    }
    return states;
}

SampleState PassSamples::loadSample(uint32_t x, uint32_t y, uint32_t s) {
    SampleState state;
    for (size_t i = 0; i < pass_.colors.size(); ++i) {
        const SceneAttachment& a = pass_.colors[i];
        if (!output_.colorFormats[i]) continue;
        const PixelFormat& format = *output_.colorFormats[i];
        if (a.loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR) {
            Color clear;
            for (size_t c = 0; c < 4; ++c) {
                const bool isSigned = format.components[0].encoding == Encoding::sint;
                clear[c] = !format.isInteger() ? static_cast<double>(a.clear.color.float32[c])
                           : isSigned          ? static_cast<double>(a.clear.color.int32[c])
                                               : static_cast<double>(a.clear.color.uint32[c]);
            }
            state.colors[i] = quantiseColor(format, clear);
        } else {
            const StoredTexel& texel = attachment(a)->at(x, y, s);
            state.colors[i] = texel.channels;
            state.flags[i] = a.loadOp == VK_ATTACHMENT_LOAD_OP_LOAD ? texel.flags : OracleFlags{kOracleUnknown};
        }
    }
    if (output_.depthFormat) {
        const SceneAttachment& a = pass_.depthStencil;
        if (a.loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR) {
            state.depth = static_cast<double>(a.clear.depthStencil.depth);
            if (output_.depthFormat->depth) state.depth = quantise(output_.depthFormat->components[0], state.depth);
            state.stencil = static_cast<uint8_t>(a.clear.depthStencil.stencil);
        } else {
            const StoredTexel& texel = attachment(a)->at(x, y, s);
            state.depth = texel.channels[0];
            state.stencil = static_cast<uint8_t>(texel.channels[1].value);
            state.flags[kDepthFlags] =
                a.loadOp == VK_ATTACHMENT_LOAD_OP_LOAD ? texel.flags : OracleFlags{kOracleUnknown};
        }
    }
    return state;
}

void PassSamples::store() {
    for (uint32_t y = 0; y < height_; ++y) {
        for (uint32_t x = 0; x < width_; ++x) {
            for (uint32_t s = 0; s < samples_; ++s) storeSample(x, y, s);
        }
    }
}

void PassSamples::storeSample(uint32_t x, uint32_t y, uint32_t s) {
    const Sample& states = at(x, y, s);
    for (size_t i = 0; i < pass_.colors.size(); ++i) {
        ImageLevel* target = attachment(pass_.colors[i]);
        if (!target) continue;
        StoredTexel texel{states[0].colors[i], states[0].flags[i]};
        for (const SampleState& state : states) {
            texel.flags |= state.flags[i];
            if (state.colors[i] != states[0].colors[i]) texel.flags |= kOracleEdge;
            for (size_t c = 0; c < 4; ++c) texel.channels[c] = texel.channels[c].united(state.colors[i][c]);
        }
        target->at(x, y, s) = texel;
    }
    if (ImageLevel* target = attachment(pass_.depthStencil)) {
        StoredTexel texel{{states[0].depth, static_cast<double>(states[0].stencil), 0.0, 1.0},
                          states[0].flags[kDepthFlags]};
        for (const SampleState& state : states) {
            texel.flags |= state.flags[kDepthFlags];
            const Interval stencil(state.stencil);
            if (state.depth != states[0].depth || state.stencil != states[0].stencil) texel.flags |= kOracleEdge;
            texel.channels[0] = texel.channels[0].united(state.depth);
            texel.channels[1] = texel.channels[1].united(stencil);
        }
        target->at(x, y, s) = texel;
    }
}

void PassSamples::resolve() {
    for (const SceneAttachment& a : pass_.colors) {
        if (a.resolveImage >= images_.size()) continue;
        const ImageLevel& source = images_[a.image].level(a.mipLevel, a.layer + layer_);
        ImageLevel& target = images_[a.resolveImage].level(0, layer_);
        for (uint32_t y = 0; y < height_; ++y) {
            for (uint32_t x = 0; x < width_; ++x) {
                target.at(x, y) = resolveSamples(images_[a.image].format(), source, x, y);
            }
        }
    }
    const SceneAttachment& depth = pass_.depthStencil;
    if (depth.image >= images_.size() || depth.resolveImage >= images_.size()) return;
    const ImageLevel& source = images_[depth.image].level(depth.mipLevel, depth.layer + layer_);
    ImageLevel& target = images_[depth.resolveImage].level(0, layer_);
    for (uint32_t y = 0; y < height_; ++y) {
        for (uint32_t x = 0; x < width_; ++x) {
            target.at(x, y) = resolveDepthStencil(images_[depth.image].format(), source, x, y, depth.depthResolve,
                                                  depth.stencilResolve);
        }
    }
}

}  // namespace vernier::conformance::exact
