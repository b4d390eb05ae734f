// The numbers behind a glTF accessor, with every range checked.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <vector>

namespace samples {

/// The bytes of a buffer view; false with what is wrong where it does not lie inside its buffer.
bool bytesOfView(const tinygltf::Model& model, int view, const uint8_t*& bytes, size_t& size, std::string& error);

// Sparse accessors, too.
/// `components` numbers per element; integers become fractions where the accessor is normalised (glTF 2.0, 3.6.2.2).
bool readFloats(const tinygltf::Model& model, int accessor, int components, std::vector<float>& values,
                std::string& error);
/// Unsigned integers of one component.
bool readIndices(const tinygltf::Model& model, int accessor, std::vector<uint32_t>& values, std::string& error);
/// How many components an element has; not positive where there is no such accessor.
int componentsOf(const tinygltf::Model& model, int accessor);

}  // namespace samples
