#include "conformance/oracle/pixel_format.h"

#include <algorithm>
#include <initializer_list>
#include <vector>

namespace vernier::conformance::exact {

namespace {

using enum Encoding;

// Components of equal width one after the other, in the given channel order ("rgba" or "bgra"); sRGB keeps
// alpha linear.
PixelFormat array(VkFormat format, const char* order, uint8_t bits, Encoding encoding) {
    PixelFormat result;
    result.format = format;
    for (const char* c = order; *c; ++c) {
        const uint8_t channel = *c == 'r' ? 0 : *c == 'g' ? 1 : *c == 'b' ? 2 : 3;
        const uint8_t index = result.componentCount++;
        const Encoding own = encoding == srgb && channel == 3 ? unorm : encoding;
        result.components[index] = {channel, static_cast<uint8_t>(index * bits), bits, own};
    }
    result.bytes = static_cast<uint8_t>(result.componentCount * bits / 8);
    return result;
}

PixelFormat packed(VkFormat format, uint8_t bytes, std::initializer_list<Component> components) {
    PixelFormat result;
    result.format = format;
    result.bytes = bytes;
    for (const Component& component : components) result.components[result.componentCount++] = component;
    return result;
}

PixelFormat depthStencil(VkFormat format, uint8_t depthBits, Encoding encoding, bool stencil) {
    PixelFormat result;
    result.format = format;
    result.depth = depthBits != 0;
    result.stencil = stencil;
    if (result.depth) result.components[result.componentCount++] = {0, 0, depthBits, encoding};
    result.bytes = static_cast<uint8_t>(!result.depth ? 1 : depthBits == 16 ? 2 : 4);
    return result;
}

std::vector<PixelFormat> buildTable() {
    std::vector<PixelFormat> t;
    struct Family {
        uint8_t bits;
        Encoding encoding;
        VkFormat r, rg, rgba, bgra;
    };
    const VkFormat none = VK_FORMAT_UNDEFINED;
    const Family families[] = {
        {8, unorm, VK_FORMAT_R8_UNORM, VK_FORMAT_R8G8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM},
        {8, snorm, VK_FORMAT_R8_SNORM, VK_FORMAT_R8G8_SNORM, VK_FORMAT_R8G8B8A8_SNORM, VK_FORMAT_B8G8R8A8_SNORM},
        {8, uint, VK_FORMAT_R8_UINT, VK_FORMAT_R8G8_UINT, VK_FORMAT_R8G8B8A8_UINT, VK_FORMAT_B8G8R8A8_UINT},
        {8, sint, VK_FORMAT_R8_SINT, VK_FORMAT_R8G8_SINT, VK_FORMAT_R8G8B8A8_SINT, VK_FORMAT_B8G8R8A8_SINT},
        {8, srgb, VK_FORMAT_R8_SRGB, VK_FORMAT_R8G8_SRGB, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_SRGB},
        {16, unorm, VK_FORMAT_R16_UNORM, VK_FORMAT_R16G16_UNORM, VK_FORMAT_R16G16B16A16_UNORM, none},
        {16, snorm, VK_FORMAT_R16_SNORM, VK_FORMAT_R16G16_SNORM, VK_FORMAT_R16G16B16A16_SNORM, none},
        {16, uint, VK_FORMAT_R16_UINT, VK_FORMAT_R16G16_UINT, VK_FORMAT_R16G16B16A16_UINT, none},
        {16, sint, VK_FORMAT_R16_SINT, VK_FORMAT_R16G16_SINT, VK_FORMAT_R16G16B16A16_SINT, none},
        {16, sfloat, VK_FORMAT_R16_SFLOAT, VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT, none},
        {32, uint, VK_FORMAT_R32_UINT, VK_FORMAT_R32G32_UINT, VK_FORMAT_R32G32B32A32_UINT, none},
        {32, sint, VK_FORMAT_R32_SINT, VK_FORMAT_R32G32_SINT, VK_FORMAT_R32G32B32A32_SINT, none},
        {32, sfloat, VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, none},
    };
    for (const Family& f : families) {
        t.push_back(array(f.r, "r", f.bits, f.encoding));
        t.push_back(array(f.rg, "rg", f.bits, f.encoding));
        t.push_back(array(f.rgba, "rgba", f.bits, f.encoding));
        if (f.bgra != none) t.push_back(array(f.bgra, "bgra", f.bits, f.encoding));
    }
    const std::pair<VkFormat, Encoding> threeFloats[] = {
        {VK_FORMAT_R32G32B32_SFLOAT, sfloat}, {VK_FORMAT_R32G32B32_UINT, uint}, {VK_FORMAT_R32G32B32_SINT, sint}};
    for (const auto& [format, encoding] : threeFloats) t.push_back(array(format, "rgb", 32, encoding));
    const std::pair<VkFormat, Encoding> abgr8[] = {{VK_FORMAT_A8B8G8R8_UNORM_PACK32, unorm},
                                                   {VK_FORMAT_A8B8G8R8_SNORM_PACK32, snorm},
                                                   {VK_FORMAT_A8B8G8R8_UINT_PACK32, uint},
                                                   {VK_FORMAT_A8B8G8R8_SINT_PACK32, sint},
                                                   {VK_FORMAT_A8B8G8R8_SRGB_PACK32, srgb}};
    for (const auto& [format, encoding] : abgr8) t.push_back(array(format, "rgba", 8, encoding));

    // The names of packed formats run from the most significant bits down.
    t.push_back(packed(VK_FORMAT_R5G6B5_UNORM_PACK16, 2, {{0, 11, 5, unorm}, {1, 5, 6, unorm}, {2, 0, 5, unorm}}));
    t.push_back(packed(VK_FORMAT_B5G6R5_UNORM_PACK16, 2, {{2, 11, 5, unorm}, {1, 5, 6, unorm}, {0, 0, 5, unorm}}));
    t.push_back(packed(VK_FORMAT_R4G4B4A4_UNORM_PACK16, 2,
                       {{0, 12, 4, unorm}, {1, 8, 4, unorm}, {2, 4, 4, unorm}, {3, 0, 4, unorm}}));
    t.push_back(packed(VK_FORMAT_B4G4R4A4_UNORM_PACK16, 2,
                       {{2, 12, 4, unorm}, {1, 8, 4, unorm}, {0, 4, 4, unorm}, {3, 0, 4, unorm}}));
    t.push_back(packed(VK_FORMAT_R5G5B5A1_UNORM_PACK16, 2,
                       {{0, 11, 5, unorm}, {1, 6, 5, unorm}, {2, 1, 5, unorm}, {3, 0, 1, unorm}}));
    t.push_back(packed(VK_FORMAT_B5G5R5A1_UNORM_PACK16, 2,
                       {{2, 11, 5, unorm}, {1, 6, 5, unorm}, {0, 1, 5, unorm}, {3, 0, 1, unorm}}));
    t.push_back(packed(VK_FORMAT_A1R5G5B5_UNORM_PACK16, 2,
                       {{3, 15, 1, unorm}, {0, 10, 5, unorm}, {1, 5, 5, unorm}, {2, 0, 5, unorm}}));
    for (const auto& [format, encoding] :
         {std::pair{VK_FORMAT_A2B10G10R10_UNORM_PACK32, unorm}, std::pair{VK_FORMAT_A2B10G10R10_UINT_PACK32, uint}}) {
        t.push_back(packed(format, 4,
                           {{3, 30, 2, encoding}, {2, 20, 10, encoding}, {1, 10, 10, encoding}, {0, 0, 10, encoding}}));
    }
    t.push_back(packed(VK_FORMAT_A2R10G10B10_UNORM_PACK32, 4,
                       {{3, 30, 2, unorm}, {0, 20, 10, unorm}, {1, 10, 10, unorm}, {2, 0, 10, unorm}}));
    t.push_back(
        packed(VK_FORMAT_B10G11R11_UFLOAT_PACK32, 4, {{2, 22, 10, ufloat}, {1, 11, 11, ufloat}, {0, 0, 11, ufloat}}));
    t.push_back(packed(VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, 4,
                       {{2, 18, 9, sharedExponent}, {1, 9, 9, sharedExponent}, {0, 0, 9, sharedExponent}}));

    t.push_back(depthStencil(VK_FORMAT_D16_UNORM, 16, unorm, false));
    t.push_back(depthStencil(VK_FORMAT_D16_UNORM_S8_UINT, 16, unorm, true));
    t.push_back(depthStencil(VK_FORMAT_X8_D24_UNORM_PACK32, 24, unorm, false));
    t.push_back(depthStencil(VK_FORMAT_D24_UNORM_S8_UINT, 24, unorm, true));
    t.push_back(depthStencil(VK_FORMAT_D32_SFLOAT, 32, sfloat, false));
    t.push_back(depthStencil(VK_FORMAT_D32_SFLOAT_S8_UINT, 32, sfloat, true));
    t.push_back(depthStencil(VK_FORMAT_S8_UINT, 0, uint, true));
    return t;
}

}  // namespace

const Component* PixelFormat::channel(uint8_t index) const {
    for (const Component& component : all()) {
        if (component.channel == index) return &component;
    }
    return nullptr;
}

bool PixelFormat::isInteger() const {
    return componentCount != 0 && (components[0].encoding == uint || components[0].encoding == sint);
}

const PixelFormat* findPixelFormat(VkFormat format) {
    static const std::vector<PixelFormat> table = buildTable();
    const auto found = std::ranges::find(table, format, &PixelFormat::format);
    return found == table.end() ? nullptr : &*found;
}

FloatLayout floatLayout(int bits) {
    switch (bits) {
        case 32:
            return {8, 23};
        case 16:
            return {5, 10};
        case 11:
            return {5, 6};
        default:
            return {5, 5};
    }
}

uint64_t extractBits(const std::byte* texel, unsigned offset, unsigned bits) {
    uint64_t result = 0;
    for (unsigned i = 0; i < bits; ++i) {
        const unsigned bit = offset + i;
        const unsigned byte = std::to_integer<unsigned>(texel[bit / 8]);
        result |= static_cast<uint64_t>((byte >> (bit % 8)) & 1u) << i;
    }
    return result;
}

void insertBits(std::byte* texel, unsigned offset, unsigned bits, uint64_t value) {
    for (unsigned i = 0; i < bits; ++i) {
        const unsigned bit = offset + i;
        const std::byte mask{static_cast<unsigned char>(1u << (bit % 8))};
        if ((value >> i) & 1u) {
            texel[bit / 8] |= mask;
        } else {
            texel[bit / 8] &= ~mask;
        }
    }
}

}  // namespace vernier::conformance::exact
