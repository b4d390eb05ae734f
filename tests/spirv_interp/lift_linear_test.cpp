// Expressions of interpolated inputs that are evaluated at the vertices: which they are, and how far the results are
// from the exact ones.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "spirv_interp/ir/link.h"
#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/verify.h"
#include "tests/spirv_interp/batch_harness.h"

namespace vernier::test {
namespace {

constexpr uint32_t kInputs = 4, kPixels = 64;

/// Hands its inputs on.
ir::Program vertexProgram() {
    std::string head = "program vertex \"main\"\n", outputs, body = "b0:\n";
    for (uint32_t k = 0; k < kInputs; ++k) {
        const std::string n = std::to_string(k);
        head += "input " + n + " f32 user " + n + ".0\n";
        outputs += "output " + n + " f32 user " + n + ".0\n";
        body += "  %" + n + " f32 = input #" + n + "\n";
    }
    for (uint32_t k = 0; k < kInputs; ++k)
        body += "  storeOutput #" + std::to_string(k) + " %" + std::to_string(k) + "\n";
    return parseProgram(head + outputs + body + "  ret\n");
}

/// Inputs %0 to %3, uniforms %5 to %8; the body begins with %9 and ends with a value to store.
ir::Program fragmentProgram(const std::string& body, const std::string& result,
                            const std::string& interpolation = "smooth center") {
    std::string text = "program fragment \"main\"\n";
    for (uint32_t k = 0; k < kInputs; ++k)
        text += "input " + std::to_string(k) + " f32 user " + std::to_string(k) + ".0 " + interpolation + "\n";
    text += "output 0 f32 user 0.0\nresource 0 uniformBuffer 0.0 x1 read\nb0:\n";
    for (uint32_t k = 0; k < kInputs; ++k)
        text += "  %" + std::to_string(k) + " f32 = input #" + std::to_string(k) + "\n";
    text += "  %4 i32 = constant 0x0\n";
    for (uint32_t k = 0; k < 4; ++k)
        text += "  %" + std::to_string(5 + k) + " f32 = loadBuffer #0 %4 %" + std::to_string(9 + k) + "\n";
    // Places of the uniforms come first.
    const size_t at = text.find("  %5 f32");
    std::string places;
    for (uint32_t k = 0; k < 4; ++k)
        places += "  %" + std::to_string(9 + k) + " i32 = constant 0x" + (k == 3 ? "c" : std::to_string(4 * k)) + "\n";
    text.insert(at, places);
    return parseProgram(text + body + "  storeOutput #0 " + result + "\n  ret\n");
}

struct Linked {
    ir::Program vertex, fragment;
    ir::LinkFacts facts;
};

Linked linked(const ir::Program& fragment, const ir::LinkOptions& options) {
    Linked all{vertexProgram(), fragment, {}};
    const Status status = ir::linkStages(all.vertex, all.fragment, &all.facts, options);
    EXPECT_TRUE(status.ok()) << status.error().message;
    EXPECT_TRUE(ir::verify(all.vertex).ok()) << ir::verify(all.vertex).error().message;
    EXPECT_TRUE(ir::verify(all.fragment).ok()) << ir::verify(all.fragment).error().message;
    return all;
}

struct Expression {
    const char *body, *result;
    uint32_t operations;
    std::array<int, kInputs> uniform;  // term k is input k times this uniform (-1: 1, -2: none)
    int constant;                      // the uniform that is added; -1: none
};

constexpr Expression kExpressions[] = {
    {"  %13 f32 = fmul %0 %5\n  %14 f32 = fmul %6 %1\n  %15 f32 = fadd %13 %14\n  %16 f32 = fmul %2 %7\n"
     "  %17 f32 = fadd %15 %16\n  %18 f32 = fadd %17 %8\n",
     "%18",
     6,
     {0, 1, 2, -2},
     3},
    {"  %13 f32 = fmul %0 %5\n  %14 f32 = ffma %6 %1 %13\n  %15 f32 = ffma %2 %7 %14\n  %16 f32 = ffma %3 %8 %15\n",
     "%16",
     4,
     {0, 1, 2, 3},
     -1},
    {"  %13 f32 = fneg %0\n  %14 f32 = fsub %1 %13\n  %15 f32 = fadd %14 %2\n  %16 f32 = fadd %15 %3\n"
     "  %17 f32 = fadd %16 %6\n",
     "%17",
     5,
     {-1, -1, -1, -1},
     1},
};

float floatOf(uint32_t bits) {
    return std::bit_cast<float>(bits);
}

/// A triangle's pixels, the values of all inputs at its vertices, and the uniforms.
struct World {
    explicit World(uint32_t seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> unit(0, 1);
        const auto number = [&] { return std::ldexp(unit(random) * 2 - 1, static_cast<int>(unit(random) * 24) - 12); };
        for (auto& values : vertices)
            for (float& value : values) value = number();
        for (float& value : uniforms) value = number();
        for (uint32_t p = 0; p < kPixels; ++p) {
            const float a = unit(random), b = unit(random);
            weights[p] = {a + b < 1 ? a : 1 - a, a + b < 1 ? b : 1 - b};
        }
    }
    std::array<std::array<float, kInputs>, 3> vertices;
    std::array<float, 4> uniforms;
    std::array<std::array<float, 2>, kPixels> weights;
};

/// The fragment program's results, its inputs interpolated as the rasteriser does it.
std::vector<float> draw(const Linked& programs, const World& world, Isa isa) {
    BufferBinding buffer{reinterpret_cast<std::byte*>(const_cast<float*>(world.uniforms.data())), 16};
    const std::vector<uint32_t> base(4, 0), count(4, 1);
    RunSetup setup;
    setup.isa = isa;
    setup.bindings.buffers = &buffer;
    setup.bindings.base = base.data();
    setup.bindings.count = count.data();
    setup.lanes = 4;
    std::vector<std::vector<uint32_t>> attributes;
    for (const ir::InterfaceSlot& slot : programs.vertex.inputs) {
        attributes.emplace_back(kPixels);
        for (uint32_t v = 0; v < 3; ++v)
            attributes.back()[v] = std::bit_cast<uint32_t>(world.vertices[v][slot.location]);
    }
    const RunResult vertices = runBatch(programs.vertex, attributes, setup);
    std::vector<std::vector<uint32_t>> inputs;
    for (const ir::InterfaceSlot& slot : programs.fragment.inputs) {
        inputs.emplace_back(kPixels);
        for (size_t out = 0; out < programs.vertex.outputs.size(); ++out) {
            const ir::InterfaceSlot& from = programs.vertex.outputs[out];
            if (from.location != slot.location || from.component != slot.component) continue;
            const std::vector<uint32_t>& values = vertices.outputs[out];
            for (uint32_t p = 0; p < kPixels; ++p) {
                const float first = floatOf(values[0]);
                const float d1 = floatOf(values[1]) - first, d2 = floatOf(values[2]) - first;
                const float part1 = world.weights[p][0] * d1, part2 = world.weights[p][1] * d2;
                inputs.back()[p] = std::bit_cast<uint32_t>(first + (part1 + part2));
            }
        }
    }
    setup.lanes = kPixels;
    const RunResult pixels = runBatch(programs.fragment, inputs, setup);
    std::vector<float> results;
    for (const uint32_t word : pixels.outputs[0]) results.push_back(floatOf(word));
    return results;
}

TEST(LiftLinear, StaysWithinItsBound) {
    double worst = 0;
    for (const Expression& expression : kExpressions) {
        const ir::Program fragment = fragmentProgram(expression.body, expression.result);
        const Linked direct = linked(fragment, {}), lifted = linked(fragment, {.liftLinear = true});
        EXPECT_EQ(direct.facts.lifted.linear, 0u);
        EXPECT_EQ(lifted.facts.lifted.linear, expression.operations);
        for (uint32_t seed = 0; seed < 200; ++seed) {
            const World world(seed);
            const auto termsAt = [&](const auto& inputs, bool absolute) {
                double sum = expression.constant < 0 ? 0 : double{world.uniforms[expression.constant]};
                if (absolute) sum = std::fabs(sum);
                for (uint32_t k = 0; k < kInputs; ++k) {
                    const int u = expression.uniform[k];
                    if (u == -2) continue;
                    const double term = double{inputs[k]} * (u < 0 ? 1.0 : double{world.uniforms[u]});
                    sum += absolute ? std::fabs(term) : term;
                }
                return sum;
            };
            double most = 0;
            for (const auto& vertex : world.vertices) most = std::max(most, termsAt(vertex, true));
            const double bound = double{ir::kLinearError} * (expression.operations + 4) * most;
            const std::vector<float> results[] = {draw(direct, world, bestIsa()), draw(lifted, world, bestIsa())};
            for (uint32_t p = 0; p < kPixels; ++p) {
                std::array<double, kInputs> inputs;
                for (uint32_t k = 0; k < kInputs; ++k) {
                    const auto& v = world.vertices;
                    inputs[k] = double{v[0][k]} + double{world.weights[p][0]} * (double{v[1][k]} - double{v[0][k]}) +
                                double{world.weights[p][1]} * (double{v[2][k]} - double{v[0][k]});
                }
                for (const auto& result : results) {
                    const double error = std::fabs(double{result[p]} - termsAt(inputs, false));
                    ASSERT_LE(error, bound) << expression.body << "seed " << seed << " pixel " << p;
                    worst = std::max(worst, error / bound);
                }
            }
        }
    }
    EXPECT_GT(worst, 0.1);  // or the bound says little
}

/// The operations that are lifted when everything may be.
uint32_t liftedOf(const std::string& body, const std::string& result, const char* interpolation = "smooth center") {
    return linked(fragmentProgram(body, result, interpolation), {.liftLinear = true}).facts.lifted.linear;
}

TEST(LiftLinear, OnlyWhatIsLinear) {
    const std::string sum =
        "  %13 f32 = fmul %0 %5\n  %14 f32 = fmul %1 %6\n  %15 f32 = fadd %13 %14\n"
        "  %16 f32 = fmul %2 %7\n  %17 f32 = fadd %15 %16\n  %18 f32 = fmul %17 %8\n";
    EXPECT_EQ(liftedOf(sum, "%18"), 6u);
    EXPECT_EQ(liftedOf(sum, "%18", "noPerspective centroid"), 6u);
    // A product of two inputs is not; what leads up to it is, though it may not pay.
    EXPECT_EQ(liftedOf(sum + "  %19 f32 = fmul %18 %3\n", "%19"), 6u);
    EXPECT_EQ(liftedOf("  %13 f32 = fmul %0 %1\n  %14 f32 = fmul %13 %2\n  %15 f32 = fmul %14 %3\n"
                       "  %16 f32 = fadd %15 %5\n  %17 f32 = fadd %16 %6\n  %18 f32 = fadd %17 %7\n",
                       "%18"),
              0u);
    EXPECT_EQ(liftedOf("  %13 f32 = fdiv %5 %0\n  %14 f32 = fdiv %6 %1\n  %15 f32 = fadd %13 %14\n"
                       "  %16 f32 = fadd %15 %5\n  %17 f32 = fadd %16 %6\n  %18 f32 = fadd %17 %7\n",
                       "%18"),
              0u);
    // What costs as much as the input it would become stays.
    EXPECT_EQ(liftedOf("  %13 f32 = fmul %0 %5\n", "%13"), 0u);
}

TEST(LiftLinear, NotWhatMustBeExact) {
    std::string sum, exact = " !noContraction";
    for (const char* line : {"%13 f32 = fmul %0 %5", "%14 f32 = fmul %1 %6", "%15 f32 = fadd %13 %14",
                             "%16 f32 = fmul %2 %7", "%17 f32 = fadd %15 %16", "%18 f32 = fmul %17 %8"})
        sum += "  " + std::string(line) + exact + "\n";
    EXPECT_EQ(liftedOf(sum, "%18"), 0u);
}

TEST(LiftLinear, NotInputsOfSeveralKinds) {
    ir::Program fragment = fragmentProgram(
        "  %13 f32 = fmul %0 %5\n  %14 f32 = fmul %1 %6\n  %15 f32 = fadd %13 %14\n  %16 f32 = fmul %15 %7\n"
        "  %17 f32 = fadd %16 %8\n  %18 f32 = fadd %17 %7\n",
        "%18");
    EXPECT_EQ(linked(fragment, {.liftLinear = true}).facts.lifted.linear, 6u);
    fragment.inputs[1].sampling = ir::Sampling::centroid;
    EXPECT_EQ(linked(fragment, {.liftLinear = true}).facts.lifted.linear, 0u);
    fragment.inputs[1].sampling = ir::Sampling::center;
    fragment.inputs[1].interpolation = ir::Interpolation::noPerspective;
    EXPECT_EQ(linked(fragment, {.liftLinear = true}).facts.lifted.linear, 0u);
}

}  // namespace
}  // namespace vernier::test
