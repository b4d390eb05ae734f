#include "tests/proof/world.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "tests/spirv_interp/atomic_model.h"

namespace vernier::proof {
namespace {

/// SplitMix64 (Steele, Lea, Flood 2014): every key has a number of its own.
uint64_t mixed(uint64_t key) {
    uint64_t z = key + 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return z ^ z >> 31;
}

constexpr uint32_t kSpecials[] = {
    0x00000000, 0x80000000, 0x3F800000, 0xBF800000, 0x00000001, 0x80000001, 0x007FFFFF, 0x00800000, 0x7F7FFFFF,
    0xFF7FFFFF, 0x7F800000, 0xFF800000, 0x7FC00000, 0xFFC00000, 0x3F000000, 0x4B000000, 0x4F000000, 0xCF000000,
    0x4F800000, 0x3F7FFFFF, 0x40490FDB, 0x33800000, 1,          2,          0x7FFFFFFF, 0x80000001, 0xFFFFFFFF,
    31,         32,         33,         0xFFFF,     0x10000,    0x80,       0x7F,       0x8000,     0x3C00,
};

int32_t wrapped(int32_t x, int32_t size) {
    return ((x % size) + size) % size;
}

int32_t floorOf(float x) {
    // Coordinates beyond any image all count as 0.
    return std::fabs(x) < 1e6f ? static_cast<int32_t>(std::floor(x)) : 0;
}

float asFloat(uint32_t bits) {
    return std::bit_cast<float>(bits);
}

}  // namespace

uint32_t specialWord(uint64_t key) {
    const uint64_t bits = mixed(key);
    if (bits % 4 != 0) return kSpecials[(bits >> 8) % std::size(kSpecials)];
    return static_cast<uint32_t>(bits >> 32);
}

// --- images

TestImage::TestImage(uint64_t seed, bool integers) : integers_(integers), texels_(size_t{kSize} * kSize * kDepth) {
    for (size_t k = 0; k < texels_.size(); ++k) {
        const auto x = static_cast<float>(k % kSize), y = static_cast<float>(k / kSize % kSize);
        for (uint32_t c = 0; c < 4; ++c) {
            const auto noise = static_cast<uint32_t>(mixed(seed * 977 + k * 4 + c) >> 40);
            // A gradient with noise on it: neighbouring texels are alike but never the same.
            const float value = (c % 2 == 0 ? x : y) / kSize * 0.75f + static_cast<float>(noise) * 0x1p-26f;
            texels_[k][c] = integers ? noise % 256 : std::bit_cast<uint32_t>(value);
        }
    }
}

std::array<uint32_t, 4> TestImage::texelAt(int32_t x, int32_t y, int32_t z, int32_t level) const {
    const int32_t size = kSize >> level;
    const int32_t u = wrapped(x, size) << level, v = wrapped(y, size) << level, w = wrapped(z, kDepth);
    return texels_[static_cast<size_t>((w * kSize + v) * kSize + u)];
}

/// Bilinear in s and t, nearest in everything else.
std::array<float, 4> TestImage::sample(const ImageAccess& a, float lod) const {
    const float clamped = lod > 0 ? std::min(lod, static_cast<float>(kLevels - 1)) : 0.0f;  // NaN: 0
    const auto level = static_cast<int32_t>(clamped + 0.5f);
    const auto size = static_cast<float>(kSize >> level);
    const bool line = a.dim == ir::ImageDim::d1, cube = a.dim == ir::ImageDim::cube;
    std::array<float, 3> c{a.coordinates[0], a.coordinates[1], a.coordinates[2]};
    int32_t z = 0;
    if (cube) {
        const float x = std::fabs(c[0]), y = std::fabs(c[1]), depth = std::fabs(c[2]);
        const uint32_t axis = x >= y && x >= depth ? 0 : y >= depth ? 1 : 2;
        const float major = c[axis];
        z = static_cast<int32_t>(axis * 2) + (major < 0 ? 1 : 0);
        const float s = c[(axis + 1) % 3] / major, t = c[(axis + 2) % 3] / major;
        c = {s * 0.5f + 0.5f, t * 0.5f + 0.5f, 0};
    } else if (a.dim == ir::ImageDim::d3) {
        z = floorOf(c[2] * kDepth) + a.offset[2];
    }
    if (a.arrayed) z += floorOf(a.coordinates[line ? 1 : cube ? 3 : 2] + 0.5f);
    const float u = c[0] * size - 0.5f, v = line ? 0.0f : c[1] * size - 0.5f;
    const int32_t x = floorOf(u), y = floorOf(v);
    const float fx = std::fabs(u) < 1e6f ? u - static_cast<float>(x) : 0.0f;
    const float fy = std::fabs(v) < 1e6f ? v - static_cast<float>(y) : 0.0f;
    std::array<float, 4> result{};
    const auto at = [&](int32_t dx, int32_t dy) {
        return texelAt(x + dx + a.offset[0], y + dy + (line ? 0 : a.offset[1]), z, level);
    };
    const std::array<std::array<uint32_t, 4>, 4> corners{at(0, 0), at(1, 0), at(0, 1), at(1, 1)};
    if (a.kind == ir::ImageKind::gather) {
        // (0,1) (1,1) (1,0) (0,0): Vulkan specification, "Texel Gathering".
        constexpr uint32_t kOrder[] = {2, 3, 1, 0};
        for (uint32_t k = 0; k < 4; ++k) {
            const uint32_t bits = corners[kOrder[k]][a.compare ? 0 : a.component & 3];
            result[k] = a.compare ? (a.reference <= asFloat(bits) ? 1.0f : 0.0f) : asFloat(bits);
        }
        return result;
    }
    const std::array<float, 4> weights{(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
    for (uint32_t channel = 0; channel < 4; ++channel) {
        if (integers_) {
            result[channel] = asFloat(corners[0][channel]);
            continue;
        }
        for (uint32_t k = 0; k < 4; ++k) {
            const float texel = asFloat(corners[k][channel]);
            result[channel] += weights[k] * (a.compare ? (a.reference <= texel ? 1.0f : 0.0f) : texel);
        }
    }
    return result;
}

std::array<uint32_t, 4> TestImage::storage(const ImageAccess& a) {
    const bool line = a.dim == ir::ImageDim::d1 || a.dim == ir::ImageDim::buffer;
    const int32_t x = a.texel[0], y = line ? 0 : a.texel[1];
    const bool layered = a.dim == ir::ImageDim::d3 || a.dim == ir::ImageDim::cube;
    int32_t z = layered ? a.texel[2] : 0;
    if (a.arrayed) z = a.texel[line ? 1 : 2];
    if (x < 0 || x >= kSize || y < 0 || y >= kSize || z < 0 || z >= kDepth) return {};
    auto& texel = texels_[static_cast<size_t>((z * kSize + y) * kSize + x)];
    const std::array<uint32_t, 4> old = texel;
    if (a.kind == ir::ImageKind::store) texel = a.value;
    if (a.kind != ir::ImageKind::atomic) return old;
    const uint32_t left = test::atomicResult(a.atomic, old[0], a.value[0], a.comparator);
    if (a.atomic != ir::AtomicOp::load) texel = {left, 0, 0, 0};  // the formats that have atomics have one component
    return {old[0], 0, 0, 0};
}

std::array<uint32_t, 4> TestImage::access(const ImageAccess& a) {
    const auto levelOfDetail = [&] {
        float square = 0;
        for (const auto& d : {a.ddx, a.ddy}) {
            float sum = 0;
            for (uint32_t k = 0; k < 2; ++k) sum += d[k] * kSize * (d[k] * kSize);
            square = std::max(square, sum);
        }
        return square > 0 ? 0.5f * std::log2(square) : -16.0f;
    };
    const auto bits = [](const std::array<float, 4>& v) { return std::bit_cast<std::array<uint32_t, 4>>(v); };
    switch (a.kind) {
        case ir::ImageKind::sampleImplicit:
            return bits(sample(a, std::max(levelOfDetail() + a.bias, a.minLod)));
        case ir::ImageKind::sampleGrad:
            return bits(sample(a, std::max(levelOfDetail(), a.minLod)));
        case ir::ImageKind::sampleLod:
            return bits(sample(a, a.lod));
        case ir::ImageKind::gather:
            return bits(sample(a, 0));
        case ir::ImageKind::fetch: {
            if (a.level < 0 || a.level >= kLevels) return {};
            const int32_t layer = a.dim == ir::ImageDim::d3 || a.arrayed ? a.texel[2] : a.sample;
            return texelAt(a.texel[0] + a.offset[0], a.texel[1] + a.offset[1], layer + a.offset[2], a.level);
        }
        case ir::ImageKind::read:
        case ir::ImageKind::store:
        case ir::ImageKind::atomic:
            return storage(a);
        case ir::ImageKind::querySize: {
            const int32_t level = a.level < 0 || a.level >= kLevels ? 0 : a.level;
            const auto size = static_cast<uint32_t>(kSize >> level);
            std::array<uint32_t, 4> result{};
            const uint32_t spatial = a.dim == ir::ImageDim::d1 || a.dim == ir::ImageDim::buffer ? 1
                                     : a.dim == ir::ImageDim::d3                                ? 3
                                                                                                : 2;
            for (uint32_t k = 0; k < spatial; ++k) result[k] = size;
            if (a.arrayed) result[spatial] = kDepth;
            return result;
        }
        case ir::ImageKind::queryLevels:
            return {kLevels, 0, 0, 0};
        case ir::ImageKind::querySamples:
            return {4, 0, 0, 0};
        case ir::ImageKind::queryLod: {
            const float lod = levelOfDetail();
            return bits({std::max(lod, 0.0f), lod, 0, 0});
        }
    }
    return {};
}

// --- inputs and buffers

double World::fraction(uint64_t key) const {
    return static_cast<double>(mixed(seed * 0x10001 + key) >> 11) * 0x1p-53;
}

uint32_t World::input(uint32_t invocation, const ir::InterfaceSlot& slot) const {
    // Fragments lie in quads along two rows; every quad is two pixels wide.
    const uint32_t quad = invocation / 4, x = quad * 2 + invocation % 2, y = invocation / 2 % 2;
    const auto number = [](double value) { return std::bit_cast<uint32_t>(static_cast<float>(value)); };
    switch (slot.builtin) {
        case ir::Builtin::user:
            break;
        case ir::Builtin::fragCoord:
            return slot.component == 0   ? number(x + 0.5)
                   : slot.component == 1 ? number(y + 8.5)
                   : slot.component == 2 ? number(0.25 + invocation * 0x1p-10)
                                         : number(1.0 / (1 + invocation % 7));
        case ir::Builtin::position:
        case ir::Builtin::pointSize:
        case ir::Builtin::pointCoord:
        case ir::Builtin::samplePosition:
        case ir::Builtin::clipDistance:
        case ir::Builtin::cullDistance:
        case ir::Builtin::tessCoord:
        case ir::Builtin::tessLevelOuter:
        case ir::Builtin::tessLevelInner:
            return number(fraction(invocation * 64 + slot.component + 7777));
        case ir::Builtin::patchVertices:
            return 4;
        case ir::Builtin::frontFacing:
            return invocation / 4 % 3 != 0 ? 1 : 0;
        case ir::Builtin::sampleMaskIn:
            return slot.component == 0 ? 1u << (invocation % 4) : 0;
        case ir::Builtin::sampleId:
            return invocation % 4;
        case ir::Builtin::primitiveId:
            return invocation / 8;
        case ir::Builtin::invocationId:
            return invocation / 8 % 3;
        case ir::Builtin::vertexIndex:
            return invocation + 3;
        case ir::Builtin::instanceIndex:
            return invocation / 5;
        case ir::Builtin::baseVertex:
            return 3;
        case ir::Builtin::baseInstance:
            return 2;
        case ir::Builtin::drawIndex:
            return 5;
        default:
            return 0;
    }
    const auto found = inputAt.find(slot.location);
    const Filling& filling = found != inputAt.end() ? found->second : inputs;
    const uint64_t key = (uint64_t{slot.location} * 8 + slot.component) * 4096 + invocation;
    const double span = filling.high - filling.low;
    double value = 0;
    switch (filling.kind) {
        case Filling::Kind::special:
            return specialWord(seed * 31 + key);
        case Filling::Kind::uniform:
            value = filling.low + span * fraction(key);
            break;
        case Filling::Kind::integer:
            value = std::floor(filling.low + (span + 1) * fraction(key));
            break;
        case Filling::Kind::index:
            value = filling.low + invocation * filling.high;
            break;
        case Filling::Kind::ramp: {
            // Affine over the grid, another slope for every component.
            const double slope = 0.5 + fraction(key / 4096 + 99), place = fraction(key / 4096 + 1234);
            const double t = place + slope * (x / 64.0 + y / 16.0);
            value = filling.low + span * (t - std::floor(t / 2) * 2) / 2;
            break;
        }
        case Filling::Kind::zero:
            break;
    }
    if (slot.type == ir::Type::f32) return number(value);
    return static_cast<uint32_t>(
        static_cast<int64_t>(std::floor(slot.type == ir::Type::i32 && span < 8 ? value * 16 : value)));
}

float World::interpolated(uint32_t invocation, const ir::InterfaceSlot& slot, uint32_t where, float a, float b) const {
    const float centre = asFloat(input(invocation, slot));
    if (where == 0) return centre + 0.125f;
    if (where == 1) return centre + 0.0625f * static_cast<float>(std::bit_cast<int32_t>(a));
    return centre + (0.5f * a + 0.25f * b);
}

std::vector<std::byte> World::bufferContents(const Slot& slot) const {
    BufferSpec spec{4096, contents};
    if (slot == kPushConstants) spec.bytes = 256;
    if (const auto found = bufferAt.find(slot); found != bufferAt.end()) spec = found->second;
    std::vector<std::byte> bytes(spec.bytes);
    const uint64_t base = (uint64_t{slot.set} * 64 + slot.binding * 8 + slot.element + 17) << 24;
    const Filling& f = spec.filling;
    for (uint32_t word = 0; word + 4 <= spec.bytes; word += 4) {
        const uint32_t k = word / 4;
        const double t = fraction(base + k);
        uint32_t bits = 0;
        const auto number = [](double value) { return std::bit_cast<uint32_t>(static_cast<float>(value)); };
        switch (f.kind) {
            case Filling::Kind::uniform:
                bits = number(f.low + (f.high - f.low) * t);
                break;
            case Filling::Kind::integer:
                bits = static_cast<uint32_t>(static_cast<int64_t>(std::floor(f.low + (f.high - f.low + 1) * t)));
                break;
            case Filling::Kind::index:
                bits = static_cast<uint32_t>(static_cast<int64_t>(f.low + k * f.high));
                break;
            case Filling::Kind::ramp:
                bits = number(f.low + k * f.high);
                break;
            case Filling::Kind::special:
                bits = specialWord(seed * 131 + base + k);
                break;
            case Filling::Kind::zero:
                break;
        }
        std::memcpy(bytes.data() + word, &bits, 4);
    }
    return bytes;
}

TestImage World::imageContents(const Slot& slot) const {
    const auto found = integerImages.find({slot.set, slot.binding, 0});
    return TestImage(seed * 1009 + slot.set * 64 + slot.binding * 8 + slot.element,
                     found != integerImages.end() && found->second);
}

std::vector<std::byte>& Memory::buffer(const Slot& slot) {
    auto found = buffers_.find(slot);
    if (found == buffers_.end()) found = buffers_.emplace(slot, world_.bufferContents(slot)).first;
    return found->second;
}

TestImage& Memory::image(const Slot& slot) {
    auto found = images_.find(slot);
    if (found == images_.end()) found = images_.emplace(slot, world_.imageContents(slot)).first;
    return found->second;
}

}  // namespace vernier::proof
