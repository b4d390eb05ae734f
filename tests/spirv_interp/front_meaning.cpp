#include "tests/spirv_interp/front_meaning.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "spirv_interp/reference/interpreter.h"

namespace vernier::test {
namespace {

constexpr size_t kBufferBytes = 512;

uint32_t mixed(uint32_t x) {
    x = (x ^ x >> 16) * 0x7FEB352Du;
    x = (x ^ x >> 15) * 0x846CA68Bu;
    return x ^ x >> 16;
}

/// A float from -4 to 4, often an integer or a half.
float someFloat(uint32_t key) {
    const uint32_t bits = mixed(key);
    const float value = static_cast<float>(bits >> 8) / static_cast<float>(1 << 24) * 8.0f - 4.0f;
    return bits % 4 == 0 ? std::round(value * 2.0f) * 0.5f : value;
}

int32_t someInt(uint32_t key) {
    const uint32_t bits = mixed(key ^ 0x55555555u);
    return bits % 3 == 0 ? static_cast<int32_t>(bits) : static_cast<int32_t>(bits >> 16 & 63) - 16;
}

uint32_t inputKey(uint32_t location, uint32_t component, uint32_t seed) {
    return seed * 4096 + location * 16 + component;
}
bool isIntLocation(uint32_t location) {
    return location == 2 || location == 3;
}

uint32_t inputBits(uint32_t location, uint32_t component, uint32_t seed) {
    const uint32_t key = inputKey(location, component, seed);
    // Unsigned inputs are small or large, never in the middle of nowhere.
    return isIntLocation(location) ? static_cast<uint32_t>(someInt(key)) : std::bit_cast<uint32_t>(someFloat(key));
}

/// The contents of a buffer: floats, with small integers where the blocks of the prologue have some.
std::vector<std::byte> bufferOf(uint32_t which, uint32_t seed) {
    std::vector<std::byte> bytes(kBufferBytes);
    for (uint32_t word = 0; word < kBufferBytes / 4; ++word) {
        const float value = someFloat(seed * 8192 + 1024 * (which + 1) + word);
        std::memcpy(bytes.data() + word * 4, &value, 4);
    }
    return bytes;
}

std::vector<uint32_t> wordsOf(const std::vector<std::byte>& bytes) {
    std::vector<uint32_t> words(bytes.size() / 4);
    if (!bytes.empty()) std::memcpy(words.data(), bytes.data(), words.size() * 4);
    return words;
}

class Buffers : public reference::Resources<double> {
  public:
    explicit Buffers(uint32_t seed) : uniform(bufferOf(0, seed)), storage(bufferOf(1, seed)), push(bufferOf(2, seed)) {
        push.resize(32);
    }
    std::span<std::byte> buffer(reference::BufferKind kind, const reference::Descriptor&) override {
        if (kind == reference::BufferKind::pushConstants) return push;
        return kind == reference::BufferKind::uniform ? uniform : storage;
    }
    std::vector<std::byte> uniform, storage, push;
};

bool sameFloat(uint32_t a, uint32_t b, double tolerance) {
    const double x = std::bit_cast<float>(a), y = std::bit_cast<float>(b);
    if (std::isnan(x) || std::isnan(y)) return std::isnan(x) && std::isnan(y);
    if (a == b || x == y) return tolerance != 0 || a == b;
    return std::fabs(x - y) <= tolerance * std::max({1.0, std::fabs(x), std::fabs(y)});
}

}  // namespace

Ending runProgram(const ir::Program& program, uint32_t seed) {
    Machine machine;
    for (const ir::InterfaceSlot& slot : program.inputs) {
        machine.inputs.push_back(inputBits(slot.location, slot.component, seed));
    }
    size_t storage = program.resources.size();
    for (size_t r = 0; r < program.resources.size(); ++r) {
        uint32_t which = 0;
        if (program.resources[r].kind == ir::ResourceKind::storageBuffer) which = 1, storage = r;
        if (program.resources[r].kind == ir::ResourceKind::pushConstants) which = 2;
        machine.buffers.push_back(bufferOf(which, seed));
        if (which == 2) machine.buffers.back().resize(32);
    }
    Ending ending;
    ending.ended = machine.run(program);
    ending.discarded = machine.killed || machine.demoted;
    for (size_t i = 0; i < program.outputs.size(); ++i) {
        const ir::InterfaceSlot& slot = program.outputs[i];
        if (!machine.written[i]) continue;
        auto& outputs = slot.type == ir::Type::f32 ? ending.floats : ending.ints;
        outputs[slot.location * 4u + slot.component] = machine.outputs[i];
    }
    ending.storage = wordsOf(storage < machine.buffers.size() ? machine.buffers[storage] : bufferOf(1, seed));
    return ending;
}

Ending runReference(const Words& words, uint32_t seed) {
    Ending ending;
    const Result<reference::Module> module = reference::Module::parse(words);
    if (!module) {
        ADD_FAILURE() << "reference: " << module.error().message;
        return ending;
    }
    // In double, so that a module's own doubles keep their bits; a float result rounded from it is the float result.
    reference::Options options;
    options.roundToFloat = true;
    const auto interpreter =
        reference::Interpreter<double>::create(*module, spv::ExecutionModelFragment, "main", options);
    if (!interpreter) {
        ADD_FAILURE() << "reference: " << interpreter.error().message;
        return ending;
    }
    reference::InterfaceValues<double> inputs;
    for (uint32_t location = 0; location < 7; ++location) {
        for (uint32_t component = 0; component < 4; ++component) {
            auto& scalar = inputs.locations[location][component];
            const uint32_t bits = inputBits(location, component, seed);
            scalar = isIntLocation(location) ? reference::Scalar<double>::ofBits(bits)
                                             : reference::Scalar<double>::ofNumber(std::bit_cast<float>(bits));
        }
    }
    Buffers buffers(seed);
    const auto outcome = interpreter->run(inputs, buffers);
    if (!outcome) {
        ADD_FAILURE() << "reference: " << outcome.error().message;
        return ending;
    }
    ending.discarded = outcome->discarded;
    for (const auto& [location, texel] : outcome->outputs.locations) {
        for (uint32_t component = 0; component < 4; ++component) {
            const uint32_t at = location.location * 4 + component;
            if (location.location == 0) {
                ending.floats[at] = std::bit_cast<uint32_t>(static_cast<float>(texel[component].number));
            } else {
                ending.ints[at] = static_cast<uint32_t>(texel[component].bits);
            }
        }
    }
    ending.storage = wordsOf(buffers.storage);
    return ending;
}

void compare(const Ending& expected, const Ending& got, double tolerance, const std::string& what) {
    EXPECT_TRUE(expected.ended && got.ended) << what;
    EXPECT_EQ(expected.discarded, got.discarded) << what;
    if (!expected.discarded) {
        for (const auto& [at, bits] : expected.floats) {
            const auto found = got.floats.find(at);
            const uint32_t other = found != got.floats.end() ? found->second : 0;
            EXPECT_TRUE(sameFloat(bits, other, tolerance))
                << what << ": o[" << at << "] is " << std::bit_cast<float>(other) << " instead of "
                << std::bit_cast<float>(bits);
        }
        for (const auto& [at, bits] : expected.ints) {
            const auto found = got.ints.find(at);
            EXPECT_EQ(bits, found != got.ints.end() ? found->second : 0) << what << ": p[" << at - 4 << "]";
        }
    }
    for (size_t word = 0; word < expected.storage.size(); ++word) {
        EXPECT_TRUE(sameFloat(expected.storage[word], got.storage[word], tolerance))
            << what << ": storage word " << word << " is " << got.storage[word] << " instead of "
            << expected.storage[word];
    }
}

}  // namespace vernier::test
