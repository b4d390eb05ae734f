// A glTF file parsed by tinygltf, its container checked first.
#pragma once

#include <tiny_gltf.h>

#include <string>
#include <vector>

#include "samples/common/picture_file.h"

namespace samples {

/// Images are decoded through stb where the file has them by name or inside of its text; of those inside of a buffer
/// view `pictures` stays empty: see pictureOf(). False with what is wrong, naming the file.
bool readGltfFile(const std::string& path, tinygltf::Model& model, std::vector<Picture>& pictures, std::string& error);

/// The picture of an image, wherever it lies.
bool pictureOf(const tinygltf::Model& model, const std::vector<Picture>& pictures, int image, Picture& picture,
               std::string& error);

}  // namespace samples
