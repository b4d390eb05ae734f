// Makes small glTF files, right and wrong ones, in code.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace samples::test {

/// Bytes of numbers, one after the other.
class Bytes {
  public:
    template <class T>
    Bytes& add(const std::vector<T>& values) {
        const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
        data_.insert(data_.end(), bytes, bytes + values.size() * sizeof(T));
        return *this;
    }
    const std::vector<uint8_t>& data() const { return data_; }

  private:
    std::vector<uint8_t> data_;
};

inline std::string base64(const std::vector<uint8_t>& bytes) {
    constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kLetters[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// A GLB of a JSON text and a binary chunk (glTF 2.0, 4.4).
inline std::vector<uint8_t> glb(std::string json, std::vector<uint8_t> binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    const auto size = static_cast<uint32_t>(12 + 8 + json.size() + 8 + binary.size());
    Bytes file;
    file.add<uint32_t>({0x46546C67, 2, size, static_cast<uint32_t>(json.size()), 0x4E4F534A});
    file.add(std::vector<char>(json.begin(), json.end()));
    file.add<uint32_t>({static_cast<uint32_t>(binary.size()), 0x004E4942}).add(binary);
    return file.data();
}

/// Replaces the one occurrence of `from`; anything else is a fault of the test and gives "".
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) return {};
    return text.replace(at, from.size(), to);
}

}  // namespace samples::test
