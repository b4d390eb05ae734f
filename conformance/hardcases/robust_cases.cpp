#include "conformance/hardcases/robust_cases.h"

#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/value_input.h"
#include "conformance/scenes/recorder.h"

#include <algorithm>

namespace vernier::conformance::hardcases {
namespace {

/// Outside: 0, or any value of the buffer (Vulkan, Robust Buffer Access).
ValueJudge zeroOr(std::vector<uint32_t> contents) {
    contents.insert(contents.begin(), 0);
    return oneOf(std::move(contents));
}

constexpr VkExtent2D kTarget{16, 16};
constexpr uint32_t kUntouched = 99;
const std::vector<uint32_t> kValues{0x51, 0x52, 0x53};

/// A covering triangle whose indices begin at `base`, a multiple of 4: its corners follow from the index alone, its
/// flat value is fetched from a buffer of three.
size_t addFarIndices(CaseInput& input, uint32_t base, int32_t vertexOffset) {
    SceneRecorder record("V10", "Vertices beyond their buffer.");
    const uint32_t target = record.colorTarget("value", VK_FORMAT_R32_UINT, kTarget);
    const std::vector<uint32_t> indices{base, base + 1, base + 2};
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(location = 0) in uint value;
layout(location = 0) flat out uint vValue;
void main() {
    gl_Position = vec4(float((gl_VertexIndex & 1) * 4 - 1), float((gl_VertexIndex >> 1 & 1) * 4 - 1), 0.0, 1.0);
    vValue = value;
}
)"),
                                            record.fragment(R"(#version 450
layout(location = 0) flat in uint vValue;
layout(location = 0) out uint color;
void main() { color = vValue; }
)"))
                                  .binding(4)
                                  .attribute(VK_FORMAT_R32_UINT, 0);
    record.pass(kTarget).color(target, {});
    // The clear value's bits are those of the first pass: integers are drawn over it.
    record.draw(pipeline, 3)
        .vertices(record.vertexBuffer("values", kValues))
        .indices(record.indexBuffer("indices", indices), VK_INDEX_TYPE_UINT32)
        .first(0, vertexOffset);
    record.output(target);
    record.robustBufferAccess();
    Result<Scene> scene = record.finish();
    if (scene) std::get<ScenePass>(scene->steps[0]).colors[0].clear.color.uint32[0] = kUntouched;
    return input.scene(std::move(scene));
}

}  // namespace

void g08(CaseInput& input) {
    const std::vector<uint32_t> contents{11, 12, 13, 14};
    ValueShader shader;
    shader.data = contents;
    shader.robust = true;
    std::vector<ValueRow> rows{{{0}, oneOf({11})}, {{3}, oneOf({14})}};
    // Indices whose byte offsets wrap around 32 bits, among them to the buffer itself, and whose signs differ.
    for (const uint32_t index :
         {4u, 0x40000000u, 0x40000001u, 0x3fffffffu, 0x80000000u, 0x7fffffffu, 0xc0000003u, 0xfffffff0u, 0xffffffffu})
        rows.push_back({{index}, zeroOr(contents)});
    shader.declarations = "layout(std430, binding = 1) readonly buffer Data { uint data[]; };\n";
    addValues(input, "G08_word", "data[u(0)]", rows, shader);
    addValues(input, "G08_signed", "data[i(0)]", rows, shader);
    // Elements of 16 bytes: the product wraps earlier.
    shader.declarations = "layout(std430, binding = 1) readonly buffer Data { uvec4 data[]; };\n";
    std::vector<ValueRow> wide{{{0}, oneOf({12})}};
    for (const uint32_t index : {1u, 0x10000000u, 0x0fffffffu, 0x80000000u, 0xffffffffu})
        wide.push_back({{index}, zeroOr(contents)});
    addValues(input, "G08_vector", "data[u(0)].y", wide, shader);
}

void v10(CaseInput& input) {
    for (const auto& [base, offset] :
         {std::pair{4u, 0}, {0x7ffffff0u, 0}, {0xfffffff0u, 0}, {0u, 0x7ffffff0}, {0u, -0x1000}}) {
        judgePixels(input, addFarIndices(input, base, offset), 0, kTarget,
                    [](const PixelReader& pixels, const Declared&) -> Verdict {
                        const uint64_t seen = pixels.code(0, 0, 0);
                        for (uint32_t y = 0; y < kTarget.height; ++y) {
                            for (uint32_t x = 0; x < kTarget.width; ++x) {
                                if (pixels.code(x, y, 0) == seen) continue;
                                return Verdict::wrong("one flat value is " + std::to_string(seen) + " and " +
                                                      std::to_string(pixels.code(x, y, 0)));
                            }
                        }
                        if (seen == 0) return {};
                        const std::string text = "a fetch outside gives " + std::to_string(seen) + ", best 0";
                        if (seen == kUntouched) return Verdict::wrong("nothing is drawn, though all indices are read");
                        return std::ranges::count(kValues, seen) != 0 ? Verdict::allowed(text) : Verdict::wrong(text);
                    });
    }
    // Within the buffer: the value itself.
    judgePixels(
        input, addFarIndices(input, 0, 0), 0, kTarget, [](const PixelReader& pixels, const Declared&) -> Verdict {
            return pixels.code(3, 3, 0) == kValues[0] ? Verdict{} : Verdict::wrong("a fetch inside misses its value");
        });
}

}  // namespace vernier::conformance::hardcases
