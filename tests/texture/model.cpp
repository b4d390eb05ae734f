#include "tests/texture/model.h"

#include <algorithm>
#include <cstring>

namespace vernier::texture_test {
namespace {

double asDouble(const TextureView& view, const VkClearColorValue& value, int c) {
    switch (view.ops.layout.type) {
        case ValueType::uint:
            return value.uint32[c];
        case ValueType::sint:
            return value.int32[c];
        default:
            return value.float32[c];
    }
}

bool isCube(const TextureView& view) {
    return view.type == VK_IMAGE_VIEW_TYPE_CUBE || view.type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
}

bool isOneDimensional(const TextureView& view) {
    return view.type == VK_IMAGE_VIEW_TYPE_1D || view.type == VK_IMAGE_VIEW_TYPE_1D_ARRAY;
}

int64_t floorMod(int64_t i, int64_t n) {
    return ((i % n) + n) % n;
}
int64_t mirror(int64_t n) {
    return n >= 0 ? n : -(1 + n);
}

/// "Wrapping Operation"; -1 for the border.
int64_t wrap(VkSamplerAddressMode mode, int64_t i, int64_t size) {
    switch (mode) {
        case VK_SAMPLER_ADDRESS_MODE_REPEAT:
            return floorMod(i, size);
        case VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT:
            return (size - 1) - mirror(floorMod(i, 2 * size) - size);
        case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE:
            return std::clamp<int64_t>(i, 0, size - 1);
        case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER:
            return i >= 0 && i < size ? i : -1;
        default:
            return std::clamp<int64_t>(mirror(i), 0, size - 1);
    }
}

/// A sampler's view of one level.
struct ModelLevel {
    const TextureView& view;
    const SamplerState& sampler;
    const TextureLevel& level;
    const Point& at;

    Rgba border() const {
        Rgba rgba{0, 0, 0, 1};
        for (int c = 0; c < 4; ++c) {
            if (view.ops.layout.rgba[c].bits != 0) rgba[c] = asDouble(view, sampler.borderColor, c);
        }
        return compare(rgba);
    }

    Rgba texel(int64_t x, int64_t y, int64_t slice) const {
        if (x < 0 || y < 0 || slice < 0) return border();
        const std::byte* const data = level.data + static_cast<uint64_t>(slice) * level.slicePitch +
                                      static_cast<uint64_t>(y) * level.rowPitch +
                                      static_cast<uint64_t>(x) * view.texelPitch;
        const VkClearColorValue value = unpackTexel(view.ops.layout, data);
        Rgba rgba;
        for (int c = 0; c < 4; ++c) rgba[c] = asDouble(view, value, c);
        return compare(rgba);
    }

    Rgba compare(const Rgba& texel) const {
        if (!sampler.compareEnable) return texel;
        const double reference = view.format == VK_FORMAT_D32_SFLOAT ? at.dref : std::clamp(at.dref, 0.0, 1.0);
        const bool less = reference < texel[0], equal = reference == texel[0];
        bool pass = false;
        switch (sampler.compareOp) {
            case VK_COMPARE_OP_LESS:
                pass = less;
                break;
            case VK_COMPARE_OP_EQUAL:
                pass = equal;
                break;
            case VK_COMPARE_OP_LESS_OR_EQUAL:
                pass = less || equal;
                break;
            case VK_COMPARE_OP_GREATER:
                pass = !less && !equal;
                break;
            case VK_COMPARE_OP_NOT_EQUAL:
                pass = !equal;
                break;
            case VK_COMPARE_OP_GREATER_OR_EQUAL:
                pass = !less;
                break;
            case VK_COMPARE_OP_ALWAYS:
                pass = true;
                break;
            default:
                break;
        }
        return {pass ? 1.0 : 0.0, 0, 0, 1};
    }
};

struct FacePoint {
    int face;
    double s, t;  // in [0, 1]
};

/// The table of "Cube Map Face Selection", row by row.
FacePoint faceOf(double x, double y, double z) {
    const double ax = std::abs(x), ay = std::abs(y), az = std::abs(z);
    double sc, tc, major;
    int face;
    if (az >= ax && az >= ay) {
        face = z < 0 ? 5 : 4;
        sc = z < 0 ? -x : x;
        tc = -y;
        major = az;
    } else if (ay >= ax) {
        face = y < 0 ? 3 : 2;
        sc = x;
        tc = y < 0 ? -z : z;
        major = ay;
    } else {
        face = x < 0 ? 1 : 0;
        sc = x < 0 ? z : -z;
        tc = -y;
        major = ax;
    }
    return {face, 0.5 * sc / major + 0.5, 0.5 * tc / major + 0.5};
}

/// The inverse: a point of the (extended) face as a direction.
std::array<double, 3> directionOf(const FacePoint& p) {
    const double s = 2 * p.s - 1, t = 2 * p.t - 1;
    switch (p.face) {
        case 0:
            return {1, -t, -s};
        case 1:
            return {-1, -t, s};
        case 2:
            return {s, 1, t};
        case 3:
            return {s, -1, -t};
        case 4:
            return {s, -t, 1};
        default:
            return {-s, -t, -1};
    }
}

Rgba cubeTexel(const ModelLevel& m, int face, int64_t x, int64_t y, int64_t firstFace) {
    const auto size = static_cast<int64_t>(m.level.width);
    const auto out = [&](int64_t i) { return i < 0 || i >= size; };
    if (out(x) && out(y)) {  // beyond a corner: the three texels that meet there
        const int64_t inX = std::clamp<int64_t>(x, 0, size - 1), inY = std::clamp<int64_t>(y, 0, size - 1);
        const Rgba a = cubeTexel(m, face, inX, inY, firstFace), b = cubeTexel(m, face, x, inY, firstFace),
                   c = cubeTexel(m, face, inX, y, firstFace);
        Rgba mean;
        for (int i = 0; i < 4; ++i) mean[i] = (a[i] + b[i] + c[i]) / 3;
        return mean;
    }
    if (out(x) || out(y)) {
        const auto d = directionOf({face, (x + 0.5) / size, (y + 0.5) / size});
        const FacePoint p = faceOf(d[0], d[1], d[2]);
        return m.texel(static_cast<int64_t>(std::floor(p.s * size)), static_cast<int64_t>(std::floor(p.t * size)),
                       firstFace + p.face);
    }
    return m.texel(x, y, firstFace + face);
}

Rgba mix(const Rgba& a, const Rgba& b, double t) {
    Rgba result;
    for (int c = 0; c < 4; ++c) result[c] = a[c] * (1 - t) + b[c] * t;
    return result;
}

int64_t layerOf(const TextureView& view, const Point& at) {
    const uint32_t layers = isCube(view) ? view.layerCount / 6 : view.layerCount;
    return std::clamp<int64_t>(std::llrint(at.layer), 0, layers - 1);
}

/// The texel coordinates (u, v, w) of a point in one level.
std::array<double, 3> unscaled(const ModelLevel& m) {
    const Point& at = m.at;
    if (m.sampler.unnormalizedCoordinates) return {at.s, at.t, 0};
    return {at.s * m.level.width, isOneDimensional(m.view) ? 0.5 : at.t * m.level.height, at.r * m.level.depth};
}

Rgba sampleLevel(const ModelLevel& m, bool linear) {
    const int64_t layer = layerOf(m.view, m.at);
    if (isCube(m.view)) {
        const FacePoint p = faceOf(m.at.s, m.at.t, m.at.r);
        const auto size = static_cast<double>(m.level.width);
        if (!linear) {
            const auto i = std::min<int64_t>(static_cast<int64_t>(p.s * size), m.level.width - 1);
            const auto j = std::min<int64_t>(static_cast<int64_t>(p.t * size), m.level.width - 1);
            return m.texel(i, j, layer * 6 + p.face);
        }
        const double u = p.s * size - 0.5, v = p.t * size - 0.5;
        const auto i = static_cast<int64_t>(std::floor(u)), j = static_cast<int64_t>(std::floor(v));
        const auto row = [&](int64_t y) {
            return mix(cubeTexel(m, p.face, i, y, layer * 6), cubeTexel(m, p.face, i + 1, y, layer * 6), u - i);
        };
        return mix(row(j), row(j + 1), v - j);
    }
    const std::array<double, 3> u = unscaled(m);
    const int64_t sizes[3] = {m.level.width, m.level.height, m.level.depth};
    const bool volume = m.view.type == VK_IMAGE_VIEW_TYPE_3D;
    const auto fetch = [&](int64_t i, int64_t j, int64_t k) {
        return m.texel(wrap(m.sampler.addressMode[0], i + m.at.offset[0], sizes[0]),
                       isOneDimensional(m.view) ? 0 : wrap(m.sampler.addressMode[1], j + m.at.offset[1], sizes[1]),
                       volume ? wrap(m.sampler.addressMode[2], k + m.at.offset[2], sizes[2]) : layer);
    };
    const double half = linear ? 0.5 : 0;
    int64_t base[3];
    double weight[3];
    for (int a = 0; a < 3; ++a) {
        base[a] = static_cast<int64_t>(std::floor(u[a] - half));
        weight[a] = u[a] - half - base[a];
    }
    if (!linear) return fetch(base[0], base[1], base[2]);
    const auto row = [&](int64_t j, int64_t k) {
        return mix(fetch(base[0], j, k), fetch(base[0] + 1, j, k), weight[0]);
    };
    const auto plane = [&](int64_t k) { return mix(row(base[1], k), row(base[1] + 1, k), weight[1]); };
    return volume ? mix(plane(base[2]), plane(base[2] + 1), weight[2]) : plane(base[2]);
}

struct Levels {
    uint32_t high, low;
    double weight;
    bool linear;
};

Levels levelsOf(const TextureView& view, const SamplerState& sampler, double lambdaPrime) {
    const double lambda = std::clamp<double>(lambdaPrime, sampler.minLod, std::max(sampler.minLod, sampler.maxLod));
    const bool linear = (lambda <= 0 ? sampler.magFilter : sampler.minFilter) == VK_FILTER_LINEAR;
    const double d = std::clamp<double>(lambda, 0, view.levelCount - 1);
    if (sampler.mipmapMode == VK_SAMPLER_MIPMAP_MODE_NEAREST) {
        const auto level = static_cast<uint32_t>(std::ceil(d + 0.5) - 1);
        return {level, level, 0, linear};
    }
    const auto high = static_cast<uint32_t>(d);
    return {high, std::min(high + 1, view.levelCount - 1), d - high, linear};
}

}  // namespace

Rgba modelSample(const TextureView& view, const SamplerState& sampler, const Point& at) {
    const Levels levels = levelsOf(view, sampler, at.lambda);
    Rgba rgba = sampleLevel({view, sampler, view.levels[levels.high], at}, levels.linear);
    if (levels.weight != 0) {
        rgba = mix(rgba, sampleLevel({view, sampler, view.levels[levels.low], at}, levels.linear), levels.weight);
    }
    if (sampler.compareEnable) return rgba;
    const VkComponentSwizzle swizzle[4] = {view.swizzle.r, view.swizzle.g, view.swizzle.b, view.swizzle.a};
    Rgba result;
    for (int c = 0; c < 4; ++c) {
        switch (swizzle[c]) {
            case VK_COMPONENT_SWIZZLE_IDENTITY:
                result[c] = rgba[c];
                break;
            case VK_COMPONENT_SWIZZLE_ZERO:
                result[c] = 0;
                break;
            case VK_COMPONENT_SWIZZLE_ONE:
                result[c] = 1;
                break;
            default:
                result[c] = rgba[swizzle[c] - VK_COMPONENT_SWIZZLE_R];
                break;
        }
    }
    return result;
}

double distanceToJump(const TextureView& view, const SamplerState& sampler, const Point& at) {
    const Levels levels = levelsOf(view, sampler, at.lambda);
    double distance = 1;
    const auto add = [&](double x) { distance = std::min(distance, std::abs(x - std::nearbyint(x))); };
    // Between levels, and between magnification and minification.
    if (sampler.mipmapMode == VK_SAMPLER_MIPMAP_MODE_NEAREST && view.levelCount > 1) add(at.lambda + 0.5);
    if (sampler.magFilter != sampler.minFilter) distance = std::min(distance, std::abs(at.lambda));
    if (isCube(view)) {
        const FacePoint p = faceOf(at.s, at.t, at.r);
        const double axes[3] = {std::abs(at.s), std::abs(at.t), std::abs(at.r)};
        for (int i = 0; i < 3; ++i) {
            const double gap = std::abs(axes[i] - axes[(i + 1) % 3]);
            distance = std::min(distance, std::max(gap, 1e-9));
        }
        if (levels.linear) return distance;
        for (const uint32_t level : {levels.high, levels.low}) {
            add(p.s * view.levels[level].width);
            add(p.t * view.levels[level].width);
        }
        return distance;
    }
    if (levels.linear && !sampler.compareEnable) return distance;
    for (const uint32_t level : {levels.high, levels.low}) {
        const std::array<double, 3> u = unscaled({view, sampler, view.levels[level], at});
        if (levels.linear) continue;
        add(u[0]);
        if (!isOneDimensional(view)) add(u[1]);
        if (view.type == VK_IMAGE_VIEW_TYPE_3D) add(u[2]);
    }
    return distance;
}

Image::Image(VkImageViewType type, VkFormat format, uint32_t width, uint32_t height, uint32_t depth, uint32_t layers,
             uint32_t levels, VkImageAspectFlags aspect)
    : type_(type), format_(format), aspect_(aspect), layers_(layers) {
    for (uint32_t l = 0; l < levels; ++l) {
        TextureLevel level;
        level.width = std::max(1u, width >> l);
        level.height = std::max(1u, height >> l);
        level.depth = std::max(1u, depth >> l);
        level.rowPitch = level.width * info().bytesPerTexel;
        level.slicePitch = uint64_t{level.rowPitch} * level.height;
        shapes_.push_back(level);
        data_.emplace_back(level.slicePitch * (type == VK_IMAGE_VIEW_TYPE_3D ? level.depth : layers));
    }
}

TextureView Image::view(Isa isa) const {
    TextureView view;
    view.type = type_;
    view.format = format_;
    view.aspect = aspect_;
    view.swizzle = swizzle;
    view.levelCount = static_cast<uint32_t>(shapes_.size());
    view.layerCount = layers_;
    view.texelPitch = info().bytesPerTexel;
    for (size_t l = 0; l < shapes_.size(); ++l) {
        view.levels[l] = shapes_[l];
        view.levels[l].data = data_[l].data();
    }
    view.ops = formatOps(format_, aspect_, isa);
    return view;
}

std::byte* Image::texel(uint32_t level, uint32_t x, uint32_t y, uint32_t slice) {
    const TextureLevel& l = shapes_[level];
    return data_[level].data() + slice * l.slicePitch + y * l.rowPitch + x * info().bytesPerTexel;
}

void Image::set(uint32_t level, uint32_t x, uint32_t y, uint32_t slice, const VkClearColorValue& value) {
    packTexel(info().layout(aspect_), value, texel(level, x, y, slice));
}

void Image::setAll(const VkClearColorValue& value) {
    for (std::vector<std::byte>& level : data_) {
        for (size_t i = 0; i < level.size(); i += info().bytesPerTexel)
            packTexel(info().layout(aspect_), value, &level[i]);
    }
}

void Image::randomize(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> number(-2, 2), depth(0, 1);
    const TexelLayout& layout = info().layout(aspect_);
    const bool isFloat = layout.rgba[0].kind == ComponentKind::sfloat || layout.rgba[0].kind == ComponentKind::ufloat;
    for (std::vector<std::byte>& level : data_) {
        if (!isFloat) {
            for (std::byte& b : level) b = static_cast<std::byte>(random());
            continue;
        }
        for (size_t i = 0; i < level.size(); i += info().bytesPerTexel) {
            VkClearColorValue value;
            for (float& f : value.float32) f = aspect_ == VK_IMAGE_ASPECT_DEPTH_BIT ? depth(random) : number(random);
            packTexel(layout, value, &level[i]);
        }
    }
}

Batch::Batch(uint32_t laneCount) : lanes(laneCount), dref(laneCount), lod(laneCount), mask(laneCount, ~0u) {
    request.lanes = lanes;
    for (int i = 0; i < 4; ++i) {
        coord[i].resize(lanes);
        out[i].assign(lanes, -12345.0f);
        request.coord[i] = coord[i].data();
        request.out[i] = out[i].data();
    }
    request.dref = dref.data();
    request.lod = lod.data();
    request.mask = mask.data();
    request.lodMode = LodMode::explicitLod;
}

Rgba Batch::result(const TextureView& view, uint32_t lane) const {
    Rgba rgba;
    for (int c = 0; c < 4; ++c) {
        VkClearColorValue value{};
        std::memcpy(&value.uint32[0], &out[c][lane], sizeof(float));
        rgba[c] = asDouble(view, value, 0);
    }
    return rgba;
}

SamplerState makeSampler(VkFilter filter, VkSamplerAddressMode mode, VkSamplerMipmapMode mipmap) {
    SamplerState sampler;
    sampler.magFilter = sampler.minFilter = filter;
    sampler.mipmapMode = mipmap;
    for (VkSamplerAddressMode& m : sampler.addressMode) m = mode;
    return sampler;
}

Rgba sampleOne(const Image& image, const SamplerState& sampler, float s, float t, float r, float layer, float dref,
               Isa isa) {
    const TextureView view = image.view(isa);
    EXPECT_TRUE(checkSampling(view, sampler).ok());
    Batch batch(4);
    for (uint32_t i = 0; i < 4; ++i) {
        batch.coord[0][i] = s;
        batch.coord[1][i] = t;
        batch.coord[2][i] = r;
        batch.coord[3][i] = layer;
        batch.dref[i] = dref;
    }
    batch.run(selectSampler(view, sampler, isa), view, sampler);
    return batch.result(view, 1);
}

}  // namespace vernier::texture_test
