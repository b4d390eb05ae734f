// What a dispatched operation costs: nanoseconds per operation and lane by batch width and instruction set, and whole
// programs against loops that a compiler fused for the same instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/micro/interp_cost.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "base/simd.h"

#ifndef VERNIER_INTERP_COST_SHARED
#define VERNIER_INTERP_COST_SHARED
namespace vernier::bench {
inline constexpr int kJuliaRounds = 96, kBodies = 64, kNoiseRounds = 8;
}  // namespace vernier::bench
#endif

HWY_BEFORE_NAMESPACE();
namespace vernier::bench::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using F = hn::ScalableTag<float>;
using U = hn::ScalableTag<uint32_t>;
constexpr F kF{};
constexpr U kU{};

/// Lanes leave the loop at different rounds.
void julia(const float*, const float* const* in, float* const* out, size_t lanes) {
    const auto four = hn::Set(kF, 4.0f), cx = hn::Set(kF, -0.79f), cy = hn::Set(kF, 0.15f), one = hn::Set(kF, 1.0f);
    for (size_t k = 0; k < lanes; k += hn::Lanes(kF)) {
        auto x = hn::Load(kF, in[0] + k), y = hn::Load(kF, in[1] + k), rounds = hn::Zero(kF);
        for (int n = 0; n < kJuliaRounds; ++n) {
            const auto xx = hn::Mul(x, x), yy = hn::Mul(y, y);
            const auto inside = hn::Lt(hn::Add(xx, yy), four);
            if (hn::AllFalse(kF, inside)) break;
            const auto xy = hn::Mul(hn::Mul(hn::Set(kF, 2.0f), x), y);
            x = hn::IfThenElse(inside, hn::Add(hn::Sub(xx, yy), cx), x);
            y = hn::IfThenElse(inside, hn::Add(xy, cy), y);
            rounds = hn::Add(rounds, hn::IfThenElseZero(inside, one));
        }
        hn::Store(rounds, kF, out[0] + k);
    }
}

/// All lanes walk over the same bodies.
void bodies(const float* uniforms, const float* const* in, float* const* out, size_t lanes) {
    for (size_t k = 0; k < lanes; k += hn::Lanes(kF)) {
        const auto x = hn::Load(kF, in[0] + k), y = hn::Load(kF, in[1] + k);
        auto ax = hn::Zero(kF), ay = hn::Zero(kF);
        for (int n = 0; n < kBodies; ++n) {
            const float* body = uniforms + 4 * n;
            const auto dx = hn::Sub(hn::Set(kF, body[0]), x), dy = hn::Sub(hn::Set(kF, body[1]), y);
            const auto d2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Set(kF, 0.01f));
            const auto scale = hn::Div(hn::Set(kF, body[2]), hn::Mul(d2, hn::Sqrt(d2)));
            ax = hn::Add(ax, hn::Mul(dx, scale));
            ay = hn::Add(ay, hn::Mul(dy, scale));
        }
        hn::Store(hn::Add(ax, ay), kF, out[0] + k);
    }
}

/// Integer hashing, as in value noise.
void noise(const float*, const float* const* in, float* const* out, size_t lanes) {
    for (size_t k = 0; k < lanes; k += hn::Lanes(kF)) {
        auto h = hn::BitCast(kU, hn::Load(kF, in[0] + k));
        auto sum = hn::Zero(kF);
        for (uint32_t n = 0; n < uint32_t{kNoiseRounds}; ++n) {
            h = hn::Mul(hn::Xor(h, hn::ShiftRight<16>(h)), hn::Set(kU, 0x7feb352du));
            h = hn::Mul(hn::Xor(h, hn::ShiftRight<15>(h)), hn::Set(kU, 0x846ca68bu));
            h = hn::Add(hn::Xor(h, hn::ShiftRight<16>(h)), hn::Set(kU, n));
            const hn::RebindToSigned<F> i;
            const auto value = hn::ConvertTo(kF, hn::BitCast(i, hn::ShiftRight<8>(h)));
            sum = hn::Add(hn::Mul(sum, hn::Set(kF, 0.5f)), hn::Mul(value, hn::Set(kF, 0x1p-24f)));
        }
        hn::Store(sum, kF, out[0] + k);
    }
}

}  // namespace vernier::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <vernier/vernier_glsl.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "spirv_interp/ir/builder.h"
#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/program.h"

namespace vernier::bench {
namespace {

constexpr uint32_t kWidths[] = {16, 32, 64};

/// The least time of a call, in seconds: the rest is somebody else's.
double secondsOf(const std::function<void()>& call) {
    using Clock = std::chrono::steady_clock;
    double best = 1;
    uint32_t calls = 1;
    for (int round = 0; round < 12;) {
        const auto begin = Clock::now();
        for (uint32_t k = 0; k < calls; ++k) call();
        const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        if (seconds < 1e-3) {
            calls *= 2;
            continue;
        }
        best = std::min(best, seconds / calls);
        ++round;
    }
    return best;
}

/// A compiled program with its buffer and its inputs filled.
class Running {
  public:
    Running(const ir::Program& program, Isa isa, uint32_t lanes, std::vector<float>& uniforms)
        : compiled_(BatchProgram::compile(program, {isa, MathTier::standard, lanes})),
          buffer_{reinterpret_cast<std::byte*>(uniforms.data()), static_cast<uint32_t>(uniforms.size() * 4)},
          inputs_(static_cast<uint32_t>(program.inputs.size())) {
        if (!compiled_) {
            std::fprintf(stderr, "%s\n", compiled_.error().message.c_str());
            std::exit(1);
        }
        bindings_.buffers = &buffer_;
        bindings_.base = &first_;
        bindings_.count = &count_;
        context_ = std::make_unique<BatchContext>(*compiled_);
        context_->beginDraw(bindings_);
    }
    uint32_t lanes() const { return (*compiled_)->lanes(); }

    /// Runs use up their inputs.
    void fill() {
        for (uint32_t slot = 0; slot < inputs_; ++slot) {
            float* row = context_->input(slot);
            if (row == nullptr) continue;
            for (uint32_t lane = 0; lane < lanes(); ++lane) row[lane] = value(slot, lane);
        }
    }
    static float value(uint32_t slot, uint32_t lane) {
        return -0.6f + 0.011f * static_cast<float>((lane * 7 + slot * 29) % 97);
    }
    void run() { context_->run(lanes(), kAll, kAll); }

  private:
    static constexpr uint32_t kAll[64] = {
        ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u,
        ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u,
        ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u};
    Result<std::shared_ptr<const BatchProgram>> compiled_;
    BufferBinding buffer_;
    uint32_t inputs_, first_ = 0, count_ = 1;
    ResourceBindings bindings_;
    std::unique_ptr<BatchContext> context_;
};

/// One row of the table of operations: `body` appends kSteps times `operations` operations.
struct OperationCase {
    const char* name;
    uint32_t operations;
    ir::ValueId (*body)(ir::Builder& builder, ir::ValueId x, ir::ValueId y, ir::ValueId z);
};
constexpr uint32_t kSteps = 128;

ir::ValueId f32(ir::Builder& builder, ir::Op op, std::initializer_list<ir::ValueId> operands) {
    return builder.append(op, ir::Type::f32, operands);
}

constexpr OperationCase kOperations[] = {
    {"add, subtract", 2,
     [](ir::Builder& b, ir::ValueId x, ir::ValueId y, ir::ValueId z) {
         return f32(b, ir::Op::fsub, {f32(b, ir::Op::fadd, {x, y}), z});
     }},
    {"multiply by a scalar", 1,
     [](ir::Builder& b, ir::ValueId x, ir::ValueId, ir::ValueId) {
         return f32(b, ir::Op::fmul, {x, b.constant(ir::Type::f32, 0x3f8ccccd)});
     }},
    {"a * b + c", 2,
     [](ir::Builder& b, ir::ValueId x, ir::ValueId y, ir::ValueId z) {
         return f32(b, ir::Op::fadd, {f32(b, ir::Op::fmul, {x, y}), z});
     }},
    {"values read twice", 2,
     [](ir::Builder& b, ir::ValueId x, ir::ValueId y, ir::ValueId z) {
         const ir::ValueId sum = f32(b, ir::Op::fadd, {x, y});
         return f32(b, ir::Op::fmul, {f32(b, ir::Op::fmax, {sum, z}), sum});
     }},
    {"compare, select", 2,
     [](ir::Builder& b, ir::ValueId x, ir::ValueId y, ir::ValueId z) {
         const auto type = static_cast<uint64_t>(ir::Type::f32);
         const ir::ValueId less = b.append(ir::Op::folt, ir::Type::b1, {x, y}, type);
         return f32(b, ir::Op::select, {less, z, x});
     }},
    {"divide", 1,
     [](ir::Builder& b, ir::ValueId x, ir::ValueId y, ir::ValueId) {
         return f32(b, ir::Op::fdiv, {x, y});
     }},
    {"square root", 1,
     [](ir::Builder& b, ir::ValueId x, ir::ValueId, ir::ValueId) { return f32(b, ir::Op::fsqrt, {x}); }},
    {"sine", 1, [](ir::Builder& b, ir::ValueId x, ir::ValueId, ir::ValueId) { return f32(b, ir::Op::fsin, {x}); }},
};

ir::Program programOf(const OperationCase& c) {
    ir::Program program;
    program.stage = ir::Stage::fragment;
    ir::Builder builder(program);
    builder.setBlock(builder.newBlock());
    ir::ValueId values[3];
    for (uint16_t k = 0; k < 3; ++k) {
        ir::InterfaceSlot slot;
        slot.location = k;
        program.inputs.push_back(slot);
        values[k] = builder.append(ir::Op::input, ir::Type::f32, {}, k);
    }
    for (uint32_t step = 0; step < kSteps; ++step) values[0] = c.body(builder, values[0], values[1], values[2]);
    program.outputs.emplace_back();
    builder.append(ir::Op::storeOutput, ir::Type::none, {values[0]}, 0);
    builder.ret();
    return program;
}

void printOperations() {
    std::printf("Nanoseconds per operation and lane\n%-24s", "");
    for (const Isa isa : availableIsas()) {
        for (const uint32_t width : kWidths) {
            const std::string name = std::string(isaName(isa)) + " x" + std::to_string(width);
            std::printf(" %11s", name.c_str());
        }
    }
    std::printf("\n");
    std::vector<float> uniforms(4);
    for (const OperationCase& c : kOperations) {
        std::printf("%-24s", c.name);
        const ir::Program program = programOf(c);
        for (const Isa isa : availableIsas()) {
            for (const uint32_t width : kWidths) {
                Running running(program, isa, width, uniforms);
                if (running.lanes() != width) {
                    std::printf(" %11s", "-");
                    continue;
                }
                running.fill();
                const double seconds = secondsOf([&] { running.run(); });
                std::printf(" %11.4f", seconds * 1e9 / (double{kSteps} * c.operations * running.lanes()));
            }
        }
        std::printf("\n");
    }
}

using Native = void (*)(const float*, const float* const*, float* const*, size_t);
Native juliaFor(Isa isa){VERNIER_SELECT_ISA(isa, julia)} Native
    bodiesFor(Isa isa){VERNIER_SELECT_ISA(isa, bodies)} Native noiseFor(Isa isa) {
    VERNIER_SELECT_ISA(isa, noise)
}

struct ProgramCase {
    const char* name;
    Native (*native)(Isa);
    const char* body;
};
constexpr ProgramCase kPrograms[] = {
    {"divergent loop (Julia)", juliaFor, R"(
    vec2 z = p;
    int n = 0;
    while (n < ROUNDS && dot(z, z) < 4.0) {
        z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + vec2(-0.79, 0.15);
        ++n;
    }
    result = float(n);)"},
    {"loop over a buffer", bodiesFor, R"(
    vec2 a = vec2(0);
    for (int n = 0; n < BODIES; ++n) {
        vec2 d = bodies[n].xy - p;
        float d2 = dot(d, d) + 0.01;
        a += d * (bodies[n].z / (d2 * sqrt(d2)));
    }
    result = a.x + a.y;)"},
    {"integer noise", noiseFor, R"(
    uint h = floatBitsToUint(p.x);
    float sum = 0.0;
    for (uint n = 0; n < NOISE; ++n) {
        h = (h ^ h >> 16) * 0x7feb352du;
        h = (h ^ h >> 15) * 0x846ca68bu;
        h = (h ^ h >> 16) + n;
        sum = sum * 0.5 + float(h >> 8) * (1.0 / 16777216.0);
    }
    result = sum;)"},
};

ir::Program programOf(const ProgramCase& c) {
    const std::string source = "#version 450\n#define ROUNDS " + std::to_string(kJuliaRounds) + "\n#define BODIES " +
                               std::to_string(kBodies) + "\n#define NOISE " + std::to_string(kNoiseRounds) +
                               "\nlayout(location = 0) in vec2 p;\nlayout(location = 0) out float result;\n"
                               "layout(set = 0, binding = 0) uniform B { vec4 bodies[BODIES]; };\nvoid main() {" +
                               c.body + "\n}\n";
    VnGlslDesc desc{};
    desc.stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    desc.source = source.c_str();
    VnGlslOutput* output = nullptr;
    if (vnCompileGlsl(&desc, &output) != VN_GLSL_SUCCESS) {
        std::fprintf(stderr, "%s\n", output != nullptr ? output->log : "out of memory");
        std::exit(1);
    }
    ShaderSource shader;
    shader.words = {output->words, output->wordCount};
    shader.stage = ir::Stage::fragment;
    Result<ir::Program> program = loadShader(shader);
    vnFreeGlslOutput(output);
    if (!program) {
        std::fprintf(stderr, "%s\n", program.error().message.c_str());
        std::exit(1);
    }
    ir::optimise(*program);
    return std::move(program).value();
}

void printPrograms(bool listings) {
    std::printf("\nNanoseconds per lane: interpreter, native loop, ratio\n%-24s", "");
    for (const Isa isa : availableIsas()) std::printf(" %26s", std::string(isaName(isa)).c_str());
    std::printf("\n");
    std::vector<float> uniforms(4 * kBodies);
    for (size_t k = 0; k < uniforms.size(); ++k) uniforms[k] = Running::value(3, static_cast<uint32_t>(k));
    for (const ProgramCase& c : kPrograms) {
        std::printf("%-24s", c.name);
        const ir::Program program = programOf(c);
        for (const Isa isa : availableIsas()) {
            if (isa > bestIsa()) {
                std::printf(" %26s", "-");
                continue;
            }
            Running running(program, isa, 0, uniforms);
            const uint32_t lanes = running.lanes();
            const double ours = secondsOf([&] {
                                    running.fill();
                                    running.run();
                                }) -
                                secondsOf([&] { running.fill(); });
            alignas(64) float rows[3][64];
            for (uint32_t slot = 0; slot < 2; ++slot) {
                for (uint32_t lane = 0; lane < 64; ++lane) rows[slot][lane] = Running::value(slot, lane);
            }
            const float* in[] = {rows[0], rows[1]};
            float* out[] = {rows[2]};
            const Native native = c.native(isa);
            const double theirs = secondsOf([&] { native(uniforms.data(), in, out, lanes); });
            std::printf("   %9.2f %8.2f %5.2f", ours * 1e9 / lanes, theirs * 1e9 / lanes, ours / theirs);
        }
        std::printf("\n");
        if (listings) {
            std::printf("%s",
                        (*BatchProgram::compile(program, {bestIsa(), MathTier::standard, 0}))->disassemble().c_str());
        }
    }
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
    const bool listings = argc > 1 && std::string(argv[1]) == "--listings";
    vernier::bench::printOperations();
    vernier::bench::printPrograms(listings);
    return 0;
}
#endif
