// Arithmetic and comparisons on numbers, integers and matrices.
#include "spirv_interp/reference/integer_ops.h"
#include "spirv_interp/reference/machine.h"

namespace vernier::reference {
namespace {

/// Exact, with the sign of the dividend.
template <class Number>
Number remainder(const Number& x, const Number& y) {
    using std::fmod;
    return fmod(x, y);
}

/// Exact before its rounding, with the sign of the divisor: x - y * floor(x / y) in real numbers.
template <class Number>
Number modulo(const Number& x, const Number& y) {
    const Number r = remainder(x, y);
    return r != Number(0) && (r < Number(0)) != (y < Number(0)) ? r + y : r;
}

}  // namespace

template <class Number>
bool Machine<Number>::executeArithmetic(const Instruction& i) {
    return executeFloat(i) || executeInteger(i) || executeFloatComparison(i) || executeMatrix(i) || executeExtended(i);
}

template <class Number>
bool Machine<Number>::executeFloat(const Instruction& i) {
    const auto binary = [&](auto function) {
        const size_t count = resultCount(i);
        const Scalars<Number>&a = data(i.operand(0), count), &b = data(i.operand(1), count);
        Scalars<Number> result;
        for (size_t k = 0; k < count; ++k)
            result.push_back(Scalar<Number>::ofNumber(function(a[k].number, b[k].number)));
        setResult(i, std::move(result));
        return true;
    };
    // x - y * whole(x / y), each operation in the type of the result.
    const auto stepwise = [&](auto whole) {
        const bool wide = module_.scalarType(resultType(i)).width == 64;
        return binary([=](const Number& x, const Number& y) {
            const auto in = [&]<class W>(W a, W b) { return Number(a - b * whole(W(a / b))); };
            return wide ? in(static_cast<double>(x), static_cast<double>(y)) : in(toFloat32(x), toFloat32(y));
        });
    };
    if (program_.options.stepwise && i.op == spv::OpFRem) return stepwise([](auto x) { return std::trunc(x); });
    if (program_.options.stepwise && i.op == spv::OpFMod) return stepwise([](auto x) { return std::floor(x); });
    switch (i.op) {
        case spv::OpFAdd:
            return binary([](const Number& a, const Number& b) { return a + b; });
        case spv::OpFSub:
            return binary([](const Number& a, const Number& b) { return a - b; });
        case spv::OpFMul:
            return binary([](const Number& a, const Number& b) { return a * b; });
        case spv::OpFDiv:
            return binary([](const Number& a, const Number& b) { return a / b; });
        case spv::OpFRem:
            return binary(remainder<Number>);
        case spv::OpFMod:
            return binary(modulo<Number>);
        case spv::OpFNegate: {
            Scalars<Number> result = data(i.operand(0), resultCount(i));
            for (Scalar<Number>& s : result) s.number = -s.number;
            setResult(i, std::move(result));
            return true;
        }
        default:
            return false;
    }
}

template <class Number>
bool Machine<Number>::executeInteger(const Instruction& i) {
    const uint32_t operandCount = integerOperandCount(i.op);
    if (operandCount == 0) return false;
    const size_t count = resultCount(i);
    const Type& type = module_.scalarType(module_.valueType(i.operand(0)));
    if (type.kind != TypeKind::integer && type.kind != TypeKind::boolean)
        fail(name(i.op) + " on type " + name(type.id));
    Scalars<Number> result;
    for (size_t k = 0; k < count; ++k) {
        std::array<uint64_t, 4> operands{};
        for (uint32_t o = 0; o < operandCount; ++o) {
            // The offset and count of bit-field instructions are scalars beside vectors.
            const bool single = o >= 1 && data(i.operand(o)).size() == 1;
            operands[o] = single ? bits(i.operand(o)) : data(i.operand(o), count)[k].bits;
        }
        result.push_back(Scalar<Number>::ofBits(*integerOperation(i.op, type.width, operands)));
    }
    setResult(i, std::move(result));
    return true;
}

template <class Number>
bool Machine<Number>::executeFloatComparison(const Instruction& i) {
    using std::isinf;
    using std::isnan;
    const auto test = [&](auto function) {
        const size_t count = resultCount(i);
        const Scalars<Number>& x = data(i.operand(0), count);
        Scalars<Number> result;
        for (size_t k = 0; k < count; ++k) result.push_back(Scalar<Number>::ofBits(function(x[k].number) ? 1 : 0));
        setResult(i, std::move(result));
        return true;
    };
    const auto compare = [&](bool ifUnordered, auto function) {
        const size_t count = resultCount(i);
        const Scalars<Number>&a = data(i.operand(0), count), &b = data(i.operand(1), count);
        Scalars<Number> result;
        for (size_t k = 0; k < count; ++k) {
            const bool unordered = isnan(a[k].number) || isnan(b[k].number);
            const bool holds = unordered ? ifUnordered : function(a[k].number, b[k].number);
            result.push_back(Scalar<Number>::ofBits(holds ? 1 : 0));
        }
        setResult(i, std::move(result));
        return true;
    };
    const auto equal = [](const Number& a, const Number& b) { return a == b; };
    const auto different = [](const Number& a, const Number& b) { return a < b || b < a; };
    const auto less = [](const Number& a, const Number& b) { return a < b; };
    const auto greater = [](const Number& a, const Number& b) { return b < a; };
    const auto lessEqual = [](const Number& a, const Number& b) { return a <= b; };
    const auto greaterEqual = [](const Number& a, const Number& b) { return b <= a; };
    switch (i.op) {
        case spv::OpIsNan:
            return test([](const Number& x) { return isnan(x); });
        case spv::OpIsInf:
            return test([](const Number& x) { return isinf(x); });
        case spv::OpOrdered:
            return compare(false, [](const Number&, const Number&) { return true; });
        case spv::OpUnordered:
            return compare(true, [](const Number&, const Number&) { return false; });
        case spv::OpFOrdEqual:
            return compare(false, equal);
        case spv::OpFUnordEqual:
            return compare(true, equal);
        case spv::OpFOrdNotEqual:
            return compare(false, different);
        case spv::OpFUnordNotEqual:
            return compare(true, different);
        case spv::OpFOrdLessThan:
            return compare(false, less);
        case spv::OpFUnordLessThan:
            return compare(true, less);
        case spv::OpFOrdGreaterThan:
            return compare(false, greater);
        case spv::OpFUnordGreaterThan:
            return compare(true, greater);
        case spv::OpFOrdLessThanEqual:
            return compare(false, lessEqual);
        case spv::OpFUnordLessThanEqual:
            return compare(true, lessEqual);
        case spv::OpFOrdGreaterThanEqual:
            return compare(false, greaterEqual);
        case spv::OpFUnordGreaterThanEqual:
            return compare(true, greaterEqual);
        case spv::OpAny:
        case spv::OpAll: {
            const bool any = i.op == spv::OpAny;
            bool result = !any;
            for (const Scalar<Number>& s : data(i.operand(0)))
                result = any ? result || s.bits != 0 : result && s.bits != 0;
            setResult(i, Scalar<Number>::ofBits(result ? 1 : 0));
            return true;
        }
        default:
            return false;
    }
}

/// Matrices are flattened column by column. Sums run from the first product to the last.
template <class Number>
bool Machine<Number>::executeMatrix(const Instruction& i) {
    const auto step = [&](const Number& x) {
        // Halves are worked on in float, and rounded at the end.
        const bool single = program_.options.stepwise && module_.scalarType(resultType(i)).width != 64;
        return single ? Number(toFloat32(x)) : x;
    };
    // Row vectors of `a` (rows x inner) times columns of `b` (inner x columns).
    const auto product = [&](size_t rows, size_t inner, size_t columns) {
        const Scalars<Number>&a = data(i.operand(0), rows * inner), &b = data(i.operand(1), inner * columns);
        Scalars<Number> result;
        for (size_t c = 0; c < columns; ++c)
            for (size_t r = 0; r < rows; ++r) {
                Number sum = step(a[r].number * b[c * inner].number);
                for (size_t k = 1; k < inner; ++k)
                    sum = step(sum + step(a[k * rows + r].number * b[c * inner + k].number));
                result.push_back(Scalar<Number>::ofNumber(sum));
            }
        setResult(i, std::move(result));
        return true;
    };
    switch (i.op) {
        case spv::OpVectorTimesScalar:
        case spv::OpMatrixTimesScalar: {
            Scalars<Number> result = data(i.operand(0), resultCount(i));
            const Number& factor = scalar(i.operand(1)).number;
            for (Scalar<Number>& s : result) s.number *= factor;
            setResult(i, std::move(result));
            return true;
        }
        case spv::OpDot:
            return product(1, data(i.operand(0)).size(), 1);
        case spv::OpVectorTimesMatrix:
            return product(1, data(i.operand(0)).size(), resultCount(i));
        case spv::OpMatrixTimesVector:
            return product(resultCount(i), data(i.operand(1)).size(), 1);
        case spv::OpMatrixTimesMatrix: {
            const Type& type = resultType(i);
            if (type.kind != TypeKind::matrix) fail("OpMatrixTimesMatrix to type " + name(type.id));
            const size_t rows = module_.types[type.element].count;
            return product(rows, data(i.operand(0)).size() / rows, type.count);
        }
        case spv::OpOuterProduct:
            return product(data(i.operand(0)).size(), 1, data(i.operand(1)).size());
        default:
            return false;
    }
}

/// Instructions with a struct of two results.
template <class Number>
bool Machine<Number>::executeExtended(const Instruction& i) {
    const auto extended = [&](auto function) {
        const size_t count = data(i.operand(0)).size();
        const Scalars<Number>&a = data(i.operand(0)), &b = data(i.operand(1), count);
        const uint32_t width = module_.scalarType(module_.valueType(i.operand(0))).width;
        Scalars<Number> result(2 * count);
        for (size_t k = 0; k < count; ++k) {
            const auto [first, second] = function(a[k].bits, b[k].bits, width);
            result[k].bits = first;
            result[count + k].bits = second;
        }
        setResult(i, std::move(result));
        return true;
    };
    using Pair = std::pair<uint64_t, uint64_t>;
    switch (i.op) {
        case spv::OpIAddCarry:
            return extended([](uint64_t a, uint64_t b, uint32_t width) {
                const uint64_t sum = (a + b) & widthMask(width);
                return Pair{sum, sum < a ? 1 : 0};
            });
        case spv::OpISubBorrow:
            return extended([](uint64_t a, uint64_t b, uint32_t width) {
                return Pair{(a - b) & widthMask(width), a < b ? 1 : 0};
            });
        case spv::OpUMulExtended:
        case spv::OpSMulExtended:
            return extended([&](uint64_t a, uint64_t b, uint32_t width) {
                return Pair{(a * b) & widthMask(width), multiplyHigh(a, b, width, i.op == spv::OpSMulExtended)};
            });
        default:
            return false;
    }
}

template bool Machine<float>::executeArithmetic(const Instruction&);
template bool Machine<double>::executeArithmetic(const Instruction&);
template bool Machine<Real>::executeArithmetic(const Instruction&);

}  // namespace vernier::reference
