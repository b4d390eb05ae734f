#include "samples/viewer/gltf_file.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <filesystem>

#include "samples/viewer/gltf_accessor.h"

namespace samples {
namespace {

constexpr char kMagic[] = {'g', 'l', 'T', 'F'};
constexpr size_t kHeader = 12, kChunkHeader = 8;

uint32_t wordAt(const std::vector<uint8_t>& bytes, size_t offset) {
    uint32_t word = 0;
    for (size_t i = 0; i < 4; ++i) word |= uint32_t{bytes[offset + i]} << (8 * i);
    return word;
}

bool isBinary(const std::vector<uint8_t>& bytes) {
    return bytes.size() >= sizeof kMagic && std::memcmp(bytes.data(), kMagic, sizeof kMagic) == 0;
}

/// Whether all chunks lie inside the file (glTF 2.0, 4.4): tinygltf reads up to eight bytes beyond the last one.
bool checkChunks(const std::vector<uint8_t>& bytes, std::string& error) {
    if (bytes.size() < kHeader + kChunkHeader) {
        error = "cut off: " + std::to_string(bytes.size()) + " bytes are no GLB";
        return false;
    }
    if (wordAt(bytes, 4) != 2) {
        error = "GLB version " + std::to_string(wordAt(bytes, 4)) + "; the viewer reads version 2";
        return false;
    }
    const size_t length = wordAt(bytes, 8);
    if (length != bytes.size()) {
        error = "cut off: its header tells of " + std::to_string(length) + " bytes, the file has " +
                std::to_string(bytes.size());
        return false;
    }
    for (size_t at = kHeader; at < length;) {
        const size_t left = length - at;
        if (left < kChunkHeader || wordAt(bytes, at) > left - kChunkHeader) {
            error = "the chunk at byte " + std::to_string(at) + " ends beyond the file";
            return false;
        }
        at += kChunkHeader + wordAt(bytes, at);
    }
    return true;
}

/// tinygltf's callback for images; a picture that cannot be decoded is left empty, with a warning.
bool decodeImage(tinygltf::Image* image, int index, std::string*, std::string* warning, int, int, const uint8_t* bytes,
                 int size, void* user) {
    auto& pictures = *static_cast<std::vector<Picture>*>(user);
    pictures.resize(std::max(pictures.size(), static_cast<size_t>(index) + 1));
    // Where the bytes are said to lie has not been checked.
    if (image->bufferView >= 0) return true;
    std::string error;
    if (!decodePicture(bytes, static_cast<size_t>(size), pictures[static_cast<size_t>(index)], error))
        *warning += "image " + std::to_string(index) + ": " + error + "\n";
    return true;
}

}  // namespace

bool readGltfFile(const std::string& path, tinygltf::Model& model, std::vector<Picture>& pictures, std::string& error) {
    std::vector<uint8_t> bytes;
    const bool found = readFile(path, bytes);
    std::string folder = std::filesystem::path(path).parent_path().string(), warning;
    if (folder.empty()) folder = ".";
    bool read = false;
    if (!found) {
        error = "could not be read";
    } else if (bytes.size() > UINT32_MAX) {
        error = "more than 4 GB";
    } else if (!isBinary(bytes) || checkChunks(bytes, error)) {
        tinygltf::TinyGLTF reader;
        reader.SetImageLoader(decodeImage, &pictures);
        const auto size = static_cast<unsigned int>(bytes.size());
        // A JSON of wrong types, and empty buffers, make tinygltf throw.
        try {
            read = isBinary(bytes)
                       ? reader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size, folder)
                       : reader.LoadASCIIFromString(&model, &error, &warning,
                                                    reinterpret_cast<const char*>(bytes.data()), size, folder);
        } catch (const std::exception& thrown) {
            error += thrown.what();
        }
    }
    while (!error.empty() && error.back() == '\n') error.pop_back();
    if (!read) error = path + ": " + (error.empty() ? "is no glTF" : error);
    pictures.resize(model.images.size());
    return read;
}

bool pictureOf(const tinygltf::Model& model, const std::vector<Picture>& pictures, int image, Picture& picture,
               std::string& error) {
    if (image < 0 || static_cast<size_t>(image) >= model.images.size()) {
        error = "there is no image " + std::to_string(image);
        return false;
    }
    const tinygltf::Image& from = model.images[static_cast<size_t>(image)];
    picture = pictures[static_cast<size_t>(image)];
    const uint8_t* bytes = nullptr;
    size_t size = 0;
    if (from.bufferView >= 0) {
        if (bytesOfView(model, from.bufferView, bytes, size, error) && decodePicture(bytes, size, picture, error))
            return true;
    } else if (!picture.texels.empty()) {
        return true;
    } else {
        error = from.uri + " could not be read";
    }
    error = "image " + std::to_string(image) + ": " + error;
    return false;
}

}  // namespace samples
