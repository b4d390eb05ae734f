// The scalars of a value, and how the lowering ends when a module does not hold what it must.
#pragma once

#include <span>

#include "base/result.h"
#include "spirv_interp/ir/ir.h"

namespace vernier {

/// Thrown inside front/ only; load_shader.cpp turns it into its Error.
struct LoweringError {
    Error error;
};

/// A span that ends the lowering when it is asked for more than it has: whatever a module says about the number of
/// scalars, nothing beside them is read or written.
template <class T>
class CheckedSpan : public std::span<T> {
  public:
    using std::span<T>::span;
    CheckedSpan(std::span<T> other) : std::span<T>(other) {}

    T& operator[](size_t index) const {
        require(index < this->size());
        return std::span<T>::operator[](index);
    }
    CheckedSpan first(size_t count) const {
        require(count <= this->size());
        return std::span<T>::first(count);
    }
    CheckedSpan subspan(size_t first, size_t count = std::dynamic_extent) const {
        require(first <= this->size() && (count == std::dynamic_extent || count <= this->size() - first));
        return std::span<T>::subspan(first, count);
    }

  private:
    static void require(bool inside) {
        if (!inside) {
            throw LoweringError{
                Error{ErrorCode::invalidArgument, "SPIR-V: a value has fewer components than are used"}};
        }
    }
};
using Scalars = CheckedSpan<const ir::ValueId>;
using NewScalars = CheckedSpan<ir::ValueId>;

}  // namespace vernier
