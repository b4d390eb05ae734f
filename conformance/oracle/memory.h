// What a scene's commands read and write: its images, and what shaders have stored into buffers.
#pragma once

#include "conformance/oracle/image_store.h"
#include "conformance/scene/scene.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace vernier::conformance::exact {

/// A buffer seen as texels of one format, from an offset on.
struct TexelBuffer {
    const PixelFormat* format = nullptr;
    VkDeviceSize offset = 0;
    std::vector<StoredTexel> texels;

    /// As the binding sees the bytes; without a format that the oracle knows it has no texels.
    static TexelBuffer of(const SceneBinding& binding, const Bytes& bytes);
    bool isSeenBy(const SceneBinding& binding) const;
};

/// A texel that a fragment stores.
struct TexelWrite {
    const SceneBinding* binding = nullptr;  // of a storage image or a storage texel buffer
    std::array<int32_t, 3> at{};            // the third is the layer or the slice
    Color color{};
    OracleFlags flags = 0;
    bool open = false;  // the fragment may not be there
};

enum class WordKind : uint8_t { unsignedInteger, signedInteger, floating };

/// A word of 32 bits that may hold several values.
struct OpenWord {
    WordKind kind = WordKind::unsignedInteger;
    Interval value;
    OracleFlags flags = 0;
};

/// A buffer that shaders have stored into. `bytes` are the declared values, those of open words the nearest ones.
struct StoredBuffer {
    Bytes bytes;
    std::map<uint64_t, OpenWord> open;  // by offset
};

/// A number as a word of a kind: rounded, and at the end of the kind's range when it is beyond.
uint32_t wordOf(WordKind kind, double number);
double numberOf(WordKind kind, uint32_t word);

struct Memory {
    std::vector<ImageStore> images;
    std::map<uint32_t, TexelBuffer> texelBuffers;  // by number of SceneBuffer: those that shaders have written
    std::map<uint32_t, StoredBuffer> buffers;      // the same of storage buffers
};

/// Stores what the fragments of one draw have left. Vulkan orders nothing among them (Shader Memory Access Ordering):
/// a texel that several have stored to may hold what any of them left. Stores outside do nothing.
Status applyWrites(const Scene& scene, const std::vector<TexelWrite>& writes, Memory& memory);

}  // namespace vernier::conformance::exact
