// GLSL.std.450 functions on whole vectors and matrices, evaluated in W and rounded to Number once. W is
// Wide<Number>, or with Options::stepwise the type of the result itself.
#include <type_traits>

#include "spirv_interp/reference/machine.h"

#include <spirv/unified1/GLSL.std.450.h>

namespace vernier::reference {
namespace {

template <class W>
using Vector = std::vector<W>;

template <class W, class Number>
Vector<W> widen(const Scalars<Number>& scalars) {
    Vector<W> result;
    for (const Scalar<Number>& s : scalars) result.push_back(static_cast<W>(s.number));
    return result;
}

template <class W>
W dot(const Vector<W>& a, const Vector<W>& b) {
    W sum = a[0] * b[0];
    for (size_t k = 1; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
}

/// Square, column by column, without row and column 0 <= `row`, `column` < n.
template <class W>
Vector<W> minor(const Vector<W>& m, size_t n, size_t row, size_t column) {
    Vector<W> result;
    for (size_t c = 0; c < n; ++c)
        for (size_t r = 0; r < n; ++r)
            if (c != column && r != row) result.push_back(m[c * n + r]);
    return result;
}

/// Laplace expansion along the first column.
template <class W>
W determinant(const Vector<W>& m, size_t n) {
    if (n == 1) return m[0];
    W sum(0);
    for (size_t r = 0; r < n; ++r) {
        const W term = m[r] * determinant(minor(m, n, r, 0), n - 1);
        sum = r == 0 ? term : r % 2 == 0 ? W(sum + term) : W(sum - term);
    }
    return sum;
}

/// The transposed cofactors over the determinant, or `stepwise` times its reciprocal.
template <class W>
Vector<W> inverse(const Vector<W>& m, size_t n, bool stepwise) {
    const W d = determinant(m, n), reciprocal = W(1) / d;
    Vector<W> result;
    for (size_t c = 0; c < n; ++c)
        for (size_t r = 0; r < n; ++r) {
            const W minorOf = determinant(minor(m, n, c, r), n - 1);
            const W cofactor = (c + r) % 2 == 0 ? minorOf : W(-minorOf);
            result.push_back(stepwise ? W(cofactor * reciprocal) : W(cofactor / d));
        }
    return result;
}

size_t squareSize(size_t scalars) {
    for (size_t n = 2; n <= 4; ++n)
        if (n * n == scalars) return n;
    fail("a matrix of " + std::to_string(scalars) + " components is not square");
}

}  // namespace

template <class Number>
bool Machine<Number>::glslGeometric(const Instruction& i, uint32_t function) {
    if constexpr (std::is_floating_point_v<Number>) {
        const Type& type = resultType(i);
        if (program_.options.stepwise &&
            (type.isScalar() || type.kind == TypeKind::vector || type.kind == TypeKind::matrix))
            return module_.scalarType(type).width == 64 ? glslGeometricIn<double>(i, function)
                                                        : glslGeometricIn<float>(i, function);
    }
    return glslGeometricIn<Wide<Number>>(i, function);
}

template <class Number>
template <class W>
bool Machine<Number>::glslGeometricIn(const Instruction& i, uint32_t function) {
    using std::fabs, std::sqrt;
    const bool stepwise = program_.options.stepwise;
    const auto finish = [&](const Vector<W>& components) {
        Scalars<Number> result;
        for (const W& x : components) result.push_back(Scalar<Number>::ofNumber(static_cast<Number>(x)));
        setResult(i, std::move(result));
        return true;
    };
    const auto argument = [&](size_t index) { return widen<W>(data(i.operand(2 + index))); };
    const auto length = [](const Vector<W>& x) { return x.size() == 1 ? W(fabs(x[0])) : W(sqrt(dot(x, x))); };
    const auto sameSize = [&](size_t index, size_t count) { return widen<W>(data(i.operand(2 + index), count)); };
    switch (function) {
        case GLSLstd450Length: {
            const Vector<W> x = argument(0);
            return finish({length(x)});
        }
        case GLSLstd450Distance: {
            Vector<W> x = argument(0);
            const Vector<W> y = sameSize(1, x.size());
            for (size_t k = 0; k < x.size(); ++k) x[k] -= y[k];
            return finish({length(x)});
        }
        case GLSLstd450Cross: {
            const Vector<W> x = sameSize(0, 3), y = sameSize(1, 3);
            return finish({x[1] * y[2] - y[1] * x[2], x[2] * y[0] - y[2] * x[0], x[0] * y[1] - y[0] * x[1]});
        }
        case GLSLstd450Normalize: {
            Vector<W> x = argument(0);
            if (x.size() == 1) return finish({x[0] > W(0) ? W(1) : x[0] < W(0) ? W(-1) : W(0)});
            const W norm = length(x);
            W reciprocal = W(1) / norm;
            if constexpr (std::is_floating_point_v<W>) {
                if (program_.options.elementary != nullptr && module_.scalarType(resultType(i)).width == 32) {
                    const W square = dot(x, x);
                    reciprocal = program_.options.elementary->evaluate(GLSLstd450InverseSqrt, toFloat32(square), 0);
                }
            }
            for (W& component : x) component = stepwise ? W(component * reciprocal) : W(component / norm);
            return finish(x);
        }
        case GLSLstd450FaceForward: {
            Vector<W> n = argument(0);
            const Vector<W> incident = sameSize(1, n.size()), reference = sameSize(2, n.size());
            if (!(dot(reference, incident) < W(0)))
                for (W& component : n) component = -component;
            return finish(n);
        }
        case GLSLstd450Reflect: {
            Vector<W> incident = argument(0);
            const Vector<W> n = sameSize(1, incident.size());
            const W twice = W(2) * dot(n, incident);
            for (size_t k = 0; k < n.size(); ++k) incident[k] -= twice * n[k];
            return finish(incident);
        }
        case GLSLstd450Refract: {
            Vector<W> incident = argument(0);
            const Vector<W> n = sameSize(1, incident.size());
            const auto eta = static_cast<W>(scalar(i.operand(4)).number);
            const W cosine = dot(n, incident);
            const W k = W(1) - eta * eta * (W(1) - cosine * cosine);
            if (k < W(0)) return finish(Vector<W>(n.size(), W(0)));
            const W along = eta * cosine + sqrt(k);
            for (size_t c = 0; c < n.size(); ++c) incident[c] = eta * incident[c] - along * n[c];
            return finish(incident);
        }
        case GLSLstd450Determinant: {
            const Vector<W> m = argument(0);
            return finish({determinant(m, squareSize(m.size()))});
        }
        case GLSLstd450MatrixInverse: {
            const Vector<W> m = argument(0);
            return finish(inverse(m, squareSize(m.size()), stepwise));
        }
        default:
            return false;
    }
}

template bool Machine<float>::glslGeometric(const Instruction&, uint32_t);
template bool Machine<double>::glslGeometric(const Instruction&, uint32_t);
template bool Machine<Real>::glslGeometric(const Instruction&, uint32_t);

}  // namespace vernier::reference
