#include "conformance/hardcases/geometry_stage_cases.h"

#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/painter_input.h"
#include "conformance/hardcases/topology_cases.h"
#include "conformance/scenes/recorder.h"

#include <random>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{64, 64};

const char* const kNothingVertexGlsl = R"(#version 450
void main() { gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }
)";

// ---- E21: order ----

constexpr uint32_t kPoints = 40, kInvocations = 3, kEmitted = 2;

const char* const kOrderGlsl = R"(#version 450
layout(points, invocations = 3) in;
layout(triangle_strip, max_vertices = 6) out;
layout(location = 0) flat out float vCode;
void corner(int number, ivec2 pixel) {
    gl_Position = vec4(vec2(pixel) / 32.0 - 1.0, 0.5, 1.0);
    vCode = float(number + 1);
    EmitVertex();
}
void main() {
    for (int k = 0; k < 2; ++k) {
        int number = (gl_PrimitiveIDIn * 3 + gl_InvocationID) * 2 + k;
        ivec2 pixel = ivec2(number * 7 % 40, number * 11 % 37);
        corner(number, pixel);
        corner(number, pixel + ivec2(24, 3));
        corner(number, pixel + ivec2(5, 26));
        EndPrimitive();
    }
}
)";

// ---- V16: strips ----

// Vertices in a zigzag, in pieces of 5, 2 and 4; or in two pieces along a row.
std::string stripGlsl(bool lines) {
    return std::string("#version 450\nlayout(points) in;\nlayout(") + (lines ? "line_strip" : "triangle_strip") +
           R"(, max_vertices = 11) out;
layout(location = 0) flat out uint vNumber;
void emit(int number, int place) {
    vec2 pixel = vec2(float(4 + 6 * place) + 0.5, )" +
           (lines ? "12.5" : "(place & 1) == 0 ? 4.0 : 26.0") + R"();
    gl_Position = vec4((pixel + vec2(0.0, 32.0 * float(gl_PrimitiveIDIn))) / 32.0 - 1.0, 0.5, 1.0);
    gl_PrimitiveID = gl_PrimitiveIDIn + 5;
    vNumber = uint(number + 1);
    EmitVertex();
}
void main() {
    for (int i = 0; i < 5; ++i) emit(i, i);
    EndPrimitive();
)" + (lines ? "" : "    emit(5, 0);\n    emit(6, 8);\n    EndPrimitive();\n") +
           R"(    for (int i = 5; i < 9; ++i) emit(i + 2, i);
    EndPrimitive();
}
)";
}

const char* const kStripFragmentGlsl = R"(#version 450
layout(location = 0) flat in uint vNumber;
layout(location = 0) out uint number;
void main() { number = vNumber | uint(gl_PrimitiveID) << 8 | (gl_FrontFacing ? 1u << 16 : 0u); }
)";

/// What the fragments of a primitive write: the number of its provoking vertex, that of the primitive, its facing.
uint64_t writtenBy(uint32_t vertex, uint32_t point, bool front) {
    return vertex + 1 + ((point + 5) << 8) + (front ? 1u << 16 : 0);
}

void addStrips(CaseInput& input, bool lines, bool last, VkCullModeFlags cull) {
    SceneRecorder record("V16", "Strips out of a geometry shader.");
    const uint32_t target = record.colorTarget("numbers", VK_FORMAT_R32_UINT, kTarget);
    PipelineRecorder pipeline = record.pipeline(record.vertex(kNothingVertexGlsl), record.fragment(kStripFragmentGlsl))
                                    .geometry(record.geometry(stripGlsl(lines)))
                                    .topology(VK_PRIMITIVE_TOPOLOGY_POINT_LIST)
                                    .cull(cull, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    if (last) pipeline.provokingVertexLast();
    record.pass(kTarget).color(target, {0, 0, 0, 0});
    record.draw(pipeline, 2);
    record.output(target);
    // Pieces by the place of their first vertex, its number, and how many primitives they are.
    const struct { uint32_t place, vertex, primitives; } pieces[] = {{0, 0, lines ? 4u : 3u}, {5, 7, lines ? 3u : 2u}};
    std::vector<Spot> spots;
    for (uint32_t point = 0; point < 2; ++point) {
        for (const auto& piece : pieces) {
            for (uint32_t i = 0; i < piece.primitives; ++i) {
                const uint32_t place = piece.place + i, provoking = piece.vertex + i + (!last ? 0 : lines ? 1 : 2);
                // A piece that begins above goes down, up, to the right: counter-clockwise. One that begins below faces
                // back, all of it.
                const bool front = lines || piece.place % 2 == 0;
                const uint32_t x = lines ? 4 + 6 * place + 3 : 4 + 6 * (place + 1), row = place % 2 == 0 ? 10 : 19;
                spots.push_back({x, (lines ? 12 : row) + 32 * point,
                                 cull != VK_CULL_MODE_NONE && !front ? 0 : writtenBy(provoking, point, front)});
            }
        }
    }
    judgeSpots(input, input.scene(record.finish()), kTarget, std::move(spots),
               "the number of the provoking vertex, of the primitive from 0x500, and 0x10000 for front faces");
}

// ---- C13: through near plane and eye ----

const char* const kThroughGlsl = R"(#version 450
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec4 colors[];
layout(location = 0) out vec4 vColor;
void main() {
    for (int i = 0; i < 3; ++i) {
        gl_Position = gl_in[i].gl_Position;
        vColor = colors[i];
        EmitVertex();
    }
}
)";

}  // namespace

void e21(CaseInput& input) {
    WindowTriangles triangles;
    for (uint32_t number = 0; number < kPoints * kInvocations * kEmitted; ++number) {
        const double x = number * 7 % 40, y = number * 11 % 37;
        triangles.push_back({{{x, y}, {x + 24, y + 3}, {x + 5, y + 26}}});
    }
    for (const bool firstWins : {false, true}) {
        SceneRecorder record("E21", "Overlapping triangles that invocations of a geometry shader make.");
        const uint32_t target = record.colorTarget("codes", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
        PipelineRecorder pipeline =
            record.pipeline(record.vertex(kNothingVertexGlsl), record.fragment(kCodeFragmentGlsl))
                .geometry(record.geometry(kOrderGlsl))
                .topology(VK_PRIMITIVE_TOPOLOGY_POINT_LIST);
        PassRecorder pass = record.pass(kTarget).color(target, {0, 0, 0, 1});
        if (firstWins) {
            pipeline.depth(VK_COMPARE_OP_LESS);
            pass.depthStencil(record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kTarget));
        }
        record.draw(pipeline, kPoints);
        record.output(target);
        PainterOptions options;
        options.firstWins = firstWins;
        judgePainter(input, input.scene(record.finish()), triangles, options);
    }
}

void v16(CaseInput& input) {
    for (const bool last : {false, true}) {
        for (const VkCullModeFlags cull : {VK_CULL_MODE_NONE, VK_CULL_MODE_BACK_BIT})
            addStrips(input, false, last, cull);
        addStrips(input, true, last, VK_CULL_MODE_NONE);
    }
}

void c13(CaseInput& input) {
    std::mt19937 random(13);
    const auto between = [&random](float low, float high) {
        return low + (high - low) * static_cast<float>(random() >> 8) * 0x1p-24f;
    };
    std::vector<ColorVertex> vertices;
    for (int i = 0; i < 24; ++i) {
        const float w = between(0.3f, 2), x = between(-2, 2) * w, y = between(-2, 2) * w, z = between(-1, 2) * w;
        vertices.push_back({{x, y, z, i % 6 == 0 ? -w : w}, {}});
        for (float& each : vertices.back().color) each = between(0, 1);
    }
    constexpr auto kFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
    constexpr auto kList = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const size_t direct = input.scene(colorScene("C13_direct", vertices, kTarget, kFormat, kList));
    const size_t through = addForOracle(input, colorScene("C13", vertices, kTarget, kFormat, kList, kThroughGlsl));
    input.judge({through, direct}, [](std::span<const Drawn* const> images, const Declared&) -> Verdict {
        return images[0]->at(0).texels == images[1]->at(0).texels
                   ? Verdict{}
                   : Verdict::allowed("a geometry shader that hands on what it gets changes bits");
    });
}

}  // namespace vernier::conformance::hardcases
