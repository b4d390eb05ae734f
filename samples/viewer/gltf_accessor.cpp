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
};

/// `count` elements of `components` from a byte of a buffer view on, whatever the view's stride is good for.
bool locateIn(const tinygltf::Model& model, int view, size_t byteOffset, size_t count, int componentType,
              int components, const std::string& name, Elements& elements, std::string& error) {
    size_t viewSize = 0;
    if (!bytesOfView(model, view, elements.bytes, viewSize, error)) {
        error = name + ": " + error;
        return false;
    }
    const auto componentSize =
        static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(componentType)));
    const size_t elementSize = componentSize * static_cast<size_t>(components);
    const size_t declared = model.bufferViews[static_cast<size_t>(view)].byteStride;
    elements.stride = declared ? declared : elementSize;
    // The last element needs its own bytes only, not a whole stride.
    const bool inside = byteOffset <= viewSize && count > 0 && elementSize <= viewSize - byteOffset &&
                        count - 1 <= (viewSize - byteOffset - elementSize) / elements.stride;
    if (!inside || elements.stride < elementSize) {
        error = name + ": " + std::to_string(count) + " elements of " + std::to_string(elementSize) +
                " bytes from byte " + std::to_string(byteOffset) + " on do not lie in its buffer view of " +
                std::to_string(viewSize) + " bytes";
        return false;
    }
    elements.bytes += byteOffset;
    elements.count = count;
    elements.componentType = componentType;
    return true;
}

/// The accessor, if it is one of `components` that glTF allows.
const tinygltf::Accessor* accessorOf(const tinygltf::Model& model, int index, int components, std::string& error) {
    const std::string name = named("accessor", index);
    if (index < 0 || static_cast<size_t>(index) >= model.accessors.size()) {
        error = "there is no " + name;
        return nullptr;
    }
    const tinygltf::Accessor& accessor = model.accessors[static_cast<size_t>(index)];
    if (tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)) != components) {
        error = name + " has not " + std::to_string(components) + " components";
        return nullptr;
    }
    const int componentSize = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType));
    if (componentSize <= 0 || accessor.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE ||
        accessor.componentType == TINYGLTF_COMPONENT_TYPE_INT) {
        error = name + " has the component type " + std::to_string(accessor.componentType) + ", which glTF lacks";
        return nullptr;
    }
    return &accessor;
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

namespace {

bool indexAt(const Elements& elements, size_t i, uint32_t& value) {
    const uint8_t* bytes = elements.bytes + i * elements.stride;
    switch (elements.componentType) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            value = *bytes;
            return true;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            value = load<uint16_t>(bytes);
            return true;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            value = load<uint32_t>(bytes);
            return true;
        default:
            return false;
    }
}

/// More than any mesh has; without a buffer view nothing else bounds how many zeros an accessor may ask for.
constexpr size_t kMostZeros = size_t{1} << 22;

/// Calls put(element, its elements, its place among them) for the elements of an accessor in order, then for those that
/// it replaces (glTF 2.0, 3.6.2.3: sparse accessors). Elements that are in no buffer view are zero: those put() is not
/// called for. `resize`: gets their number before.
template <class Resize, class Put>
bool forEachElement(const tinygltf::Model& model, int index, int components, const Resize& resize, const Put& put,
                    std::string& error) {
    const tinygltf::Accessor* accessor = accessorOf(model, index, components, error);
    if (!accessor) return false;
    const std::string name = named("accessor", index);
    Elements elements;
    if (accessor->bufferView >= 0 || !accessor->sparse.isSparse) {
        if (!locateIn(model, accessor->bufferView, accessor->byteOffset, accessor->count, accessor->componentType,
                      components, name, elements, error))
            return false;
    } else if (accessor->count == 0 || accessor->count > kMostZeros) {
        error = name + ": " + std::to_string(accessor->count) + " elements";
        return false;
    }
    resize(accessor->count);
    for (size_t i = 0; i < elements.count; ++i)
        if (!put(i, elements, i)) {
            error = name + ": indices are unsigned integers";
            return false;
        }
    if (!accessor->sparse.isSparse) return true;
    const auto& sparse = accessor->sparse;
    if (sparse.count <= 0) {
        error = name + ": replaces " + std::to_string(sparse.count) + " elements";
        return false;
    }
    Elements places, values;
    const auto count = static_cast<size_t>(sparse.count);
    if (tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(sparse.indices.componentType)) <= 0 ||
        !locateIn(model, sparse.indices.bufferView, static_cast<size_t>(sparse.indices.byteOffset), count,
                  sparse.indices.componentType, 1, name + ", sparse indices", places, error) ||
        !locateIn(model, sparse.values.bufferView, static_cast<size_t>(sparse.values.byteOffset), count,
                  accessor->componentType, components, name + ", sparse values", values, error)) {
        if (error.empty()) error = name + ": indices are unsigned integers";
        return false;
    }
    for (size_t i = 0; i < count; ++i) {
        uint32_t place = 0;
        if (!indexAt(places, i, place) || place >= accessor->count || !put(place, values, i)) {
            error = name + ": replaces element " + std::to_string(place) + " of " + std::to_string(accessor->count);
            return false;
        }
    }
    return true;
}

}  // namespace

bool readFloats(const tinygltf::Model& model, int accessor, int components, std::vector<float>& values,
                std::string& error) {
    const auto width = static_cast<size_t>(components);
    const auto put = [&](size_t at, const Elements& elements, size_t from) {
        const auto size =
            static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(elements.componentType)));
        const bool normalized = model.accessors[static_cast<size_t>(accessor)].normalized;
        for (size_t c = 0; c < width; ++c)
            values[at * width + c] =
                component(elements.bytes + from * elements.stride + c * size, elements.componentType, normalized);
        return true;
    };
    return forEachElement(
        model, accessor, components, [&](size_t count) { values.assign(count * width, 0.0f); }, put, error);
}

bool readIndices(const tinygltf::Model& model, int accessor, std::vector<uint32_t>& values, std::string& error) {
    const auto put = [&](size_t at, const Elements& elements, size_t from) {
        return indexAt(elements, from, values[at]);
    };
    return forEachElement(
        model, accessor, 1, [&](size_t count) { values.assign(count, 0); }, put, error);
}

int componentsOf(const tinygltf::Model& model, int accessor) {
    if (accessor < 0 || static_cast<size_t>(accessor) >= model.accessors.size()) return 0;
    return tinygltf::GetNumComponentsInType(static_cast<uint32_t>(model.accessors[static_cast<size_t>(accessor)].type));
}

}  // namespace samples
