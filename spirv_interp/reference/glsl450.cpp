// GLSL.std.450, componentwise functions on floats: each is evaluated in W and rounded to Number once. W is
// Wide<Number>, or with Options::stepwise the type of the result itself.
#include <limits>
#include <type_traits>

#include "spirv_interp/reference/machine.h"

#include <spirv/unified1/GLSL.std.450.h>

namespace vernier::reference {
namespace {

constexpr double kRadiansPerDegree = 0.017453292519943295769, kDegreesPerRadian = 57.295779513082320877;

template <class W>
W constant(double x) {
    return static_cast<W>(x);
}

template <class W>
W pi() {
    using std::acos;
    return acos(W(-1));
}

/// A NaN is ignored (NMin, NMax; FMin and FMax leave it open). Of two zeros the second.
template <class W>
W minimum(const W& a, const W& b) {
    using std::isnan;
    return isnan(b) || a < b ? a : b;
}
template <class W>
W maximum(const W& a, const W& b) {
    using std::isnan;
    return isnan(b) || b < a ? a : b;
}
template <class W>
W clamp(const W& x, const W& low, const W& high) {
    return minimum(maximum(x, low), high);
}

template <class W>
W smoothStep(const W& edge0, const W& edge1, const W& x) {
    const W t = clamp(W((x - edge0) / (edge1 - edge0)), W(0), W(1));
    return t * t * (W(3) - W(2) * t);
}

bool isElementary(uint32_t function) {
    return (function >= GLSLstd450Sin && function <= GLSLstd450Log2) || function == GLSLstd450InverseSqrt;
}

/// x - floor(x) rounds up to 1 just below an integer.
template <class W>
W fract(const W& x) {
    using std::floor;
    const W fraction = x - floor(x);
    if constexpr (std::is_floating_point_v<W>) {
        const W below = W(1) - std::numeric_limits<W>::epsilon() / 2;
        return fraction > below ? below : fraction;
    } else {
        return fraction;
    }
}

}  // namespace

template <class Number>
bool Machine<Number>::glslNumber(const Instruction& i, uint32_t function) {
    const Type& type = module_.scalarType(resultType(i));
    if (program_.options.elementary != nullptr && isElementary(function) && type.width == 32) {
        const size_t count = resultCount(i);
        const bool two = function == GLSLstd450Atan2 || function == GLSLstd450Pow;
        const Scalars<Number>&x = data(i.operand(2), count), &y = data(i.operand(two ? 3 : 2), count);
        Scalars<Number> result;
        for (size_t k = 0; k < count; ++k) {
            result.push_back(Scalar<Number>::ofNumber(Number(
                program_.options.elementary->evaluate(function, toFloat32(x[k].number), toFloat32(y[k].number)))));
        }
        setResult(i, std::move(result));
        return true;
    }
    if constexpr (std::is_floating_point_v<Number>) {
        if (program_.options.stepwise)
            return type.width == 64 ? glslNumberIn<double>(i, function) : glslNumberIn<float>(i, function);
    }
    return glslNumberIn<Wide<Number>>(i, function);
}

template <class Number>
template <class W>
bool Machine<Number>::glslNumberIn(const Instruction& i, uint32_t function) {
    const bool stepwise = program_.options.stepwise;
    const bool half = module_.scalarType(resultType(i)).width == 16;
    const auto toHalf = [](double x) { return Number(halfToFloat32(doubleToHalf(x))); };
    using std::acos, std::acosh, std::asin, std::asinh, std::atan, std::atan2, std::atanh, std::ceil, std::cos,
        std::cosh, std::exp, std::exp2, std::fabs, std::floor, std::fma, std::log, std::log2, std::pow, std::rint,
        std::sin, std::sinh, std::sqrt, std::tan, std::tanh, std::trunc;
    const auto finish = [&](size_t count, auto component) {
        Scalars<Number> result;
        for (size_t k = 0; k < count; ++k)
            result.push_back(Scalar<Number>::ofNumber(static_cast<Number>(component(k))));
        setResult(i, std::move(result));
        return true;
    };
    const auto unary = [&](auto f) {
        const size_t count = resultCount(i);
        const Scalars<Number>& x = data(i.operand(2), count);
        return finish(count, [&](size_t k) { return f(static_cast<W>(x[k].number)); });
    };
    const auto binary = [&](auto f) {
        const size_t count = resultCount(i);
        const Scalars<Number>&x = data(i.operand(2), count), &y = data(i.operand(3), count);
        return finish(count, [&](size_t k) { return f(static_cast<W>(x[k].number), static_cast<W>(y[k].number)); });
    };
    const auto ternary = [&](auto f) {
        const size_t count = resultCount(i);
        const Scalars<Number>&x = data(i.operand(2), count), &y = data(i.operand(3), count),
              &z = data(i.operand(4), count);
        return finish(count, [&](size_t k) {
            return f(static_cast<W>(x[k].number), static_cast<W>(y[k].number), static_cast<W>(z[k].number));
        });
    };
    switch (function) {
        case GLSLstd450Round:  // which way a half goes is left open
        case GLSLstd450RoundEven:
            return unary([](const W& x) { return rint(x); });
        case GLSLstd450Trunc:
            return unary([](const W& x) { return trunc(x); });
        case GLSLstd450FAbs:
            return unary([](const W& x) { return fabs(x); });
        case GLSLstd450FSign:
            return unary([](const W& x) { return x > W(0) ? W(1) : x < W(0) ? W(-1) : W(0); });
        case GLSLstd450Floor:
            return unary([](const W& x) { return floor(x); });
        case GLSLstd450Ceil:
            return unary([](const W& x) { return ceil(x); });
        case GLSLstd450Fract:
            return unary([=](const W& x) {
                constexpr float kHalfBelowOne = 0x1.ffcp-1f;
                const W fraction = fract(x);
                if (!half) return fraction;
                const Number rounded = toHalf(static_cast<double>(fraction));
                return static_cast<W>(rounded < Number(kHalfBelowOne) ? rounded : Number(kHalfBelowOne));
            });
        case GLSLstd450Radians:
            return unary(
                [=](const W& x) { return stepwise ? W(x * constant<W>(kRadiansPerDegree)) : W(x * pi<W>() / W(180)); });
        case GLSLstd450Degrees:
            return unary(
                [=](const W& x) { return stepwise ? W(x * constant<W>(kDegreesPerRadian)) : W(x * W(180) / pi<W>()); });
        case GLSLstd450Sin:
            return unary([](const W& x) { return sin(x); });
        case GLSLstd450Cos:
            return unary([](const W& x) { return cos(x); });
        case GLSLstd450Tan:
            return unary([](const W& x) { return tan(x); });
        case GLSLstd450Asin:
            return unary([](const W& x) { return asin(x); });
        case GLSLstd450Acos:
            return unary([](const W& x) { return acos(x); });
        case GLSLstd450Atan:
            return unary([](const W& x) { return atan(x); });
        case GLSLstd450Sinh:
            return unary([](const W& x) { return sinh(x); });
        case GLSLstd450Cosh:
            return unary([](const W& x) { return cosh(x); });
        case GLSLstd450Tanh:
            return unary([](const W& x) { return tanh(x); });
        case GLSLstd450Asinh:
            return unary([](const W& x) { return asinh(x); });
        case GLSLstd450Acosh:
            return unary([](const W& x) { return acosh(x); });
        case GLSLstd450Atanh:
            return unary([](const W& x) { return atanh(x); });
        case GLSLstd450Atan2:
            return binary([](const W& y, const W& x) { return atan2(y, x); });
        case GLSLstd450Pow:
            return binary([](const W& x, const W& y) { return pow(x, y); });
        case GLSLstd450Exp:
            return unary([](const W& x) { return exp(x); });
        case GLSLstd450Log:
            return unary([](const W& x) { return log(x); });
        case GLSLstd450Exp2:
            return unary([](const W& x) { return exp2(x); });
        case GLSLstd450Log2:
            return unary([](const W& x) { return log2(x); });
        case GLSLstd450Sqrt:
            return unary([](const W& x) { return sqrt(x); });
        case GLSLstd450InverseSqrt:
            return unary([](const W& x) { return W(W(1) / sqrt(x)); });
        case GLSLstd450FMin:
        case GLSLstd450NMin:
            return binary(minimum<W>);
        case GLSLstd450FMax:
        case GLSLstd450NMax:
            return binary(maximum<W>);
        case GLSLstd450FClamp:
        case GLSLstd450NClamp:
            return ternary(clamp<W>);
        case GLSLstd450FMix:
            return ternary([](const W& x, const W& y, const W& a) { return W(x * (W(1) - a) + y * a); });
        case GLSLstd450Step:
            return binary([](const W& edge, const W& x) { return x < edge ? W(0) : W(1); });
        case GLSLstd450SmoothStep:
            return ternary(smoothStep<W>);
        case GLSLstd450Fma: {
            // In the type of the result: rounding to a wider one first would round twice.
            const size_t count = resultCount(i);
            const Scalars<Number>&a = data(i.operand(2), count), &b = data(i.operand(3), count),
                  &c = data(i.operand(4), count);
            const bool single = program_.options.roundToFloat && module_.scalarType(resultType(i)).width == 32;
            return finish(count, [&](size_t k) {
                // The product of two halves is exact in binary64, and so is the half next to the sum.
                if (half)
                    return toHalf(static_cast<double>(a[k].number) * static_cast<double>(b[k].number) +
                                  static_cast<double>(c[k].number));
                return single ? Number(fma(toFloat32(a[k].number), toFloat32(b[k].number), toFloat32(c[k].number)))
                              : fma(a[k].number, b[k].number, c[k].number);
            });
        }
        default:
            return false;
    }
}

template <class Number>
void Machine<Number>::executeGlsl(const Instruction& i) {
    if (module_.info(i.operand(0)).kind != IdKind::glslSet) fail(name(i.operand(0)) + " is no instruction set");
    const uint32_t function = i.operand(1);
    const bool known = glslNumber(i, function) || glslGeometric(i, function) || glslStructured(i, function) ||
                       glslInteger(i, function) || glslPacking(i, function) || glslInterpolate(i, function);
    if (!known) failUnsupported("GLSL.std.450 instruction " + std::to_string(function));
}

template void Machine<float>::executeGlsl(const Instruction&);
template void Machine<double>::executeGlsl(const Instruction&);
template void Machine<Real>::executeGlsl(const Instruction&);

}  // namespace vernier::reference
