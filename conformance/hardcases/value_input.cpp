#include "conformance/hardcases/value_input.h"

#include "conformance/hardcases/judges.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vernier::conformance::hardcases {
namespace {

std::string hex(uint32_t bits) {
    char text[64];
    std::snprintf(text, sizeof text, "0x%08x (%.9g)", bits, static_cast<double>(std::bit_cast<float>(bits)));
    return text;
}

Result<Scene> valueScene(std::string_view name, std::string_view expression, const ValueShader& shader,
                         const std::vector<ValueRow>& rows) {
    const VkExtent2D extent{static_cast<uint32_t>(rows.size()), 1};
    SceneRecorder record(name, "An expression on a table of inputs.");
    std::vector<uint32_t> texels;
    for (size_t k = 0; k < 3; ++k) {
        for (const ValueRow& row : rows) texels.push_back(row.in[k]);
    }
    const uint32_t inputs = record.texture("inputs", VK_FORMAT_R32_UINT, {extent.width, 3}, {bytesOf(texels)});
    const uint32_t target = record.colorTarget("results", VK_FORMAT_R32_UINT, extent);
    const std::string glsl = "#version 450\n" + shader.extensions +
                             "layout(binding = 0) uniform usampler2D inputs;\n"
                             "layout(location = 0) out uint result;\n"
                             "uint u(int k) { return texelFetch(inputs, ivec2(int(gl_FragCoord.x), k), 0).r; }\n"
                             "int i(int k) { return int(u(k)); }\n"
                             "float f(int k) { return uintBitsToFloat(u(k)); }\n"
                             "int row() { return int(gl_FragCoord.x); }\n" +
                             shader.declarations + "void main() { result = " + std::string(expression) + "; }\n";
    record.pass(extent).color(target, {0, 0, 0, 0});
    const uint32_t fragment = record.fragment(glsl);
    if (shader.edit && !record.spirv(fragment).empty()) shader.edit(record.spirv(fragment));
    auto draw = record.draw(record.pipeline(record.vertex(kCoverVertexGlsl), fragment), 3)
                    .texture(0, inputs, record.sampler(VK_FILTER_NEAREST));
    if (!shader.data.empty()) {
        draw.storageBuffer(1, record.buffer("data", VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, shader.data));
    }
    if (shader.robust) record.robustBufferAccess();
    record.output(target);
    return record.finish();
}

}  // namespace

void addValues(CaseInput& input, std::string_view name, std::string_view expression, std::vector<ValueRow> rows,
               const ValueShader& shader) {
    const size_t scene = input.scene(valueScene(name, expression, shader, rows));
    const VkExtent2D extent{static_cast<uint32_t>(rows.size()), 1};
    judgePixels(
        input, scene, 0, extent,
        [rows = std::move(rows), text = std::string(expression)](const PixelReader& pixels, const Declared& declared) {
            Verdict worst;
            for (uint32_t x = 0; x < rows.size(); ++x) {
                const auto bits = static_cast<uint32_t>(pixels.code(x, 0, 0));
                Verdict verdict = rows[x].judge(bits, declared);
                if (verdict.outcome != Outcome::exact) {
                    std::string inputs;
                    for (const uint32_t in : rows[x].in) inputs += (inputs.empty() ? "" : ", ") + hex(in);
                    verdict.witness = text + " of " + inputs + " is " + hex(bits) + "; " + verdict.witness;
                }
                worst = worst.worse(verdict);
            }
            return worst;
        });
}

double ulpOf(double value) {
    const double size = std::max(std::abs(value), 0x1p-126);
    return std::ldexp(1.0, std::ilogb(size) - 23);
}

double OwnTolerance::of(double exactly, const OwnBounds& bounds) const {
    const precision::Promise& promise = angle ? bounds.angles : bounds.functions;
    return std::max(promise.ulp * scale * ulpOf(exactly), promise.absolute);
}

ValueJudge floatNear(double exactly, double tolerance, OwnTolerance ownTolerance) {
    return [=](uint32_t bits, const Declared& declared) -> Verdict {
        if (std::isnan(exactly)) return {};
        const double got = std::bit_cast<float>(bits);
        if (got == static_cast<double>(static_cast<float>(exactly))) return {};
        char text[80];
        std::snprintf(text, sizeof text, "exactly %.9g, permitted within %.3g", exactly, tolerance);
        if (declared.own && std::abs(got - exactly) <= ownTolerance.of(exactly, *declared.own))
            return Verdict::declared(text);
        const bool flushed = got == 0 && std::abs(exactly) < 0x1p-126;
        const bool overflown =
            std::isinf(got) && std::abs(exactly) + tolerance > 0x1.fffffep127 && (got > 0) == (exactly > 0);
        if (flushed || overflown || std::abs(got - exactly) <= tolerance) return Verdict::allowed(text);
        return Verdict::wrong(text);
    };
}

ValueJudge floatWithin(double exactly, double ulps) {
    return floatNear(exactly, ulps * ulpOf(exactly));
}

ValueJudge oneOf(std::vector<uint32_t> bits, std::optional<uint32_t> own) {
    return [bits = std::move(bits), own](uint32_t got, const Declared& declared) -> Verdict {
        if (got == bits.front()) return {};
        const std::string text = "exactly " + hex(bits.front());
        if (declared.own && got == own) return Verdict::declared(text + "; this is the declared answer");
        return std::ranges::count(bits, got) != 0 ? Verdict::allowed(text + "; this is permitted too")
                                                  : Verdict::wrong(text);
    };
}

ValueJudge anything() {
    return [](uint32_t, const Declared&) { return Verdict{}; };
}

}  // namespace vernier::conformance::hardcases
