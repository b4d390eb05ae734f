// The types of a module, and how their values come apart into scalars ("leaves").
#pragma once

#include <vector>

#include "spirv_interp/front/module.h"
#include "spirv_interp/ir/ir.h"

namespace vernier {

/// A scalar of a value: how lanes hold it, and its width in memory. Integers of less than 32 bits are held in i32 with
/// zeros above them, whatever their sign; halves as an f32 that has a binary16 value.
struct LeafType {
    ir::Type type = ir::Type::none;
    uint8_t bits = 0;       // 8, 16, 32 or 64; 32 for booleans
    bool isSigned = false;  // integers

    operator ir::Type() const { return type; }
    uint32_t bytes() const { return bits / 8u; }
    bool isHalf() const { return type == ir::Type::f32 && bits == 16; }
    bool isNarrowInteger() const { return type == ir::Type::i32 && bits < 32; }
    /// Of a narrow integer: the bits that can be set.
    uint32_t mask() const { return (1u << bits) - 1; }
};

struct ImageType {
    ir::Type component = ir::Type::f32;  // f32 or i32
    spv::Dim dim{};
    bool depth = false, arrayed = false, multisampled = false;
    bool storage = false;  // used without a sampler: read and write
};

struct SpirvType {
    enum class Kind : uint8_t {
        unknown,
        void_,
        boolean,
        integer,
        floating,
        vector,
        matrix,
        array,
        runtimeArray,
        structure,
        pointer,
        function,
        image,
        sampler,
        sampledImage,
    };
    Kind kind = Kind::unknown;
    LeafType scalar;                // of scalars, vectors and matrices
    uint32_t element = 0;           // vector, matrix (column), array, pointer, sampledImage (image): type id
    uint32_t count = 0;             // vector, matrix, array: elements
    spv::StorageClass storage{};    // pointer
    std::vector<uint32_t> members;  // structure: type ids; their first leaves and words in memberLeaf, memberWord
    std::vector<uint32_t> memberLeaf, memberWord;
    uint32_t leaves = 0;  // scalars in a value; opaque types have none
    uint32_t words = 0;   // 32-bit words that hold the leaves outside buffers
    uint32_t depth = 0;   // of composites inside composites
    ImageType image;

    bool isComposite() const {
        return kind == Kind::vector || kind == Kind::matrix || kind == Kind::array || kind == Kind::structure;
    }
    bool isOpaque() const { return kind == Kind::image || kind == Kind::sampler || kind == Kind::sampledImage; }
};

/// Composites of more leaves than this are refused.
inline constexpr uint32_t kMaxLeaves = 1u << 16;

/// And those nested deeper: types are walked by recursion. The universal limit for structures is the same.
inline constexpr uint32_t kMaxTypeDepth = 255;

}  // namespace vernier
