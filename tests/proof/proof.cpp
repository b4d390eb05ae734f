#include "tests/proof/proof.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include "spirv_interp/ir/place_vertices.h"

namespace vernier::proof {
namespace {

bool isNan(uint32_t bits) {
    return (bits & 0x7FFFFFFFu) > 0x7F800000u;
}
bool sameWord(uint32_t a, uint32_t b) {
    return a == b || (isNan(a) && isNan(b));
}
bool sameHalf(uint32_t a, uint32_t b) {
    return a == b || ((a & 0x7FFFu) > 0x7C00u && (b & 0x7FFFu) > 0x7C00u);
}
/// Nobody says which words of a buffer are floats, and of how many bits.
bool sameMemory(uint32_t a, uint32_t b) {
    return sameWord(a, b) || (sameHalf(a & 0xFFFFu, b & 0xFFFFu) && sameHalf(a >> 16, b >> 16));
}

std::string hex(uint32_t bits) {
    std::ostringstream text;
    float value = 0;
    std::memcpy(&value, &bits, 4);
    text << std::hex << "0x" << bits << " (" << std::dec << value << ")";
    return text.str();
}

std::string nameOf(const Slot& slot) {
    if (slot == kPushConstants) return "push constants";
    return "set " + std::to_string(slot.set) + " binding " + std::to_string(slot.binding) + "[" +
           std::to_string(slot.element) + "]";
}

/// Collects lines up to a limit.
class Lines {
  public:
    explicit Lines(size_t limit) : limit_(limit) {}
    void add(const std::string& line) {
        if (count_++ < limit_) text_ += "  " + line + "\n";
    }
    std::string text() const {
        return count_ > limit_ ? text_ + "  and " + std::to_string(count_ - limit_) + " more\n" : text_;
    }

  private:
    size_t limit_, count_ = 0;
    std::string text_;
};

}  // namespace

std::vector<Shape> maskShapes(const Case& subject) {
    if (subject.stage == ir::Stage::compute) return {{"all", {}, {}}};
    const uint32_t invocations = subject.invocations;
    const uint64_t seed = subject.world.seed;
    std::vector<Shape> shapes;
    const auto add = [&](const char* name, auto exec, auto store) {
        Shape shape{name, std::vector<bool>(invocations), std::vector<bool>(invocations)};
        for (uint32_t k = 0; k < invocations; ++k) {
            shape.exec[k] = exec(k);
            shape.store[k] = shape.exec[k] && store(k);
        }
        shapes.push_back(std::move(shape));
    };
    const auto yes = [](uint32_t) { return true; };
    const auto noise = [seed](uint32_t k, uint32_t salt) { return specialWord(seed * 64 + k * 2 + salt) >> 3 & 1; };
    const uint32_t one = static_cast<uint32_t>(seed * 7 + 5) % invocations;
    add("all", yes, yes);
    add(
        "one alone", [=](uint32_t k) { return k == one; }, yes);
    add(
        "every other quad", [](uint32_t k) { return k / 4 % 2 == 1; }, yes);
    add(
        "the first 11", [](uint32_t k) { return k < 11; }, yes);
    add(
        "random", [=](uint32_t k) { return noise(k, 0) != 0; }, [=](uint32_t k) { return noise(k, 1) != 0; });
    return shapes;
}

size_t outputCount(const ir::Program& program) {
    if (program.stage != ir::Stage::geometry) return program.outputs.size();
    return size_t{ir::wordsOfVertex(program)} * program.geometry.outputVertices + 1;
}

const ir::InterfaceSlot& outputAt(const ir::Program& program, size_t output) {
    if (program.stage != ir::Stage::geometry) return program.outputs[output];
    return output + 1 == outputCount(program) ? program.outputs.back()
                                              : program.outputs[output % ir::wordsOfVertex(program)];
}

uint32_t invocationOfInput(const ir::Program& program, const ir::InterfaceSlot& slot, uint32_t invocation) {
    if (program.stage == ir::Stage::geometry) return invocation * 8 + slot.index;
    return slot.index != 0 ? invocation * 40 + slot.index : invocation;
}

Program lower(const Case& subject) {
    Program result;
    ShaderSource source;
    source.words = subject.words;
    source.stage = subject.stage;
    std::vector<Specialization::Entry> entries;
    for (uint32_t k = 0; k < subject.specialization.size(); ++k) {
        entries.push_back({subject.specialization[k].id, k * static_cast<uint32_t>(sizeof(SpecConstant)) + 4, 4});
    }
    source.specialization = {entries, std::as_bytes(std::span(subject.specialization))};
    auto program = loadShader(source);
    if (!program) {
        result.error = "front: " + program.error().message;
    } else {
        result.ir = std::move(*program);
    }
    return result;
}

std::string compare(const ir::Program& program, const Shape& shape, const Ending& expected, const Ending& got,
                    size_t limit) {
    Lines lines(limit);
    if (expected.error != got.error) return "  " + expected.error + " | " + got.error + "\n";
    for (size_t k = 0; k < shape.store.size(); ++k) {
        if (!shape.store[k]) continue;
        if (expected.live[k] != got.live[k]) {
            lines.add("invocation " + std::to_string(k) + (got.live[k] ? " is not discarded" : " is discarded"));
            continue;
        }
        if (!expected.live[k]) continue;
        for (size_t s = 0; s < expected.outputs.size(); ++s) {
            const uint32_t a = expected.outputs[s][k], b = got.outputs[s][k];
            const ir::InterfaceSlot& output = outputAt(program, s);
            const bool floating = output.type == ir::Type::f32;
            if (!expected.written[s][k] || a == b || (floating && sameWord(a, b))) continue;
            lines.add("invocation " + std::to_string(k) + " output " + std::to_string(output.location) + "." +
                      std::to_string(output.component) + " (built-in " +
                      std::to_string(static_cast<int>(output.builtin)) + ", number " + std::to_string(s) +
                      "): " + hex(b) + " instead of " + hex(a));
        }
    }
    for (const auto& [slot, bytes] : expected.memory->buffers()) {
        const auto& others = got.memory->buffer(slot);
        for (size_t at = 0; at + 4 <= bytes.size(); at += 4) {
            uint32_t a = 0, b = 0;
            std::memcpy(&a, bytes.data() + at, 4);
            std::memcpy(&b, others.data() + at, 4);
            if (!sameMemory(a, b))
                lines.add(nameOf(slot) + " word " + std::to_string(at / 4) + ": " + hex(b) + " instead of " + hex(a));
        }
    }
    for (const auto& [slot, image] : expected.memory->images()) {
        const auto &a = image.texels(), &b = got.memory->image(slot).texels();
        for (size_t k = 0; k < a.size(); ++k) {
            if (!std::equal(a[k].begin(), a[k].end(), b[k].begin(), sameWord))
                lines.add(nameOf(slot) + " texel " + std::to_string(k) + ": " + hex(b[k][0]) + " instead of " +
                          hex(a[k][0]));
        }
    }
    return lines.text();
}

std::string differences(const Case& subject, const ProofOptions& options) {
    const Program program = lower(subject);
    if (!program.error.empty()) return program.error + "\n";
    std::string all;
    std::vector<Shape> shapes = maskShapes(subject);
    if (!options.allShapes) shapes.resize(1);
    for (const Shape& shape : shapes) {
        const Ending expected = runReference(subject, program.ir, shape, options.tier);
        if (!expected.error.empty()) return expected.error + "\n";
        for (const Isa isa : availableIsas()) {
            for (const uint32_t lanes : options.lanes) {
                if (program.ir.usesSubgroups && lanes < ir::kSubgroupSize) continue;  // refused
                const Ending got = runBatch(subject, program.ir, shape, {isa, options.tier, lanes});
                const std::string text = compare(program.ir, shape, expected, got);
                if (!text.empty()) {
                    all += subject.name + ", " + std::string(isaName(isa)) + ", " + std::to_string(lanes) +
                           " lanes, invocations: " + shape.name + "\n" + text;
                }
            }
        }
        if (all.size() > 4000) break;
    }
    return all;
}

}  // namespace vernier::proof
