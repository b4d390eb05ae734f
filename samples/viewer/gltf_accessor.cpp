#include "samples/viewer/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace samples {
namespace {

std::string named(const char* what, int index) {
    return what + (" " + std::to_string(index));
}

/// Where the elements lie: `stride` bytes apart.
struct Elements {
    const uint8_t* bytes = nullptr;
    size_t count = 0, stride = 0;
    int componentType = 0;
    bool normalized = false;
};

bool locate(const tinygltf::Model& model, int index, int components, Elements& elements, std::string& error) {
    const std::string name = named("accessor", index);
    if (index < 0 || static_cast<size_t>(index) >= model.accessors.size()) {
        error = "there is no " + name;
        return false;
    }
    const tinygltf::Accessor& accessor = model.accessors[static_cast<size_t>(index)];
    if (accessor.sparse.isSparse) {
        error = name + " is sparse, which the viewer cannot read";
        return false;
    }
    if (tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)) != components) {
        error = name + " has not " + std::to_string(components) + " components";
        return false;
    }
    const int componentSize = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType));
    if (componentSize <= 0 || accessor.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE ||
        accessor.componentType == TINYGLTF_COMPONENT_TYPE_INT) {
        error = name + " has the component type " + std::to_string(accessor.componentType) + ", which glTF lacks";
        return false;
    }
    size_t viewSize = 0;
    if (!bytesOfView(model, accessor.bufferView, elements.bytes, viewSize, error)) {
        error = name + ": " + error;
        return false;
    }
    const size_t elementSize = static_cast<size_t>(componentSize) * static_cast<size_t>(components);
    const size_t declared = model.bufferViews[static_cast<size_t>(accessor.bufferView)].byteStride;
    elements.stride = declared ? declared : elementSize;
    // The last element needs its own bytes only, not a whole stride.
    const bool inside = accessor.byteOffset <= viewSize && accessor.count > 0 &&
                        elementSize <= viewSize - accessor.byteOffset &&
                        accessor.count - 1 <= (viewSize - accessor.byteOffset - elementSize) / elements.stride;
    if (!inside || elements.stride < elementSize) {
        error = name + ": " + std::to_string(accessor.count) + " elements of " + std::to_string(elementSize) +
                " bytes from byte " + std::to_string(accessor.byteOffset) + " on do not lie in its buffer view of " +
                std::to_string(viewSize) + " bytes";
        return false;
    }
    elements.bytes += accessor.byteOffset;
    elements.count = accessor.count;
    elements.componentType = accessor.componentType;
    elements.normalized = accessor.normalized;
    return true;
}

template <class T>
T load(const uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

template <class T>
float number(const uint8_t* bytes, bool normalized) {
    const auto value = static_cast<float>(load<T>(bytes));
    if (!normalized) return value;
    return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

float component(const uint8_t* bytes, int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return number<int8_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return number<uint8_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return number<int16_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return number<uint16_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return number<uint32_t>(bytes, normalized);
        default:
            return load<float>(bytes);
    }
}

}  // namespace

bool bytesOfView(const tinygltf::Model& model, int view, const uint8_t*& bytes, size_t& size, std::string& error) {
    if (view < 0 || static_cast<size_t>(view) >= model.bufferViews.size()) {
        error = "there is no " + named("buffer view", view);
        return false;
    }
    const tinygltf::BufferView& from = model.bufferViews[static_cast<size_t>(view)];
    if (from.buffer < 0 || static_cast<size_t>(from.buffer) >= model.buffers.size()) {
        error = named("buffer view", view) + ": there is no " + named("buffer", from.buffer);
        return false;
    }
    const std::vector<uint8_t>& data = model.buffers[static_cast<size_t>(from.buffer)].data;
    if (from.byteOffset > data.size() || from.byteLength > data.size() - from.byteOffset) {
        error = named("buffer view", view) + ": bytes " + std::to_string(from.byteOffset) + " to " +
                std::to_string(from.byteOffset + from.byteLength) + " do not lie in " + named("buffer", from.buffer) +
                ", which has " + std::to_string(data.size());
        return false;
    }
    bytes = data.data() + from.byteOffset;
    size = from.byteLength;
    return true;
}

bool readFloats(const tinygltf::Model& model, int accessor, int components, std::vector<float>& values,
                std::string& error) {
    Elements elements;
    if (!locate(model, accessor, components, elements, error)) return false;
    const auto width = static_cast<size_t>(components);
    const auto size =
        static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(elements.componentType)));
    values.resize(elements.count * width);
    for (size_t i = 0; i < elements.count; ++i)
        for (size_t c = 0; c < width; ++c)
            values[i * width + c] =
                component(elements.bytes + i * elements.stride + c * size, elements.componentType, elements.normalized);
    return true;
}

bool readIndices(const tinygltf::Model& model, int accessor, std::vector<uint32_t>& values, std::string& error) {
    Elements elements;
    if (!locate(model, accessor, 1, elements, error)) return false;
    values.resize(elements.count);
    for (size_t i = 0; i < elements.count; ++i) {
        const uint8_t* bytes = elements.bytes + i * elements.stride;
        switch (elements.componentType) {
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                values[i] = *bytes;
                break;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                values[i] = load<uint16_t>(bytes);
                break;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
                values[i] = load<uint32_t>(bytes);
                break;
            default:
                error = named("accessor", accessor) + ": indices are unsigned integers";
                return false;
        }
    }
    return true;
}

}  // namespace samples
