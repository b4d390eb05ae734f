#include "spirv_interp/tool/scalar_text.h"

#include <bit>
#include <cinttypes>
#include <cstdio>
#include <cstring>

#include "spirv_interp/reference/module_data.h"
#include "spirv_interp/reference/number_ops.h"

namespace vernier::tool {
namespace {

using reference::ModuleData;
using reference::ScalarKind;
using reference::Type;
using reference::TypeKind;

int64_t signedOf(uint64_t bits, uint32_t width) {
    return static_cast<int64_t>(bits << (64 - width)) >> (64 - width);
}

/// Walks through a block by its layout decorations and prints the scalars that differ.
class BlockPrinter {
  public:
    BlockPrinter(const ModuleData& module, const std::vector<std::byte>& before, const std::vector<std::byte>& after)
        : module_(module), before_(before), after_(after) {}

    void visit(const Type& type, uint64_t at, const std::string& path, uint32_t matrixStride, bool rowMajor) const {
        const auto element = [&](uint64_t index) { return path + "[" + std::to_string(index) + "]"; };
        switch (type.kind) {
            case TypeKind::structure:
                for (uint32_t m = 0; m < type.members.size(); ++m) {
                    const auto found = module_.memberNames.find({type.id, m});
                    const std::string name =
                        found != module_.memberNames.end() ? found->second : "member" + std::to_string(m);
                    const reference::Decorations& d = module_.decorationsOf(type.id, m);
                    visit(module_.types[type.members[m]], at + d.offset.value_or(0),
                          path.empty() ? name : path + "." + name, d.matrixStride.value_or(0), d.rowMajor);
                }
                break;
            case TypeKind::array:
            case TypeKind::runtimeArray: {
                const uint64_t stride = module_.decorationsOf(type.id).arrayStride.value_or(0);
                if (stride == 0) return;
                // What fits; an element may end before the next begins.
                const uint64_t there = at < after_.size() ? (after_.size() - at + stride - 1) / stride : 0;
                const uint64_t count = type.kind == TypeKind::array ? std::min<uint64_t>(there, type.count) : there;
                for (uint64_t k = 0; k < count; ++k) {
                    if (differ(at + k * stride, stride)) {
                        visit(module_.types[type.element], at + k * stride, element(k), matrixStride, rowMajor);
                    }
                }
                break;
            }
            case TypeKind::matrix: {
                const Type& column = module_.types[type.element];
                const Type& scalar = module_.types[column.element];
                const uint32_t bytes = scalar.width / 8, along = rowMajor ? matrixStride : bytes;
                for (uint32_t c = 0; c < type.count; ++c)
                    for (uint32_t r = 0; r < column.count; ++r)
                        print(scalar, at + c * (rowMajor ? bytes : matrixStride) + r * along,
                              element(c) + "[" + std::to_string(r) + "]");
                break;
            }
            case TypeKind::vector:
                for (uint32_t k = 0; k < type.count; ++k)
                    print(module_.types[type.element], at + k * module_.types[type.element].width / 8, element(k));
                break;
            default:
                print(type, at, path);
                break;
        }
    }

  private:
    bool differ(uint64_t at, uint64_t size) const {
        if (at >= after_.size()) return false;
        return std::memcmp(before_.data() + at, after_.data() + at, std::min<uint64_t>(size, after_.size() - at)) != 0;
    }
    void print(const Type& type, uint64_t at, const std::string& path) const {
        const uint64_t bytes = type.width / 8;
        if (at + bytes > after_.size() || !differ(at, bytes)) return;
        uint64_t bits = 0;
        std::memcpy(&bits, after_.data() + at, bytes);
        const ScalarKind kind = type.kind == TypeKind::pointer ? ScalarKind::uint64 : scalarKind(type);
        std::printf("    %s = %s\n", path.c_str(), scalarText(kind, bits).c_str());
    }

    const ModuleData& module_;
    const std::vector<std::byte>&before_, &after_;
};

/// The block of a binding; nullptr without one.
const Type* blockOf(const ModuleData& module, uint32_t set, uint32_t binding) {
    for (const reference::Variable& variable : module.variables) {
        const reference::Decorations& d = module.decorationsOf(variable.id);
        if (d.set.value_or(0) != set || !d.binding || *d.binding != binding) continue;
        const Type* type = &module.types[module.types[variable.pointerType].element];
        while (type->isArray()) type = &module.types[type->element];
        if (type->kind == TypeKind::structure) return type;
    }
    return nullptr;
}

void printImage(std::pair<uint32_t, uint32_t> place, const Image& before, const Image& after) {
    if (before.texels == after.texels) return;
    std::printf("  image %u.%u:\n", place.first, place.second);
    const auto width = static_cast<size_t>(after.extent[0]), height = static_cast<size_t>(after.extent[1]);
    for (size_t k = 0; k < after.texels.size(); ++k) {
        if (before.texels[k] == after.texels[k]) continue;
        std::printf("    [%zu, %zu, %zu] =", k % width, k / width % height, k / width / height);
        for (const uint32_t word : after.texels[k])
            std::printf(" %s", scalarText(after.floating ? ScalarKind::float32 : ScalarKind::int32, word).c_str());
        std::printf("\n");
    }
}

}  // namespace

std::string scalarText(ScalarKind kind, uint64_t bits) {
    char text[40];
    switch (kind) {
        case ScalarKind::boolean:
            return bits != 0 ? "true" : "false";
        case ScalarKind::int8:
            return std::to_string(signedOf(bits, 8));
        case ScalarKind::int16:
            return std::to_string(signedOf(bits, 16));
        case ScalarKind::int32:
            return std::to_string(signedOf(bits, 32));
        case ScalarKind::int64:
            return std::to_string(static_cast<int64_t>(bits));
        case ScalarKind::uint8:
            return std::to_string(bits & 0xFF);
        case ScalarKind::uint16:
            return std::to_string(bits & 0xFFFF);
        case ScalarKind::uint32:
            return std::to_string(bits & 0xFFFFFFFF);
        case ScalarKind::uint64:
            return std::to_string(bits);
        // As many digits as tell any two values apart.
        case ScalarKind::float16:
            std::snprintf(text, sizeof text, "%.5g",
                          static_cast<double>(reference::halfToFloat32(static_cast<uint32_t>(bits & 0xFFFF))));
            return text;
        case ScalarKind::float32:
            std::snprintf(text, sizeof text, "%.9g",
                          static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(bits))));
            return text;
        case ScalarKind::float64:
            std::snprintf(text, sizeof text, "%.17g", std::bit_cast<double>(bits));
            return text;
    }
    return "";
}

void printChanges(const reference::Module& module, const Invocation& before, const Invocation& after) {
    for (const auto& [place, bytes] : after.buffers) {
        const auto& old = before.buffers.at(place);
        const Type* block = blockOf(module.data(), place.first, place.second);
        if (bytes == old || block == nullptr) continue;
        std::printf("  buffer %u.%u:\n", place.first, place.second);
        BlockPrinter(module.data(), old, bytes).visit(*block, 0, "", 0, false);
    }
    for (const auto& [place, image] : after.images) printImage(place, before.images.at(place), image);
}

}  // namespace vernier::tool
