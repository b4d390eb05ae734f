// Faults put into what was drawn of a case: its judges must call them wrong and name the cause.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <map>

#include "conformance/drivers/api_driver.h"
#include "conformance/hardcases/run.h"

namespace vernier::conformance::hardcases {

struct Ideal {
    CaseInput input;
    std::vector<SceneOutcome> drawn;
};

/// Vernier's rendering, for what the oracle judges but does not draw: lines, points, tables of values.
inline const Ideal& vernier(std::string_view id) {
    static std::map<std::string_view, Ideal> cache;
    static const auto driver = ApiDriver::create({});
    const auto [found, fresh] = cache.try_emplace(id);
    if (!fresh) return found->second;
    findCase(id)->build(found->second.input);
    for (const Scene& scene : found->second.input.scenes()) {
        found->second.drawn.push_back(drawScene(**driver, scene));
    }
    return found->second;
}

using Fault = std::function<void(std::vector<SceneOutcome>&)>;

inline Verdict verdictOn(const Ideal& made, const Fault& fault, const Declared& declared = {}) {
    std::vector<SceneOutcome> drawn = made.drawn;
    fault(drawn);
    return judgeCase(made.input, drawn, declared);
}

inline std::byte& byteAt(RenderedImage& image, uint32_t x, uint32_t y, uint32_t channel) {
    return image.texels[(size_t{y} * image.extent.width + x) * 4 + channel];
}

inline void setFloat(RenderedImage& image, uint32_t x, uint32_t y, uint32_t channel, float value) {
    std::memcpy(image.texels.data() + (size_t{y} * image.extent.width + x) * 16 + channel * 4, &value, 4);
}

/// On Vernier's rendering.
inline void expectCaught(std::string_view id, const Fault& fault, const std::string& cause) {
    EXPECT_LE(verdictOn(vernier(id), [](auto&) {}).outcome, Outcome::allowed) << id;
    const Verdict verdict = verdictOn(vernier(id), fault);
    EXPECT_EQ(verdict.outcome, Outcome::wrong) << id;
    EXPECT_NE(verdict.witness.find(cause), std::string::npos) << id << ": " << verdict.witness;
}

inline void setCode(RenderedImage& image, uint32_t x, uint32_t y, uint32_t code) {
    std::memcpy(image.texels.data() + (size_t{y} * image.extent.width + x) * 4, &code, 4);
}

inline uint32_t codeAt(const RenderedImage& image, uint32_t x, uint32_t y) {
    uint32_t code;
    std::memcpy(&code, image.texels.data() + (size_t{y} * image.extent.width + x) * 4, 4);
    return code;
}

}  // namespace vernier::conformance::hardcases
