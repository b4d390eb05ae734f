#include "spirv_interp/tool/invocation.h"

#include <cstdlib>
#include <cstring>
#include <fstream>

#include "spirv_interp/reference/number_ops.h"

namespace vernier::tool {
namespace {

constexpr std::pair<spv::BuiltIn, const char*> kBuiltins[] = {
    {spv::BuiltInPosition, "Position"},
    {spv::BuiltInPointSize, "PointSize"},
    {spv::BuiltInClipDistance, "ClipDistance"},
    {spv::BuiltInCullDistance, "CullDistance"},
    {spv::BuiltInVertexIndex, "VertexIndex"},
    {spv::BuiltInInstanceIndex, "InstanceIndex"},
    {spv::BuiltInBaseVertex, "BaseVertex"},
    {spv::BuiltInBaseInstance, "BaseInstance"},
    {spv::BuiltInDrawIndex, "DrawIndex"},
    {spv::BuiltInFragCoord, "FragCoord"},
    {spv::BuiltInFrontFacing, "FrontFacing"},
    {spv::BuiltInPointCoord, "PointCoord"},
    {spv::BuiltInSampleId, "SampleId"},
    {spv::BuiltInSamplePosition, "SamplePosition"},
    {spv::BuiltInSampleMask, "SampleMask"},
    {spv::BuiltInPrimitiveId, "PrimitiveId"},
    {spv::BuiltInFragDepth, "FragDepth"},
    {spv::BuiltInBaryCoordKHR, "BaryCoord"},
    {spv::BuiltInBaryCoordNoPerspKHR, "BaryCoordNoPersp"},
};

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts;
    for (size_t first = 0; first <= text.size();) {
        const size_t comma = std::min(text.find(',', first), text.size());
        const size_t begin = text.find_first_not_of(" \t", first);
        const size_t end = text.find_last_not_of(" \t", comma - 1);
        if (comma > first && begin < comma) parts.push_back(text.substr(begin, end - begin + 1));
        first = comma + 1;
    }
    return parts;
}

uint64_t parseInteger(const std::string& text) {
    const bool negative = text.starts_with('-');
    return negative ? static_cast<uint64_t>(std::strtoll(text.c_str(), nullptr, 0))
                    : std::strtoull(text.c_str(), nullptr, 0);
}

template <class T>
void append(std::vector<std::byte>& bytes, T value) {
    const size_t at = bytes.size();
    bytes.resize(at + sizeof value);
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

Result<std::vector<std::byte>> parseBytes(const std::string& text) {
    const size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    const std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
    std::vector<std::byte> bytes;
    if (kind == "zero") {
        const unsigned long size = std::strtoul(rest.c_str(), nullptr, 0);
        if (size == 0 || size > (1ul << 30)) return invalidArgument("zero:" + rest + " is no size in bytes");
        bytes.resize((size + 3) / 4 * 4);
        return bytes;
    }
    for (const std::string& item : split(rest)) {
        if (kind == "f") {
            append(bytes, std::strtof(item.c_str(), nullptr));
        } else if (kind == "d") {
            append(bytes, std::strtod(item.c_str(), nullptr));
        } else if (kind == "h") {
            append(bytes, static_cast<uint16_t>(reference::doubleToHalf(std::strtod(item.c_str(), nullptr))));
        } else if (kind == "i" || kind == "u") {
            append(bytes, static_cast<uint32_t>(parseInteger(item)));
        } else if (kind == "b") {
            append(bytes, static_cast<uint8_t>(parseInteger(item)));
        } else if (kind == "s") {
            append(bytes, static_cast<uint16_t>(parseInteger(item)));
        } else if (kind == "l") {
            append(bytes, parseInteger(item));
        } else {
            return invalidArgument("bytes are h:, f:, d:, b:, s:, i:, u:, l: or zero:, not \"" + kind + ":\"");
        }
    }
    bytes.resize((bytes.size() + 3) / 4 * 4);
    return bytes;
}

/// "4x2x1:" and bytes of four components for each texel.
Result<Image> parseImage(const std::string& text) {
    Image image;
    const size_t colon = text.find(':');
    const std::string extent = text.substr(0, colon), bytes = colon == std::string::npos ? "" : text.substr(colon + 1);
    char rest = 0;
    const int count =
        std::sscanf(extent.c_str(), "%dx%dx%d%c", &image.extent[0], &image.extent[1], &image.extent[2], &rest);
    int64_t texels = 1;
    for (const int32_t size : image.extent) texels *= size > 0 && size <= 4096 ? size : 0;
    if (count < 1 || count > 3 || texels < 1 || texels > (1 << 24))
        return invalidArgument("\"" + extent + "\" is no size of an image: W, WxH or WxHxD");
    image.texels.resize(static_cast<size_t>(texels));
    const bool zero = bytes.starts_with("zero");
    if (!zero && !bytes.starts_with("f:") && !bytes.starts_with("i:") && !bytes.starts_with("u:"))
        return invalidArgument("texels are f:, i:, u: or zero, not \"" + bytes.substr(0, bytes.find(':') + 1) + "\"");
    image.floating = zero || bytes.starts_with("f:");
    if (zero) return image;
    const auto values = parseBytes(bytes);
    if (!values) return values.error();
    if (values->size() != image.texels.size() * sizeof(Words4)) {
        return invalidArgument("an image of " + extent + " has " + std::to_string(texels * 4) + " values, not " +
                               std::to_string(values->size() / 4));
    }
    std::memcpy(image.texels.data(), values->data(), values->size());
    return image;
}

/// The set and binding of "buffer 0.1" or "image 0.1".
Result<std::pair<uint32_t, uint32_t>> placeOf(const std::string& name) {
    unsigned set = 0, binding = 0;
    const std::string places = name.substr(name.find(' '));
    char rest = 0;
    if (std::sscanf(places.c_str(), "%u.%u%c", &set, &binding, &rest) != 2)
        return invalidArgument("\"" + name + "\" is no \"" + name.substr(0, name.find(' ')) + " SET.BINDING\"");
    return std::pair<uint32_t, uint32_t>{set, binding};
}

template <class Number>
reference::Scalar<Number> scalarOf(reference::ScalarKind kind, const std::string& text) {
    using reference::ScalarKind;
    using Scalar = reference::Scalar<Number>;
    switch (kind) {
        case ScalarKind::boolean:
            return Scalar::ofBits(text == "true" || (text != "false" && std::strtol(text.c_str(), nullptr, 0) != 0));
        case ScalarKind::float16:
        case ScalarKind::float32:
            return Scalar::ofNumber(Number(std::strtof(text.c_str(), nullptr)));
        case ScalarKind::float64:
            return Scalar::ofNumber(static_cast<Number>(std::strtod(text.c_str(), nullptr)));
        case ScalarKind::int64:
        case ScalarKind::uint64:
            return Scalar::ofBits(parseInteger(text));
        default:
            return Scalar::ofBits(static_cast<uint32_t>(parseInteger(text)));
    }
}

/// Behind the name of what PerVertexKHR declares.
std::string vertexOf(const reference::InterfaceVariable& variable) {
    return variable.perVertex ? "[" + std::to_string(variable.index) + "]" : "";
}

bool isNamed(const reference::InterfaceVariable& variable, const std::string& name) {
    const std::string own = variable.name + vertexOf(variable);
    if (!variable.name.empty() && (own == name || own == "gl_" + name)) return true;
    return variable.isBuiltin ? builtinName(variable.builtin) == name
                              : "location" + std::to_string(variable.location) + vertexOf(variable) == name;
}

}  // namespace

Status applySetting(const std::string& setting, Invocation& invocation) {
    const size_t equals = setting.find('=');
    if (equals == std::string::npos) return invalidArgument("\"" + setting + "\" has no \"=\"");
    const std::string name = setting.substr(0, equals), value = setting.substr(equals + 1);
    if (name.starts_with("buffer ")) {
        const auto place = placeOf(name);
        auto bytes = parseBytes(value);
        if (!place) return place.error();
        if (!bytes) return bytes.error();
        invocation.buffers[*place] = std::move(*bytes);
    } else if (name.starts_with("image ")) {
        const auto place = placeOf(name);
        auto image = parseImage(value);
        if (!place) return place.error();
        if (!image) return image.error();
        invocation.images[*place] = std::move(*image);
    } else if (name == "push") {
        auto bytes = parseBytes(value);
        if (!bytes) return bytes.error();
        invocation.pushConstants = std::move(*bytes);
    } else if (name == "groups") {
        const std::vector<std::string> counts = split(value);
        for (size_t k = 0; k < 3 && k < counts.size(); ++k) {
            invocation.groups[k] = static_cast<uint32_t>(std::strtoul(counts[k].c_str(), nullptr, 0));
        }
    } else {
        invocation.inputs[name] = split(value);
    }
    return {};
}

Status readDescription(const std::string& path, Invocation& invocation) {
    std::ifstream file(path);
    if (!file) return invalidArgument(path + " cannot be read");
    for (std::string line; std::getline(file, line);) {
        line.resize(std::min(line.find('#'), line.size()));
        const size_t first = line.find_first_not_of(" \t\r"), last = line.find_last_not_of(" \t\r");
        if (first == std::string::npos) continue;
        if (const Status status = applySetting(line.substr(first, last - first + 1), invocation); !status.ok()) {
            return status;
        }
    }
    return {};
}

std::string builtinName(spv::BuiltIn builtin) {
    for (const auto& [value, name] : kBuiltins)
        if (value == builtin) return name;
    return "builtin" + std::to_string(static_cast<uint32_t>(builtin));
}

std::string variableName(const reference::InterfaceVariable& variable) {
    if (!variable.name.empty()) return variable.name + vertexOf(variable);
    return variable.isBuiltin ? builtinName(variable.builtin)
                              : "location" + std::to_string(variable.location) + vertexOf(variable);
}

template <class Number>
Result<reference::InterfaceValues<Number>> interfaceValues(const Invocation& invocation,
                                                           const reference::Module& module, size_t entryPoint) {
    reference::InterfaceValues<Number> values;
    for (const auto& [name, items] : invocation.inputs) {
        const reference::InterfaceVariable* found = nullptr;
        std::string known;
        for (const reference::InterfaceVariable& variable : module.interfaceVariables(entryPoint)) {
            if (variable.output) continue;
            known += " " + variableName(variable);
            if (isNamed(variable, name)) found = &variable;
        }
        if (found == nullptr) return invalidArgument("no input \"" + name + "\"; there are:" + known);
        for (uint32_t k = 0; k < items.size() && k < found->scalars(); ++k) {
            const auto scalar = scalarOf<Number>(found->kind, items[k]);
            if (found->isBuiltin) {
                values.builtins[found->builtin].push_back(scalar);
            } else {
                const auto at = found->placeOf(k);
                auto& texel = values.locations[{at.location, found->index}];
                texel[at.component] = scalar;
                if (isWide(found->kind) && !isFloating(found->kind)) {
                    texel[at.component].bits &= 0xFFFFFFFFu;
                    texel[at.component + 1].bits = scalar.bits >> 32;
                }
            }
        }
    }
    return values;
}

template Result<reference::InterfaceValues<float>> interfaceValues(const Invocation&, const reference::Module&, size_t);
template Result<reference::InterfaceValues<double>> interfaceValues(const Invocation&, const reference::Module&,
                                                                    size_t);
template Result<reference::InterfaceValues<reference::Real>> interfaceValues(const Invocation&,
                                                                             const reference::Module&, size_t);

}  // namespace vernier::tool
